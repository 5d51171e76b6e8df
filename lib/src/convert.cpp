#include <burin/convert.hpp>

#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>

#include <burin/compare.hpp>
#include <burin/fit.hpp>
#include <burin/rasterize.hpp>

namespace burin {
namespace {

constexpr int kLengthSteps = 16;  // chords per quadratic: its length within 1 in 1000

// Tells the user which stage runs and keeps the time of each.
class StageClock {
  public:
    StageClock(const Progress& progress, ConvertStats& stats) : progress_(progress), stats_(stats) {}

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
        stats_.seconds.emplace_back(stage_, spent.count());
        if (progress_) progress_(stage_, 1.0);
        stage_ = nullptr;
    }

  private:
    const Progress& progress_;
    ConvertStats& stats_;
    const char* stage_ = nullptr;
    std::chrono::steady_clock::time_point begun_;
};

Error stopped() { return {ErrorCode::invalid_argument, "stopped on request"}; }

double length_of(const Element& element) {
    if (element.kind == ElementKind::line) return length(element.p2 - element.p0);
    double sum = 0.0;
    for (int i = 0; i < kLengthSteps; ++i)
        sum += length(point_at(element, (i + 1.0) / kLengthSteps) - point_at(element, double(i) / kLengthSteps));
    return sum;
}

void count_elements(const ResolvedPattern& pattern, double texels_per_metre, ConvertStats& stats) {
    std::vector<std::uint32_t> paths;
    for (const ResolvedElement& element : pattern.elements) {
        const bool line = element.element.kind == ElementKind::line;
        (line ? stats.lines : stats.quadratics) += 1;
        stats.path_length_texels += length_of(element.element) * texels_per_metre;
        paths.push_back(element.path);
    }
    std::sort(paths.begin(), paths.end());
    stats.paths = static_cast<int>(std::unique(paths.begin(), paths.end()) - paths.begin());
    stats.profiles = static_cast<int>(pattern.profiles.size());
}

// Maps of lines and plateaus come above 0.5, rock and terrain stay below 0.2.
constexpr double kPathLikeShare = 0.35;

// The figures of the textures as they are stored.
Status measure(const HeightMap& map, const PackedTextures& textures, const PathDetail& detail, int threads,
               ConvertStats& stats) {
    const auto unpacked = unpack_textures(textures, detail);
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

// Vectorize, and refine where the refinement can follow the pattern.
Result<Vectorized> find_paths(const HeightMap& map, const ConvertOptions& options, const Progress& progress,
                              StageClock& clock, ConvertStats& stats) {
    if (!clock.begin("vectorize")) return stopped();
    VectorizeOptions vectorize = options.vectorize;
    vectorize.threads = options.threads;
    auto traced = vectorize_map(map, vectorize, progress);
    if (!traced) return traced.error();
    stats.noise = traced->noise;
    stats.tolerance = traced->tolerance;
    if (!options.refine || traced->pattern.paths.empty()) return traced;
    if (!clock.begin("refine")) return stopped();
    RefineOptions refinement = options.refinement;
    refinement.threads = options.threads;
    // A pattern that resolves only leniently is kept as it was traced; `refined` says so.
    stats.refined = refine_pattern(traced->pattern, map.image, refinement).ok();
    return traced;
}

struct Packed {
    PackedTextures textures;
    PathDetail detail;
};

// Resolve, grid, pack.
Result<Packed> pack_pattern(const Pattern& pattern, const HeightMap& map, const ConvertOptions& options,
                            StageClock& clock, ConvertStats& stats) {
    if (!clock.begin("resolve")) return stopped();
    const auto resolved = resolve_pattern(pattern, options.resolve);
    if (!resolved) return resolved.error();
    count_elements(*resolved, map.image.width / resolved->size.x, stats);
    stats.dropped_paths = resolved->stats.dropped_paths;
    stats.repeat = resolved->wrap == Wrap::repeat;

    if (!clock.begin("grid")) return stopped();
    GridOptions grid_options = options.grid;
    grid_options.threads = options.threads;
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

}  // namespace

Result<Converted> convert_map(const HeightMap& map, const Model& model, const ConvertOptions& options,
                              const Progress& progress) {
    Converted converted;
    ConvertStats& stats = converted.stats;
    StageClock clock(progress, stats);
    const auto traced = find_paths(map, options, progress, clock, stats);
    if (!traced) return traced.error();
    const auto packed = pack_pattern(traced->pattern, map, options, clock, stats);
    if (!packed) return packed.error();

    if (!clock.begin("measure")) return stopped();
    if (const Status measured = measure(map, packed->textures, packed->detail, options.threads, stats); !measured)
        return measured.error();

    if (!clock.begin("bake")) return stopped();
    const Pattern& pattern = traced->pattern;
    const Fallback fallback = bake_fallback(map.image, pattern.size, pattern.depth, pattern.wrap, options.fallback);

    if (!clock.begin("write")) return stopped();
    auto bytes = write_glb(model, packed->textures, packed->detail, fallback, options.attach);
    if (!bytes) return bytes.error();
    clock.end();
    converted.glb = std::move(*bytes);
    stats.file_bytes = converted.glb.size();
    return converted;
}

}  // namespace burin
