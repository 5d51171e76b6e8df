#include <burin/author.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>

#include <burin/rasterize.hpp>

namespace burin {
namespace {

// Runs a stage and adds what it took to the list.
class StageTimes {
  public:
    explicit StageTimes(AuthorStats& stats) : stats_(stats) {}
    template <typename Stage>
    auto run(const char* name, const Stage& stage) {
        const auto begun = std::chrono::steady_clock::now();
        auto result = stage();
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun;
        stats_.seconds.emplace_back(name, spent.count());
        return result;
    }

  private:
    AuthorStats& stats_;
};

void count(const Pattern& pattern, const ResolvedPattern& resolved, AuthorStats& stats) {
    stats.paths = static_cast<int>(pattern.paths.size());
    int* const kinds[] = {&stats.grooves, &stats.ridges, &stats.steps};  // as PathKind counts them
    for (const Path& path : pattern.paths) ++*kinds[static_cast<std::size_t>(path_kind(pattern, path))];
    for (const ResolvedElement& element : resolved.elements)
        (element.element.kind == ElementKind::line ? stats.lines : stats.quadratics) += 1;
    stats.profiles = static_cast<int>(resolved.profiles.size());
    stats.resolved = resolved.stats;
}

Fallback fallback_of(const ResolvedPattern& resolved, const AuthorOptions& options) {
    // Texels are as square as whole numbers allow, and no side is so short that slopes vanish in it.
    const int width = options.fallback_heights;
    const int height = std::clamp(static_cast<int>(std::lround(width * resolved.size.y / resolved.size.x)), 16, 4096);
    const Image heights = rasterize_height(resolved, width, height, {.samples = 2, .threads = options.threads});
    return bake_fallback(heights, resolved.size, resolved.depth, resolved.wrap, options.fallback);
}

}  // namespace

Result<AuthoredTextures> author_textures(const Pattern& pattern, const AuthorOptions& options) {
    AuthoredTextures out;
    StageTimes times(out.stats);
    const auto resolved = times.run("resolve", [&] { return resolve_pattern(pattern, options.resolve); });
    if (!resolved) return resolved.error();
    count(pattern, *resolved, out.stats);
    // The fallback asks for the resolved pattern alone: it is baked beside the stages to come, which leave cores idle.
    AuthorStats beside;
    std::future<Fallback> baking =
        std::async(std::launch::async, [&] { return StageTimes(beside).run("bake", [&] { return fallback_of(*resolved, options); }); });
    GridOptions grid_options = options.grid;
    grid_options.threads = options.threads;
    const auto grid = times.run("grid", [&] { return build_grid(*resolved, grid_options); });
    if (!grid) return grid.error();
    auto textures = times.run("pack", [&] { return pack_textures(*resolved, *grid, options.pack); });
    if (!textures) return textures.error();
    out.detail = describe_pattern(*resolved, *textures);
    out.detail.tex_coord = options.attach.tex_coord;
    out.textures = std::move(*textures);
    out.stats.cells = out.textures.grid_width * out.textures.grid_height;
    out.stats.grid_bytes = out.textures.grid.size() * sizeof(std::uint32_t);
    out.stats.data_bytes = out.textures.data.size() * sizeof(std::uint32_t);
    out.fallback = baking.get();
    out.stats.seconds.insert(out.stats.seconds.end(), beside.seconds.begin(), beside.seconds.end());
    return out;
}

Result<Authored> author_asset(const Pattern& pattern, const Model& model, const AuthorOptions& options) {
    if (const auto target = find_material(model, options.attach); !target) return target.error();
    auto textures = author_textures(pattern, options);
    if (!textures) return textures.error();
    Authored out{std::move(*textures), {}};
    StageTimes times(out.stats);
    auto glb = times.run("write", [&] { return write_glb(model, out.textures, out.detail, out.fallback, options.attach); });
    if (!glb) return glb.error();
    out.glb = std::move(*glb);
    out.stats.file_bytes = out.glb.size();
    return out;
}

}  // namespace burin
