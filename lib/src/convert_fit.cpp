// Traced once, fitted as often as it takes to keep within a budget.
#include "convert_internal.hpp"

#include <algorithm>
#include <cmath>

namespace burin::converting {

namespace {

VectorizeOptions vectorize_options(const ConvertOptions& options) {
    VectorizeOptions vectorize = options.vectorize;
    vectorize.threads = options.threads;
    return vectorize;
}

Result<Source> trace_source(const HeightMap& map, std::shared_ptr<const HeightMap> separated, const ConvertOptions& options,
                            const Progress& progress, StageClock& clock, bool gentle = false) {
    if (!clock.begin("vectorize")) return stopped();
    Source source{map, std::move(separated), {}};
    VectorizeOptions vectorize = vectorize_options(options);
    vectorize.gentle = gentle;
    auto traced = trace_map(source.detail(), vectorize, progress);
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

// A sixteenth of the map's 8-bit size; above 1024 x 1024 it stays at 63 KiB until that is a 128th, since a map
// drawn at twice the resolution does not hold twice the paths. A small map may be as rich as one of 512 x 512.
std::size_t default_budget(std::size_t texels) {
    constexpr std::size_t kLeast = 16 * 1024, kUsual = 63 * 1024;
    return std::max(kLeast, std::min(texels / 16, std::max(kUsual, texels / 128)));
}

Result<Candidate> fit_within(const Source& source, const ConvertOptions& options, std::size_t budget,
                             const Progress& progress, StageClock& clock, int most_elements) {
    const bool asked = options.max_texture_bytes > 0;
    constexpr int kMostHalvings = 12;
    const int most_attempts = asked ? 12 : 4, fewest = asked ? 1 : 16;
    // The refinement finds profiles alike, and stores fewer.
    const std::size_t enough = asked ? budget : budget + budget / 50;
    VectorizeOptions vectorize = vectorize_options(options);
    vectorize.shading = source.shading;
    vectorize.most_bytes = budget;
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

// Whether curves were fitted more loosely than the map shows, or paths given up, for the sake of the budget.
bool is_short_of_bytes(const Candidate& candidate) { return candidate.most_elements > 0 || candidate.traced.is_short; }

// Whether a candidate that takes more room than usual is made of paths, and not of very many short ones.
bool deserves_room(const ConvertStats& stats) {
    constexpr double kLeastLength = 9.0, kNearlyAll = 0.9;  // texels per element; explained: dots are short and many
    return stats.explained >= kNearlyAll || stats.path_length_texels >= kLeastLength * (stats.lines + stats.quadratics);
}

// Where the default budget was too small for what the map is made of, twice or four times as much.
Result<Start> with_room(Start start, const ConvertOptions& options, const Progress& progress, StageClock& clock) {
    constexpr double kMustGain = 0.04, kPromises = 0.1;  // for every doubling; of the first, for another to be tried
    const std::size_t usual = default_budget(start.source.map.image.texels.size());
    for (const std::size_t budget : {2 * usual, 4 * usual}) {
        const ConvertStats& stats = start.candidate.stats;
        const bool may_be_paths = stats.explained >= kPathLikeShare || stats.paths == 0;
        const bool may_gain = may_be_paths && stats.explained <= 1.0 - kMustGain;
        if (options.max_texture_bytes > 0 || !is_short_of_bytes(start.candidate) || !may_gain) break;
        if (budget <= start.budget) continue;
        auto larger = fit_within(start.source, options, budget, progress, clock);
        if (!larger) return larger.error();
        const double must_gain = kMustGain * std::log2(static_cast<double>(budget) / static_cast<double>(start.budget));
        const double gain = larger->stats.explained - stats.explained;
        if (gain >= must_gain && deserves_room(larger->stats)) start.candidate = std::move(*larger), start.budget = budget;
        if (gain < kPromises) break;
    }
    return start;
}

// With steps along soft ground, or without where they explain too little for what they cost.
Result<Start> start_from(Source source, const ConvertOptions& options, std::size_t budget, const Progress& progress,
                         StageClock& clock, int most_elements = 0) {
    constexpr double kMustGain = 0.005;
    auto shaded = fit_within(source, options, budget, progress, clock, most_elements);
    if (!shaded) return shaded.error();
    if (!shaded->traced.shaded) return with_room({std::move(source), std::move(*shaded), budget}, options, progress, clock);
    source.shading = false;
    auto plain = fit_within(source, options, budget, progress, clock, shaded->most_elements);
    if (!plain) return plain.error();
    source.shading = shaded->stats.explained > plain->stats.explained + kMustGain;
    Candidate& better = source.shading ? *shaded : *plain;
    return with_room({std::move(source), std::move(better), budget}, options, progress, clock);
}

// The map with steps along gentle borders too, where it is hardly explained otherwise and few such steps explain nearly all:
// on rock they are contour lines, and where the budget was too small already there would be more of them.
Result<Start> or_gentle(Start start, const HeightMap& map, const ConvertOptions& options, std::size_t budget,
                        const Progress& progress, StageClock& clock) {
    constexpr double kNearlyAll = 0.9, kLoosest = 1.0;  // explained; texels
    if (start.candidate.stats.explained >= kClearShare || is_short_of_bytes(start.candidate)) return start;
    auto source = trace_source(map, nullptr, options, progress, clock, true);
    if (!source) return source.error();
    VectorizeOptions vectorize = vectorize_options(options);
    vectorize.most_bytes = budget;
    const auto fitted = fit_traced_map(source->traced, map, vectorize, progress);
    if (!fitted) return fitted.error();
    // A fit that the budget loosens by so much follows the grain of rock.
    if (fitted->tolerance > kLoosest || fitted->pattern.paths.empty()) return start;
    auto gentle = start_from(std::move(*source), options, budget, progress, clock);
    if (!gentle) return gentle.error();
    return gentle->candidate.stats.explained >= kNearlyAll ? std::move(gentle) : std::move(start);
}

// With the soft ground of the map, or without where that explains more.
Result<Start> trace_on_ground(const HeightMap& map, const ConvertOptions& options, std::size_t budget,
                              const Progress& progress, StageClock& clock) {
    constexpr double kLeastDeviation = 0.004, kMustGain = 0.002;
    auto source = trace_source(map, nullptr, options, progress, clock);
    if (!source) return source.error();
    auto start = start_from(std::move(*source), options, budget, progress, clock);
    if (!start) return start.error();
    // Where the budget is what leaves most of the map unexplained, level ground would not help.
    const double explained = start->candidate.stats.explained;
    const bool is_short = start->candidate.most_elements > 0 && explained < kClearShare;
    if (is_short || start->budget > budget) return start;
    if (explained + kMustGain > 1.0) return start;  // nor can it where all is explained
    if (!clock.begin("vectorize")) return stopped();
    // Only a bound on the error asks for closer paths later, and what was traced takes room.
    if (options.max_error <= 0.0) start->source.traced = {}, start->candidate.heights = {};
    auto separated = separate_ground(map, vectorize_options(options));
    if (!separated) return separated.error();
    if (separated->deviation < kLeastDeviation) return start;
    auto detail = std::make_shared<const HeightMap>(std::move(separated->detail));
    auto other_source = trace_source(map, std::move(detail), options, progress, clock);
    if (!other_source) return other_source.error();
    auto other = start_from(std::move(*other_source), options, start->budget, progress, clock, start->candidate.most_elements);
    if (!other) return other.error();
    const bool gains = other->candidate.stats.explained >= start->candidate.stats.explained + kMustGain;
    return gains ? std::move(other) : std::move(start);
}

}  // namespace

Result<Start> trace_best(const HeightMap& map, const ConvertOptions& options, std::size_t budget,
                         const Progress& progress, StageClock& clock) {
    auto start = trace_on_ground(map, options, budget, progress, clock);
    if (!start) return start;
    return or_gentle(std::move(*start), map, options, budget, progress, clock);
}

}  // namespace burin::converting
