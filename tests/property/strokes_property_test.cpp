// Lines drawn on bodies: what is seen in space, judged by the truth from the packed textures, stays where and as wide as it was drawn.
#include <cmath>

#include <gtest/gtest.h>

#include <strokes/judge.hpp>

namespace burin::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;

StrokeOptions usual(double width = 0.008) {
    StrokeOptions options;
    options.width = width;
    options.height = 0.3 * width;
    return options;
}

ProjectedStrokes projected(const Model& model, const std::vector<Stroke>& strokes, const StrokeOptions& options) {
    auto made = project_strokes(model, strokes, options);
    EXPECT_TRUE(made.ok()) << (made.ok() ? "" : made.error().message);
    return made.ok() ? std::move(*made) : ProjectedStrokes{};
}

// Within 0.1 % of the body and `width` of the width, and seen everywhere.
void expect_shown(const Model& model, const Stroke& stroke, const std::string& what, double width = 0.02, const StrokeOptions& options = usual()) {
    const Mesh mesh(model, "");
    const ProjectedStrokes made = projected(model, {stroke}, options);
    const auto figures = judge_strokes(mesh, made.pattern, {stroke}, options, options.width);
    ASSERT_TRUE(figures.ok()) << what << ": " << figures.error().message;
    EXPECT_GT(figures->seen, 10) << what;
    EXPECT_EQ(figures->missing, 0) << what << " at " << figures->worst_missing.x << " " << figures->worst_missing.y << " " << figures->worst_missing.z;
    EXPECT_LT(figures->stray, 0.001 * figures->size) << what;
    EXPECT_LT(figures->offset, 0.001 * figures->size) << what;
    EXPECT_LT(figures->width_error, width) << what << " at " << figures->worst_width.x << " " << figures->worst_width.y << " " << figures->worst_width.z;
}

Stroke line(Point3 a, Point3 b, int points = 2) {
    Stroke stroke{"line", {}, false};
    for (int i = 0; i < points; ++i) stroke.points.push_back(a + (b - a) * (double(i) / (points - 1)));
    return stroke;
}

TEST(StrokesProperty, CirclesOnASphereOfSixCharts) {
    const Model model = cube_sphere(24, 1.0).model();
    for (unsigned seed = 1; seed <= 8; ++seed) {
        std::mt19937 random(seed);
        const Point3 axis = random_direction(random);
        const double turn = random() % 3 ? 1.0 + double(random() % 4) : 2.0 * kPi;
        expect_shown(model, circle_on_sphere(axis, random() % 2 ? 0.0 : 0.2, double(random() % 6), turn, 300), "seed " + std::to_string(seed));
    }
}

// Charts of different stretch meet: half of the width on either side is seen by its own Jacobian, and fitted on its own.
TEST(StrokesProperty, CirclesOverChartsStretchedThreeToOne) {
    const Model model = cube_sphere(32, 3.0).model();
    for (unsigned seed = 1; seed <= 4; ++seed) {
        std::mt19937 random(seed);
        expect_shown(model, circle_on_sphere(random_direction(random), 0.0, 0.0, 3.0, 300), "seed " + std::to_string(seed), 0.03);
    }
}

TEST(StrokesProperty, WindingsOfATorus) {
    const Model whole = torus(60, 1, 1.0).model(), parts = torus(60, 6, 3.0).model();
    for (unsigned seed = 1; seed <= 4; ++seed) {
        std::mt19937 random(seed);
        const auto next = [&] { return double(random()) / 4294967296.0; };
        const Stroke stroke = winding(6 * next(), 6 * next(), next() - 0.5, 2 * next() - 1, 300);
        expect_shown(whole, stroke, "one chart, seed " + std::to_string(seed));
        expect_shown(parts, stroke, "six charts, seed " + std::to_string(seed));
    }
}

// The seam of one chart that closes by a whole tile is none: the pattern repeats, and a parallel is one closed path.
TEST(StrokesProperty, SeamOfAWholeTile) {
    const Model model = latitude_sphere(48).model();
    const Stroke parallel = circle_on_sphere({0, 1, 0}, 0.1, 0.3, 2.0 * kPi, 300);
    const ProjectedStrokes made = projected(model, {parallel}, usual());
    ASSERT_EQ(made.pattern.paths.size(), 1u);
    EXPECT_TRUE(made.pattern.paths[0].closed);
    EXPECT_EQ(made.pattern.wrap, Wrap::repeat);
    expect_shown(model, parallel, "parallel");
    expect_shown(model, circle_on_sphere({0, 0, 1}, 0.0, -0.5 * kPi - 0.6, 1.2, 100), "along the seam");
    expect_shown(model, circle_on_sphere(unit({0, 0.3, 1}), 0.0, -0.5 * kPi - 0.6, 1.2, 100), "over the seam");
}

class TwoCharts : public testing::Test {
  protected:
    const Model model = two_charts(7, 0.7).model();
    StrokeOptions options = usual(0.03);
};

TEST_F(TwoCharts, AcrossTheBorderAtManyAngles) {
    for (const double degrees : {90.0, 60.0, 30.0, 15.0, 5.0, 2.0}) {
        const double a = degrees / 180.0 * kPi;
        const Point3 way{0.9 * std::sin(a), 0.0, 0.9 * std::cos(a)};
        expect_shown(model, line(way * -1.0 + Point3{0.0031, 0, 0.01}, way + Point3{0.0031, 0, 0.01}), std::to_string(degrees) + " degrees", 0.02, options);
    }
}

TEST_F(TwoCharts, AlongTheBorder) {
    expect_shown(model, line({0, 0, -0.9}, {0, 0, 0.9}), "exactly", 0.02, options);
    expect_shown(model, line({0.01, 0, -0.9}, {0.01, 0, 0.9}), "beside it", 0.02, options);
    expect_shown(model, line({0.0149, 0, -0.9}, {0.0149, 0, 0.9}), "touching it", 0.02, options);
    const ProjectedStrokes far = projected(model, {line({0.05, 0, -0.9}, {0.05, 0, 0.9})}, options);
    EXPECT_EQ(far.pattern.paths.size(), 1u) << "one that does not touch it shows in one chart alone";
}

// Caps are half a width long: an end on the border shows on both sides of it.
TEST_F(TwoCharts, EndsOnTheBorder) {
    const Mesh mesh(model, "");
    for (const double end : {0.0, -0.005, -0.012}) {
        const ProjectedStrokes made = projected(model, {line({-0.5, 0, 0.1}, {end, 0, 0.1})}, options);
        ASSERT_EQ(made.pattern.paths.size(), 2u) << end;
        EXPECT_EQ(made.pattern.paths[1].end_cap, CapKind::round);
        const auto resolved = resolve_pattern(made.pattern);
        ASSERT_TRUE(resolved.ok()) << resolved.error().message;
        // Over the border, at half of the cap's reach.
        const auto place = mesh.nearest({end + 0.0125, 0, 0.1});
        EXPECT_LT(surface_at(*resolved, {place.uv.x * made.pattern.size.x, place.uv.y * made.pattern.size.y}).height, -0.1 * options.height) << end;
    }
    EXPECT_EQ(projected(model, {line({-0.5, 0, 0.1}, {-0.02, 0, 0.1})}, options).pattern.paths.size(), 1u);
}

TEST_F(TwoCharts, AlongEdgesAndThroughVertices) {
    const double step = 1.0 / 7.0;
    expect_shown(model, line({-3 * step, 0, -0.9}, {-3 * step, 0, 0.9}), "along edges", 0.02, options);
    expect_shown(model, line({-6 * step, 0, -1 + 4 * step}, {6 * step, 0, -1 + 4 * step}), "along edges, over the border", 0.02, options);
    expect_shown(model, line({-6 * step, 0, -1 + 2 * step}, {6 * step, 0, -1 + 10 * step}, 7), "through vertices", 0.02, options);
}

// What is across a corner has no width; that nothing is missing can be asked.
TEST_F(TwoCharts, BendsCloseToTheBorder) {
    const Mesh mesh(model, "");
    for (const double tip : {-0.02, -0.004, 0.0, 0.004, 0.02}) {
        const Stroke stroke{"bent", {{-0.4, 0, -0.4}, {tip, 0, 0.0}, {-0.4, 0, 0.4}}, false};
        const auto figures = judge_strokes(mesh, projected(model, {stroke}, options).pattern, {stroke}, options, options.width);
        ASSERT_TRUE(figures.ok()) << figures.error().message;
        EXPECT_EQ(figures->missing, 0) << tip << " at " << figures->worst_missing.x << " " << figures->worst_missing.z;
        EXPECT_LT(figures->stray, 0.001 * figures->size) << tip;
    }
}

TEST_F(TwoCharts, ClosedOverTheBorder) {
    Stroke ring{"ring", {}, true};
    for (int i = 0; i < 90; ++i) ring.points.push_back({0.05 + 0.5 * std::cos(i * kPi / 45), 0, 0.5 * std::sin(i * kPi / 45)});
    expect_shown(model, ring, "ring", 0.02, options);
}

// Over the rim of the mesh and back: parted there, with a note, and shown up to the rim.
TEST_F(TwoCharts, LeavesTheMesh) {
    Stroke bow{"bow", {{-0.5, 0, 0.6}, {-0.4, 0, 0.9}, {-0.3, 0, 1.05}, {-0.2, 0, 0.9}, {-0.1, 0, 0.6}}, false};
    const ProjectedStrokes made = projected(model, {bow}, options);
    EXPECT_EQ(made.pattern.paths.size(), 2u);
    ASSERT_EQ(made.notes.size(), 1u);
    EXPECT_NE(made.notes[0].find("stroke 1 'bow' is parted at"), std::string::npos) << made.notes[0];
    const Mesh mesh(model, "");
    const Stroke kept{"kept", {{-0.5, 0, 0.6}, {-0.4, 0, 0.9}}, false};
    const auto figures = judge_strokes(mesh, made.pattern, {kept}, options, 0.03);
    ASSERT_TRUE(figures.ok());
    EXPECT_EQ(figures->missing, 0);
}

TEST_F(TwoCharts, PointsFarFromTheSurfaceAreNamed) {
    Stroke stroke = line({-0.5, 0, 0}, {-0.4, 0.3, 0});
    stroke.name = "scratch";
    const auto made = project_strokes(model, std::span(&stroke, 1), options);
    ASSERT_FALSE(made.ok());
    EXPECT_NE(made.error().message.find("stroke 1 'scratch': point 2 of 2 at (-0.4, 0.3, 0) is 0.3 m away"), std::string::npos) << made.error().message;
    options.max_distance = 0.31;
    EXPECT_TRUE(project_strokes(model, std::span(&stroke, 1), options).ok());
}

// Slivers without area between two halves, as T-junctions that were closed leave them, and triangles far smaller than the width.
TEST(StrokesProperty, TinyAndDegenerateTriangles) {
    Body body;
    const auto at = [&](double x, double z) { return body.place({x, 0, z}); };
    const auto uv = [&](double x, double z) { return body.uv({0.5 + 0.4 * x, 0.5 + 0.4 * z}); };
    const std::size_t p[] = {at(-1, -1), at(1, -1), at(-1, 0), at(1, 0), at(-1, 1), at(1, 1), at(0.2, 0), at(0.2001, 0.0001), at(0.2002, 0)};
    const std::size_t t[] = {uv(-1, -1), uv(1, -1), uv(-1, 0), uv(1, 0), uv(-1, 1), uv(1, 1), uv(0.2, 0), uv(0.2001, 0.0001), uv(0.2002, 0)};
    const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) { body.triangle({p[a], p[b], p[c]}, {t[a], t[b], t[c]}); };
    triangle(0, 2, 1), triangle(1, 2, 3);
    triangle(2, 6, 3), triangle(6, 8, 3);                      // no area
    triangle(2, 4, 6), triangle(6, 4, 7), triangle(7, 4, 5), triangle(7, 5, 8), triangle(8, 5, 3), triangle(6, 7, 8);
    const Model model = body.model();
    expect_shown(model, line({0.2, 0, -0.9}, {0.2, 0, 0.9}, 5), "through slivers", 0.02, usual(0.03));
    expect_shown(model, line({-0.9, 0, 0}, {0.9, 0, 0}), "along slivers", 0.02, usual(0.03));
    expect_shown(model, line({-0.5, 0, -0.5}, {0.7, 0, 0.4}), "across", 0.02, usual(0.03));
}

// Two halves that share their texture coordinates: the groove shows on both, and a note says where.
TEST(StrokesProperty, MirroredHalvesAreNoted) {
    Body body;
    for (const double side : {-1.0, 1.0})
        body.sheet(3, 3, [&](double x, double z) { return Point3{side * (1.0 - x), 0, side * z}; }, [](double x, double z) { return Vec2{0.1 + 0.8 * x, 0.1 + 0.8 * z}; });
    const ProjectedStrokes made = projected(body.model(), {line({0.3, 0, 0.2}, {0.6, 0, 0.7})}, usual(0.03));
    ASSERT_EQ(made.notes.size(), 1u);
    EXPECT_NE(made.notes[0].find("also shows at (-0."), std::string::npos) << made.notes[0];
}

TEST(StrokesProperty, EqualBitsEachTime) {
    const Model model = cube_sphere(12, 3.0).model();
    const Stroke stroke = circle_on_sphere(unit({1, 2, 3}), 0.0, 0.0, 5.0, 200);
    const Pattern a = projected(model, {stroke}, usual()).pattern, b = projected(model, {stroke}, usual()).pattern;
    ASSERT_EQ(a.paths.size(), b.paths.size());
    for (std::size_t i = 0; i < a.paths.size(); ++i) {
        ASSERT_EQ(a.paths[i].elements.size(), b.paths[i].elements.size());
        for (std::size_t k = 0; k < a.paths[i].elements.size(); ++k) {
            EXPECT_TRUE(a.paths[i].elements[k].p0 == b.paths[i].elements[k].p0);
            EXPECT_EQ(a.paths[i].elements[k].width1, b.paths[i].elements[k].width1);
        }
    }
}

}  // namespace
}  // namespace burin::bench
