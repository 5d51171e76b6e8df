// Question: how many bytes does a scene take?
#include <cstdio>
#include <cstring>

#include "questions.hpp"

namespace burin::bench {
namespace {

// Bytes of the paper for the same class of scene, in units of 1000, as its Table 1 has them.
double paper_kilobytes(const std::string& scene) {
    struct Row {
        const char* scene;
        double kilobytes;
    };
    constexpr Row kRows[] = {{"engraved_armour", 535}, {"sine_path", 30.6}, {"overhang", 12}, {"sunken_square", 1},
                             {"tapered_cracks", 64}, {"letters", 50}, {"scratched_sphere", 198}};
    for (const Row& row : kRows)
        if (scene == row.scene) return row.kilobytes;
    return 0.0;
}

}  // namespace

void ask_memory(const Settings& settings) {
    std::printf("\n### Memory\n\nBytes of both textures as uploaded, which are also those in the file. The file's fallback maps and mesh come on top.\n\n"
                "| scene | elements | cells | grid B | data B | together kB | paper kB |\n|---|--:|--:|--:|--:|--:|--:|\n");
    for_each_subject(settings, [](const Subject& subject) {
        const PackedTextures& textures = subject.prepared.textures;
        const std::size_t grid = 4 * textures.grid.size(), data = 4 * textures.data.size();
        const double paper = paper_kilobytes(subject.name);
        char beside[20] = "";
        if (paper > 0.0) std::snprintf(beside, sizeof beside, "%g", paper);
        std::printf("| %s | %zu | %d x %d | %zu | %zu | %.1f | %s |\n", subject.name.c_str(), subject.prepared.resolved.elements.size(),
                    textures.grid_width, textures.grid_height, grid, data, double(grid + data) / 1000.0, beside);
    }, false);
}

}  // namespace burin::bench
