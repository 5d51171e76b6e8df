// Question: how far are the shares of footprints that the reference renderer finds from those that rays of the truth find?
//
//     bench_reference [--count FOOTPRINTS] [--side RAYS]      of each kind of [2008] figure 5; SIDE x SIDE rays over the box of a footprint
//
// What is seen is off by the part of the footprint that goes to another facet than the truth's; what is lit likewise. The truth's own rays
// are off, too: by how much shows the second table, of rays against as many others.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "../../tests/judge/judge.hpp"
#include "../../tests/reference/truth_shares.hpp"

namespace burin::bench {
namespace {

using namespace testing;

struct Errors {
    std::vector<double> seen, lit;
    double worst_sum = 0.0, microseconds = 0.0;
};

struct Outcome {
    ShareError error, noise;
    double sum = 0.0, microseconds = 0.0;
};

Outcome measure_one(GrooveCase which, std::uint64_t seed, int side, bool noise) {
    const reference::GroovedSurface surface = grooved(make_case(which, seed));
    const Situation situation = make_situation(seed);
    reference::AreasWork work;
    std::vector<reference::Share> shares;
    reference::find_areas(surface, situation.footprint, situation.slopes, {}, work, shares);
    Outcome outcome;
    outcome.microseconds = 1e300;
    for (int run = 0; run < 5; ++run) {
        reference::AreasWork alone;  // nothing is left of what neighbours have met
        const auto start = std::chrono::steady_clock::now();
        reference::find_areas(surface, situation.footprint, situation.slopes, {}, alone, shares);
        outcome.microseconds = std::min(outcome.microseconds, std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
    }
    for (const reference::Share& share : shares) outcome.sum += share.seen;
    const Shares truth = shares_by_truth(surface, situation, side, seed);
    outcome.error = compare_shares(gather_shares(surface.pattern(), shares), truth);
    if (noise) outcome.noise = compare_shares(truth, shares_by_truth(surface, situation, side, seed + 1));
    return outcome;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return values.empty() ? 0.0 : sum / double(values.size());
}

double percentile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[std::size_t(share * double(values.size() - 1))];
}

void measure(GrooveCase which, int count, int side) {
    std::vector<Outcome> outcomes(static_cast<std::size_t>(count));
    in_parallel(outcomes.size(), [&](std::size_t i) { outcomes[i] = measure_one(which, std::uint64_t(which) * 1000003 + i, side, i % 16 == 0); });
    Errors errors;
    std::vector<double> noise;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        errors.seen.push_back(outcomes[i].error.seen);
        errors.lit.push_back(outcomes[i].error.lit);
        errors.worst_sum = std::max(errors.worst_sum, std::abs(outcomes[i].sum - 1.0));
        errors.microseconds += outcomes[i].microseconds / count;
        if (i % 16 == 0) noise.push_back(outcomes[i].noise.seen);
    }
    // Rays against rays are off by both, which are alike and not of one another.
    std::printf("| %s | %d | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f | %.0e | %.1f |\n", name_of(which), count, 100 * mean_of(errors.seen),
                100 * percentile(errors.seen, 0.99), 100 * percentile(errors.seen, 1.0), 100 * mean_of(errors.lit), 100 * percentile(errors.lit, 0.99),
                100 * percentile(errors.lit, 1.0), 100 * mean_of(noise) / 1.41421356, errors.worst_sum, errors.microseconds);
    std::fflush(stdout);
}

}  // namespace
}  // namespace burin::bench

int main(int argc, char** argv) {
    int count = 10000, side = 72;
    for (int i = 1; i < argc; i += 2) {
        const std::string name = argv[i];
        const int value = i + 1 < argc ? std::atoi(argv[i + 1]) : 0;
        if ((name != "--count" && name != "--side") || value < 1) {
            std::fprintf(stderr, "bench_reference: error: '%s' is no option with a whole number above 0; --count and --side work\n", argv[i]);
            return 2;
        }
        (name == "--count" ? count : side) = value;
    }
    std::printf("\n### Shares of footprints\n\nPer cent of the footprint that goes to another facet than rays of the truth say, %d x %d over the box of each; views and lights from 5 to 90\n"
                "degrees, footprints from a tenth of a groove to several. Rays: what rays of the truth are off by themselves. Sum: how far shares are\n"
                "from 1, at most. us: of one footprint on one core, the least of five runs, mean.\n\n"
                "| case | footprints | seen, mean | 99 %% | worst | lit, mean | 99 %% | worst | rays | sum | us |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
                side, side);
    for (int which = 0; which < burin::testing::kGrooveCases; ++which) burin::bench::measure(burin::testing::GrooveCase(which), count, side);
    return 0;
}
