// Question: how long do reading and writing a pattern in JSON take, and do they grow with the number of elements and not faster?
//
//     bench_json [LARGEST]        numbers of elements are 10^3, 10^4, ... up to LARGEST, 10^6 unless given
//
// Paths have four elements each, lines and quadratics in turn, with a pair of scales for each. A table in Markdown goes to standard output;
// seconds are those of the processor, which other programs on the machine do not lengthen.
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>

#include <burin/pattern_json.hpp>

namespace {

using namespace burin;

Pattern make_pattern(int count) {
    std::mt19937_64 engine(1);
    const auto random = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
    Pattern pattern;
    pattern.profiles.push_back({{{-1e-4, 0.0}, {0.0, -5e-5}, {1e-4, 0.0}}, {}});
    for (int i = 0; i < count; i += 4) {
        Path& path = pattern.paths.emplace_back();
        Vec2 from{random(), random()};
        for (int k = 0; k < 4; ++k) {
            const Vec2 to = from + Vec2{random(), random()} * 1e-3, control = from + Vec2{random(), random()} * 1e-3;
            path.elements.push_back({k % 2 ? ElementKind::quadratic : ElementKind::line, from, control, to, random(), random()});
            from = to;
        }
    }
    return pattern;
}

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

int main(int argc, char** argv) {
    const int largest = argc > 1 ? std::atoi(argv[1]) : 1000000;
    std::printf("| elements | MB | write, s | read, s |\n|---|---|---|---|\n");
    for (int count = 1000; count <= largest; count *= 10) {
        const Pattern pattern = make_pattern(count);
        const double begun = seconds();
        const std::string text = write_pattern_json(pattern);
        const double written = seconds();
        const auto read = read_pattern_json(text, "bench.json");
        const double done = seconds();
        if (!read || read->paths.size() != pattern.paths.size()) return std::fprintf(stderr, "not read\n"), 1;
        std::printf("| %d | %.1f | %.3f | %.3f |\n", count, static_cast<double>(text.size()) / 1e6, written - begun, done - written);
    }
}
