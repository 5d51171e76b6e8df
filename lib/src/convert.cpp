#include <burin/convert.hpp>

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <stdexcept>

#include <burin/compare.hpp>
#include <burin/rasterize.hpp>

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

void count_elements(const ResolvedPattern& pattern, double texels_per_metre, ConvertStats& stats) {
    std::vector<std::uint32_t> paths;
    for (const ResolvedElement& element : pattern.elements) {
        const bool line = element.element.kind == ElementKind::line;
        (line ? stats.lines : stats.quadratics) += 1;
        stats.path_length_texels += curve::arc_length(element.element) * texels_per_metre;
        paths.push_back(element.path);
    }
    std::sort(paths.begin(), paths.end());
    stats.paths = static_cast<int>(std::unique(paths.begin(), paths.end()) - paths.begin());
    stats.profiles = static_cast<int>(pattern.profiles.size());
}

// Maps of lines and plateaus come above 0.5, rock and terrain stay below 0.2.
constexpr double kPathLikeShare = 0.35;
constexpr double kAccidentShare = 0.1;

// The figures of the textures as they are stored.
Status measure(const HeightMap& map, const PackedTextures& textures, const PathDetail& detail, int threads,
               ConvertStats& stats) {
    const auto unpacked = unpack_textures(textures, detail);
    // What burin packed breaks the format: a bug, whatever the map.
    if (!unpacked && unpacked.error().code == ErrorCode::invalid_input)
        throw std::logic_error("the packed pattern breaks the format: " + unpacked.error().message);
    if (!unpacked) return unpacked.error();
    RasterizeOptions options;
    options.threads = threads;
    options.level_tolerance = 4e-5;  // levels and heights come from 16-bit codes
    const Image heights = rasterize_height(unpacked->pattern, map.image.width, map.image.height, options);
    const Comparison figures = compare_heights(heights, map.image, detail.repeat ? Wrap::repeat : Wrap::clamp);
    stats.explained = figures.explained;
    stats.path_like = figures.explained >= kPathLikeShare;
    stats.rms = figures.rms;
    stats.p999 = figures.p999;
    stats.max = figures.max;
    return Done{};
}

struct Packed {
    PackedTextures textures;
    PathDetail detail;
};

std::size_t texture_bytes(const PackedTextures& textures) {
    return (textures.grid.size() + textures.data.size()) * sizeof(std::uint32_t);
}

// Resolve, grid, pack.
Result<Packed> pack_pattern(const Pattern& pattern, const HeightMap& map, const ConvertOptions& options,
                            std::size_t budget, StageClock& clock, ConvertStats& stats) {
    if (!clock.begin("resolve")) return stopped();
    const auto resolved = resolve_pattern(pattern, options.resolve);
    if (!resolved) return resolved.error();
    stats.paths = stats.lines = stats.quadratics = 0;
    stats.path_length_texels = 0.0;
    count_elements(*resolved, map.image.width / resolved->size.x, stats);
    stats.dropped_paths = resolved->stats.dropped_paths;
    stats.repeat = resolved->wrap == Wrap::repeat;

    if (!clock.begin("grid")) return stopped();
    GridOptions grid_options = options.grid;
    grid_options.threads = options.threads;
    if (grid_options.max_bytes == 0) grid_options.max_bytes = budget / 2;
    const auto grid = build_grid(*resolved, grid_options);
    if (!grid) return grid.error();
    stats.cells = grid->cols * grid->rows;

    if (!clock.begin("pack")) return stopped();
    auto textures = pack_textures(*resolved, *grid, options.pack);
    if (!textures) return textures.error();
    stats.grid_bytes = textures->grid.size() * sizeof(std::uint32_t);
    stats.data_bytes = textures->data.size() * sizeof(std::uint32_t);
    PathDetail detail = describe_pattern(*resolved, *textures);
    detail.tex_coord = options.attach.tex_coord;
    return Packed{std::move(*textures), std::move(detail)};
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
};

Result<Candidate> pack_and_measure(Vectorized traced, const HeightMap& map, const ConvertOptions& options,
                                   std::size_t budget, StageClock& clock) {
    Candidate candidate;
    auto packed = pack_pattern(traced.pattern, map, options, budget, clock, candidate.stats);
    if (!packed) return packed.error();
    if (!clock.begin("measure")) return stopped();
    const Status measured = measure(map, packed->textures, packed->detail, options.threads, candidate.stats);
    if (!measured) return measured.error();
    candidate.packed = std::move(*packed);
    candidate.traced = std::move(traced);
    return candidate;
}

// Vectorizes with ever fewer elements until the textures keep to the budget. `detail`: the map, or what of it to trace.
Result<Candidate> trace_within(const HeightMap& detail, const HeightMap& map, const ConvertOptions& options, std::size_t budget,
                               const Progress& progress, StageClock& clock) {
    VectorizeOptions vectorize = options.vectorize;
    vectorize.threads = options.threads;
    if (!clock.begin("vectorize")) return stopped();
    const auto traced = trace_map(detail, vectorize, progress);
    if (!traced) return traced.error();
    for (int attempt = 0;; ++attempt) {
        if (!clock.begin("vectorize")) return stopped();
        auto fitted = fit_traced_map(*traced, detail, vectorize, progress);
        if (!fitted) return fitted.error();
        auto candidate = pack_and_measure(std::move(*fitted), map, options, budget, clock);
        if (!candidate) return candidate.error();
        const std::size_t bytes = texture_bytes(candidate->packed.textures);
        const int elements = candidate->stats.lines + candidate->stats.quadratics;
        if (bytes <= budget || attempt == 3 || elements <= 16) return candidate;
        const int most = vectorize.most_elements > 0 ? std::min(vectorize.most_elements, elements) : elements;
        vectorize.most_elements = std::max(16, static_cast<int>(most * 0.85 * static_cast<double>(budget) / bytes));
    }
}

// The map as it is, or without its soft ground where that explains more: whether a ramp is ground or the side of a wide
// bevel shows when its paths are drawn. `map` becomes what was traced.
Result<Candidate> trace_best(HeightMap& map, const ConvertOptions& options, std::size_t budget,
                             const Progress& progress, StageClock& clock) {
    constexpr double kLeastDeviation = 0.004, kMustGain = 0.002;
    auto candidate = trace_within(map, map, options, budget, progress, clock);
    if (!candidate) return candidate;
    if (!clock.begin("vectorize")) return stopped();
    auto separated = separate_ground(map, options.vectorize);
    if (!separated) return separated.error();
    if (separated->deviation < kLeastDeviation) return candidate;
    auto other = trace_within(separated->detail, map, options, budget, progress, clock);
    if (!other) return other;
    if (other->stats.explained < candidate->stats.explained + kMustGain) return candidate;
    map = std::move(separated->detail);
    return other;
}

// A step of the refinement looks at every texel within reach of every element: wide profiles on long paths would take
// minutes and gain little, since a soft wall shows its place well. Whether it runs depends on the pattern alone, not on a
// clock, so that the bytes do not depend on the machine.
bool can_afford_refinement(const Pattern& pattern, const Image& map) {
    constexpr double kMostTexels = 3e5;  // element lengths times profile widths: up to 6 seconds on two cores
    const double texels = map.width / pattern.size.x;
    double work = 0.0;
    for (const Path& path : pattern.paths) {
        const std::vector<ProfilePoint>& points = pattern.profiles[path.profile].points;
        const double reach = (points.back().b - points.front().b) * texels + 2.0;
        for (const Element& element : path.elements) work += curve::arc_length(element) * texels * reach;
    }
    return work <= kMostTexels;
}

Unrefined reason_not_to_refine(const Candidate& candidate, const HeightMap& map, const ConvertOptions& options) {
    if (!options.refine) return Unrefined::not_asked;
    if (candidate.traced.pattern.paths.empty()) return Unrefined::no_paths;
    if (!candidate.stats.path_like) return Unrefined::not_path_like;
    return can_afford_refinement(candidate.traced.pattern, map.image) ? Unrefined::no : Unrefined::too_much_work;
}

// Least squares against the map. What it makes worse, because the traced structure is not that of the map, is not kept.
// `traced`: what the candidate was traced in, see trace_best.
Result<Candidate> refine_candidate(Candidate candidate, const HeightMap& traced, const HeightMap& map, const ConvertOptions& options,
                                   std::size_t budget, StageClock& clock) {
    candidate.stats.unrefined = reason_not_to_refine(candidate, map, options);
    if (candidate.stats.unrefined != Unrefined::no) return candidate;
    if (!clock.begin("refine")) return stopped();
    candidate.stats.unrefined = Unrefined::no_gain;
    RefineOptions refinement = options.refinement;
    refinement.threads = options.threads;
    Vectorized refined = candidate.traced;
    if (!refine_pattern(refined.pattern, traced.image, refinement)) return candidate;
    auto better = pack_and_measure(std::move(refined), map, options, budget, clock);
    if (!better || better->stats.explained < candidate.stats.explained) return candidate;
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

}  // namespace

Result<Converted> convert_map(const HeightMap& map, const Model& model, const ConvertOptions& options,
                              const Progress& progress) {
    Converted converted;
    std::vector<std::pair<std::string, double>> seconds;
    StageClock clock(progress, seconds);
    const std::size_t budget = options.max_texture_bytes > 0 ? options.max_texture_bytes
                                                             : default_budget(map.image.texels.size());
    HeightMap traced = map;
    auto candidate = trace_best(traced, options, budget, progress, clock);
    const double traced_explained = candidate ? candidate->stats.explained : 0.0;
    if (candidate) candidate = without_accidents(std::move(*candidate), map, options, budget, clock);
    if (candidate) candidate = refine_candidate(std::move(*candidate), traced, map, options, budget, clock);
    if (!candidate) return candidate.error();

    if (!clock.begin("bake")) return stopped();
    const Pattern& pattern = candidate->traced.pattern;
    const Fallback fallback = bake_fallback(map.image, pattern.size, pattern.depth, pattern.wrap, options.fallback);

    if (!clock.begin("write")) return stopped();
    auto bytes = write_glb(model, candidate->packed.textures, candidate->packed.detail, fallback, options.attach);
    if (!bytes) return bytes.error();
    clock.end();
    converted.glb = std::move(*bytes);
    converted.stats = candidate->stats;
    converted.stats.traced_explained = traced_explained;
    converted.stats.noise = candidate->traced.noise;
    converted.stats.tolerance = candidate->traced.tolerance;
    converted.stats.seconds = std::move(seconds);
    converted.stats.file_bytes = converted.glb.size();
    return converted;
}

}  // namespace burin
