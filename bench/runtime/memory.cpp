// Questions: how many bytes does a scene take? And the tables of the papers row by row: what a scene of the same class takes here, and what
// the paper printed for its own.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include <burin/grid.hpp>
#include <burin/pack.hpp>
#include <burin/resolve.hpp>

#include "questions.hpp"
#include "timing.hpp"

namespace burin::bench {
namespace {

// A row of a paper's Table 1. Kilobytes are as printed, of textures or of what stands for them.
struct PaperRow {
    const char *figure, *scene, *time;
    double kilobytes;
    const char* resolution;  // of grid and data texture
};
constexpr PaperRow kPaperRows[] = {
    {"2010: 1 left", "engraved_armour", "57.7 fps", 535, "250x250 / 137x137"},
    {"2010: 8 top left", "sine_path", "245.0 fps", 30.6, "50x50 / 42x42"},
    {"2010: 8 top middle", "overhang", "56.6 fps", 12, "25x25 / 24x24"},
    {"2010: 8 top right", "sunken_square", "156.4 fps", 1, "2x2 / 8x8"},
    {"2010: 8 bottom left", "tapered_cracks", "193.2 fps", 64, "100x100 / 39x39"},
    {"2010: 8 bottom middle", "letters", "36.8 fps", 50, "75x75 / 42x42"},
    {"2010: 8 bottom right", "scratched_sphere", "84.4 fps", 198, "100x100 / 101x101"},
    {"2008: 10 left", "parallel_grooves", "26 s", 16, ""},
    {"2008: 10 right", "crossing_scratches", "27 s", 19, ""},
    {"2008: 11 left", "grooved_sphere", "21 s", 16, ""},
    {"2008: 12 bottom left", "vinyl_three_profiles", "32 s", 124, ""},
    {"2008: 12 bottom right", "vinyl_recorded", "43 s", 124, ""},
    {"2008: 13", "columns", "258 s", 283, ""},
    {"2008: 1 left", "house", "214 s", 852, ""},
};

// All parts of a scene through resolve, grid and pack.
struct Prepared {
    std::size_t elements = 0, bytes = 0;
    std::string resolution;
    double seconds = 0.0;
};
Result<Prepared> prepare_scene(const scenes::Scene& scene) {
    Prepared sum;
    for (const scenes::Part& part : scene.parts) {
        const auto start = std::chrono::steady_clock::now();
        const auto resolved = resolve_pattern(part.pattern);
        if (!resolved) return resolved.error();
        const auto grid = build_grid(*resolved);
        if (!grid) return grid.error();
        const auto textures = pack_textures(*resolved, *grid);
        if (!textures) return textures.error();
        sum.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        sum.elements += resolved->elements.size();
        sum.bytes += 4 * (textures->grid.size() + textures->data.size());
        char sides[60];
        std::snprintf(sides, sizeof sides, "%s%dx%d / %dx%d", sum.resolution.empty() ? "" : ", ", textures->grid_width, textures->grid_height,
                      textures->data_width, textures->data_height);
        sum.resolution += sides;
    }
    return sum;
}

double milliseconds(const OpenedScene& scene, Antialiasing antialiasing, int tries) {
    RenderOptions options = scene.options;
    options.antialiasing = antialiasing;
    PassTimer timer(scene.asset, options);
    for (int k = 0; k < tries; ++k) timer.try_once();
    return 1e3 * timer.median_seconds();
}

void print_row(const Settings& settings, const PaperRow& row) {
    const scenes::Scene scene = scenes::find_scene(row.scene)->make();
    auto prepared = prepare_scene(scene);
    auto opened = open_scene(scene);
    if (!prepared || !opened) {
        std::printf("| %s | %s | %s |\n", row.figure, row.scene, (prepared ? opened.error() : prepared.error()).message.c_str());
        return;
    }
    for (int k = 0; k < 2; ++k)  // the first time caches are cold
        if (const auto again = prepare_scene(scene); again) prepared->seconds = std::min(prepared->seconds, again->seconds);
    opened->options.backend = settings.backend;
    opened->options.width = settings.quick ? 200 : 400;
    opened->options.height = settings.quick ? 150 : 300;
    const int tries = settings.quick ? 2 : 3;
    std::printf("| %s | %s | %zu | %.1f | %g | %s | %s | %.1f | %.0f | %.0f | %s |\n", row.figure, row.scene, prepared->elements, double(prepared->bytes) / 1000.0,
                row.kilobytes, prepared->resolution.c_str(), row.resolution, 1e3 * prepared->seconds, milliseconds(*opened, Antialiasing::points, tries),
                milliseconds(*opened, Antialiasing::regions, tries), row.time);
    std::fflush(stdout);
}

}  // namespace

void ask_tables(const Settings& settings) {
    std::printf("\n### The tables of the papers\n\nHere: bytes of both textures of all materials, in units of 1000; resolve, grid and pack, ms of wall time, the least of three\n"
                "(the paper of 2010: \"a few seconds\"); processor time of a frame of %s at the scene's own view, ms, by a ray in every pixel and by areas.\n"
                "Paper: its Table 1 for its own scene on its own machine (a GeForce 8800; a Pentium 4), the one of 2010 by rays but for figure 1.\n\n"
                "| figure | scene | elements | kB | paper kB | grid / data | paper grid / data | prepare ms | ray ms | areas ms | paper |\n"
                "|---|---|--:|--:|--:|---|---|--:|--:|--:|--:|\n",
                settings.quick ? "200 x 150" : "400 x 300");
    for (const PaperRow& row : kPaperRows)
        if (settings.scene.empty() || settings.scene == row.scene) print_row(settings, row);
}

void ask_memory(const Settings& settings) {
    std::printf("\n### Memory\n\nBytes of both textures as uploaded, which are also those in the file. The file's fallback maps and mesh come on top.\n\n"
                "| scene | elements | cells | grid B | data B | together kB |\n|---|--:|--:|--:|--:|--:|\n");
    for_each_subject(settings, [](const Subject& subject) {
        const PackedTextures& textures = subject.prepared.textures;
        const std::size_t grid = 4 * textures.grid.size(), data = 4 * textures.data.size();
        std::printf("| %s | %zu | %d x %d | %zu | %zu | %.1f |\n", subject.name.c_str(), subject.prepared.resolved.elements.size(),
                    textures.grid_width, textures.grid_height, grid, data, double(grid + data) / 1000.0);
    }, false);
}

}  // namespace burin::bench
