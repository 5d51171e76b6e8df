// From a pattern to a candidate: resolved, gridded, packed, measured.
#include "convert_internal.hpp"

#include <algorithm>
#include <stdexcept>

#include <burin/compare.hpp>

#include "resolve_curve.hpp"

namespace burin::converting {

Error stopped() { return {ErrorCode::invalid_argument, "stopped on request"}; }

Result<Image> reconstruct(const Image& map, const PackedTextures& textures, const PathDetail& detail,
                          const ReconstructOptions& options) {
    auto heights = reconstruct_heights(textures, detail, map.width, map.height, options);
    // What burin packed breaks the format: a bug, whatever the map.
    if (!heights && heights.error().code == ErrorCode::invalid_input)
        throw std::logic_error("the packed pattern breaks the format: " + heights.error().message);
    return heights;
}

int samples_for(const ConvertStats& stats, int usual) { return std::max(std::min(usual, 2), usual >> stats.halvings); }

std::size_t bytes_of(const PackedTextures& textures) {
    return (textures.grid.size() + textures.data.size()) * sizeof(std::uint32_t);
}

std::size_t element_bytes(const PackedTextures& textures) {
    return textures.data.size() * sizeof(std::uint32_t) - static_cast<std::size_t>(textures.sections.list_texels) * 16;
}

namespace {

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

Status measure(const HeightMap& map, int threads, Candidate& candidate) {
    ConvertStats& stats = candidate.stats;
    const PathDetail& detail = candidate.packed.detail;
    candidate.heights = {};
    auto heights = reconstruct(map.image, candidate.packed.textures, detail,
                               {.samples = samples_for(stats, ReconstructOptions{}.samples), .threads = threads});
    if (!heights) return heights.error();
    candidate.heights = std::move(*heights);
    const Comparison figures =
        compare_heights(candidate.heights, map.image, detail.repeat ? Wrap::repeat : Wrap::clamp, threads);
    stats.explained = figures.explained;
    stats.path_like = figures.explained >= kPathLikeShare;
    stats.rms = figures.rms;
    stats.p999 = figures.p999;
    stats.p999_without_smooth = figures.p999_without_smooth;
    stats.max = figures.max;
    return Done{};
}

Result<PackedTextures> grid_and_pack(const ResolvedPattern& pattern, const GridOptions& options, const PackOptions& pack,
                                     StageClock& clock) {
    if (!clock.begin("grid")) return stopped();
    const auto grid = build_grid(pattern, options);
    if (!grid) return grid.error();
    if (!clock.begin("pack")) return stopped();
    return pack_textures(pattern, *grid, pack);
}

// What the budget leaves to cells and lists; one byte at least, since none is no limit.
std::size_t room_beside(const PackedTextures& textures, std::size_t budget) {
    return std::max<std::size_t>(1, budget - std::min(budget, element_bytes(textures)));
}

// Larger cells make rays slower, but fewer elements lose something: cells and lists may be this small a share of the budget.
constexpr std::size_t kLeastGrid = 5;

}  // namespace

int room_for_elements(const PackedTextures& textures, std::size_t budget) {
    constexpr std::size_t kQuadraticBytes = 38;
    const std::size_t room = room_beside(textures, budget);
    return static_cast<int>((room - std::min(room, budget / kLeastGrid)) / kQuadraticBytes);
}

namespace {

// What is nearly as small as a clean map should be becomes so by cells up to twice as large: a ray looks at a few more
// elements in each.
PackedTextures smaller_grid(PackedTextures textures, const ResolvedPattern& pattern, std::size_t texels, GridOptions options,
                            const PackOptions& pack, StageClock& clock) {
    constexpr std::size_t kSmall = 40, kMostTimes = 2;  // a share of the map's 8-bit size
    const std::size_t small = texels / kSmall, beside = bytes_of(textures) - element_bytes(textures);
    options.max_bytes = room_beside(textures, small);
    if (bytes_of(textures) <= small || kMostTimes * options.max_bytes < beside) return textures;
    auto larger = grid_and_pack(pattern, options, pack, clock);
    return larger && bytes_of(*larger) <= small ? std::move(*larger) : textures;
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
    if (grid.max_bytes == 0) grid.max_bytes = std::max<std::size_t>(1, budget / 2);
    auto textures = grid_and_pack(*resolved, grid, options.pack, clock);
    if (textures && !chosen && bytes_of(*textures) > budget) {
        grid.max_bytes = std::max(budget / kLeastGrid, room_beside(*textures, budget));
        // Too large a cell lists too many elements: then it is elements that go.
        if (auto larger = grid_and_pack(*resolved, grid, options.pack, clock)) textures = std::move(larger);
    }
    if (!textures) return textures.error();
    if (!chosen && options.max_texture_bytes == 0)
        textures = smaller_grid(std::move(*textures), *resolved, map.image.texels.size(), grid, options.pack, clock);
    stats.cells = textures->grid_width * textures->grid_height;
    stats.grid_bytes = textures->grid.size() * sizeof(std::uint32_t);
    stats.data_bytes = textures->data.size() * sizeof(std::uint32_t);
    PathDetail detail = describe_pattern(*resolved, *textures);
    detail.tex_coord = options.attach.tex_coord;
    return Packed{std::move(*textures), std::move(detail), std::move(paths)};
}

}  // namespace

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
    const Status measured = measure(map, options.threads, candidate);
    if (!measured) return measured.error();
    return candidate;
}

Result<Candidate> pack_and_measure(Vectorized traced, const HeightMap& map, const ConvertOptions& options,
                                   std::size_t budget, StageClock& clock) {
    auto candidate = pack_candidate(std::move(traced), map, options, budget, clock);
    if (!candidate) return candidate;
    return measure_candidate(std::move(*candidate), map, options, clock);
}

}  // namespace burin::converting
