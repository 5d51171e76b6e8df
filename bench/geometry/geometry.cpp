// bench_geometry: the reference renderer beside ray-traced triangles, as [2008] table 1 has it, at equal error.
//
//     bench_geometry [time|memory] [--quick] [--scene NAME] [--cache FOLDER] [--pictures FOLDER]
//
// For each flat scene and view: the reference's error against the truth and its time; then Embree on the exact mesh, with more and more samples
// per pixel, until it is as near: uniform, and adaptive. Times are processor time of all threads, the least of three; the mesh and its BVH are
// made beforehand. Memory: the smallest displaced grid that comes within a decibel of the exact mesh.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <optional>
#include <string>

#include <burin/image_io.hpp>
#include <burin/grid.hpp>
#include <reference/render.hpp>
#include <reference/gather.hpp>
#include <reference/surface.hpp>
#include <runtime/image_error.hpp>
#include <scenes/scenes.hpp>

#include "traced_mesh.hpp"

namespace burin::bench {
namespace {

struct Settings {
    bool quick = false, time = true, memory = true;
    std::string scene, cache, pictures;
};

struct Timed {
    RgbaImage picture;
    double seconds = 1e9;
};

template <typename Draw>
Timed time_of(const Draw& draw) {
    Timed timed;
    for (int run = 0; run < 3; ++run) {
        const std::clock_t start = std::clock();
        timed.picture = draw();
        timed.seconds = std::min(timed.seconds, double(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return timed;
}

// The least number of samples that comes as near to the truth, or the most that was tried.
struct Reached {
    int samples = 0;
    double psnr = 0.0, seconds = 0.0;
    bool reached = false;
};

Reached reach(const TracedMesh& mesh, const Subject& subject, const PlaneView& view, const TruthPicture& truth, double psnr, bool adaptive) {
    Reached out;
    for (const int samples : {1, 4, 9, 16, 25, 36, 64, 100, 144, 256, 400, 625, 1024}) {
        if (adaptive && samples <= 4) continue;
        const TraceOptions options{samples, adaptive};
        const double found = compare_pictures(draw_traced(mesh, subject, view, options), truth).psnr;
        if (found <= out.psnr && samples < 1024) continue;
        out = {samples, found, 0.0, found >= psnr};
        if (out.reached) break;
    }
    out.seconds = time_of([&] { return draw_traced(mesh, subject, view, {out.samples, adaptive}); }).seconds;
    return out;
}

struct Ratios {
    std::vector<double> uniform, adaptive, steep;
};

std::string text_of(const Reached& r, double ratio) {
    char text[80];
    std::snprintf(text, sizeof text, "%d | %.1f | %s%.1f", r.samples, r.psnr, r.reached ? "" : "> ", ratio);
    return text;
}

void measure_view(const Settings& settings, const Subject& subject, const mesh::TriangleMesh& tile, const PlaneView& view, Ratios& ratios) {
    const TruthPicture truth = draw_truth(subject, view, settings.cache);
    if (std::count(truth.feature.begin(), truth.feature.end(), 1) == 0) return;
    const Extent extent = extent_of(view, subject.prepared.resolved);
    const Asset asset = asset_of(subject, extent);
    reference::ReferenceOptions options{options_of(view, subject.prepared.resolved.size)};
    const Timed ours = time_of([&] { return reference::render_reference(asset, options)->image(); });
    const double psnr = compare_pictures(ours.picture, truth).psnr;
    const TracedMesh traced(tile, subject.prepared.resolved, extent);
    const Reached uniform = reach(traced, subject, view, truth, psnr, false), adaptive = reach(traced, subject, view, truth, psnr, true);
    const double pixels = double(view.width) * view.height, by = uniform.seconds / ours.seconds, by_adaptive = adaptive.seconds / ours.seconds;
    std::printf("| %s | %s | %.1f | %.2f | %s | %s |\n", subject.name.c_str(), view.name.c_str(), psnr, ours.seconds / pixels * 1e6,
                text_of(uniform, by).c_str(), text_of(adaptive, by_adaptive).c_str());
    std::fflush(stdout);
    ratios.uniform.push_back(by);
    ratios.adaptive.push_back(by_adaptive);
    if (view.name == "80 degrees") ratios.steep.push_back(std::min(by, by_adaptive));
    if (settings.pictures.empty()) return;
    const std::string path = settings.pictures + "/" + subject.name + "_" + view.name + "_traced.png";
    if (Status written = write_png(path, show_difference(draw_traced(traced, subject, view, {256, false}), truth)); !written)
        std::fprintf(stderr, "%s\n", written.error().message.c_str());
}

// By the truth, which is asked of the cell's elements alone.
double height_at(const reference::GroovedSurface& surface, Vec2 p) {
    const CellGrid& grid = surface.grid();
    const auto place = [](double at, double side, int count) { return std::size_t(std::clamp(int(at / side * count), 0, count - 1)); };
    const std::size_t cell = place(p.y, surface.pattern().size.y, grid.rows) * std::size_t(grid.cols) + place(p.x, surface.pattern().size.x, grid.cols);
    const std::span<const std::uint32_t> near(grid.refs.data() + grid.first_ref[cell], grid.first_ref[cell + 1] - grid.first_ref[cell]);
    return surface.truth().surface_at(p, near, reference::ground_near(surface, p)).height;
}

// Heights of the truth as a grid of triangles: what a displacement map is when it is traced. Around a map that ends a last row stands upright on
// its border.
mesh::TriangleMesh displaced_grid(const reference::GroovedSurface& surface, int side) {
    const ResolvedPattern& pattern = surface.pattern();
    const int ring = pattern.wrap == Wrap::clamp ? 1 : 0, corners = side + 1 + 2 * ring;
    mesh::TriangleMesh grid;
    grid.positions.resize(std::size_t(corners) * std::size_t(corners));
    testing::in_parallel(std::size_t(corners), [&](std::size_t row) {
        for (int column = 0; column < corners; ++column) {
            const int i = std::clamp(column - ring, 0, side), j = std::clamp(int(row) - ring, 0, side);
            const bool inside = i == column - ring && j == int(row) - ring;
            const Vec2 p{pattern.size.x * i / side, pattern.size.y * j / side};
            grid.positions[row * std::size_t(corners) + std::size_t(column)] = {p.x, p.y, inside ? height_at(surface, p) : pattern.outer_level};
        }
    });
    for (int j = 0; j + 1 < corners; ++j)
        for (int i = 0; i + 1 < corners; ++i) {
            const auto a = std::uint32_t(j * corners + i), b = a + 1, c = a + std::uint32_t(corners), d = c + 1;
            grid.triangles.push_back({a, b, d});
            grid.triangles.push_back({a, d, c});
            grid.origins.insert(grid.origins.end(), 2, {kGround, kGround});
        }
    return grid;
}

// Bytes of the smallest grid that comes within a decibel of the exact mesh, seen from the middle distance.
void measure_memory(const Settings& settings, const Subject& subject, const mesh::TriangleMesh& tile, const PlaneView& view, const reference::GroovedSurface& surface) {
    const ResolvedPattern& pattern = subject.prepared.resolved;
    const std::size_t own = surface.bytes();
    const TruthPicture truth = draw_truth(subject, view, settings.cache);
    const Extent extent = extent_of(view, pattern);
    const TracedMesh exact(tile, pattern, extent);
    const TraceOptions many{256, false};
    const double psnr = compare_pictures(draw_traced(exact, subject, view, many), truth).psnr;
    double found = 0.0;
    std::size_t bytes = 0;
    int side = 128;
    for (; side <= (settings.quick ? 1024 : 4096); side *= 2) {
        const TracedMesh grid(displaced_grid(surface, side), pattern, extent);
        bytes = grid.bytes();
        found = compare_pictures(draw_traced(grid, subject, view, many), truth).psnr;
        if (found >= psnr - 1.0) break;
    }
    const bool reached = found >= psnr - 1.0;
    std::printf("| %s | %.1f | %.1f | %zu | %.1f | %.0f | %s%d | %.1f | %.1f | %s%.0f |\n", subject.name.c_str(), double(own) / 1024.0, psnr, exact.triangles(),
                double(exact.bytes()) / 1048576.0, double(exact.bytes()) / double(own), reached ? "" : "> ", reached ? side : side / 2, found, double(bytes) / 1048576.0,
                reached ? "" : "> ", double(bytes) / double(own));
    std::fflush(stdout);
}

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

struct Prepared {
    Subject subject;
    mesh::TriangleMesh tile;
};

std::vector<Prepared> prepare(const Settings& settings) {
    std::vector<Prepared> out;
    for (const scenes::SceneEntry& entry : scenes::scene_table()) {
        if (!settings.scene.empty() && settings.scene != entry.name) continue;
        const scenes::Scene scene = entry.make();
        if (!scene.flat) continue;
        auto subject = prepare_subject(entry);
        if (!subject) {
            std::printf("%s: %s\n", entry.name, subject.error().message.c_str());
            continue;
        }
        const auto grid = build_grid(subject->prepared.resolved);
        // A tenth of the default: flat pieces of bends must not show in the shading.
        auto tile = mesh::mesh_pattern(subject->prepared.resolved, *grid, {.tolerance = 1e-4 * subject->width});
        if (tile) out.push_back({std::move(*subject), std::move(*tile)});
        else std::printf("%s: %s\n", entry.name, tile.error().message.c_str());
    }
    return out;
}

struct Size {
    int width, height;
};

void ask_time(const Settings& settings, const std::vector<Prepared>& all, Size size) {
    std::printf("\n### Time at equal error\n\n| scene | view | reference dB | us/pixel | Embree samples | dB | x time | adaptive | dB | x time |\n"
                "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    Ratios ratios;
    for (const Prepared& one : all)
        for (const PlaneView& view : standard_views(one.subject, size.width, size.height)) measure_view(settings, one.subject, one.tile, view, ratios);
    std::printf("\nMedian: uniform %.1f, adaptive %.1f; at 80 degrees the lower of both: median %.1f, least %.1f\n", median(ratios.uniform), median(ratios.adaptive),
                median(ratios.steep), ratios.steep.empty() ? 0.0 : *std::min_element(ratios.steep.begin(), ratios.steep.end()));
}

void ask_memory(const Settings& settings, const std::vector<Prepared>& all, Size size) {
    std::printf("\n### Memory at equal error\n\n| scene | reference KB | exact dB | triangles | MB | ratio | grid | dB | MB | ratio |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const Prepared& one : all) {
        const auto grid = build_grid(one.subject.prepared.resolved);
        const reference::GroovedSurface surface(one.subject.prepared.resolved, *grid);
        measure_memory(settings, one.subject, one.tile, standard_views(one.subject, size.width, size.height)[1], surface);
    }
}

void run(const Settings& settings) {
    const std::vector<Prepared> all = prepare(settings);
    const Size size = settings.quick ? Size{96, 72} : Size{160, 120};
    if (settings.time) ask_time(settings, all, size);
    if (settings.memory) ask_memory(settings, all, size);
}

}  // namespace
}  // namespace burin::bench

int main(int argc, char** argv) {
    burin::bench::Settings settings;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const auto value = [&] { return std::string(i + 1 < argc ? argv[++i] : ""); };
        if (word == "--quick") settings.quick = true;
        else if (word == "time") settings.memory = false;
        else if (word == "memory") settings.time = false;
        else if (word == "--scene") settings.scene = value();
        else if (word == "--cache") settings.cache = value();
        else if (word == "--pictures") settings.pictures = value();
        else return std::fprintf(stderr, "bench_geometry: '%s' is not an option; time, memory, --quick, --scene NAME, --cache FOLDER, --pictures FOLDER work\n", word.c_str()), 2;
    }
    burin::bench::run(settings);
}
