// Shares of footprints against rays of the truth. What fails prints its seed. Ten thousand footprints of each kind: bench_reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../property/random_pattern.hpp"
#include "truth_shares.hpp"

namespace burin {
namespace {

using namespace testing;

double total_of(const std::vector<reference::Share>& shares) {
    double total = 0.0;
    for (const reference::Share& share : shares) total += share.seen;
    return total;
}

void expect_sound(const std::vector<reference::Share>& shares) {
    for (const reference::Share& share : shares) {
        EXPECT_GE(share.lit, 0.0);
        EXPECT_LE(share.lit, share.seen + 1e-12);
        EXPECT_NEAR(dot(share.normal, share.normal), 1.0, 1e-9);
    }
}

class EachCase : public ::testing::TestWithParam<int> {};

TEST_P(EachCase, SharesAreThoseOfTheTruth) {
    constexpr int kCount = 24;
    ShareError mean;
    reference::AreasWork work;
    std::vector<reference::Share> shares;
    for (int i = 0; i < kCount; ++i) {
        const std::uint64_t seed = 1000u * unsigned(GetParam()) + unsigned(i);
        SCOPED_TRACE("seed " + std::to_string(seed));
        const reference::GroovedSurface surface = grooved(make_case(GrooveCase(GetParam()), seed));
        const Situation situation = make_situation(seed);
        reference::find_areas(surface, situation.footprint, situation.slopes, {}, work, shares);
        EXPECT_NEAR(total_of(shares), 1.0, 1e-6);
        expect_sound(shares);
        const ShareError error = compare_shares(gather_shares(surface.pattern(), shares), shares_by_truth(surface, situation, 64, seed));
        EXPECT_LE(error.seen, 0.02);
        EXPECT_LE(error.lit, 0.02);
        mean.seen += error.seen / kCount;
        mean.lit += error.lit / kCount;
    }
    // Some 0.2 % of it are the truth's own: it has 4096 rays.
    EXPECT_LE(mean.seen, 0.005);
    EXPECT_LE(mean.lit, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EachCase, ::testing::Range(0, kGrooveCases),
                         [](const auto& one) { return identifier_of(GrooveCase(one.param)); });

// Steps, curves, caps, joins, scales: whatever a pattern can hold.
TEST(RandomPatterns, SharesAreThoseOfTheTruth) {
    constexpr int kPatterns = 16, kPlaces = 6;
    reference::AreasWork work;
    std::vector<reference::Share> shares;
    ShareError mean;
    int off = 0;
    for (int i = 0; i < kPatterns; ++i) {
        RandomPatternOptions options;
        options.near_degenerate = false;
        options.wrap = i % 3 == 0 ? Wrap::clamp : Wrap::repeat;
        options.step_loops = i % 2 == 0 ? 3 : 0;
        const auto pattern = resolve_pattern(random_pattern(std::uint64_t(i) + 1, options));
        ASSERT_TRUE(pattern) << pattern.error().message;
        const reference::GroovedSurface surface = grooved(*pattern);
        for (int k = 0; k < kPlaces; ++k) {
            const std::uint64_t seed = std::uint64_t(i) * 100 + unsigned(k);
            SCOPED_TRACE("pattern " + std::to_string(i + 1) + ", seed " + std::to_string(seed));
            const Situation situation = make_situation_on(*pattern, seed);
            reference::find_areas(surface, situation.footprint, situation.slopes, {}, work, shares);
            EXPECT_NEAR(total_of(shares), 1.0, 0.01);
            if (std::abs(total_of(shares) - 1.0) > 1e-5) ++off;
            expect_sound(shares);
            const ShareError error = compare_shares(gather_shares(*pattern, shares), shares_by_truth(surface, situation, 40, seed));
            EXPECT_LE(error.seen, 0.05);
            mean.seen += error.seen / (kPatterns * kPlaces);
            mean.lit += error.lit / (kPatterns * kPlaces);
        }
    }
    // 1600 rays of the truth are off by 0.4 % themselves.
    EXPECT_LE(mean.seen, 0.008);
    EXPECT_LE(mean.lit, 0.008);
    EXPECT_LE(off, 3) << "footprints of which something is lost or shown twice";
}

// Both ways of sampling say the same where both can be taken.
TEST(LineSampling, AgreesWithAreas) {
    reference::AreasWork work;
    std::vector<reference::Share> lines, areas;
    reference::AreasOptions by_area;
    by_area.lines = false;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const reference::GroovedSurface surface = grooved(make_case(GrooveCase(seed % 2), seed));
        const Situation situation = make_situation(seed);
        reference::find_areas(surface, situation.footprint, situation.slopes, {}, work, lines);
        reference::find_areas(surface, situation.footprint, situation.slopes, by_area, work, areas);
        const ShareError error = compare_shares(gather_shares(surface.pattern(), lines), gather_shares(surface.pattern(), areas));
        EXPECT_LE(error.seen, 1e-6);
        EXPECT_LE(error.lit, 1e-6);
    }
    EXPECT_GT(work.by_line, 180);
}

// What the eye sees of a point and the light reaches, the light sees and the eye reaches.
TEST(Visibility, EyeAndLightMayChangePlaces) {
    reference::AreasWork work;
    std::vector<reference::Share> there, back;
    int met = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const reference::GroovedSurface surface = grooved(make_case(GrooveCase(seed % kGrooveCases), seed));
        Situation situation = make_situation(seed);
        const Vec2 at = middle_of(situation.footprint);
        situation.footprint = reference::make_parallelogram(at, {1e-7, 0.0}, {0.0, 1e-7});
        reference::find_areas(surface, situation.footprint, situation.slopes, {}, work, there);
        if (there.size() != 1) continue;  // on a border
        const reference::Share share = there[0];
        const Vec2 from = reference::plan(share.place) - situation.slopes.light * (surface.top() - share.place.z);
        const reference::Slopes swapped{situation.slopes.light, situation.slopes.view, true};
        reference::find_areas(surface, reference::make_parallelogram(from, {1e-7, 0.0}, {0.0, 1e-7}), swapped, {}, work, back);
        if (back.size() != 1 || (share.lit > 0.0 && share.lit < share.seen)) continue;
        const bool seen_back = back[0].element == share.element && back[0].facet == share.facet && std::abs(back[0].place.z - share.place.z) < 1e-6;
        EXPECT_EQ(share.lit > 0.0, seen_back && back[0].lit > 0.0);
        ++met;
    }
    EXPECT_GT(met, 300);
}

// What leaves the facets of a footprint in some direction, against rays of the truth from the same places.
TEST(Beams, MeetWhatRaysMeet) {
    reference::AreasWork work, inner;
    std::vector<reference::Share> shares, hits;
    reference::AreasOptions options;
    options.corners = true;
    int beams = 0, rays = 0, wrong = 0;
    for (std::uint64_t seed = 0; seed < 120; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const reference::GroovedSurface surface = grooved(make_case(GrooveCase(seed % kGrooveCases), seed));
        const Situation situation = make_situation(seed);
        reference::find_areas(surface, situation.footprint, situation.slopes, options, work, shares);
        EXPECT_NEAR(total_of(shares), 1.0, 1e-6);
        for (const reference::Share& share : shares) {
            if (share.seen < 1e-5) continue;  // needles, as thin as rounding
            const reference::Beam beam = beam_from(share, work.area.corners, seed + std::uint64_t(beams));
            const double left = reference::find_hits(surface, beam, situation.slopes, options, inner, hits);
            EXPECT_LE(total_of(hits), 1.0 + 1e-6);
            EXPECT_NEAR(total_of(hits) + left, 1.0, 1e-6);
            const BeamCheck check = check_beam(surface, beam, hits, inner.area.corners);
            rays += check.rays;
            wrong += check.wrong;
            ++beams;
        }
    }
    EXPECT_GT(beams, 300);
    // A ray may pass beside an edge by less than both tell apart.
    EXPECT_LE(wrong, rays / 500) << "of " << rays << " rays";
}

TEST(Footprint, HalvesHoldTheWhole) {
    const reference::Footprint whole = reference::make_ellipse({0.3, 0.2}, {0.02, 0.01}, {-0.005, 0.03});
    reference::Footprint first, second;
    reference::halve(whole, first, second);
    EXPECT_NEAR(area_of(first) + area_of(second), area_of(whole), 1e-15);
    EXPECT_NEAR(area_of(first), area_of(second), 1e-3 * area_of(whole));
}

}  // namespace
}  // namespace burin
