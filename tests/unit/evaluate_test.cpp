// The truth on patterns whose surface has a closed form that a person can check.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <burin/evaluate.hpp>
#include <burin/rasterize.hpp>

#include "../property/resolved_builder.hpp"

namespace burin {
namespace {

using namespace testing;

constexpr double kPi = std::numbers::pi;

// A groove 0.1 wide at the top, 0.04 at the bottom, 3 mm deep.
double groove_at(double b) {
    const double d = std::abs(b);
    return d >= 0.05 ? 0.0 : d <= 0.02 ? -0.003 : -0.003 * (0.05 - d) / 0.03;
}

class Surface : public ::testing::Test {
  protected:
    std::uint32_t groove_style(double level = 0.0) {
        return builder.style(builder.groove(0.05, 0.02, 0.003), level);
    }
    void expect_height(Vec2 p, double height) const {
        EXPECT_NEAR(surface_at(builder.pattern, p).height, height, 1e-12) << "at " << p.x << ' ' << p.y;
    }
    // A square of places with this centre, side by side with a closed form.
    template <typename Height>
    void expect_everywhere(Vec2 centre, double half, Height&& height) const {
        const Truth truth(builder.pattern);
        for (int i = 0; i <= 40; ++i)
            for (int j = 0; j <= 40; ++j) {
                const Vec2 d{half * (i / 20.0 - 1.0) + 1.3e-5, half * (j / 20.0 - 1.0) + 0.7e-5};
                EXPECT_NEAR(truth.surface_at(centre + d).height, height(d), 1e-12)
                    << "at offset " << d.x << ' ' << d.y;
            }
    }
    ResolvedBuilder builder;
};

TEST_F(Surface, NothingButGround) {
    builder.pattern.outer_level = -0.001;
    const SurfacePoint point = surface_at(builder.pattern, {0.3, 0.8});
    EXPECT_EQ(point.height, -0.001);
    EXPECT_EQ(point.element, kGround);
    EXPECT_EQ(point.normal[2], 1.0);
}

TEST_F(Surface, GrooveHasItsProfileAcross) {
    builder.add(make_line({0.2, 0.5}, {0.8, 0.5}), butt_end(), butt_end(), groove_style());
    expect_everywhere({0.5, 0.5}, 0.1, [](Vec2 d) { return groove_at(d.y); });
    const SurfacePoint wall = surface_at(builder.pattern, {0.5, 0.47});  // b = y - 0.5: n of +x is +y
    EXPECT_EQ(wall.element, 0u);
    EXPECT_EQ(wall.facet, 0u);
    EXPECT_NEAR(wall.offset, -0.03, 1e-15);
    EXPECT_NEAR(wall.normal[1] / wall.normal[2], 0.1, 1e-12);  // falls by 3 mm over 30 mm towards +y
}

TEST_F(Surface, ProfileRunsLeftToRight) {
    const std::uint32_t lopsided = builder.profile({{-0.05, 0}, {-0.04, -0.002}, {0.05, 0}}, 3u);
    builder.add(make_line({0.5, 0.9}, {0.5, 0.1}), butt_end(), butt_end(), builder.style(lopsided));
    // Upwards on screen (v down): the right hand is +x.
    expect_height({0.5 - 0.04, 0.5}, -0.002);
    expect_height({0.5 + 0.04, 0.5}, -0.002 / 9.0);
}

TEST_F(Surface, CrossingGroovesLowerWins) {
    const std::uint32_t style = groove_style();
    builder.add(make_line({0.2, 0.5}, {0.8, 0.5}), butt_end(), butt_end(), style);
    builder.add(make_line({0.5, 0.2}, {0.5, 0.8}), butt_end(), butt_end(), style);
    expect_everywhere({0.5, 0.5}, 0.08, [](Vec2 d) { return std::min(groove_at(d.x), groove_at(d.y)); });
}

TEST_F(Surface, CrossingRidgesHigherWinsAndGrooveCutsBoth) {
    const std::uint32_t ridge = builder.style(builder.ridge(0.05, 0.002));
    builder.add(make_line({0.2, 0.5}, {0.8, 0.5}), butt_end(), butt_end(), ridge);
    builder.add(make_line({0.5, 0.2}, {0.5, 0.8}), butt_end(), butt_end(), ridge);
    const auto roof = [](double b) { return std::max(0.0, 0.002 * (1.0 - std::abs(b) / 0.05)); };
    expect_everywhere({0.5, 0.5}, 0.08, [&](Vec2 d) { return std::max(roof(d.x), roof(d.y)); });
    builder.add(make_line({0.25, 0.35}, {0.25, 0.65}), butt_end(), butt_end(), groove_style());
    expect_everywhere({0.25, 0.5}, 0.04,
                      [&](Vec2 d) { return std::abs(d.x) < 0.05 ? groove_at(d.x) : roof(d.y); });
}

TEST_F(Surface, RimsAddAndTheirGrooveCuts) {
    const std::uint32_t rims =
        builder.profile({{-0.06, 0}, {-0.05, 0.001}, {0, -0.002}, {0.05, 0.001}, {0.06, 0}}, 6u);
    builder.add(make_line({0.2, 0.5}, {0.8, 0.5}), butt_end(), butt_end(), builder.style(rims));
    builder.add(make_line({0.5, 0.2}, {0.5, 0.8}), butt_end(), butt_end(),
                builder.style(builder.ridge(0.05, 0.002)));
    expect_height({0.3, 0.55}, 0.001);
    expect_height({0.5, 0.5}, -0.002);         // the ridge does not fill the groove
    expect_height({0.5, 0.5 + 0.055}, 0.002);  // but it covers the rim
    expect_height({0.5, 0.5 + 0.04}, -0.002 + 0.003 * 0.8);
}

TEST_F(Surface, EndsButtHipRound) {
    const std::uint32_t style = groove_style();
    builder.add(make_line({0.2, 0.2}, {0.5, 0.2}), butt_end(), butt_end(), style);
    builder.add(make_line({0.2, 0.5}, {0.5, 0.5}), hip_end(), hip_end(), style);
    builder.add(make_line({0.2, 0.8}, {0.5, 0.8}), round_end(), round_end(), style);
    const auto beyond = [](Vec2 d) { return std::max(d.x, 0.0); };
    expect_everywhere({0.5, 0.2}, 0.07, [](Vec2 d) { return d.x > 0 ? 0.0 : groove_at(d.y); });
    expect_everywhere({0.5, 0.5}, 0.07,
                      [&](Vec2 d) { return groove_at(std::max(std::abs(d.y), beyond(d))); });
    expect_everywhere({0.5, 0.8}, 0.07, [&](Vec2 d) { return groove_at(std::hypot(d.y, beyond(d))); });
    expect_everywhere({0.2, 0.8}, 0.07, [&](Vec2 d) { return groove_at(std::hypot(d.y, beyond(-d))); });
}

TEST_F(Surface, HipKeepsTheSides) {
    const std::uint32_t lopsided = builder.profile({{-0.05, 0}, {-0.04, -0.002}, {0.05, 0}}, 3u);
    builder.add(make_line({0.2, 0.5}, {0.5, 0.5}), butt_end(), hip_end(), builder.style(lopsided));
    expect_height({0.54, 0.49}, -0.002);        // left half across the end
    expect_height({0.54, 0.51}, -0.002 / 9.0);  // right half
}

// A right turn at (0.5, 0.5): east, then south (v down). The outer sector is the north-east.
class Corner : public Surface {
  protected:
    void bend(CornerShape shape) {
        const ElementEnd corner = corner_end(Priority::left, shape, bisector({1, 0}, {0, 1}));
        const std::uint32_t style = groove_style();
        builder.add(make_line({0.2, 0.5}, {0.5, 0.5}), butt_end(), corner, style);
        builder.add(make_line({0.5, 0.5}, {0.5, 0.8}), corner, butt_end(), style);
    }
    // Both arms act in the inner sector, each only up to its end's normal.
    static double arms(Vec2 d) {
        return std::min(d.x <= 0 ? groove_at(d.y) : 0.0, d.y >= 0 ? groove_at(d.x) : 0.0);
    }
    static bool outer(Vec2 d) { return d.x > 0 && d.y < 0; }
};

TEST_F(Corner, MitreTakesTheLargerOffset) {
    bend(CornerShape::mitre);
    expect_everywhere({0.5, 0.5}, 0.07,
                      [](Vec2 d) { return outer(d) ? groove_at(std::max(d.x, -d.y)) : arms(d); });
}

TEST_F(Corner, RoundTakesTheDistance) {
    bend(CornerShape::round);
    expect_everywhere({0.5, 0.5}, 0.07,
                      [](Vec2 d) { return outer(d) ? groove_at(std::hypot(d.x, d.y)) : arms(d); });
}

TEST_F(Corner, BevelIsStraightAcross) {
    bend(CornerShape::bevel);
    expect_everywhere({0.5, 0.5}, 0.07, [](Vec2 d) { return outer(d) ? groove_at(d.x - d.y) : arms(d); });
}

TEST_F(Surface, IntersectedEndStopsAtThePathLine) {
    // The deep one ends on the shallow one and leaves its far half whole.
    const std::uint32_t shallow = builder.style(builder.groove(0.05, 0.02, 0.001)), deep = groove_style();
    builder.add(make_line({0.2, 0.5}, {0.8, 0.5}), butt_end(), butt_end(), shallow);
    builder.add(make_line({0.5, 0.8}, {0.5, 0.5}), butt_end(), clip_end(0.0), deep);
    expect_everywhere({0.5, 0.5}, 0.07, [](Vec2 d) {
        const double across = groove_at(d.y) / 3.0;
        return d.y >= 0 ? std::min(across, groove_at(d.x)) : across;
    });
}

TEST_F(Surface, LeaningEndIsClippedOnItsLine) {
    // Clip line through (0.5, 0.5) at 45 degrees; the element lies to the west of it, and reaches beyond its
    // end on one side.
    builder.add(make_line({0.2, 0.5}, {0.5, 0.5}), butt_end(), clip_end(kPi / 4), groove_style());
    expect_everywhere({0.5, 0.5}, 0.07, [](Vec2 d) { return d.x < d.y ? groove_at(d.y) : 0.0; });
}

TEST_F(Surface, ScalesRunAlongTheElement) {
    Element e = make_line({0.2, 0.5}, {0.6, 0.5});
    e.width0 = 1.0, e.width1 = 0.5;
    e.height0 = 0.25, e.height1 = 1.0;
    builder.add(e, butt_end(), hip_end(), groove_style());
    const double width = 0.75, height = 0.625;  // half way
    for (const double b : {-0.03, 0.01, 0.02, 0.034})
        expect_height({0.4, 0.5 + b}, height * groove_at(b / width));
    expect_height({0.61, 0.5}, groove_at(0.01 / 0.5));  // end values beyond the end
    expect_height({0.6201, 0.5}, groove_at(0.0201 / 0.5));
}

TEST_F(Surface, ArcMeasuresFromItsNearestPoint) {
    // y = x^2 / 0.4 between x = -0.2 and 0.2, about (0.5, 0.4).
    builder.add(make_arc({0.3, 0.5}, {0.5, 0.3}, {0.7, 0.5}), round_end(), round_end(), groove_style());
    const Truth truth(builder.pattern);
    for (const double x : {-0.19, -0.1, 0.0, 0.03, 0.15})
        for (const double b : {-0.045, -0.03, 0.01, 0.04}) {
            const Vec2 t = unit({1.0, 5.0 * x}), on{0.5 + x, 0.4 + x * x / 0.4};
            const SurfacePoint point = truth.surface_at(on + normal_of(t) * b);
            EXPECT_NEAR(point.offset, b, 1e-13);
            EXPECT_NEAR(point.height, groove_at(b), 1e-13);
        }
    // Beyond the end its tangent goes on; the cap rounds it.
    const Vec2 t = unit(Vec2{1.0, 1.0});
    EXPECT_NEAR(truth.surface_at(Vec2{0.7, 0.5} + t * 0.03 + normal_of(t) * 0.01).offset,
                std::hypot(0.03, 0.01), 1e-13);
}

TEST_F(Surface, StepAddsBelowAndCutsAbove) {
    // A loop with its inside to the right and 1 mm higher; the west side is asked.
    const std::uint32_t step = builder.style(builder.bevel_step(0.04, 0.001), 0.0, true);
    builder.polygon({{0.3, 0.3}, {0.7, 0.3}, {0.7, 0.7}, {0.3, 0.7}}, step);
    EXPECT_EQ(ground_at(builder.pattern, {0.5, 0.5}), 0.001);
    EXPECT_EQ(ground_at(builder.pattern, {0.1, 0.1}), 0.0);
    EXPECT_EQ(ground_at(builder.pattern, {1.5, -0.5}), 0.001);  // another tile
    expect_everywhere({0.3, 0.5}, 0.07,
                      [](Vec2 d) { return 0.001 * std::clamp((d.x + 0.04) / 0.08, 0.0, 1.0); });
    // Outer corner mitred: the roof of two bevels.
    expect_height({0.28, 0.27}, 0.001 * 0.01 / 0.08);
}

TEST_F(Surface, StepWallIsHitFromTheSide) {
    const std::uint32_t wall = builder.profile({{0, 0}, {0, 0.001}}, 0u);
    builder.circle({0.5, 0.5}, 0.2, 8, 1, builder.style(wall, 0.0, true));
    const Ray ray{{0.1, 0.5, 0.0005}, {1, 0, 0}};
    const RayHit hit = trace_ray(builder.pattern, ray);
    ASSERT_TRUE(hit.hit);
    EXPECT_NEAR(hit.t, 0.2, 1e-12);
    EXPECT_LT(hit.element, 8u);
    EXPECT_EQ(hit.facet, 0u);
    EXPECT_NEAR(hit.normal[0], -1.0, 1e-9);
    EXPECT_FALSE(trace_ray(builder.pattern, {{0.1, 0.5, 0.0015}, {1, 0, 0}}).hit);
}

TEST_F(Surface, RegionsNestAndFeaturesKeepTheirLevel) {
    const std::uint32_t up = builder.profile({{0, 0}, {0, 0.001}}, 0u),
                        down = builder.profile({{0, 0}, {0, -0.002}}, 0u);
    builder.circle({0.5, 0.5}, 0.3, 8, 1, builder.style(up, 0.0, true));
    builder.circle({0.5, 0.5}, 0.1, 8, 1, builder.style(down, 0.001, true));
    builder.add(make_line({0.05, 0.5}, {0.95, 0.5}), butt_end(), butt_end(), groove_style(0.001));
    expect_height({0.5, 0.5}, -0.001);  // in the pit: not the groove's region
    expect_height({0.5, 0.3}, 0.001);
    expect_height({0.7, 0.5}, 0.001 - 0.003);
    expect_height({0.7, 0.54}, 0.001 + groove_at(0.04));
    expect_height({0.1, 0.5}, 0.0);  // outside
}

TEST_F(Surface, GroundBesideStepsFromBorderToBorder) {
    builder.pattern.wrap = Wrap::clamp;
    const std::uint32_t wall = builder.profile({{0, 0}, {0, -0.002}}, 0u);
    builder.add(make_line({0.5, 1.0}, {0.5, 0.0}), butt_end(), butt_end(), builder.style(wall, 0.0, true));
    expect_height({0.2, 0.5}, 0.0);  // left of the way up
    expect_height({0.8, 0.5}, -0.002);
    expect_height({1.2, 0.5}, 0.0);  // beyond the map
}

TEST_F(Surface, RepeatsOrEndsAtTheBorder) {
    builder.add(make_line({0.9, 0.5}, {1.1, 0.5}), butt_end(), butt_end(), groove_style());
    expect_height({0.05, 0.5}, -0.003);
    expect_height({0.95, 0.5}, -0.003);
    expect_height({3.05, -1.5}, -0.003);
    builder.pattern.wrap = Wrap::clamp;
    expect_height({0.05, 0.5}, 0.0);
    expect_height({0.95, 0.5}, -0.003);
    expect_height({1.05, 0.5}, 0.0);
}

// ---- profiles that are no height fields
// --------------------------------------------------------------------------

TEST_F(Surface, DovetailGrooveIsOpenBelowItsLips) {
    const std::uint32_t dovetail =
        builder.profile({{-0.02, 0}, {-0.05, -0.003}, {0.05, -0.003}, {0.02, 0}}, 7u);
    builder.add(make_line({0.2, 0.5}, {0.8, 0.5}), butt_end(), butt_end(), builder.style(dovetail));
    const Truth truth(builder.pattern);
    EXPECT_NEAR(truth.surface_at({0.5, 0.51}).height, -0.003, 1e-15);
    EXPECT_NEAR(truth.surface_at({0.5, 0.53}).height, 0.0, 1e-15);
    EXPECT_TRUE(truth.is_solid({0.5, 0.53}, -0.0005));  // the lip
    EXPECT_FALSE(truth.is_solid({0.5, 0.53}, -0.002));  // under it
    // From the middle of the groove outwards and up: the lip from below.
    const RayHit hit = truth.trace_ray({{0.5, 0.5, -0.0025}, {0, 1, 0}});
    ASSERT_TRUE(hit.hit);
    EXPECT_NEAR(hit.t, 0.045, 1e-12);
    EXPECT_EQ(hit.facet, 2u);
    EXPECT_LT(hit.normal[2], 0.0);
}

TEST_F(Surface, MushroomHasRoomUnderItsCap) {
    const std::uint32_t mushroom = builder.profile({{-0.01, 0},
                                                    {-0.01, 0.001},
                                                    {-0.04, 0.001},
                                                    {-0.04, 0.002},
                                                    {0.04, 0.002},
                                                    {0.04, 0.001},
                                                    {0.01, 0.001},
                                                    {0.01, 0}},
                                                   0u);
    builder.add(make_line({0.2, 0.5}, {0.8, 0.5}), butt_end(), butt_end(), builder.style(mushroom));
    const Truth truth(builder.pattern);
    EXPECT_NEAR(truth.surface_at({0.5, 0.53}).height, 0.002, 1e-15);
    EXPECT_FALSE(truth.is_solid({0.5, 0.53}, 0.0005));
    const RayHit stem = truth.trace_ray({{0.5, 0.6, 0.0005}, {0, -1, 0}});
    ASSERT_TRUE(stem.hit);
    EXPECT_NEAR(stem.t, 0.09, 1e-12);
    EXPECT_EQ(stem.facet, 6u);
    EXPECT_NEAR(stem.normal[1], 1.0, 1e-12);
    const RayHit below = truth.trace_ray({{0.5, 0.53, 0.0005}, {0, 0, 1}});
    ASSERT_TRUE(below.hit);
    EXPECT_NEAR(below.t, 0.0005, 1e-12);
    EXPECT_EQ(below.facet, 5u);
}

TEST_F(Surface, ExplicitFlagsDecideWhatCuts) {
    // The same roof, once external and once cutting: where a ridge crosses, the second one holds it down.
    const std::uint32_t ridge = builder.style(builder.ridge(0.05, 0.002));
    for (const std::uint32_t mask : {0u, 3u}) {
        builder.pattern.elements.clear();
        const std::uint32_t roof = builder.profile({{-0.05, 0}, {0, 0.0008}, {0.05, 0}}, mask);
        builder.add(make_line({0.2, 0.5}, {0.8, 0.5}), butt_end(), butt_end(), builder.style(roof));
        builder.add(make_line({0.5, 0.2}, {0.5, 0.8}), butt_end(), butt_end(), ridge);
        expect_height({0.3, 0.5}, 0.0008);
        expect_height({0.5, 0.5}, mask ? 0.0008 : 0.002);
    }
}

// ---- rays
// ----------------------------------------------------------------------------------------------------

TEST_F(Surface, RayMeetsTheFarWall) {
    builder.add(make_line({0.2, 0.5}, {0.8, 0.5}), butt_end(), butt_end(), groove_style());
    // Over the groove's middle, 45 degrees in units of the wall: wall z = -0.003 (0.05 - b) / 0.03.
    const RayHit hit = trace_ray(builder.pattern, {{0.5, 0.5, 0.0}, {0, 0.01, -0.0005}});
    ASSERT_TRUE(hit.hit && !hit.inside);
    const double t = 0.005 / (0.001 + 0.0005);  // -0.0005 t = -0.005 + 0.001 t
    EXPECT_NEAR(hit.t, t, 1e-12);
    EXPECT_EQ(hit.element, 0u);
    EXPECT_EQ(hit.facet, 2u);
    EXPECT_NEAR(hit.normal[1] / hit.normal[2], -0.1, 1e-12);
}

TEST_F(Surface, ButtEndIsAWall) {
    builder.add(make_line({0.2, 0.5}, {0.5, 0.5}), butt_end(), butt_end(), groove_style());
    const RayHit hit = trace_ray(builder.pattern, {{0.4, 0.5, -0.001}, {1, 0, 0}});
    ASSERT_TRUE(hit.hit);
    EXPECT_NEAR(hit.t, 0.1, 1e-12);
    EXPECT_EQ(hit.facet, kWall);
    EXPECT_NEAR(hit.normal[0], -1.0, 1e-12);
}

TEST_F(Surface, RaysFromTheSurfaceFromInsideAndAway) {
    builder.add(make_line({0.2, 0.5}, {0.8, 0.5}), butt_end(), butt_end(), groove_style());
    const RayHit on = trace_ray(builder.pattern, {{0.1, 0.1, 0.0}, {0.1, 0, -1}});
    EXPECT_TRUE(on.hit && !on.inside);
    EXPECT_NEAR(on.t, 0.0, 1e-12);
    EXPECT_EQ(on.element, kGround);
    const RayHit inside = trace_ray(builder.pattern, {{0.1, 0.1, -0.001}, {0, 0, 1}});
    EXPECT_TRUE(inside.hit && inside.inside);
    EXPECT_EQ(inside.t, 0.0);
    EXPECT_FALSE(trace_ray(builder.pattern, {{0.5, 0.5, -0.002}, {0, 0, 1}}).hit);
    EXPECT_FALSE(trace_ray(builder.pattern, {{0.5, 0.5, 0.01}, {1, 1, 0.1}}).hit);
}

TEST_F(Surface, GrazingRayFindsARidgeManyTilesAway) {
    builder.add(make_line({0.5, 0.2}, {0.5, 0.4}), butt_end(), butt_end(),
                builder.style(builder.ridge(0.01, 0.002)));
    // Slope 1:100 in v: passes tile after tile beside the ridge, and meets it where v comes to 0.2 again.
    const RayHit hit = trace_ray(builder.pattern, {{0.0, 0.41, 0.001}, {1, 0.01, 0}});
    ASSERT_TRUE(hit.hit);
    EXPECT_NEAR(hit.position[0], 79.495, 1e-9);
    EXPECT_EQ(hit.element, 0u);
}

TEST_F(Surface, ClampedMapEndsInAWall) {
    builder.pattern.wrap = Wrap::clamp;
    builder.add(make_line({0.2, 0.5}, {1.3, 0.5}), butt_end(), butt_end(), groove_style());
    const RayHit hit = trace_ray(builder.pattern, {{0.9, 0.5, -0.001}, {1, 0, 0}});
    ASSERT_TRUE(hit.hit);
    EXPECT_NEAR(hit.t, 0.1, 1e-12);
    EXPECT_NEAR(hit.normal[0], -1.0, 1e-12);
    const RayHit far = trace_ray(builder.pattern, {{-5, 0.5, 0.5}, {1, 0, -1}});
    ASSERT_TRUE(far.hit);
    EXPECT_NEAR(far.position[0], -4.5, 1e-12);
}

// ---- maps
// ------------------------------------------------------------------------------------------------------

TEST_F(Surface, MapIsTheExactAreaMean) {
    // A plain wall half-way through a column of texels, and a bevel that is linear inside every texel.
    builder.pattern.wrap = Wrap::clamp;
    const std::uint32_t box = builder.profile({{-0.25, 0}, {-0.25, -0.004}, {0.25, -0.004}, {0.25, 0}}, 7u);
    builder.add(make_line({0.5, 0.0}, {0.5, 1.0}), butt_end(), butt_end(), builder.style(box));
    const Image map = rasterize_height(builder.pattern, 10, 3);
    const double top = 1.0 - 0.3, floor = 1.0 - 0.7;  // base offset 3 mm of 10
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 10; ++x) {
            const double expected = x < 2 || x > 7 ? top : x == 2 || x == 7 ? 0.5 * (top + floor) : floor;
            EXPECT_NEAR(map.at(x, y), expected, 1e-6) << x << ' ' << y;
        }
}

TEST_F(Surface, MapOfARegionIsPartOfTheMap) {
    builder.circle({0.5, 0.5}, 0.3, 8, 1, groove_style());
    const Image whole = rasterize_height(builder.pattern, 64, 64);
    const Image part = rasterize_height(builder.pattern, 64, 64, {.region = {13, 9, 30, 21}});
    ASSERT_EQ(part.width, 30);
    ASSERT_EQ(part.height, 21);
    for (int y = 0; y < 21; ++y)
        for (int x = 0; x < 30; ++x) EXPECT_EQ(part.at(x, y), whole.at(13 + x, 9 + y));
}

}  // namespace
}  // namespace burin
