// Question: has any sample a hole? One ray for each pixel of a picture of the whole pattern, by the shader and by the truth.
//
// A pixel is wrong where the two meet different facets farther than half a pixel from every border between facets; wrong
// pixels beside each other are a hole that shows.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "questions.hpp"

namespace burin::bench {
namespace {

struct Counts {
    long wrong = 0, beside = 0, borders = 0;  // pixels; `beside`: wrong ones with a wrong neighbour
    double worst = 0.0;                       // of wrong ones, share of the depth
};

// Parallel rays that see the whole tile, `elevation` degrees above the plane; the pixels lie on the object surface.
struct Picture {
    int side;
    Vec2 pixel;
    Vec2 slope;

    Picture(const ResolvedPattern& pattern, int pixels, double elevation)
        : side(pixels), pixel{pattern.size.x / pixels, pattern.size.y / pixels} {
        // Aslant, so that no row of rays runs along the axes that patterns are drawn on.
        const double turn = 0.6, run = std::tan((90.0 - elevation) * std::numbers::pi / 180.0);
        slope = Vec2{std::cos(turn), std::sin(turn)} * run;
    }
    PatternRay ray(int x, int y) const {
        return {{float((x + 0.5) * pixel.x), float((y + 0.5) * pixel.y)}, {float(slope.x), float(slope.y)}};
    }
};

constexpr long kPrinted = 6;

// So that it can be followed by hand.
void print_wrong(const Subject& subject, const PatternRay& ray, float off) {
    std::fprintf(stderr, "%s: ray at (%.9g, %.9g) slope (%.9g, %.9g) is off by %.2g of the depth\n", subject.name.c_str(), double(ray.origin[0]),
                 double(ray.origin[1]), double(ray.slope[0]), double(ray.slope[1]), double(off));
}

Counts judge(const Subject& subject, const Picture& picture, const std::vector<PatternRay>& rays, const std::vector<ShadedHit>& hits) {
    const Truth truth = testing::truth_of_stored(subject.prepared);
    const double border = 0.5 * std::max(picture.pixel.x, picture.pixel.y);
    std::vector<float> off(rays.size(), 0.0f);  // share of the depth where a pixel is wrong; -1 at a border
    testing::in_parallel(rays.size(), [&](std::size_t i) {
        const testing::Verdict verdict = testing::compare_hit(truth, subject.prepared, rays[i], hits[i], border);
        if (!verdict.sheet && verdict.facet_differs) off[i] = verdict.border ? -1.0f : float(std::max(verdict.height, 1e-9));
    });
    Counts counts;
    const auto wrong = [&](int x, int y) {
        return x >= 0 && y >= 0 && x < picture.side && y < picture.side && off[std::size_t(y) * std::size_t(picture.side) + std::size_t(x)] > 0.0f;
    };
    for (int y = 0; y < picture.side; ++y)
        for (int x = 0; x < picture.side; ++x) {
            const float here = off[std::size_t(y) * std::size_t(picture.side) + std::size_t(x)];
            if (here < 0.0f) ++counts.borders;
            if (!wrong(x, y)) continue;
            ++counts.wrong;
            counts.worst = std::max(counts.worst, double(here));
            if (counts.wrong <= kPrinted) print_wrong(subject, rays[std::size_t(y) * std::size_t(picture.side) + std::size_t(x)], here);
            bool neighbour = false;
            for (int k = 0; k < 9; ++k) neighbour = neighbour || (k != 4 && wrong(x + k % 3 - 1, y + k / 3 - 1));
            if (neighbour) ++counts.beside;
        }
    return counts;
}

void measure(const Settings& settings, const Subject& subject) {
    const int side = settings.quick ? 512 : 2048;
    for (const double elevation : {60.0, 20.0}) {
        const Picture picture(subject.prepared.resolved, side, elevation);
        std::vector<PatternRay> rays;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) rays.push_back(picture.ray(x, y));
        const auto hits = shade_rays(subject.prepared.textures, subject.prepared.detail, rays, settings.backend);
        if (!hits) {
            std::printf("| %s | %s |\n", subject.name.c_str(), hits.error().message.c_str());
            return;
        }
        const Counts counts = judge(subject, picture, rays, *hits);
        std::printf("| %s | %g | %d x %d | %ld | %ld | %ld | %.1e |\n", subject.name.c_str(), elevation, side, side, counts.wrong, counts.beside,
                    counts.borders, counts.worst);
        std::fflush(stdout);
    }
}

}  // namespace

void ask_holes(const Settings& settings) {
    std::printf("\n### Holes\n\nOne ray per pixel of the whole pattern, shader against truth. Wrong: another facet, half a pixel or more from every border;\n"
                "beside: wrong ones that touch another; borders: other facets nearer than that; worst: share of the depth by which a wrong one is off.\n\n"
                "| scene | elevation | pixels | wrong | beside | borders | worst |\n|---|--:|--:|--:|--:|--:|--:|\n");
    for_each_subject(settings, [&](const Subject& subject) { measure(settings, subject); }, false);
}

}  // namespace burin::bench
