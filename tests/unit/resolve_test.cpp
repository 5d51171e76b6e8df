// Joins, ends, steps and errors of resolve_pattern on patterns small enough to know the answer.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <burin/evaluate.hpp>
#include <burin/resolve.hpp>

#include "layout.h"

namespace burin {
namespace {

constexpr double kPi = std::numbers::pi;

Element line(Vec2 a, Vec2 b) {
    Element e;
    e.p0 = a;
    e.p2 = b;
    return e;
}

Element arc(Vec2 a, Vec2 control, Vec2 b) {
    Element e = line(a, b);
    e.kind = ElementKind::quadratic;
    e.p1 = control;
    return e;
}

Path chain(const std::vector<Vec2>& points, std::uint32_t profile = 0, bool closed = false) {
    Path path;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        path.elements.push_back(line(points[i], points[i + 1]));
    path.closed = closed;
    path.profile = profile;
    return path;
}

// Profile 0: V groove, half-width 0.01. Profile 1: step down by 0.002 from left to right. Profile 2: plain
// wall of 0.002 up.
Pattern empty_pattern(Wrap wrap = Wrap::repeat) {
    Pattern pattern;
    pattern.depth = 0.01;
    pattern.base_offset = 0.004;
    pattern.wrap = wrap;
    pattern.profiles = {{{{-0.01, 0}, {0, -0.003}, {0.01, 0}}, {}},
                        {{{-0.005, 0}, {0.005, -0.002}}, {}},
                        {{{0, 0}, {0, 0.002}}, {}}};
    return pattern;
}

ResolvedPattern resolve(const Pattern& pattern, const ResolveOptions& options = {}) {
    Result<ResolvedPattern> result = resolve_pattern(pattern, options);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? *result : ResolvedPattern{};
}

std::string refusal(const Pattern& pattern, const ResolveOptions& options = {}) {
    const Result<ResolvedPattern> result = resolve_pattern(pattern, options);
    return result.ok() ? "accepted" : result.error().message;
}

int count(const ResolvedPattern& pattern, JunctionKind kind) {
    int n = 0;
    for (const Junction& j : pattern.junctions) n += j.kind == kind ? 1 : 0;
    return n;
}

bool is(const ElementEnd& end, EndShape shape) {
    return end.priority == Priority::both && end.shape == static_cast<int>(shape);
}
bool is_clip(const ElementEnd& end) { return is(end, EndShape::clip); }
bool is_tee(const ElementEnd& end) { return is(end, EndShape::tee); }
bool is_hip(const ElementEnd& end) { return is(end, EndShape::hip); }

// ---- profiles

std::uint32_t mask_of(const std::vector<ProfilePoint>& points) {
    Pattern pattern = empty_pattern();
    pattern.profiles = {{points, {}}};
    pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}}, 0)};
    if (points.front().h != points.back().h)
        pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}, {0.3, 0.4}, {0.2, 0.2}}, 0, true)};
    const ResolvedPattern resolved = resolve(pattern);
    return resolved.profiles.empty() ? ~0u : resolved.profiles[0].internal_mask;
}

TEST(ResolveProfile, GrooveCutsRidgeAdds) {
    EXPECT_EQ(mask_of({{-0.01, 0}, {0, -0.003}, {0.01, 0}}), 0b11u);
    EXPECT_EQ(mask_of({{-0.01, 0}, {0, 0.003}, {0.01, 0}}), 0u);
    EXPECT_EQ(mask_of({{-0.01, 0}, {-0.005, 0.001}, {0.005, 0.001}, {0.01, 0}}), 0u);
}

TEST(ResolveProfile, RimsAddAndTheTroughBetweenThemCuts) {
    EXPECT_EQ(mask_of({{-0.01, 0}, {-0.008, 0.001}, {0, -0.002}, {0.008, 0.001}, {0.01, 0}}), 0b0110u);
}

TEST(ResolveProfile, FlatGroundBesideAGrooveIsExternal) {
    EXPECT_EQ(mask_of({{-0.02, 0}, {-0.01, 0}, {0, -0.003}, {0.01, 0}, {0.02, 0}}), 0b0110u);
}

TEST(ResolveProfile, StepAddsOnItsLowSideAndCutsOnItsHighSide) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}, {0.3, 0.4}, {0.2, 0.2}}, 1, true)};
    const ResolvedPattern resolved = resolve(pattern);
    ASSERT_EQ(resolved.profiles[1].points.size(), 3u);
    EXPECT_EQ(resolved.profiles[1].points[1].b, 0.0);
    EXPECT_DOUBLE_EQ(resolved.profiles[1].points[1].h, -0.001);
    EXPECT_EQ(resolved.profiles[1].internal_mask, 0b01u);
    EXPECT_TRUE(resolved.styles[resolved.elements[0].style].step);
}

// The far bank of a moat along a step rises past the low ground: only what lies below it cuts.
TEST(ResolveProfile, FacetThatPassesTheGroundOfItsSideIsSplitThere) {
    Pattern pattern = empty_pattern();
    pattern.profiles[1].points = {
        {-0.01, 0}, {-0.002, -0.004}, {0.002, -0.004}, {0.006, 0.002}, {0.01, -0.002}};
    pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}, {0.3, 0.4}, {0.2, 0.2}}, 1, true)};
    const ResolvedPattern resolved = resolve(pattern);
    bool at_ground = false;
    for (const ProfilePoint& p : resolved.profiles[1].points)
        at_ground = at_ground || (p.b > 0.002 && p.b < 0.006 && std::abs(p.h + 0.002) < 1e-12);
    EXPECT_TRUE(at_ground);
}

TEST(ResolveProfile, OverhangNeedsFlags) {
    // Sides that lean over the trough's bottom twice: a vertical ray from the inner fold meets the outer one.
    Pattern pattern = empty_pattern();
    pattern.profiles[0].points = {{-0.01, 0},       {-0.012, 0.002}, {-0.004, 0.001},
                                  {-0.008, 0.0005}, {0, -0.002},     {0.01, 0}};
    pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}})};
    const std::string message = refusal(pattern);
    EXPECT_NE(message.find("profile 0"), std::string::npos) << message;
    EXPECT_NE(message.find("overhang"), std::string::npos) << message;
    pattern.profiles[0].facets.assign(5, FacetClass::internal);
    pattern.profiles[0].facets[0] = FacetClass::external;
    EXPECT_EQ(resolve(pattern).profiles[0].internal_mask, 0b11110u);
}

// ---- joints and corners

TEST(ResolveJoints, SmallTurnIsAJointOnOneLine) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}, {0.6, 0.208}})};
    const ResolvedPattern resolved = resolve(pattern);
    ASSERT_EQ(resolved.elements.size(), 2u);
    EXPECT_TRUE(is_clip(resolved.elements[0].end) && is_clip(resolved.elements[1].start));
    EXPECT_EQ(resolved.elements[0].end.clip_angle, resolved.elements[1].start.clip_angle);
    EXPECT_NEAR(resolved.elements[0].end.clip_angle, kPi / 2 + 0.02, 1e-3);
    EXPECT_EQ(count(resolved, JunctionKind::corner), 0);
}

TEST(ResolveJoints, CornerGivesBackTheOuterSide) {
    Pattern pattern = empty_pattern();
    // Turns towards +y, the right: the outer side is the left one. The outer bisector runs along (1, -1).
    pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}, {0.4, 0.4}})};
    const ResolvedPattern resolved = resolve(pattern);
    for (const ElementEnd& end : {resolved.elements[0].end, resolved.elements[1].start}) {
        EXPECT_EQ(end.priority, Priority::left);
        EXPECT_EQ(end.shape, static_cast<int>(CornerShape::mitre));
        EXPECT_NEAR(end.clip_angle, 0.75 * kPi, 1e-12);
    }
    EXPECT_EQ(count(resolved, JunctionKind::corner), 1);
    EXPECT_EQ(count(resolved, JunctionKind::isolated_end), 2);
    EXPECT_TRUE(is_hip(resolved.elements[0].start) && is_hip(resolved.elements[1].end));
}

TEST(ResolveJoints, MitreLimitAndJoinsOnRequest) {
    Pattern pattern = empty_pattern();
    // 1 / cos(turn / 2) is about 6.4 for a turn of 162 degrees.
    pattern.paths = {
        chain({{0.2, 0.2}, {0.4, 0.2}, {0.4 - 0.2 * std::cos(0.1 * kPi), 0.2 + 0.2 * std::sin(0.1 * kPi)}})};
    EXPECT_EQ(resolve(pattern).elements[0].end.shape, static_cast<int>(CornerShape::bevel));
    EXPECT_EQ(resolve(pattern, {.mitre_limit = 8.0}).elements[0].end.shape,
              static_cast<int>(CornerShape::mitre));
    pattern.paths[0].join = JoinKind::round;
    EXPECT_EQ(resolve(pattern).elements[0].end.shape, static_cast<int>(CornerShape::round));
}

TEST(ResolveJoints, ClosedPathJoinsItsEnds) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}, {0.4, 0.4}, {0.2, 0.4}, {0.2, 0.2}}, 0, true)};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(count(resolved, JunctionKind::corner), 4);
    EXPECT_EQ(resolved.elements[0].start.priority, Priority::left);
    EXPECT_EQ(resolved.elements[3].end.priority, Priority::left);
}

TEST(ResolveJoints, PathAroundTheTileJoinsModuloTheTile) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.1, 0.5}, {0.4, 0.5}, {0.8, 0.5}, {1.1, 0.5}}, 0, true)};
    const ResolvedPattern resolved = resolve(pattern);
    for (const ResolvedElement& e : resolved.elements) EXPECT_TRUE(is_clip(e.start) && is_clip(e.end));
    EXPECT_TRUE(resolved.junctions.empty());
}

TEST(ResolveJoints, EndsOfTwoPathsThatMeetAcrossTheTileJoin) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.7, 0.5}, {1.0, 0.5}}), chain({{0.3, 0.5}, {0.00005, 0.5}})};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_TRUE(is_clip(resolved.elements[0].end));
    EXPECT_TRUE(is_clip(resolved.elements[1].end));
    EXPECT_EQ(resolved.elements[1].element.p2.x, 0.0);
    EXPECT_EQ(resolved.stats.snapped_ends, 1);
}

TEST(ResolveJoints, OpenPathWhoseEndsMeetGetsACorner) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}, {0.4, 0.4}, {0.2, 0.2}})};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(count(resolved, JunctionKind::corner), 3);
    EXPECT_EQ(count(resolved, JunctionKind::isolated_end), 0);
}

TEST(ResolveJoints, StarNeedsPriorityOnlyAtAFreeSectorAboveHalf) {
    Pattern pattern = empty_pattern();
    const Vec2 c{0.5, 0.5};
    const auto spoke = [&](double degrees) {
        return chain({c, c + Vec2{std::cos(degrees * kPi / 180), std::sin(degrees * kPi / 180)} * 0.2});
    };
    pattern.paths = {spoke(0), spoke(120), spoke(240)};
    const ResolvedPattern even = resolve(pattern);
    for (const ResolvedElement& e : even.elements) EXPECT_EQ(e.start.priority, Priority::none);
    EXPECT_EQ(count(even, JunctionKind::star), 1);

    pattern.paths = {spoke(-60), spoke(10), spoke(60)};
    const ResolvedPattern fan = resolve(pattern);
    // The free sector opens to the left of the picture: direction 180 degrees, between the arms at 60 and
    // -60.
    EXPECT_EQ(fan.elements[0].start.priority, Priority::left);
    EXPECT_EQ(fan.elements[1].start.priority, Priority::none);
    EXPECT_EQ(fan.elements[2].start.priority, Priority::right);
    const double off = std::fmod(fan.elements[0].start.clip_angle, kPi);
    EXPECT_NEAR(std::min(off, kPi - off), 0.0, 1e-9);
}

// ---- ends

TEST(ResolveEnds, CapsOnRequest) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}})};
    pattern.paths[0].start_cap = CapKind::butt;
    pattern.paths[0].end_cap = CapKind::round;
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(resolved.elements[0].start.priority, Priority::none);
    EXPECT_EQ(resolved.elements[0].end.priority, Priority::both);
    EXPECT_EQ(resolved.elements[0].end.shape, static_cast<int>(EndShape::round));
}

TEST(ResolveEnds, TaperAddsAnElementThatRunsOut) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}})};
    pattern.paths[0].start_cap = pattern.paths[0].end_cap = CapKind::taper;
    const ResolvedPattern resolved = resolve(pattern);
    ASSERT_EQ(resolved.elements.size(), 3u);
    EXPECT_EQ(resolved.elements[0].element.width0, 0.0);
    EXPECT_EQ(resolved.elements[0].element.height1, 1.0);
    EXPECT_EQ(resolved.elements[2].element.height1, 0.0);
    EXPECT_LT(resolved.elements[0].element.p0.x, 0.2);
    EXPECT_TRUE(is_clip(resolved.elements[0].end) && is_clip(resolved.elements[1].start));
}

TEST(ResolveEnds, TeeSnapsAndClipsAlongTheOtherPath) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.2, 0.2}, {0.8, 0.2}}), chain({{0.5, 0.5}, {0.45, 0.20005}})};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(resolved.elements[1].element.p2.y, 0.2);
    EXPECT_TRUE(is_tee(resolved.elements[1].end));
    EXPECT_EQ(resolved.elements[1].end.clip_angle, 0.0);
    EXPECT_EQ(count(resolved, JunctionKind::tee), 1);
    EXPECT_EQ(count(resolved, JunctionKind::crossing), 0);
    EXPECT_EQ(resolved.stats.snapped_ends, 1);
}

TEST(ResolveEnds, TeeOnACurveLandsOnTheCurve) {
    Pattern pattern = empty_pattern();
    Path bow;
    bow.elements = {arc({0.2, 0.5}, {0.5, 0.2}, {0.8, 0.5})};
    // The arc's vertex is (0.5, 0.35).
    pattern.paths = {bow, chain({{0.5, 0.7}, {0.50002, 0.35003}})};
    const ResolvedPattern resolved = resolve(pattern);
    const ResolvedElement& ending = resolved.elements.back();
    EXPECT_NEAR(ending.element.p2.y, 0.35, 1e-7);
    const double angle = ending.end.clip_angle;
    EXPECT_NEAR(std::min(angle, kPi - angle), 0.0, 1e-3);
}

TEST(ResolveEnds, EndOnItsOwnPathIsATee) {
    Pattern pattern = empty_pattern();
    // The figure 6: the end comes back onto the first stroke.
    pattern.paths = {chain({{0.2, 0.2}, {0.2, 0.6}, {0.5, 0.6}, {0.5, 0.4}, {0.2, 0.4}})};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(count(resolved, JunctionKind::tee), 1);
    EXPECT_TRUE(is_tee(resolved.elements[3].end));
    EXPECT_NEAR(resolved.elements[3].end.clip_angle, kPi / 2, 1e-12);
}

TEST(ResolveEnds, CrossingNeedsNoPriority) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.2, 0.2}, {0.8, 0.8}}), chain({{0.2, 0.8}, {0.8, 0.2}})};
    const ResolvedPattern resolved = resolve(pattern);
    ASSERT_EQ(count(resolved, JunctionKind::crossing), 1);
    EXPECT_EQ(resolved.stats.step_crossings, 0);
    for (const Junction& j : resolved.junctions) {
        if (j.kind != JunctionKind::crossing) continue;
        EXPECT_NEAR(length(j.position - Vec2{0.5, 0.5}), 0.0, 1e-12);
    }
}

TEST(ResolveEnds, CrossingsAcrossTheTileAreFound) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.9, 0.5}, {1.2, 0.5}}), chain({{0.1, 0.4}, {0.1, 0.6}})};
    EXPECT_EQ(count(resolve(pattern), JunctionKind::crossing), 1);
}

TEST(ResolveEnds, EndOnTheBorderOfAClampedMapRunsToIt) {
    Pattern pattern = empty_pattern(Wrap::clamp);
    pattern.paths = {chain({{0.5, 0.5}, {0.99996, 0.4}})};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(resolved.elements[0].element.p2.x, 1.0);
    EXPECT_TRUE(is_tee(resolved.elements[0].end));
    EXPECT_NEAR(resolved.elements[0].end.clip_angle, kPi / 2, 1e-12);
}

// ---- steps

// A square plate 0.002 below ground: inside to the right of a path that turns right.
Path plate(double low, double high) {
    return chain({{low, low}, {high, low}, {high, high}, {low, high}, {low, low}}, 1, true);
}

TEST(ResolveSteps, GrooveIsSplitAtAStepAndContinuesOnTheOtherLevel) {
    Pattern pattern = empty_pattern();
    pattern.paths = {plate(0.4, 0.6), chain({{0.2, 0.5}, {0.8, 0.5}})};
    const ResolvedPattern resolved = resolve(pattern);
    ASSERT_EQ(resolved.elements.size(), 7u);
    EXPECT_EQ(resolved.elements[4].element.p2, (Vec2{0.4, 0.5}));
    EXPECT_EQ(resolved.elements[5].element.p2, (Vec2{0.6, 0.5}));
    const double levels[] = {0.0, -0.002, 0.0};
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(resolved.styles[resolved.elements[4 + i].style].level, levels[i], 1e-15);
    EXPECT_TRUE(is_tee(resolved.elements[4].end) && is_tee(resolved.elements[5].start));
    EXPECT_NEAR(resolved.elements[4].end.clip_angle, kPi / 2, 1e-12);
    EXPECT_EQ(resolved.stats.step_crossings, 2);
    // 0.003 below its own ground on both levels.
    EXPECT_NEAR(surface_at(resolved, {0.3, 0.5}).height, -0.003, 1e-12);
    EXPECT_NEAR(surface_at(resolved, {0.5, 0.5}).height, -0.005, 1e-12);
}

TEST(ResolveSteps, GrooveThatEndsInsideAPlateIsSplitOnce) {
    Pattern pattern = empty_pattern();
    pattern.paths = {plate(0.4, 0.6), chain({{0.2, 0.45}, {0.5, 0.47}, {0.55, 0.5}})};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(resolved.stats.step_crossings, 1);
    EXPECT_NEAR(resolved.styles[resolved.elements.back().style].level, -0.002, 1e-15);
}

TEST(ResolveSteps, WrongLevelIsThatOfTheGround) {
    Pattern pattern = empty_pattern();
    pattern.paths = {plate(0.4, 0.6), chain({{0.45, 0.5}, {0.55, 0.5}})};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(resolved.stats.releveled, 1);
    EXPECT_NEAR(resolved.styles[resolved.elements.back().style].level, -0.002, 1e-15);
}

TEST(ResolveSteps, NestedPlatesHaveTheirOwnGround) {
    Pattern pattern = empty_pattern();
    Path inner = plate(0.45, 0.55);
    inner.level = -0.002;
    pattern.paths = {plate(0.4, 0.6), inner, chain({{0.3, 0.5}, {0.52, 0.5}})};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(resolved.stats.step_crossings, 2);
    EXPECT_EQ(resolved.stats.uneven_levels, 0);
    EXPECT_NEAR(resolved.styles[resolved.elements.back().style].level, -0.004, 1e-15);
}

TEST(ResolveSteps, UnevenLevelsAreBroughtTogether) {
    Pattern pattern = empty_pattern();
    Path inner = plate(0.45, 0.55);
    inner.level = -0.00205;
    pattern.paths = {plate(0.4, 0.6), inner};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(resolved.stats.uneven_levels, 1);
    EXPECT_NEAR(resolved.styles[resolved.elements.back().style].level, -0.002, 1e-15);
    EXPECT_NEAR(surface_at(resolved, {0.5, 0.5}).ground, -0.00405, 1e-12);
}

TEST(ResolveSteps, StepMayEndOnAStepOrOnTheMapBorder) {
    Pattern pattern = empty_pattern(Wrap::clamp);
    pattern.paths = {chain({{0.0, 0.5}, {1.0, 0.5}}, 1)};
    EXPECT_TRUE(is_tee(resolve(pattern).elements[0].end));
    // Inside the plate a wall from side to side; its left, towards +x here, is the lower part's own level.
    Pattern plates = empty_pattern();
    Path wall = chain({{0.5, 0.6}, {0.5, 0.4}}, 2);
    wall.level = -0.002;
    plates.paths = {plate(0.4, 0.6), wall};
    const ResolvedPattern resolved = resolve(plates);
    EXPECT_EQ(count(resolved, JunctionKind::tee), 2);
    EXPECT_TRUE(is_tee(resolved.elements.back().start) && is_tee(resolved.elements.back().end));
}

TEST(ResolveSteps, GrooveMayEndOnAStep) {
    Pattern pattern = empty_pattern();
    pattern.paths = {plate(0.4, 0.6), chain({{0.2, 0.5}, {0.40003, 0.5}})};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(resolved.stats.step_crossings, 0);
    EXPECT_EQ(resolved.elements.back().element.p2.x, 0.4);
    EXPECT_NEAR(resolved.elements.back().end.clip_angle, kPi / 2, 1e-12);
    EXPECT_EQ(resolved.styles[resolved.elements.back().style].level, 0.0);
}

// ---- cutting to the tile

TEST(ResolveTile, LongElementsAreCutIntoSmoothlyJoinedPieces) {
    Pattern pattern = empty_pattern();
    Path long_path = chain({{-0.4, 0.1}, {2.3, 0.35}});
    long_path.elements[0].width1 = 2.0;
    pattern.paths = {long_path};
    const ResolvedPattern resolved = resolve(pattern);
    ASSERT_GE(resolved.elements.size(), 5u);
    for (std::size_t i = 0; i < resolved.elements.size(); ++i) {
        const Element& e = resolved.elements[i].element;
        EXPECT_TRUE(e.p0.x >= 0.0 && e.p0.x < 1.0 && e.p2.x >= -0.5 && e.p2.x < 1.5);
        if (i > 0) {
            EXPECT_TRUE(is_clip(resolved.elements[i].start));
            EXPECT_DOUBLE_EQ(e.width0, resolved.elements[i - 1].element.width1);
        }
    }
    EXPECT_TRUE(is_hip(resolved.elements.front().start) && is_hip(resolved.elements.back().end));
    EXPECT_EQ(resolved.elements.back().element.width1, 2.0);
}

TEST(ResolveTile, StrongTurnsAreSplit) {
    Pattern pattern = empty_pattern();
    Path hook;
    hook.elements = {arc({0.3, 0.3}, {0.6, 0.3}, {0.35, 0.4})};
    pattern.paths = {hook};
    const ResolvedPattern resolved = resolve(pattern);
    ASSERT_EQ(resolved.elements.size(), 2u);
    EXPECT_TRUE(is_clip(resolved.elements[0].end) && is_clip(resolved.elements[1].start));
}

TEST(ResolveTile, WiderThanTheTileIsRefused) {
    Pattern pattern = empty_pattern();
    pattern.profiles[0].points = {{-0.45, 0}, {0, -0.003}, {0.45, 0}};
    pattern.paths = {chain({{0.2, 0.2}, {0.4, 0.2}})};
    EXPECT_NE(refusal(pattern).find("path 0 at (0.2, 0.2)"), std::string::npos) << refusal(pattern);
}

// ---- errors, each naming the path and the place

struct Bad {
    const char* name;
    void (*spoil)(Pattern&);
    const char* expected;
};

class ResolveErrors : public ::testing::TestWithParam<Bad> {};

TEST_P(ResolveErrors, NameWhatAndWhere) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.1, 0.1}, {0.2, 0.1}}), chain({{0.3, 0.7}, {0.6, 0.7}, {0.6, 0.9}})};
    GetParam().spoil(pattern);
    const std::string message = refusal(pattern);
    EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
    // Lenient: the rest of the pattern comes through, and what was left out is told.
    const std::string expected = GetParam().expected;
    if (!expected.starts_with("path") && !expected.starts_with("step")) return;
    const Result<ResolvedPattern> rest = resolve_pattern(pattern, {.lenient = true});
    ASSERT_TRUE(rest.ok()) << rest.error().message;
    EXPECT_GE(rest->stats.dropped_paths, 1);
    EXPECT_EQ(rest->stats.first_dropped, message);
    EXPECT_EQ(rest->stats.crossings.empty(), message.find(" crosses step") == std::string::npos);
    EXPECT_FALSE(rest->elements.empty());
}

const double kNan = std::nan("");

INSTANTIATE_TEST_SUITE_P(
    Patterns, ResolveErrors,
    ::testing::Values(
        Bad{"Gap", [](Pattern& p) { p.paths[1].elements[1].p0.x = 0.61; },
            "path 1, element 1 at (0.61, 0.7) does not start"},
        Bad{"NotFinite", [](Pattern& p) { p.paths[1].elements[0].p2.y = kNan; },
            "path 1, element 0 at (0.3, 0.7)"},
        Bad{"FarAway", [](Pattern& p) { p.paths[1].elements[1].p2.x = 65.0; },
            "path 1, element 1 at (0.6, 0.7) lies more than 64 tiles away, at (65, 0.9)"},
        Bad{"NoElement", [](Pattern& p) { p.paths[1].elements.clear(); }, "path 1 has no element"},
        Bad{"ProfileIndex", [](Pattern& p) { p.paths[1].profile = 9; }, "path 1 uses profile 9 of 3"},
        Bad{"MaterialIndex", [](Pattern& p) { p.paths[1].material = 1; }, "path 1 uses material 1 of 1"},
        Bad{"Scale", [](Pattern& p) { p.paths[1].elements[0].width1 = 4.0; },
            "path 1, element 0 at (0.3, 0.7) has scale 4"},
        Bad{"NotClosed", [](Pattern& p) { p.paths[1].closed = true; }, "path 1 at (0.6, 0.9) is closed"},
        Bad{"ZeroLength",
            [](Pattern& p) {
                p.paths[1] = chain({{0.3, 0.7}, {0.3, 0.7}});
            },
            "path 1 at (0.3, 0.7) has length zero"},
        Bad{"Level", [](Pattern& p) { p.paths[1].level = kNan; }, "path 1 has a level"},
        Bad{"LooseStep", [](Pattern& p) { p.paths[1].profile = 1; },
            "path 1 at (0.3, 0.7) is a step path that ends nowhere"},
        Bad{"StepHeightScale",
            [](Pattern& p) {
                p.paths[1].profile = 1;
                p.paths[1].elements[1].height1 = 0.5;
            },
            "path 1, element 1 at (0.6, 0.7) changes the height scale"},
        Bad{"StepsCross",
            [](Pattern& p) {
                p.paths.push_back(plate(0.4, 0.6));
                p.paths.push_back(plate(0.5, 0.8));
            },
            "step path 2 crosses step path 3 at (0.6, 0.5)"},
        Bad{"StepCrossesItself",
            [](Pattern& p) {
                p.paths.push_back(
                    chain({{0.3, 0.2}, {0.5, 0.4}, {0.5, 0.2}, {0.3, 0.4}, {0.3, 0.2}}, 1, true));
            },
            "step path 2 crosses step path 2 at (0.4, 0.3)"},
        Bad{"ProfilePoints", [](Pattern& p) { p.profiles[0].points.resize(1); }, "profile 0: 1 points"},
        Bad{"ProfileOrder",
            [](Pattern& p) { std::swap(p.profiles[0].points[0].b, p.profiles[0].points[2].b); },
            "profile 0: the last point lies left"},
        Bad{"ProfileGround", [](Pattern& p) { p.profiles[0].points[0].h = 0.001; },
            "profile 0: the first point"},
        Bad{"ProfileFlags", [](Pattern& p) { p.profiles[0].facets.resize(1); },
            "profile 0: 1 facet flags for 3 points"},
        Bad{"StepOffItsLine", [](Pattern& p) { p.profiles[1].points[0].b = 0.001; },
            "profile 1: a step profile must reach over b = 0"},
        Bad{"Size", [](Pattern& p) { p.size.x = 0.0; }, "pattern size"},
        Bad{"Depth", [](Pattern& p) { p.depth = -1.0; }, "pattern depth"},
        Bad{"Outer", [](Pattern& p) { p.outer_level = 1.0; }, "outer level"},
        Bad{"Materials", [](Pattern& p) { p.materials.clear(); }, "no material"}),
    [](const auto& bad) { return std::string(bad.param.name); });

TEST(ResolveOptionsTest, OutOfRangeIsRefused) {
    EXPECT_NE(refusal(empty_pattern(), {.snap = 0.1}).find("snap"), std::string::npos);
    EXPECT_NE(refusal(empty_pattern(), {.smooth_angle = 1.0}).find("smooth_angle"), std::string::npos);
    EXPECT_NE(refusal(empty_pattern(), {.mitre_limit = 0.5}).find("mitre_limit"), std::string::npos);
}

TEST(ResolveErrorsMore, HeightsAboveTheObjectSurfaceAreRefused) {
    Pattern pattern = empty_pattern();
    pattern.profiles[0].points[1].h = 0.005;
    pattern.paths = {chain({{0.1, 0.1}, {0.2, 0.1}})};
    EXPECT_NE(refusal(pattern).find("reaches height"), std::string::npos);
}

TEST(ResolveErrorsMore, LenientDropsWhatHungOnADroppedStep) {
    Pattern pattern = empty_pattern();
    // Wall 1 ends on wall 0; wall 0 ends nowhere. Both go; the groove stays.
    pattern.paths = {chain({{0.2, 0.2}, {0.8, 0.2}}, 1), chain({{0.5, 0.2}, {0.5, 0.6}, {0.2, 0.6}}, 1),
                     chain({{0.1, 0.9}, {0.4, 0.9}})};
    const ResolvedPattern resolved = resolve(pattern, {.lenient = true});
    EXPECT_EQ(resolved.stats.dropped_paths, 2);
    EXPECT_EQ(resolved.elements.size(), 1u);
}

TEST(ResolveCleaning, DuplicatesAndZeroLengthAreDroppedAndCounted) {
    Pattern pattern = empty_pattern();
    pattern.paths = {chain({{0.2, 0.2}, {0.3, 0.2}, {0.3, 0.2}, {0.4, 0.2}}), chain({{0.1, 0.9}, {0.4, 0.9}}),
                     chain({{0.1, 0.9}, {0.4, 0.9}})};
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(resolved.stats.dropped_elements, 2);
    EXPECT_EQ(resolved.elements.size(), 3u);
}

// Bolts are that: neither too short to be kept nor drawn to what they lie beside.
TEST(ResolveCleaning, DotsStayWhereTheyAre) {
    for (const double distance : {1e-4, 1e-5}) {
        Pattern pattern = empty_pattern();
        pattern.paths = {chain({{0.2, 0.5}, {0.8, 0.5}}), chain({{0.4, 0.50003}, {0.4 + distance, 0.50003}}),
                         chain({{0.7, 0.2}, {0.7 + distance, 0.2}})};
        const ResolvedPattern resolved = resolve(pattern);
        ASSERT_EQ(resolved.elements.size(), 3u);
        EXPECT_EQ(resolved.stats.dropped_elements, 0);
        EXPECT_EQ(resolved.stats.snapped_ends, 0);
        EXPECT_EQ(resolved.elements[1].element.p2.x, 0.4 + distance);
        EXPECT_FALSE(is_tee(resolved.elements[1].start) || is_tee(resolved.elements[2].end));
    }
}

// Half a tile that begins a hair's breadth before its end: its last point would round to a code there is not.
TEST(ResolveCleaning, WhatEndsAtTheLastCodeIsCut) {
    for (const double before : {0.0, 1e-16, 1e-9, 3e-7}) {
        Pattern pattern = empty_pattern();
        pattern.paths = {chain({{1.0 - before, 0.6}, {1.5 - before, 0.6}})};
        for (const ResolvedElement& e : resolve(pattern).elements)
            EXPECT_LT(std::lround((std::max(e.element.p0.x, e.element.p2.x) + 0.5) * BURIN_COORDINATE_STEPS), 1l << 20);
    }
}

TEST(ResolveCleaning, EmptyPatternStaysEmpty) {
    const ResolvedPattern resolved = resolve(empty_pattern());
    EXPECT_TRUE(resolved.elements.empty() && resolved.junctions.empty());
}

}  // namespace
}  // namespace burin
