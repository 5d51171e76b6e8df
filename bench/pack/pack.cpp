// Question: how long do grid and pack take, and do they grow with the number of elements and not faster?
//
//     bench_pack [LARGEST]        numbers of elements are 10^3, 10^4, ... up to LARGEST, 10^6 unless given
//
// Elements are short scratches that lie apart, with isolated ends: all lines, or lines and quadratics in turn. All are in one
// pattern, which is wide beyond BURIN_MAX_NARROW_ELEMENT_TEXELS; there they are also split into patterns that are not, which are
// packed side by side, one on each core. Tables in Markdown go to standard output.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <burin/grid.hpp>
#include <burin/pack.hpp>
#include <burin/resolve.hpp>

namespace {

using namespace burin;

constexpr int kMostPerNarrow = 40000;  // 60000 texels where every second element takes two

Element make_scratch(Vec2 from, Vec2 way, bool curved) {
    Element e;
    e.kind = curved ? ElementKind::quadratic : ElementKind::line;
    e.p0 = from;
    e.p2 = from + way;
    e.p1 = from + way * 0.5 + Vec2{-way.y, way.x} * 0.2;
    return e;
}

// One scratch in every square of a lattice over a tile of 1 m.
Pattern scratches(int count, bool mixed, unsigned seed) {
    Pattern pattern;
    pattern.depth = 0.001;
    const int side = int(std::ceil(std::sqrt(double(count))));
    const double square = 1.0 / side;
    for (const double half : {0.08, 0.05, 0.03})
        pattern.profiles.push_back({{{-half * square, 0}, {0, -0.0005}, {half * square, 0}}, {}});
    std::mt19937 engine(seed);
    const auto uniform = [&] { return double(engine() >> 8) * 0x1p-24; };
    for (int i = 0; i < count; ++i) {
        const Vec2 corner{i % side * square, i / side * square};
        const Vec2 from{(0.15 + 0.2 * uniform()) * square, (0.15 + 0.7 * uniform()) * square};
        const Vec2 to{(0.65 + 0.2 * uniform()) * square, (0.15 + 0.7 * uniform()) * square};
        Path path;
        path.profile = std::uint32_t(i % 3);
        path.elements.push_back(make_scratch(corner + from, to - from, mixed && i % 2 == 1));
        pattern.paths.push_back(std::move(path));
    }
    return pattern;
}

template <typename Value>
Value need(Result<Value> result) {
    if (result) return std::move(*result);
    std::fprintf(stderr, "bench_pack: error: %s\n", result.error().message.c_str());
    std::exit(1);
}

template <typename Work>
double seconds_of(const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// work(i) for i below count, on every core.
template <typename Work>
void in_parallel(std::size_t count, const Work& work) {
    std::atomic<std::size_t> next{0};
    std::vector<std::jthread> threads;
    for (unsigned t = 0; t < std::max(1u, std::thread::hardware_concurrency()); ++t)
        threads.emplace_back([&] {
            for (std::size_t i = next++; i < count; i = next++) work(i);
        });
}

struct Times {
    std::vector<double> tries;
    double least() const { return *std::min_element(tries.begin(), tries.end()); }
    double median() {
        std::nth_element(tries.begin(), tries.begin() + std::ptrdiff_t(tries.size() / 2), tries.end());
        return tries[tries.size() / 2];
    }
};

void measure(int count, bool mixed, int patterns) {
    std::vector<ResolvedPattern> resolved;
    const double resolving = seconds_of([&] {
        for (int i = 0; i < patterns; ++i) resolved.push_back(need(resolve_pattern(scratches(count / patterns, mixed, unsigned(i)))));
    });
    std::vector<CellGrid> grids;
    const double gridding = seconds_of([&] {
        for (const ResolvedPattern& pattern : resolved) grids.push_back(need(build_grid(pattern)));
    });
    std::size_t elements = 0, bytes = 0;
    for (const ResolvedPattern& pattern : resolved) elements += pattern.elements.size();
    constexpr int kTries = 7;
    Times packing, processor;
    std::vector<PackedTextures> packed(resolved.size());
    for (int k = 0; k < kTries; ++k) {
        const std::clock_t before = std::clock();
        packing.tries.push_back(seconds_of([&] { in_parallel(resolved.size(), [&](std::size_t i) { packed[i] = need(pack_textures(resolved[i], grids[i])); }); }));
        processor.tries.push_back(double(std::clock() - before) / CLOCKS_PER_SEC);
    }
    for (const PackedTextures& textures : packed) bytes += 4 * (textures.grid.size() + textures.data.size());
    std::printf("| %s | %zu | %d | %d | %.1f | %.2f | %.3f | %.4f | %.4f | %.4f | %.2f |\n", mixed ? "lines and quadratics" : "lines", elements, patterns, packed[0].sections.wide() ? 32 : 16,
                double(bytes) / double(elements), resolving, gridding, packing.least(), packing.median(), processor.least(), processor.least() / double(elements) * 1e6);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const int largest = argc > 1 ? std::atoi(argv[1]) : 1000000;
    if (argc > 2 || largest < 1000) {
        std::fprintf(stderr, "bench_pack: error: usage: bench_pack [LARGEST], at least 1000\n");
        return 2;
    }
    std::printf("## Pack\n\nSeconds on %u cores; of pack the least and the median of seven tries, and the least that all cores together worked on it.\n\n"
                "| elements | number | patterns | bits of a reference | bytes per element | resolve s | grid s | pack s, least | median | of all cores | us per element |\n"
                "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
                std::thread::hardware_concurrency());
    for (const bool mixed : {false, true})
        for (int count = 1000; count <= largest; count *= 10) {
            measure(count, mixed, 1);
            if (count > kMostPerNarrow) measure(count, mixed, (count + kMostPerNarrow - 1) / kMostPerNarrow);
        }
    return 0;
}
