// Resolution independence of the whole way from a map to paths: what is drawn again lies nearer to the drawing that the map
// was made from than bilinear interpolation of the map does, with ends, corners, crossings and T-junctions. The full
// table is bench/resolution's.
#include <gtest/gtest.h>

#include <cstdio>

#include "../../bench/resolution/authored.hpp"
#include "../../bench/resolution/contour.hpp"
#include "../../bench/resolution/level_lines.hpp"
#include "../../bench/resolution/start.hpp"

namespace burin::bench {
namespace {

constexpr int kTexels = 512, kZoom = 1024;

struct Distances {
    LineDistance ours, bilinear;
};

Distances measure(const Pattern& drawing, int bits) {
    const Image map = map_of(drawing, kTexels, bits);
    const std::vector<double> heights = half_heights(drawing);
    const std::vector<Segment> truth = lines_of(drawing, heights, kZoom, kTexels);
    const Pattern ours = vectorized(map, drawing, true);
    return {distance_between(truth, lines_of(ours, heights, kZoom, kTexels)),
            distance_between(truth, lines_of(zoomed(map, kZoom, drawing.wrap), heights, kTexels))};
}

void expect_nearer(const Pattern& drawing, int bits, const char* name) {
    const Distances d = measure(drawing, bits);
    std::printf("  %-32s ours %.4f, bilinear %.4f texels RMS; lost %.2f %%\n", name, d.ours.rms, d.bilinear.rms,
                100.0 * d.ours.lost);
    EXPECT_LT(d.ours.rms, d.bilinear.rms) << name << ", worst at " << d.ours.worst.x << ", " << d.ours.worst.y;
    EXPECT_EQ(d.ours.lost, 0.0) << name;
    EXPECT_GT(d.bilinear.length, 1000.0) << name;
}

TEST(Resolution, BroadGrooveWithSoftWalls) { expect_nearer(plate(kTexels, {8.0, 2.0}), 16, "plate, groove 8, walls 2"); }

TEST(Resolution, BroadGrooveWithSharpWalls) { expect_nearer(plate(kTexels, {8.0, 0.4}), 16, "plate, groove 8, walls 0.4"); }

TEST(Resolution, ThinGroove) { expect_nearer(plate(kTexels, {2.0, 0.0}), 16, "plate, groove 2, vertical"); }

TEST(Resolution, EightBits) { expect_nearer(plate(kTexels, {8.0, 0.4}), 8, "plate, groove 8, 8 bit"); }

TEST(Resolution, RandomCrossingsStemsBendsAndArcs) {
    for (const unsigned seed : {1u, 4u}) {
        const std::string name = "random, seed " + std::to_string(seed);
        expect_nearer(random_plate(kTexels, {8.0, 2.0}, seed), 16, name.c_str());
        expect_nearer(random_plate(kTexels, {2.0, 0.0}, seed), 16, (name + ", thin").c_str());
    }
}

}  // namespace
}  // namespace burin::bench
