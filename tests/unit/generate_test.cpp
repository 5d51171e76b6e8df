// Each kind of generated pattern where its numbers say what must be there.
#include <burin/generate.hpp>

#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include <burin/evaluate.hpp>
#include <burin/resolve.hpp>

namespace burin {
namespace {

constexpr double kPi = std::numbers::pi;

Pattern generated(const char* kind, const ParameterValues& parameters, Wrap wrap = Wrap::repeat) {
    GenerateSpec spec;
    spec.kind = kind;
    spec.parameters = parameters;
    spec.wrap = wrap;
    auto pattern = generate_pattern(spec);
    EXPECT_TRUE(pattern) << pattern.error().message;
    return pattern ? *pattern : Pattern{};
}

Truth truth_of(const Pattern& pattern) {
    const auto resolved = resolve_pattern(pattern);
    EXPECT_TRUE(resolved) << resolved.error().message;
    return Truth(*resolved);
}

TEST(Generate, table_is_whole) {
    for (const GeneratorEntry& entry : generator_table()) {
        std::map<std::string, int> names;
        for (const Parameter& p : entry.parameters) {
            EXPECT_EQ(++names[p.name], 1) << entry.name << " " << p.name;
            EXPECT_TRUE(p.low <= p.usual && p.usual <= p.high) << entry.name << " " << p.name;
        }
    }
}

TEST(Generate, tiles_stand_between_joints) {
    const Pattern pattern = generated("tiles", {{"columns", 4}, {"rows", 2}, {"joint", 0.006}, {"bevel", 0.002}, {"depth", 0.003}, {"uneven", 0}});
    ASSERT_EQ(pattern.paths.size(), 8u);
    EXPECT_DOUBLE_EQ(pattern.depth, 0.003);
    EXPECT_EQ(pattern.base_offset, 0.0);
    const Truth truth = truth_of(pattern);
    EXPECT_DOUBLE_EQ(truth.surface_at({0.025, 0.05}).height, 0.0);   // a tile
    EXPECT_DOUBLE_EQ(truth.surface_at({0.05, 0.05}).height, -0.003);  // a joint
    EXPECT_DOUBLE_EQ(truth.surface_at({0.0, 0.0}).height, -0.003);    // where four meet
    EXPECT_DOUBLE_EQ(truth.surface_at({0.05 - 0.0019, 0.05}).height, -0.003);
    EXPECT_DOUBLE_EQ(truth.surface_at({0.05 - 0.0041, 0.05}).height, 0.0);
}

TEST(Generate, bricks_shift_and_their_joints_can_be_grooves) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp})
        for (const double raised : {0.0, 1.0}) {
            const Pattern pattern = generated("bricks", {{"columns", 2}, {"course_pairs", 1}, {"raised", raised}, {"uneven", 0}, {"irregular", 0}}, wrap);
            const Truth truth = truth_of(pattern);
            const double deep = -0.003;
            EXPECT_NEAR(truth.surface_at({0.1, 0.05}).height, deep, 1e-12);  // between two bricks of the first course
            EXPECT_NEAR(truth.surface_at({0.1, 0.15}).height, 0.0, 1e-12);   // in the middle of one of the second
            EXPECT_NEAR(truth.surface_at({0.05, 0.15}).height, deep, 1e-12);
            EXPECT_NEAR(truth.surface_at({0.15, 0.15}).height, deep, 1e-12);
            EXPECT_NEAR(truth.surface_at({0.05, 0.1}).height, deep, 1e-12);  // between the courses
        }
}

TEST(Generate, hatching_has_the_angle_and_distance_asked_for) {
    const Pattern pattern = generated("hatch", {{"layers", 1}, {"angle", 30}, {"spacing", 0.004}, {"jitter", 0}, {"uneven", 0}});
    const Element& e = pattern.paths.front().elements.front();
    const Vec2 way = e.p2 - e.p0;
    EXPECT_NEAR(std::atan2(way.y, way.x) * 180.0 / kPi, 30.0, 1.0);
    const double apart = pattern.size.x * pattern.size.y / (length(way) * double(pattern.paths.size()));
    EXPECT_NEAR(apart, 0.004, 0.0003);
    // Clamped lines need not close: both are exact.
    const Pattern open = generated("hatch", {{"layers", 1}, {"angle", 30}, {"spacing", 0.004}, {"jitter", 0}, {"uneven", 0}}, Wrap::clamp);
    const Element &a = open.paths[10].elements.front(), &b = open.paths[11].elements.front();
    const Vec2 along = unit(a.p2 - a.p0);
    EXPECT_NEAR(std::atan2(along.y, along.x) * 180.0 / kPi, 30.0, 1e-9);
    EXPECT_NEAR(std::abs(cross(b.p0 - a.p0, along)), 0.004, 1e-12);
}

TEST(Generate, knurl_leaves_points) {
    const Pattern pattern = generated("knurl", {{"spacing", 0.005}});
    const Truth truth = truth_of(pattern);
    double highest_point = -1.0, sum = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const double height = truth.surface_at({0.2 * ((i * 0.6180339887) - std::floor(i * 0.6180339887)), 0.2 * i / 2000.0}).height;
        highest_point = std::max(highest_point, height);
        sum += height;
    }
    EXPECT_GT(highest_point, -0.1 * pattern.depth);
    // The lower one of two triangle waves that know nothing of each other is two thirds down on the average.
    EXPECT_NEAR(sum / 2000.0, -2.0 / 3.0 * pattern.depth, 0.03 * pattern.depth);
}

TEST(Generate, threads_go_over_and_under) {
    const Pattern pattern = generated("weave", {{"warp", 2}, {"weft", 2}, {"under", 0.4}});
    const Truth truth = truth_of(pattern);
    const ResolvedPattern resolved = *resolve_pattern(pattern);
    const double pitch = 0.05;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) {
            const SurfacePoint point = truth.surface_at({(i + 0.5) * pitch, (k + 0.5) * pitch});
            EXPECT_NEAR(point.height, pattern.base_offset, 1e-12);
            const Element& e = resolved.elements[point.element].element;
            EXPECT_EQ(std::abs(e.p2.x - e.p0.x) < std::abs(e.p2.y - e.p0.y), (i + k) % 2 == 0) << i << " " << k;
        }
}

TEST(Generate, grooves_of_a_record_lie_one_inside_the_other) {
    for (const double spiral : {0.0, 1.0}) {
        const Pattern pattern = generated("vinyl", {{"outer", 0.9}, {"inner", 0.5}, {"pitch", 0.002}, {"spiral", spiral}, {"uneven", 0}});
        EXPECT_EQ(pattern.paths.size(), spiral == 1.0 ? 1u : 20u);
        const Truth truth = truth_of(pattern);
        for (int turn = 1; turn < 19; ++turn)
            for (const double angle : {0.3, 2.0, 5.0}) {
                const double radius = 0.09 - 0.002 * (turn + (spiral == 1.0 ? angle / (2.0 * kPi) : 0.0));
                const Vec2 d{std::cos(angle), std::sin(angle)};
                EXPECT_NEAR(truth.surface_at(Vec2{0.1, 0.1} + d * radius).height, -0.0005, 1e-5) << turn;
                EXPECT_NEAR(truth.surface_at(Vec2{0.1, 0.1} + d * (radius - 0.001)).height, 0.0, 1e-12) << turn;
            }
    }
}

// Two rings are linked when one is on top where they cross first and the other where they cross again.
TEST(Generate, rings_of_chainmail_are_linked) {
    const Pattern pattern = generated("chainmail", {{"columns", 4}, {"row_pairs", 4}});
    const Truth truth = truth_of(pattern);
    const ResolvedPattern resolved = *resolve_pattern(pattern);
    const Vec2 pitch{0.05, 0.025};
    const double radius = 0.45 * pitch.x;
    for (const double side : {1.0, -1.0}) {
        const Vec2 first{2.25 * pitch.x, 2.5 * pitch.y}, second = first + Vec2{side * 0.5 * pitch.x, pitch.y};
        const Vec2 middle = lerp(first, second, 0.5), apart = second - first;
        const Vec2 off = normal_of(unit(apart)) * std::sqrt(radius * radius - 0.25 * dot(apart, apart));
        std::uint32_t on_top[2];
        for (int k = 0; k < 2; ++k) on_top[k] = resolved.elements[truth.surface_at(middle + off * (k == 0 ? 1.0 : -1.0)).element].path;
        EXPECT_NE(on_top[0], on_top[1]) << side;
    }
}

TEST(Generate, cracks_thin_to_nothing_and_branches_begin_on_their_parent) {
    const Pattern pattern = generated("cracks", {{"count", 3}, {"generations", 1}, {"branching", 0.5}});
    ASSERT_GT(pattern.paths.size(), 6u);
    for (const Path& path : pattern.paths) EXPECT_EQ(path.elements.back().width1, 0.0);
    int trunks = 0;
    for (const Path& path : pattern.paths) trunks += path.elements.front().width0 == 0.0;
    EXPECT_EQ(trunks, 3);
    const ResolvedPattern resolved = *resolve_pattern(pattern);
    int tees = 0;
    for (const Junction& junction : resolved.junctions) tees += junction.kind == JunctionKind::tee;
    EXPECT_GE(tees, int(pattern.paths.size()) - 3);
}

TEST(Generate, another_profile_in_place_of_the_usual_one) {
    GenerateSpec spec;
    spec.kind = "vinyl";
    spec.profile = "flat(floor=0.25)";
    EXPECT_EQ(generate_pattern(spec)->profiles.front().points.size(), 4u);
    spec.profile = "flat(flor=0.25)";
    EXPECT_FALSE(generate_pattern(spec));
}

}  // namespace
}  // namespace burin
