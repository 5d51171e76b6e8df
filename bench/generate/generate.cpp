// Question: how long do random scratches take, to generate, to write as a drawing, and to resolve and pack?
//
//     bench_generate FOLDER [LARGEST] [DENSITY]     numbers of scratches are 10^3, 10^4, ... up to LARGEST, 10^6 unless given
//
// DENSITY is per square centimetre, 4 unless given: the tile grows with the number. Drawings go to FOLDER and are removed. One pattern
// holds BURIN_MAX_ELEMENT_TEXELS of elements, so that packing ends with that limit's message where there are more; a wear map of
// several patterns is several tiles. A table in Markdown goes to standard output.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <burin/generate.hpp>
#include <burin/grid.hpp>
#include <burin/image_io.hpp>
#include <burin/pack.hpp>
#include <burin/resolve.hpp>
#include <burin/svg.hpp>

namespace {

using namespace burin;

template <typename Work>
double seconds_of(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string time_text(double seconds) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", seconds);
    return text;
}

struct Row {
    double generated = 0.0, drawn = 0.0, written = 0.0;
    std::size_t bytes = 0;
    std::string resolved, gridded, packed;
};

// Times of the stages behind the pattern; the first that fails says why.
void pack(const Pattern& pattern, Row& row) {
    Result<ResolvedPattern> resolved = Error{};
    const double resolving = seconds_of([&] { resolved = resolve_pattern(pattern); });
    row.resolved = resolved ? time_text(resolving) : resolved.error().message;
    if (!resolved) return;
    Result<CellGrid> grid = Error{};
    const double gridding = seconds_of([&] { grid = build_grid(*resolved); });
    row.gridded = grid ? time_text(gridding) : grid.error().message;
    if (!grid) return;
    Result<PackedTextures> textures = Error{};
    const double packing = seconds_of([&] { textures = pack_textures(*resolved, *grid); });
    row.packed = textures ? time_text(packing) : textures.error().message;
}

int measure(const std::string& file, double count, double density) {
    GenerateSpec spec;
    spec.kind = "scratches";
    const double side = 0.01 * std::sqrt(count / density);
    spec.size = {side, side};
    spec.parameters = {{"density", density}};
    Row row;
    Result<Pattern> pattern = Error{};
    row.generated = seconds_of([&] { pattern = generate_pattern(spec); });
    if (!pattern) {
        std::fprintf(stderr, "bench_generate: error: %s\n", pattern.error().message.c_str());
        return 1;
    }
    std::string svg;
    row.drawn = seconds_of([&] { svg = write_svg(*pattern); });
    row.bytes = svg.size();
    Status written = Done{};
    row.written = seconds_of([&] { written = write_file(file, {reinterpret_cast<const std::uint8_t*>(svg.data()), svg.size()}); });
    std::remove(file.c_str());
    if (!written) {
        std::fprintf(stderr, "bench_generate: error: %s\n", written.error().message.c_str());
        return 1;
    }
    svg = std::string();
    pack(*pattern, row);
    std::printf("| %zu | %.3g | %.3f | %.3f | %.3f | %.1f | %s | %s | %s |\n", pattern->paths.size(), side, row.generated, row.drawn, row.written,
                double(row.bytes) / 1048576.0, row.resolved.c_str(), row.gridded.c_str(), row.packed.c_str());
    std::fflush(stdout);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    const double largest = argc > 2 ? std::atof(argv[2]) : 1e6, density = argc > 3 ? std::atof(argv[3]) : 4.0;
    if (argc < 2 || argc > 4 || !(largest >= 1000.0) || !(density > 0.0)) {
        std::fprintf(stderr, "bench_generate: error: usage: bench_generate FOLDER [LARGEST] [DENSITY], at least 1000 and above 0\n");
        return 2;
    }
    std::printf("## Generate\n\nSeconds on %u cores.\n\n"
                "| scratches | tile m | generate | draw as SVG | write it | MiB | resolve | grid | pack |\n|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
                std::thread::hardware_concurrency());
    for (double count = 1000.0; count <= largest; count *= 10.0)
        if (measure(std::string(argv[1]) + "/bench_generate.svg", count, density) != 0) return 1;
    return 0;
}
