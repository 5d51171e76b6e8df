// Path data: every command, exact where it can be, within the tolerance where not.
#include <cmath>

#include <gtest/gtest.h>

#include <burin/path_data.hpp>

#include "../property/random_pattern.hpp"

namespace burin::testing {
namespace {

constexpr std::uint64_t kSeed = 20261124;
constexpr double kTolerance = 1e-4;

std::vector<Subpath> parse(const std::string& data, const Affine& transform = {}) {
    const PathData read = parse_path_data(data, transform, kTolerance);
    EXPECT_EQ(read.problem, "") << data;
    return read.subpaths;
}

Vec2 at(const Element& e, double t) {
    if (e.kind == ElementKind::line) return lerp(e.p0, e.p2, t);
    return e.p0 * ((1 - t) * (1 - t)) + e.p1 * (2 * t * (1 - t)) + e.p2 * (t * t);
}

double distance_to(const std::vector<Element>& elements, Vec2 p) {
    double nearest = 1e300;
    for (const Element& e : elements)
        for (int k = 0; k <= 400; ++k) nearest = std::min(nearest, length(at(e, k / 400.0) - p));
    return nearest;
}

TEST(PathData, LinesAndQuadraticsAreExact) {
    const auto paths = parse("M0.1 0.2L.3,.4h1v-1H0.25V0.75 Q1 2 3 4 T 5 6zm1 1l2 2");
    ASSERT_EQ(paths.size(), 2u);
    ASSERT_EQ(paths[0].elements.size(), 8u);
    EXPECT_TRUE(paths[0].closed);
    EXPECT_FALSE(paths[1].closed);
    const auto& e = paths[0].elements;
    EXPECT_EQ(e[0].p0, (Vec2{0.1, 0.2}));
    EXPECT_EQ(e[0].p2, (Vec2{0.3, 0.4}));
    EXPECT_EQ(e[3].p2, (Vec2{0.25, -0.6}));
    EXPECT_EQ(e[4].p2, (Vec2{0.25, 0.75}));
    EXPECT_EQ(e[5].p1, (Vec2{1, 2}));
    EXPECT_EQ(e[6].p1, (Vec2{5, 6}));
    EXPECT_EQ(e[7].p2, (Vec2{0.1, 0.2}));
    for (std::size_t i = 1; i < e.size(); ++i) EXPECT_EQ(e[i].p0, e[i - 1].p2);
    EXPECT_EQ(paths[1].start, (Vec2{1.1, 1.2}));
}

TEST(PathData, RaisedQuadraticsComeBack) {
    const auto paths = parse("M0 0C2 4 4 6 6 6");
    ASSERT_EQ(paths[0].elements.size(), 1u);
    EXPECT_NEAR(length(paths[0].elements[0].p1 - Vec2{3, 6}), 0.0, 1e-12);
}

TEST(PathData, CubicsKeepToTheTolerance) {
    Random random(kSeed);
    for (int k = 0; k < 200; ++k) {
        Vec2 p[4];
        for (Vec2& q : p) q = {random.between(-1, 1), random.between(-1, 1)};
        PathPen pen({}, kTolerance);
        pen.move_to(p[0]);
        pen.cubic_to(p[1], p[2], p[3]);
        const auto elements = pen.finish()[0].elements;
        for (int i = 0; i <= 50; ++i) {
            const double t = i / 50.0, s = 1 - t;
            const Vec2 q = p[0] * (s * s * s) + p[1] * (3 * s * s * t) + p[2] * (3 * s * t * t) + p[3] * (t * t * t);
            // Half a step between the places that the distance is asked at.
            EXPECT_LE(distance_to(elements, q), kTolerance + 0.01 / double(elements.size())) << "seed " << kSeed << ", cubic " << k;
        }
        for (std::size_t i = 1; i < elements.size(); ++i) EXPECT_EQ(elements[i].p0, elements[i - 1].p2);
    }
}

TEST(PathData, ArcsKeepToTheTolerance) {
    // A stretched and turned circle of radius 2 about (1, 1): every point of the result maps back onto it.
    const Affine stretch{3.0, 0.5, -0.25, 1.0, 0.1, 0.2};
    for (const char* data : {"M3 1A2 2 0 0 1 1 3", "M3 1A2 2 0 1 1 1 -1", "M3 1A2 2 0 1 0 1 3"}) {
        const auto elements = parse(data, stretch)[0].elements;
        const double det = stretch.determinant();
        for (const Element& e : elements)
            for (int k = 0; k <= 20; ++k) {
                const Vec2 p = at(e, k / 20.0) - Vec2{stretch.e, stretch.f};
                const Vec2 q{(stretch.d * p.x - stretch.c * p.y) / det, (stretch.a * p.y - stretch.b * p.x) / det};
                EXPECT_NEAR(length(q - Vec2{1, 1}), 2.0, kTolerance) << data;
            }
    }
}

TEST(PathData, ArcsAsSvgHasThem) {
    EXPECT_EQ(parse("M0 0A0 1 0 0 1 3 4")[0].elements[0].kind, ElementKind::line);
    // Radii that are too small grow until the arc fits: half a circle.
    const auto half = parse("M0 0A.1 .1 0 0 1 2 0")[0].elements;
    EXPECT_LE(distance_to(half, {1, -1}), 1e-3);
    EXPECT_EQ(half.back().p2, (Vec2{2, 0}));
}

TEST(PathData, ProblemsEndTheData) {
    const PathData broken = parse_path_data("M 30 40 L 110 160 L 150#80", {}, kTolerance);
    EXPECT_EQ(broken.problem, "path data has '#' at character 24, behind '10 160 L 150'") << broken.problem;
    ASSERT_EQ(broken.subpaths.size(), 1u);
    EXPECT_EQ(broken.subpaths[0].elements.size(), 1u);
    EXPECT_NE(parse_path_data("L 1 1", {}, kTolerance).problem, "");
    EXPECT_NE(parse_path_data("M 100 100 h -25 a 25 25 0 -1 0 25 -25 z", {}, kTolerance).problem, "");
    EXPECT_EQ(parse_path_data("", {}, kTolerance).problem, "");
    EXPECT_TRUE(parse_path_data("", {}, kTolerance).subpaths.empty());
}

TEST(PathData, SubpathsWithoutLengthStayAsDots) {
    const auto paths = parse("M1 1ZM2 2L2 2");
    ASSERT_EQ(paths.size(), 2u);
    EXPECT_TRUE(paths[0].elements.empty());
    EXPECT_EQ(paths[1].start, (Vec2{2, 2}));
}

}  // namespace
}  // namespace burin::testing
