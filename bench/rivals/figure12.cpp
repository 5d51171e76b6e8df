// bench_figure12: four ways to draw the same relief near and far, as figure 12 of 2010 has them: its surface as triangles, tessellation displaced by
// a map, relief mapping, and burin's paths.
//
//     bench_figure12 [--quick] [--scene NAME ...] [--cache FOLDER] [--pictures FOLDER]
//
// All in one context, light and shading text, against the truth's picture. A table in Markdown goes to standard output.
#include <algorithm>
#include <cstdio>
#include <string>
#include <thread>

#include <burin/grid.hpp>
#include <burin/image_io.hpp>

#include "exact_geometry.hpp"
#include "furnished.hpp"

namespace burin::rivals {
namespace {

struct Settings {
    bool quick = false;  // smaller pictures, fewer runs
    std::vector<std::string> scenes;
    std::string pictures, cache;
};

// A row of the table. `paper`: frames per second of the paper, on its own object and machine; 0: not given.
struct Way {
    std::string name, setting;
    double paper = 0.0;
    std::size_t triangles = 0;
    double bytes = 0.0;
    Draw draw;
    std::vector<double> milliseconds;
};

// Frames per second of the paper's four pictures.
struct Paper {
    double geometry, tessellation, relief, paths;
};
constexpr Paper kPaperNear{50, 57, 599, 315}, kPaperFar{49, 60, 181, 198};

std::string describe(const char* format, auto... values) {
    char text[80];
    std::snprintf(text, sizeof text, format, values...);
    return text;
}

struct Scene {
    const gl::Context& context;
    const bench::Subject& subject;
    const mesh::TriangleMesh& tile;
    SceneMaps& maps;
    Stage& stage;
    Paper paper;
};

double decibels_of(const Scene& scene, const Draw& draw) { return bench::compare_pictures(draw().image(), scene.stage.truth()).psnr; }

Result<Draw> geometry_draw(const Scene& scene, const GeometrySettings& settings, Way& way) {
    auto loaded = ExactGeometry::load(scene.context, scene.subject, scene.tile, scene.stage, settings);
    if (!loaded) return loaded.error();
    auto geometry = std::make_shared<ExactGeometry>(std::move(*loaded));
    way.triangles = geometry->drawn_triangles();
    way.bytes = geometry->bytes();
    return Draw([geometry] { return geometry->draw(); });
}

// Its depth map as small as shadows allow.
Result<Way> geometry_way(const Scene& scene, const char* name, GeometrySettings settings, double paper) {
    constexpr double kLoss = 0.05;
    Way way{.name = name, .paper = paper};
    settings.shadow_texels = 4096;
    double best = 0.0;
    for (; settings.shadow_texels >= 256; settings.shadow_texels /= 2) {
        Way other = way;
        auto draw = geometry_draw(scene, settings, other);
        if (!draw) return draw.error();
        const double found = decibels_of(scene, *draw);
        if (found < best - kLoss) break;
        best = std::max(best, found);
        way = other;
        way.draw = *draw;
        way.setting = describe("depth map %d²", settings.shadow_texels);
    }
    return way;
}

Result<Way> rival_way(const Scene& scene, Technique technique, int finest, double paper) {
    Stage& stage = scene.stage;
    RivalSettings settings;
    settings.technique = technique;
    settings.size = finest;
    settings.samples = 4;
    settings.steps = 64;
    settings.refinements = 8;
    settings.wide_heights = true;
    settings.edge = stage.pixel_in_uv();
    if (const auto first = stage.rival(settings); !first) return first.error();
    settings = tune_rival(settings, [&](const RivalSettings& tried) { return decibels_of(scene, *stage.rival(tried)); });
    const bool triangles = technique == Technique::triangles;
    Way way{.name = triangles ? "tessellation, 4 samples" : describe("relief mapping to %d², 4 samples", finest), .paper = paper};
    way.setting = describe("%d², %d steps, bias %g", settings.size, settings.steps, double(settings.bias));
    way.draw = *stage.rival(settings);
    way.triangles = stage.triangles_of(settings);
    way.bytes = stage.bytes_of(settings).plain;
    return way;
}

Result<Way> paths_way(const Scene& scene, const char* name, const std::function<void(RenderOptions&)>& apply, double paper) {
    auto draw = scene.stage.burin(apply);
    if (!draw) return draw.error();
    const PackedTextures& textures = scene.subject.prepared.textures;
    return Way{.name = name, .paper = paper, .triangles = scene.stage.asset().primitives[0].indices.size() / 3,
               .bytes = 4.0 * double(textures.grid.size() + textures.data.size()), .draw = *draw};
}

Result<std::vector<Way>> ways_of(const Scene& scene) {
    const auto four = [](RenderOptions& o) { o.antialiasing = Antialiasing::points, o.samples = 4; };
    Result<Way> found[] = {geometry_way(scene, "geometry, 4 samples of coverage", {.passes = 1, .coverage = true}, scene.paper.geometry),
                           geometry_way(scene, "geometry, 4 samples", {.passes = 4, .coverage = false}, 0.0),
                           geometry_way(scene, "geometry, 16 samples", {.passes = 16, .coverage = false}, 0.0),
                           rival_way(scene, Technique::triangles, 4096, scene.paper.tessellation),
                           rival_way(scene, Technique::relief, 512, scene.paper.relief),
                           rival_way(scene, Technique::relief, 4096, 0.0),
                           paths_way(scene, "paths, 4 samples", four, scene.paper.paths),
                           paths_way(scene, "paths, areas", [](RenderOptions&) {}, 0.0)};
    std::vector<Way> ways;
    for (Result<Way>& way : found) {
        if (!way) return way.error();
        ways.push_back(std::move(*way));
    }
    return ways;
}

void save(const Settings& settings, const Scene& scene, const Way& way) {
    if (settings.pictures.empty()) return;
    std::string path = scene.subject.name + " " + scene.stage.view().name + " " + way.name;
    std::replace_if(path.begin(), path.end(), [](char letter) { return letter == ' ' || letter == ',' || letter == '/'; }, '_');
    if (Status written = write_png(settings.pictures + "/figure12_" + path + ".png", bench::show_difference(way.draw().image(), scene.stage.truth())); !written)
        std::fprintf(stderr, "%s\n", written.error().message.c_str());
}

void print_ways(const Settings& settings, const Scene& scene, std::vector<Way>& ways) {
    for (int k = 0; k < (settings.quick ? 5 : 9); ++k)
        for (Way& way : ways) way.milliseconds.push_back(time_once(way.draw));
    for (Way& way : ways) {
        std::sort(way.milliseconds.begin(), way.milliseconds.end());
        std::printf("| %s | %s | %s | %s | %.1f | %.1f | %zu | %.1f | %s |\n", scene.subject.name.c_str(), scene.stage.view().name.c_str(), way.name.c_str(),
                    way.setting.c_str(), decibels_of(scene, way.draw), way.milliseconds[way.milliseconds.size() / 2], way.triangles, way.bytes / 1000.0,
                    way.paper > 0.0 ? describe("%g", way.paper).c_str() : "");
        std::fflush(stdout);
        save(settings, scene, way);
    }
}

Status compare_ways(const Settings& settings, const gl::Context& context, const scenes::SceneEntry& entry) {
    auto subject = bench::prepare_subject(entry);
    if (!subject) return subject.error();
    const auto grid = build_grid(subject->prepared.resolved);
    if (!grid) return grid.error();
    const auto tile = mesh::mesh_pattern(subject->prepared.resolved, *grid);
    if (!tile) return tile.error();
    SceneMaps maps(context, *subject, 4096, settings.cache);
    for (const bench::PlaneView& view : bench::standard_views(*subject, settings.quick ? 96 : 160, settings.quick ? 72 : 120)) {
        if (view.name != "near" && view.name != "far") continue;
        Stage stage(context, *subject, maps, view, settings.cache);
        const Scene scene{context, *subject, *tile, maps, stage, view.name == "near" ? kPaperNear : kPaperFar};
        auto ways = ways_of(scene);
        if (!ways) return ways.error();
        print_ways(settings, scene, *ways);
    }
    return Done{};
}

int run(const Settings& settings) {
    auto context = gl::open_context(Backend::osmesa);
    if (!context) return std::fprintf(stderr, "bench_figure12: error: %s\n", context.error().message.c_str()), 1;
    std::printf("Renderer: %s. Threads: %u.%s\n\n### Near and far\n\n", (*context)->describe().c_str(), std::thread::hardware_concurrency(), settings.quick ? " Quick." : "");
    std::printf("Processor time of a picture of %s pixels, ms, the median of runs in turns; error against the truth, dB. Triangles: as drawn, of all tiles. kB: of geometry\n"
                "one tile's corners and triangles, without the depth map for its shadows, 4 bytes a texel, which is drawn anew for each picture; of maps with mips; of burin\n"
                "both textures. Samples of coverage share a facet's shading. Paper: frames per second of its own object on its own machine: 698107 triangles of geometry,\n"
                "14948 of the surface that maps and paths lie on.\n\n"
                "| scene | view | technique | setting | PSNR | ms | triangles | kB | paper fps |\n|---|---|---|---|--:|--:|--:|--:|--:|\n",
                settings.quick ? "96 x 72" : "160 x 120");
    int status = 0;
    for (const std::string& name : settings.scenes) {
        const scenes::SceneEntry* entry = scenes::find_scene(name);
        const Status done = entry != nullptr ? compare_ways(settings, **context, *entry) : Status(Error{ErrorCode::invalid_argument, "no such scene"});
        if (!done) std::fprintf(stderr, "bench_figure12: error: %s: %s\n", name.c_str(), done.error().message.c_str()), status = 1;
    }
    return status;
}

}  // namespace
}  // namespace burin::rivals

int main(int argc, char** argv) {
    burin::rivals::Settings settings;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool more = i + 1 < argc;
        if (word == "--quick") settings.quick = true;
        else if (word == "--scene" && more) settings.scenes.push_back(argv[++i]);
        else if (word == "--cache" && more) settings.cache = argv[++i];
        else if (word == "--pictures" && more) settings.pictures = argv[++i];
        else return std::fprintf(stderr, "bench_figure12: error: '%s' is no option, or not followed by what it needs; options: --quick --scene NAME (more than once if wanted) --cache FOLDER --pictures FOLDER\n", word.c_str()), 2;
    }
    if (settings.scenes.empty()) settings.scenes = {"tapered_cracks", "letters", "crossing"};
    return burin::rivals::run(settings);
}
