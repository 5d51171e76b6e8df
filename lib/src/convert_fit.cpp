// Traced once, fitted as often as it takes to keep within a budget.
#include "convert_internal.hpp"

#include <algorithm>

namespace burin::converting {

namespace {

VectorizeOptions vectorize_options(const ConvertOptions& options) {
    VectorizeOptions vectorize = options.vectorize;
    vectorize.threads = options.threads;
    return vectorize;
}

Result<Source> trace_source(const HeightMap& map, std::shared_ptr<const HeightMap> separated, const ConvertOptions& options,
                            const Progress& progress, StageClock& clock) {
    if (!clock.begin("vectorize")) return stopped();
    Source source{map, std::move(separated), {}};
    auto traced = trace_map(source.detail(), vectorize_options(options), progress);
    if (!traced) return traced.error();
    source.traced = std::move(*traced);
    return source;
}

int count_elements(const Pattern& pattern) {
    std::size_t sum = 0;
    for (const Path& path : pattern.paths) sum += path.elements.size();
    return static_cast<int>(sum);
}

// Of elements, so that the textures keep to the budget: what is too much goes at the elements' cost, since cells and lists are
// as small already as they may be.
double share_to_keep(const PackedTextures& textures, std::size_t budget, int attempt) {
    constexpr double kLeast = 0.2;
    const double margin = std::max(0.5, 1.0 - 0.03 * attempt * attempt);  // what did not suffice once takes more
    const double bytes = static_cast<double>(bytes_of(textures)), excess = bytes - static_cast<double>(budget);
    return margin * std::max(kLeast, 1.0 - excess / static_cast<double>(element_bytes(textures)));
}

}  // namespace

Result<Candidate> fit_within(const Source& source, const ConvertOptions& options, std::size_t budget,
                             const Progress& progress, StageClock& clock, int most_elements) {
    const bool asked = options.max_texture_bytes > 0;
    constexpr int kMostHalvings = 12;
    const int most_attempts = asked ? 12 : 4, fewest = asked ? 1 : 16;
    // The refinement finds profiles alike, and stores fewer.
    const std::size_t enough = asked ? budget : budget + budget / 50;
    VectorizeOptions vectorize = vectorize_options(options);
    vectorize.shading = source.shading;
    if (most_elements > 0) vectorize.most_elements = most_elements;
    for (int attempt = 1;; ++attempt) {
        if (!clock.begin("vectorize")) return stopped();
        auto fitted = fit_traced_map(source.traced, source.detail(), vectorize, progress);
        if (!fitted) return fitted.error();
        const int traced = count_elements(fitted->pattern);
        auto candidate = pack_candidate(std::move(*fitted), source.map, options, budget, clock);
        // Where too many elements act at one place, fewer of them may still be stored.
        if (!candidate && candidate.error().code == ErrorCode::limit_exceeded && attempt < kMostHalvings && traced > fewest) {
            vectorize.most_elements = std::max(fewest, traced / 2);
            continue;
        }
        if (!candidate) return candidate.error();
        const int elements = candidate->stats.lines + candidate->stats.quadratics;
        candidate->most_elements = vectorize.most_elements;
        if (candidate->bytes() <= enough || attempt >= most_attempts || elements <= fewest)
            return measure_candidate(std::move(*candidate), source.map, options, clock);
        const int most = vectorize.most_elements > 0 ? std::min(vectorize.most_elements, elements) : elements;
        vectorize.most_elements = std::max(fewest, static_cast<int>(most * share_to_keep(candidate->packed.textures, budget, attempt)));
    }
}

namespace {

// With steps along soft ground, or without where they explain too little for what they cost.
Result<Start> start_from(Source source, const ConvertOptions& options, std::size_t budget, const Progress& progress,
                         StageClock& clock, int most_elements = 0) {
    constexpr double kMustGain = 0.005;
    auto shaded = fit_within(source, options, budget, progress, clock, most_elements);
    if (!shaded) return shaded.error();
    if (!shaded->traced.shaded) return Start{std::move(source), std::move(*shaded)};
    source.shading = false;
    auto plain = fit_within(source, options, budget, progress, clock, shaded->most_elements);
    if (!plain) return plain.error();
    source.shading = shaded->stats.explained > plain->stats.explained + kMustGain;
    Candidate& better = source.shading ? *shaded : *plain;
    return Start{std::move(source), std::move(better)};
}

}  // namespace

Result<Start> trace_best(const HeightMap& map, const ConvertOptions& options, std::size_t budget,
                         const Progress& progress, StageClock& clock) {
    constexpr double kLeastDeviation = 0.004, kMustGain = 0.002;
    auto source = trace_source(map, nullptr, options, progress, clock);
    if (!source) return source.error();
    auto start = start_from(std::move(*source), options, budget, progress, clock);
    if (!start) return start.error();
    // Where the budget is what leaves most of the map unexplained, level ground would not help.
    if (start->candidate.most_elements > 0 && start->candidate.stats.explained < kClearShare) return start;
    if (!clock.begin("vectorize")) return stopped();
    // Only a bound on the error asks for closer paths later, and what was traced takes room.
    if (options.max_error <= 0.0) start->source.traced = {};
    auto separated = separate_ground(map, vectorize_options(options));
    if (!separated) return separated.error();
    if (separated->deviation < kLeastDeviation) return start;
    auto detail = std::make_shared<const HeightMap>(std::move(separated->detail));
    auto other_source = trace_source(map, std::move(detail), options, progress, clock);
    if (!other_source) return other_source.error();
    auto other = start_from(std::move(*other_source), options, budget, progress, clock, start->candidate.most_elements);
    if (!other) return other.error();
    const bool gains = other->candidate.stats.explained >= start->candidate.stats.explained + kMustGain;
    return gains ? std::move(other) : std::move(start);
}

}  // namespace burin::converting
