// Shares of footprints against rays of the truth. Seeds are printed with what fails.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "../property/random_pattern.hpp"
#include "truth_shares.hpp"

namespace burin {
namespace {

using namespace testing;

class EachCase : public ::testing::TestWithParam<int> {};

TEST_P(EachCase, SharesAreThoseOfTheTruth) {
    const auto which = GrooveCase(GetParam());
    const int count = std::getenv("N") ? std::atoi(std::getenv("N")) : 30;
    std::vector<double> errors;
    double sum = 0.0, lit = 0.0, worst_sum = 0.0;
    reference::AreasWork work;
    std::vector<reference::Share> shares;
    for (int i = 0; i < count; ++i) {
        const std::uint64_t seed = 1000u * unsigned(GetParam()) + unsigned(i);
        const ResolvedPattern pattern = make_case(which, seed);
        const auto grid = build_grid(pattern);
        ASSERT_TRUE(grid) << grid.error().message;
        const reference::GroovedSurface surface(pattern, *grid);
        const Situation situation = make_situation(seed);
        reference::find_areas(surface, situation.footprint, situation.slopes, {}, work, shares);
        double total = 0.0;
        for (const auto& share : shares) total += share.seen;
        worst_sum = std::max(worst_sum, std::abs(total - 1.0));
        const Shares truth = shares_by_truth(surface, situation, 72, seed);
        const ShareError error = compare_shares(gather_shares(surface.pattern(), shares), truth);
        errors.push_back(error.seen);
        sum += error.seen / count;
        lit += error.lit / count;
        if (std::getenv("V") && (error.seen > 0.01 || error.lit > 0.01 || std::abs(total - 1) > 1e-6)) {
            std::printf("seed %llu seen %.4f lit %.4f total %.6f by line %ld\n", (unsigned long long)seed, error.seen, error.lit, total, work.by_line);
            if (std::atoi(std::getenv("V")) > 1) {
                for (const auto& [k, s] : gather_shares(surface.pattern(), shares)) std::printf("  ours  %d %d %.4f %.4f\n", int(k.first), int(k.second), s.seen, s.lit);
                for (const auto& [k, s] : truth) std::printf("  truth %d %d %.4f %.4f\n", int(k.first), int(k.second), s.seen, s.lit);
            }
        }
    }
    std::sort(errors.begin(), errors.end());
    std::printf("%s: seen mean %.4f %%, 99 %% %.4f %%, worst %.4f %%; lit mean %.4f %%; sum off by %.1e; line %ld area %ld\n", name_of(which), 100 * sum,
                100 * errors[std::size_t(0.99 * (count - 1))], 100 * errors.back(), 100 * lit, worst_sum, work.by_line, work.by_area);
    EXPECT_LE(sum, 0.005);
    EXPECT_LE(lit, 0.005);
    EXPECT_LE(worst_sum, 1e-6);
}

// Steps, curves, caps, joins, scales: whatever a pattern can hold.
TEST(RandomPatterns, SharesAreThoseOfTheTruth) {
    const int count = std::getenv("N") ? std::atoi(std::getenv("N")) : 12;
    const int first = std::getenv("F") ? std::atoi(std::getenv("F")) : 0;
    reference::AreasWork work;
    std::vector<reference::Share> shares;
    std::vector<double> errors;
    double sum = 0.0, lit = 0.0, worst_sum = 0.0;
    for (int i = first; i < first + count; ++i) {
        RandomPatternOptions options;
        options.near_degenerate = false;
        options.wrap = i % 3 == 0 ? Wrap::clamp : Wrap::repeat;
        options.step_loops = i % 2 == 0 ? 3 : 0;
        const auto pattern = resolve_pattern(random_pattern(std::uint64_t(i) + 1, options));
        ASSERT_TRUE(pattern) << pattern.error().message;
        const auto grid = build_grid(*pattern);
        ASSERT_TRUE(grid) << grid.error().message;
        const reference::GroovedSurface surface(*pattern, *grid);
        for (int k = 0; k < 8; ++k) {
            const Situation situation = make_situation_on(*pattern, std::uint64_t(i) * 100 + unsigned(k));
            reference::find_areas(surface, situation.footprint, situation.slopes, {}, work, shares);
            double total = 0.0;
            for (const auto& share : shares) total += share.seen;
            worst_sum = std::max(worst_sum, std::abs(total - 1.0));
            const Shares truth = shares_by_truth(surface, situation, 40, unsigned(i));
            const ShareError error = compare_shares(gather_shares(surface.pattern(), shares), truth);
            errors.push_back(error.seen);
            sum += error.seen / (8 * count);
            lit += error.lit / (8 * count);
            if (std::getenv("V") && (error.seen > 0.02 || error.lit > 0.02 || std::abs(total - 1) > 1e-5)) {
                std::printf("pattern %d place %d seen %.4f lit %.4f total %.6f by line %ld\n", i, k, error.seen, error.lit, total, work.by_line);
                if (std::atoi(std::getenv("V")) > 1) {
                    for (const auto& [q, s] : gather_shares(surface.pattern(), shares)) std::printf("  ours  %d %d %.4f %.4f\n", int(q.first), int(q.second), s.seen, s.lit);
                    for (const auto& [q, s] : truth) std::printf("  truth %d %d %.4f %.4f\n", int(q.first), int(q.second), s.seen, s.lit);
                }
            }
        }
    }
    std::sort(errors.begin(), errors.end());
    std::printf("random: seen mean %.4f %%, 99 %% %.4f %%, worst %.4f %%; lit mean %.4f %%; sum off by %.1e; line %ld area %ld\n", 100 * sum,
                100 * errors[std::size_t(0.99 * double(errors.size() - 1))], 100 * errors.back(), 100 * lit, worst_sum, work.by_line, work.by_area);
    EXPECT_LE(sum, 0.008);
    EXPECT_LE(worst_sum, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Kinds, EachCase, ::testing::Range(0, kGrooveCases));

}  // namespace
}  // namespace burin
