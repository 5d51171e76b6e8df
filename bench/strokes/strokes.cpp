// How near strokes stay to where they were drawn, and how wide they are: bench_strokes [--armour model.gltf] [--count strokes] [--seed n]
// With BURIN_EACH_STROKE set, each stroke that misses its figures is named.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "judge.hpp"

namespace burin::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Sum {
    StrokeFigures worst;
    int strokes = 0, pieces = 0, borders = 0;
    double milliseconds = 0.0;
};

void print_head() {
    std::puts("| body | strokes | pieces | borders | elements | farthest element | farthest groove | width, most | width, rms | widths off by 2 % | missing | ms |");
    std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print(const char* name, const Sum& sum) {
    const StrokeFigures& f = sum.worst;
    std::printf("| %s | %d | %d | %d | %d | %.4f %% | %.4f %% | %.2f %% | %.2f %% | %d of %d | %d of %d | %.0f |\n", name, sum.strokes, sum.pieces, sum.borders, f.elements,
                100 * f.stray / f.size, 100 * f.offset / f.size, 100 * f.width_error, 100 * f.width_rms, f.wide, f.widths, f.missing, f.seen, sum.milliseconds);
    std::fflush(stdout);
}

// One stroke at a time, so that none disturbs another.
bool add(const Model& model, const Mesh& mesh, const Stroke& stroke, const StrokeOptions& options, Sum& sum) {
    const auto begun = std::chrono::steady_clock::now();
    const auto made = project_strokes(model, std::span(&stroke, 1), options);
    sum.milliseconds += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
    if (!made) return std::printf("stroke %d: %s\n", sum.strokes, made.error().message.c_str()), false;
    const auto figures = judge_strokes(mesh, made->pattern, {stroke}, options, options.width);
    if (!figures) return std::printf("stroke %d: %s\n", sum.strokes, figures.error().message.c_str()), false;
    StrokeFigures& worst = sum.worst;
    if (std::getenv("BURIN_EACH_STROKE") && (figures->missing || figures->width_error > 0.02 || figures->stray > 0.001 * figures->size))
        std::printf("stroke %d: missing %d near %g %g %g, width %.2f %% at %g %g %g, stray %.4f %%, pieces %d, length %g\n", sum.strokes, figures->missing,
                    figures->worst_missing.x, figures->worst_missing.y, figures->worst_missing.z, 100 * figures->width_error, figures->worst_width.x,
                    figures->worst_width.y, figures->worst_width.z, 100 * figures->stray / figures->size, made->stats.pieces, made->stats.length);
    worst.size = figures->size;
    worst.stray = std::max(worst.stray, figures->stray), worst.offset = std::max(worst.offset, figures->offset);
    worst.width_error = std::max(worst.width_error, figures->width_error), worst.width_rms = std::max(worst.width_rms, figures->width_rms);
    worst.seen += figures->seen, worst.missing += figures->missing, worst.widths += figures->widths, worst.wide += figures->wide, worst.left_out += figures->left_out, worst.echoes += figures->echoes, worst.elements += figures->elements;
    ++sum.strokes, sum.pieces += made->stats.pieces, sum.borders += made->stats.borders;
    return true;
}

StrokeOptions usual(double width) {
    StrokeOptions options;
    options.width = width;
    options.height = 0.3 * width;
    return options;
}

void run_sphere(const char* name, const Model& model, int count, unsigned seed, double highest) {
    const Mesh mesh(model, "");
    std::mt19937 random(seed);
    Sum sum;
    while (sum.strokes < count) {
        const Point3 axis = random_direction(random);
        const double height = random() % 2 ? 0.0 : 0.3 * double(random()) / 4294967296.0;
        const double begin = 2 * kPi * double(random()) / 4294967296.0, turn = random() % 4 ? 1.0 + double(random() % 4) : 2 * kPi;
        const Stroke stroke = circle_on_sphere(axis, height, begin, turn, 400);
        // Where there is no surface there is nothing to measure.
        if (std::any_of(stroke.points.begin(), stroke.points.end(), [&](Point3 p) { return std::abs(p.y) > highest; })) continue;
        if (!add(model, mesh, stroke, usual(0.008), sum)) return;
    }
    print(name, sum);
}

void run_torus(const char* name, const Model& model, int count, unsigned seed) {
    const Mesh mesh(model, "");
    std::mt19937 random(seed);
    const auto next = [&] { return double(random()) / 4294967296.0; };
    Sum sum;
    while (sum.strokes < count)
        if (!add(model, mesh, winding(2 * kPi * next(), 2 * kPi * next(), next() - 0.5, 2 * next() - 1, 400), usual(0.008), sum)) return;
    print(name, sum);
}

void run_armour(const char* path, int count, unsigned seed) {
    const auto model = read_model(path);
    if (!model) return void(std::printf("%s\n", model.error().message.c_str()));
    const Mesh mesh(*model, "");
    std::mt19937 random(seed);
    Sum sum;
    while (sum.strokes < count) {
        const Stroke stroke = mesh.march(mesh.random_place(random), random_direction(random), mesh.size() / 1000, 300);
        if (stroke.points.size() < 50) continue;
        if (!add(*model, mesh, stroke, usual(mesh.size() / 400), sum)) return;
    }
    print("armour", sum);
    std::printf("armour: %d places of elements show elsewhere too; %d places with edges across were not asked\n", sum.worst.echoes, sum.worst.left_out);
}

}  // namespace
}  // namespace burin::bench

int main(int argc, char** argv) {
    using namespace burin::bench;
    const char* armour = nullptr;
    int count = 20;
    unsigned seed = 1;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (!std::strcmp(argv[i], "--armour")) armour = argv[i + 1];
        if (!std::strcmp(argv[i], "--count")) count = std::atoi(argv[i + 1]);
        if (!std::strcmp(argv[i], "--seed")) seed = unsigned(std::atoi(argv[i + 1]));
    }
    std::printf("seed %u, width 1 %% of the diameter\n\n", seed);
    print_head();
    run_sphere("sphere, latitudes, 96 rows", latitude_sphere(96).model(), count, seed, 0.45);
    run_sphere("sphere, cube of 32 rows", cube_sphere(32, 1.0).model(), count, seed, 1.0);
    run_sphere("sphere, cube, 3:1", cube_sphere(32, 3.0).model(), count, seed, 1.0);
    run_torus("torus, one chart", torus(60, 1, 1.0).model(), count, seed);
    run_torus("torus, six charts, 3:1", torus(60, 6, 3.0).model(), count, seed);
    if (armour) run_armour(armour, count, seed);
}
