#include <burin/convert.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <stdexcept>

#include <burin/compare.hpp>
#include <burin/reconstruct.hpp>

#include "resolve_curve.hpp"

namespace burin {
namespace {

// Tells the user which stage runs and sums up the time of each.
class StageClock {
  public:
    using Seconds = std::vector<std::pair<std::string, double>>;
    StageClock(const Progress& progress, Seconds& seconds) : progress_(progress), seconds_(seconds) {}

    // False when the user wants to stop.
    bool begin(const char* stage) {
        end();
        stage_ = stage;
        begun_ = std::chrono::steady_clock::now();
        return !progress_ || progress_(stage, 0.0);
    }
    void end() {
        if (!stage_) return;
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun_;
        // A stage that runs again, for a smaller budget or after the refinement, adds to its time.
        const auto known = std::find_if(seconds_.begin(), seconds_.end(), [&](const auto& s) { return s.first == stage_; });
        if (known == seconds_.end())
            seconds_.emplace_back(stage_, spent.count());
        else
            known->second += spent.count();
        if (progress_) progress_(stage_, 1.0);
        stage_ = nullptr;
    }

  private:
    const Progress& progress_;
    Seconds& seconds_;
    const char* stage_ = nullptr;
    std::chrono::steady_clock::time_point begun_;
};

Error stopped() { return {ErrorCode::invalid_argument, "stopped on request"}; }

// Counts what is stored, and gives the places of the paths it came from.
std::vector<std::uint32_t> count_elements(const ResolvedPattern& pattern, double texels_per_metre, ConvertStats& stats) {
    std::vector<std::uint32_t> paths;
    for (const ResolvedElement& element : pattern.elements) {
        const bool line = element.element.kind == ElementKind::line;
        (line ? stats.lines : stats.quadratics) += 1;
        stats.path_length_texels += curve::arc_length(element.element) * texels_per_metre;
        paths.push_back(element.path);
    }
    std::sort(paths.begin(), paths.end());
    paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
    stats.paths = static_cast<int>(paths.size());
    stats.profiles = static_cast<int>(pattern.profiles.size());
    return paths;
}

// Maps of lines and plateaus come above 0.5, rock and terrain stay below 0.2.
constexpr double kPathLikeShare = 0.35;
// A map whose paths explain less than this has more of them than the budget takes, or other things.
constexpr double kClearShare = 0.6;
constexpr double kAccidentShare = 0.1;

// The heights of the textures as they are stored.
Result<Image> reconstruct(const HeightMap& map, const PackedTextures& textures, const PathDetail& detail,
                          const ReconstructOptions& options) {
    auto heights = reconstruct_heights(textures, detail, map.image.width, map.image.height, options);
    // What burin packed breaks the format: a bug, whatever the map.
    if (!heights && heights.error().code == ErrorCode::invalid_input)
        throw std::logic_error("the packed pattern breaks the format: " + heights.error().message);
    return heights;
}

// Of a map that shows as much in fewer texels, a texel tells as much from fewer samples.
int samples_for(const ConvertStats& stats, int usual) { return std::max(std::min(usual, 2), usual >> stats.halvings); }

Status measure(const HeightMap& map, const PackedTextures& textures, const PathDetail& detail, int threads,
               ConvertStats& stats) {
    const auto heights = reconstruct(map, textures, detail, {.samples = samples_for(stats, ReconstructOptions{}.samples), .threads = threads});
    if (!heights) return heights.error();
    const Comparison figures = compare_heights(*heights, map.image, detail.repeat ? Wrap::repeat : Wrap::clamp, threads);
    stats.explained = figures.explained;
    stats.path_like = figures.explained >= kPathLikeShare;
    stats.rms = figures.rms;
    stats.p999 = figures.p999;
    stats.p999_without_smooth = figures.p999_without_smooth;
    stats.max = figures.max;
    return Done{};
}

struct Packed {
    PackedTextures textures;
    PathDetail detail;
    std::vector<std::uint32_t> paths;  // of the pattern, that are stored
};

Result<PackedTextures> grid_and_pack(const ResolvedPattern& pattern, const GridOptions& options, const PackOptions& pack,
                                     StageClock& clock) {
    if (!clock.begin("grid")) return stopped();
    const auto grid = build_grid(pattern, options);
    if (!grid) return grid.error();
    if (!clock.begin("pack")) return stopped();
    return pack_textures(pattern, *grid, pack);
}

std::size_t bytes_of(const PackedTextures& textures) {
    return (textures.grid.size() + textures.data.size()) * sizeof(std::uint32_t);
}

// Of elements and their styles, without cells and lists.
std::size_t element_bytes(const PackedTextures& textures) {
    return textures.data.size() * sizeof(std::uint32_t) - static_cast<std::size_t>(textures.sections.list_texels) * 16;
}

// What the budget leaves to cells and lists.
std::size_t room_beside(const PackedTextures& textures, std::size_t budget) {
    return budget - std::min(budget, element_bytes(textures));
}

// Larger cells make rays slower, but fewer elements lose something: cells and lists may be this small a share of the budget.
constexpr std::size_t kLeastGrid = 5;

// Quadratics that there is room for, with their place in the lists.
int room_for_elements(const PackedTextures& textures, std::size_t budget) {
    constexpr std::size_t kQuadraticBytes = 38;
    const std::size_t room = room_beside(textures, budget);
    return static_cast<int>((room - std::min(room, budget / kLeastGrid)) / kQuadraticBytes);
}

// Resolve, grid, pack.
Result<Packed> pack_pattern(const Pattern& pattern, const HeightMap& map, const ConvertOptions& options,
                            std::size_t budget, StageClock& clock, ConvertStats& stats) {
    if (!clock.begin("resolve")) return stopped();
    const auto resolved = resolve_pattern(pattern, options.resolve);
    if (!resolved) return resolved.error();
    stats.paths = stats.lines = stats.quadratics = 0;
    stats.path_length_texels = 0.0;
    std::vector<std::uint32_t> paths = count_elements(*resolved, map.image.width / resolved->size.x, stats);
    stats.dropped_paths = resolved->stats.dropped_paths;
    stats.repeat = resolved->wrap == Wrap::repeat;

    GridOptions grid = options.grid;
    grid.threads = options.threads;
    const bool chosen = grid.max_bytes > 0 || grid.cell_size > 0.0;
    if (grid.max_bytes == 0) grid.max_bytes = budget / 2;
    auto textures = grid_and_pack(*resolved, grid, options.pack, clock);
    if (textures && !chosen && bytes_of(*textures) > budget) {
        grid.max_bytes = std::max(budget / kLeastGrid, room_beside(*textures, budget));
        textures = grid_and_pack(*resolved, grid, options.pack, clock);
    }
    if (!textures) return textures.error();
    stats.cells = textures->grid_width * textures->grid_height;
    stats.grid_bytes = textures->grid.size() * sizeof(std::uint32_t);
    stats.data_bytes = textures->data.size() * sizeof(std::uint32_t);
    PathDetail detail = describe_pattern(*resolved, *textures);
    detail.tex_coord = options.attach.tex_coord;
    return Packed{std::move(*textures), std::move(detail), std::move(paths)};
}

// A sixteenth of the map's 8-bit size; above 1024 x 1024 it stays at 63 KiB until that is a 128th, since a map
// drawn at twice the resolution does not hold twice the paths. A small map may be as rich as one of 512 x 512.
std::size_t default_budget(std::size_t texels) {
    constexpr std::size_t kLeast = 16 * 1024, kUsual = 63 * 1024;
    return std::max(kLeast, std::min(texels / 16, std::max(kUsual, texels / 128)));
}

// A pattern, its textures, and what they were measured to explain.
struct Candidate {
    Vectorized traced;
    Packed packed;
    ConvertStats stats;  // counts and figures of this candidate
    int most_elements = 0;  // that it took to keep within the budget; 0: all there were
    std::size_t bytes() const { return stats.grid_bytes + stats.data_bytes; }
};

Result<Candidate> pack_candidate(Vectorized traced, const HeightMap& map, const ConvertOptions& options,
                                 std::size_t budget, StageClock& clock) {
    Candidate candidate;
    auto packed = pack_pattern(traced.pattern, map, options, budget, clock, candidate.stats);
    if (!packed) return packed.error();
    candidate.packed = std::move(*packed);
    candidate.traced = std::move(traced);
    return candidate;
}

Result<Candidate> measure_candidate(Candidate candidate, const HeightMap& map, const ConvertOptions& options, StageClock& clock) {
    if (!clock.begin("measure")) return stopped();
    const Packed& packed = candidate.packed;
    const Status measured = measure(map, packed.textures, packed.detail, options.threads, candidate.stats);
    if (!measured) return measured.error();
    return candidate;
}

Result<Candidate> pack_and_measure(Vectorized traced, const HeightMap& map, const ConvertOptions& options,
                                   std::size_t budget, StageClock& clock) {
    auto candidate = pack_candidate(std::move(traced), map, options, budget, clock);
    if (!candidate) return candidate;
    return measure_candidate(std::move(*candidate), map, options, clock);
}

VectorizeOptions vectorize_options(const ConvertOptions& options) {
    VectorizeOptions vectorize = options.vectorize;
    vectorize.threads = options.threads;
    return vectorize;
}

// A map, and what of it was traced: the map itself, or the map without its soft ground.
struct Source {
    const HeightMap& map;
    std::shared_ptr<const HeightMap> separated;  // null: the map itself
    TracedMap traced;
    bool shading = true;  // see VectorizeOptions
    const HeightMap& detail() const { return separated ? *separated : map; }
};

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

// Fits with ever fewer elements until the textures keep to the budget; a budget that was asked for goes before looks.
// `most_elements`: as many as kept to it when the same map was traced in another way, or 0.
Result<Candidate> fit_within(const Source& source, const ConvertOptions& options, std::size_t budget,
                             const Progress& progress, StageClock& clock, int most_elements = 0) {
    const bool asked = options.max_texture_bytes > 0;
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
        if (!candidate && candidate.error().code == ErrorCode::limit_exceeded && attempt < most_attempts && traced > fewest) {
            vectorize.most_elements = std::max(fewest, traced / 2);
            continue;
        }
        if (!candidate) return candidate.error();
        const int elements = candidate->stats.lines + candidate->stats.quadratics;
        candidate->most_elements = vectorize.most_elements;
        if (candidate->bytes() <= enough || attempt == most_attempts || elements <= fewest)
            return measure_candidate(std::move(*candidate), source.map, options, clock);
        const int most = vectorize.most_elements > 0 ? std::min(vectorize.most_elements, elements) : elements;
        vectorize.most_elements = std::max(fewest, static_cast<int>(most * share_to_keep(candidate->packed.textures, budget, attempt)));
    }
}

struct Start {
    Source source;
    Candidate candidate;
};

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

// The map as it is, or without its soft ground where that explains more: whether a ramp is ground or the side of a wide
// bevel shows when its paths are drawn.
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

// A step of the refinement looks at the texels within reach of every element: wide profiles on long paths would take
// long and gain little, since a soft wall shows its place well. Whether it runs depends on the pattern alone, not on a
// clock, so that the bytes do not depend on the machine.
bool can_afford_refinement(const Pattern& pattern, const Image& map, double explained) {
    // Element lengths times profile widths: up to 6 seconds on two cores where the paths are what the map is made of, half
    // as long where much of it is something else.
    constexpr double kMade = 0.9, kMostTexels = 1e6, kMostOfOthers = 3e5;
    const double texels = map.width / pattern.size.x;
    double work = 0.0;
    for (const Path& path : pattern.paths) {
        const std::vector<ProfilePoint>& points = pattern.profiles[path.profile].points;
        const double reach = (points.back().b - points.front().b) * texels + 2.0;
        for (const Element& element : path.elements) work += curve::arc_length(element) * texels * reach;
    }
    return work <= (explained >= kMade ? kMostTexels : kMostOfOthers);
}

Unrefined reason_not_to_refine(const Candidate& candidate, const HeightMap& map, const ConvertOptions& options) {
    if (!options.refine) return Unrefined::not_asked;
    if (candidate.traced.pattern.paths.empty()) return Unrefined::no_paths;
    if (!candidate.stats.path_like) return Unrefined::not_path_like;
    return can_afford_refinement(candidate.traced.pattern, map.image, candidate.stats.explained) ? Unrefined::no : Unrefined::too_much_work;
}

// Whether curves were fitted more loosely than the map shows, or elements given up, for the sake of the budget: then the
// refinement has none to add.
bool is_short_of_bytes(const Candidate& candidate) {
    return candidate.most_elements > 0 || candidate.traced.tolerance > kUsualTolerance;
}

// Takes out elements of hardly a texel: where a crossing left a kink, the refinement may fold it, and what lies in the
// outer sector of a fold reaches far.
Pattern without_folds(Pattern pattern, double texel) {
    constexpr double kShortest = 1.5;  // texels
    for (Path& path : pattern.paths) {
        std::vector<Element>& elements = path.elements;
        for (std::size_t i = 1; i + 1 < elements.size();) {
            if (length(elements[i].p2 - elements[i].p0) >= kShortest * texel) {
                ++i;
                continue;
            }
            elements[i + 1].p0 = elements[i].p0;
            elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }
    return pattern;
}

// Least squares against the map. What it makes worse, because the traced structure is not that of the map, is not kept.
Result<Candidate> refine_candidate(Candidate candidate, const Source& source, const ConvertOptions& options,
                                   std::size_t budget, StageClock& clock) {
    const HeightMap& map = source.map;
    candidate.stats.unrefined = reason_not_to_refine(candidate, map, options);
    if (candidate.stats.unrefined != Unrefined::no) return candidate;
    if (!clock.begin("refine")) return stopped();
    candidate.stats.unrefined = Unrefined::no_gain;
    RefineOptions refinement = options.refinement;
    refinement.threads = options.threads;
    refinement.damage = candidate.traced.damage;
    if (is_short_of_bytes(candidate)) refinement.elements = false;
    refinement.most_splits = std::min(refinement.most_splits, room_for_elements(candidate.packed.textures, budget));
    Vectorized refined = candidate.traced;
    if (!refine_pattern(refined.pattern, source.detail().image, refinement)) return candidate;
    Vectorized unfolded = refined;
    auto better = pack_and_measure(std::move(refined), map, options, budget, clock);
    if (!better || better->stats.explained < candidate.stats.explained) {
        const double texel = unfolded.pattern.size.x / map.image.width;
        unfolded.pattern = without_folds(std::move(unfolded.pattern), texel);
        better = pack_and_measure(std::move(unfolded), map, options, budget, clock);
    }
    if (!better || better->stats.explained < candidate.stats.explained) return candidate;
    if (options.max_texture_bytes > 0 && better->bytes() > budget) return candidate;
    return better;
}

// Paths that explain next to nothing are accidents of rock or noise: the fallback maps show the surface better alone.
Result<Candidate> without_accidents(Candidate candidate, const HeightMap& map, const ConvertOptions& options,
                                    std::size_t budget, StageClock& clock) {
    if (candidate.stats.explained >= kAccidentShare || candidate.traced.pattern.paths.empty()) return candidate;
    Vectorized empty = candidate.traced;
    empty.pattern.paths.clear();
    empty.pattern.profiles.clear();
    return pack_and_measure(std::move(empty), map, options, budget, clock);
}

// A candidate without what is no path, and refined.
Result<Candidate> finish_candidate(Candidate fitted, const Source& source, const ConvertOptions& options,
                                   std::size_t budget, StageClock& clock) {
    const double traced_explained = fitted.stats.explained;
    auto candidate = without_accidents(std::move(fitted), source.map, options, budget, clock);
    if (candidate) candidate = refine_candidate(std::move(*candidate), source, options, budget, clock);
    if (candidate) candidate->stats.traced_explained = traced_explained;
    return candidate;
}

Result<Start> start_within(const HeightMap& map, const ConvertOptions& options, std::size_t budget,
                           const Progress& progress, StageClock& clock) {
    auto start = trace_best(map, options, budget, progress, clock);
    if (!start) return start.error();
    auto finished = finish_candidate(std::move(start->candidate), start->source, options, budget, clock);
    if (!finished) return finished.error();
    start->candidate = std::move(*finished);
    return start;
}

// A bound that no conversion kept, and the value that one did keep.
Error cannot_keep(const std::string& bound, const std::string& why, const std::string& works) {
    return {ErrorCode::invalid_argument, bound + " cannot be kept: " + why + "; " + works + " works"};
}

// Looks for a number of bytes that can be kept, to be told: what works is what was tried.
Error refuse_bytes(const HeightMap& map, ConvertOptions options, std::size_t reached, const Progress& progress,
                   StageClock& clock) {
    const std::string bound = "a limit of " + std::to_string(options.max_texture_bytes) + " bytes for both textures";
    const std::string why = "giving up elements came down to " + std::to_string(reached) + " bytes";
    while (true) {
        options.max_texture_bytes = std::max(reached, options.max_texture_bytes + options.max_texture_bytes / 2);
        const auto kept = start_within(map, options, options.max_texture_bytes, progress, clock);
        if (!kept) return kept.error();
        if (kept->candidate.bytes() <= options.max_texture_bytes)
            return cannot_keep(bound, why, std::to_string(options.max_texture_bytes) + " bytes");
    }
}

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", share * 100.0);
    return text;
}

// Three digits, upwards: what was reached keeps within it.
std::string percent_above(double share) {
    const double scale = std::pow(10.0, 2.0 - std::floor(std::log10(std::max(share * 100.0, 1e-6))));
    return percent(std::ceil(share * 100.0 * scale) / scale / 100.0);
}

Error refuse_error(const ConvertOptions& options, const Candidate& best) {
    std::string why = "the closest paths err by " + percent(best.stats.p999) + " % in the 99.9th percentile";
    if (best.stats.p999_without_smooth < 0.8 * best.stats.p999)
        why += ", by " + percent(best.stats.p999_without_smooth) + " % but for soft ground, which is no path";
    return cannot_keep("a height error of " + percent(options.max_error) + " % of range", why,
                       percent_above(best.stats.p999) + " %");
}

// Fits ever closer until 99.9 % of the texels keep the bound, or closer paths are no better.
Result<Candidate> closer_within(const Source& source, ConvertOptions options, Candidate best, const Progress& progress,
                                StageClock& clock) {
    const bool bytes_bound = options.max_texture_bytes > 0;
    const std::size_t budget = bytes_bound ? options.max_texture_bytes : source.map.image.texels.size();
    constexpr std::size_t kElementBytes = 36;  // with its share of the grid
    if (!bytes_bound) options.vectorize.most_elements = static_cast<int>(std::max<std::size_t>(budget / kElementBytes, 64));
    for (int round = 0; round < 3 && best.stats.p999 > options.max_error; ++round) {
        options.vectorize.tolerance = best.traced.tolerance / 2.0;
        auto closer = fit_within(source, options, budget, progress, clock);
        if (closer) closer = finish_candidate(std::move(*closer), source, options, budget, clock);
        if (!closer || (bytes_bound && closer->bytes() > budget)) break;  // no room for closer paths
        if (closer->stats.p999 > 0.98 * best.stats.p999) break;
        best = std::move(*closer);
    }
    if (best.stats.p999 > options.max_error) return refuse_error(options, best);
    return best;
}

Result<Candidate> within_bounds(const HeightMap& map, const ConvertOptions& options, std::size_t budget,
                                const Progress& progress, StageClock& clock) {
    const bool bytes_bound = options.max_texture_bytes > 0;
    auto start = start_within(map, options, budget, progress, clock);
    if (!start) return start.error();
    const Candidate& first = start->candidate;
    if (bytes_bound && first.bytes() > budget) return refuse_bytes(map, options, first.bytes(), progress, clock);
    if (options.max_error <= 0.0 || first.stats.p999 <= options.max_error) return std::move(start->candidate);
    return closer_within(start->source, options, std::move(start->candidate), progress, clock);
}

// The candidate of a coarser map, with the figures that it reaches against the map itself.
Result<Candidate> of_finer_map(Candidate candidate, const HeightMap& map, int halvings, const ConvertOptions& options,
                               StageClock& clock) {
    const int times = 1 << halvings;
    candidate.stats.halvings = halvings;
    candidate.stats.path_length_texels *= times;
    candidate.traced.tolerance *= times;
    return measure_candidate(std::move(candidate), map, options, clock);
}

// As many texels as show all of the map are traced.
Result<Candidate> best_candidate(const HeightMap& map, const ConvertOptions& options, const Progress& progress,
                                 StageClock& clock) {
    const bool bytes_bound = options.max_texture_bytes > 0;
    const std::size_t budget = bytes_bound ? options.max_texture_bytes : default_budget(map.image.texels.size());
    if (options.max_error > 0.0) return within_bounds(map, options, budget, progress, clock);
    if (!clock.begin("coarsen")) return stopped();
    CoarsenOptions coarsen = options.coarsen;
    coarsen.threads = options.threads;
    const Coarsened coarse = coarsen_map(map, coarsen);
    if (!coarse.map) return within_bounds(map, options, budget, progress, clock);
    ConvertOptions coarse_options = options;
    coarse_options.vectorize.tolerance /= 1 << coarse.halvings;
    auto candidate = within_bounds(*coarse.map, coarse_options, budget, progress, clock);
    if (candidate) candidate = of_finer_map(std::move(*candidate), map, coarse.halvings, options, clock);
    return candidate;
}

// Without the paths that could not be joined: the pattern of what is stored.
Pattern stored_pattern(Pattern pattern, const std::vector<std::uint32_t>& paths) {
    std::vector<Path> kept;
    for (const std::uint32_t path : paths) kept.push_back(std::move(pattern.paths[path]));
    pattern.paths = std::move(kept);
    return pattern;
}

void count_kinds(const Pattern& pattern, ConvertStats& stats) {
    int* const counts[] = {&stats.grooves, &stats.ridges, &stats.steps};  // as PathKind counts them
    for (const Path& path : pattern.paths) ++*counts[static_cast<std::size_t>(path_kind(pattern, path))];
}

// The certificate by class. Drawn again only where both classes are there.
Status share_out(const HeightMap& map, const Candidate& candidate, int threads, ConvertStats& stats) {
    const bool lines = stats.grooves + stats.ridges > 0;
    double steps = lines ? 0.0 : stats.explained;
    if (lines && stats.steps > 0) {
        // Fewer samples take a third of the time and move the share by less than 0.0005.
        const auto heights = reconstruct(map, candidate.packed.textures, candidate.packed.detail,
                                         {.steps_only = true, .samples = samples_for(stats, 2), .threads = threads});
        if (!heights) return heights.error();
        steps = compare_heights(*heights, map.image, stats.repeat ? Wrap::repeat : Wrap::clamp, threads).explained;
    }
    stats.shares = {steps, stats.explained - steps, 1.0 - stats.explained};
    return Done{};
}

// What the stored paths leave, as a normal map.
Result<Residual> residual_of(const HeightMap& map, const FoundPattern& found, const ConvertOptions& options) {
    // Fewer samples than the figures of heights take: half the time, and angles within 0.02 degrees.
    const auto heights = reconstruct(map, found.textures, found.detail, {.samples = samples_for(found.stats, 3), .threads = options.threads});
    if (!heights) return heights.error();
    ResidualOptions residual = options.residual;
    residual.threads = options.threads;
    const bool chosen = residual.most_texels != ResidualOptions{}.most_texels;
    if (!chosen && found.stats.explained >= kWellExplained) residual.most_texels = map.image.texels.size() / 64;
    if (found.pattern.paths.empty()) residual.worthwhile = 0.0;
    const Wrap wrap = found.stats.repeat ? Wrap::repeat : Wrap::clamp;
    return bake_residual(map.image, *heights, found.pattern.size, found.pattern.depth, wrap, residual);
}

}  // namespace

Result<FoundPattern> find_pattern(const HeightMap& map, const ConvertOptions& options, const Progress& progress) {
    if (!(options.max_error >= 0.0 && options.max_error <= 1.0))
        return Error{ErrorCode::invalid_argument,
                     "max_error: " + std::to_string(options.max_error) + " of the range; 0 to 1 would work"};
    std::vector<std::pair<std::string, double>> seconds;
    StageClock clock(progress, seconds);
    auto candidate = best_candidate(map, options, progress, clock);
    if (!candidate) return candidate.error();

    FoundPattern found;
    found.stats = candidate->stats;
    found.stats.noise = candidate->traced.noise;
    found.stats.tolerance = candidate->traced.tolerance;
    found.pattern = stored_pattern(std::move(candidate->traced.pattern), candidate->packed.paths);
    count_kinds(found.pattern, found.stats);
    if (!clock.begin("measure")) return stopped();
    if (const Status shared = share_out(map, *candidate, options.threads, found.stats); !shared) return shared.error();
    clock.end();
    found.stats.seconds = std::move(seconds);
    found.textures = std::move(candidate->packed.textures);
    found.detail = std::move(candidate->packed.detail);
    return found;
}

Result<Converted> convert_map(const HeightMap& map, const Model& model, const ConvertOptions& options,
                              const Progress& progress) {
    auto found = find_pattern(map, options, progress);
    if (!found) return found.error();
    Converted converted{std::move(*found), {}, {}};
    StageClock clock(progress, converted.stats.seconds);
    if (!clock.begin("bake")) return stopped();
    auto residual = residual_of(map, converted, options);
    if (!residual) return residual.error();
    converted.residual = std::move(*residual);
    const Pattern& pattern = converted.pattern;
    Fallback fallback = bake_fallback(map.image, pattern.size, pattern.depth, pattern.wrap, options.fallback);
    // Both show the whole map then; one is stored.
    if (pattern.paths.empty() && converted.residual.picture.width > 0) fallback.normal = {};

    if (!clock.begin("write")) return stopped();
    auto bytes = write_glb(model, converted.textures, converted.detail, fallback, options.attach, converted.residual);
    if (!bytes) return bytes.error();
    clock.end();
    converted.glb = std::move(*bytes);
    converted.stats.file_bytes = converted.glb.size();
    return converted;
}

}  // namespace burin
