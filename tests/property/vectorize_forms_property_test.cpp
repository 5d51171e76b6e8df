// Forms that fill a map: hills, dots by the hundred, rings, lines round the tile, grooves that grow deeper, scratches over
// clouds. Sizes, places and contrasts at random; whatever they are, all of it is found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../sampled_image.hpp"
#include "converted_map.hpp"
#include "drawn_map.hpp"

namespace burin::testing {
namespace {

constexpr int kSide = 256;

// Also says what was found.
Converted found_in(const Image& image) {
    Converted result = converted(image);
    std::printf("  %d paths, explained %.4f, %zu bytes\n", result.stats.paths, result.stats.explained,
                result.stats.grid_bytes + result.stats.data_bytes);
    return result;
}

template <typename Surface>
Image image_of(const Surface& surface) {
    return sampled_image(kSide, kSide, 4, surface);
}

// Domes and pyramids have no level texels on top; how high they are makes no difference.
TEST(VectorizeForms, HillsOfAnyHeight) {
    Uniform random(seed_of_run());
    for (const double height : {0.15, 0.5, random(0.6, 0.8), 1.0}) {
        const double radius = random(22.0, 28.0);
        const auto at = [&](double x, double y, bool dome) {
            const double u = std::fabs(std::fmod(x, 64.0) - 32.0) / radius, v = std::fabs(std::fmod(y, 64.0) - 32.0) / radius;
            return height * (dome ? std::sqrt(std::max(0.0, 1.0 - u * u - v * v)) : std::max(0.0, 1.0 - std::max(u, v)));
        };
        for (const bool dome : {true, false}) {
            SCOPED_TRACE((dome ? "domes " : "pyramids ") + std::to_string(height));
            const ConvertStats stats = found_in(image_of([&](double x, double y) { return at(x, y, dome); })).stats;
            EXPECT_GE(stats.paths, 16);
            EXPECT_GT(stats.explained, 0.98);
        }
    }
}

// They take more than the default budget, which is no reason to lose any.
TEST(VectorizeForms, DotsByTheHundred) {
    Uniform random(seed_of_run());
    const double radius = random(1.8, 2.6);
    const Image dots = image_of([&](double x, double y) {
        return std::hypot(std::fmod(x, 8.0) - 4.0, std::fmod(y, 8.0) - 4.0) < radius ? 0.9 : 0.2;
    });
    const ConvertStats stats = found_in(dots).stats;
    EXPECT_EQ(stats.paths, (kSide / 8) * (kSide / 8));
    EXPECT_GT(stats.explained, 0.98);
}

// Wherever the tile begins, lines that run round it close, and what lies across its seams is whole.
TEST(VectorizeForms, SeamsAreNowhere) {
    Uniform random(seed_of_run());
    const double dx = random(0, kSide), dy = random(0, kSide);
    const auto wrapped = [](double a) { return a - kSide * std::floor(a / kSide); };
    const Image map = image_of([&](double px, double py) {
        const double x = wrapped(px + dx), y = wrapped(py + dy);
        const bool level = std::fabs(y - 40.0) < 5.0, diagonal = std::fabs(wrapped(x - y) - 128.0) < 6.0;
        const bool disc = std::hypot(x - 60.0, y - 150.0) < 22.0;
        return disc ? 0.9 : level || diagonal ? 0.2 : 0.6;
    });
    const Converted result = found_in(map);
    EXPECT_TRUE(result.stats.repeat);
    EXPECT_EQ(result.stats.paths, 3);
    EXPECT_GT(result.stats.explained, 0.995);
    for (const Path& path : result.pattern.paths) EXPECT_TRUE(path.closed);
}

TEST(VectorizeForms, RingsAreConcentric) {
    Uniform random(seed_of_run());
    DrawnMap map(1.5);
    const Vec2 middle{128.0 + random(-2, 2), 128.0 + random(-2, 2)};
    std::vector<double> radii;
    for (double r = 20.0; r < 110.0; r += random(15.0, 22.0)) radii.push_back(r);
    for (const double r : radii) map.draw(map.pens().groove(random(3, 5), 0.5), bench::circle(middle, r));
    const Recovered r = recovered_from(map.take());
    ASSERT_EQ(r.pattern.paths.size(), radii.size());
    const double texel = r.pattern.size.x / kTexels;
    for (const Path& path : r.pattern.paths) {
        EXPECT_TRUE(path.closed);
        double nearest = 1e300, farthest = 0.0;
        for (const Element& e : path.elements) {
            const double distance = length(e.p0 * (1.0 / texel) - middle);
            nearest = std::min(nearest, distance), farthest = std::max(farthest, distance);
        }
        EXPECT_LT(farthest - nearest, 0.1);
    }
}

// A groove that grows deeper, and one that is deepest in the middle, are a path each but for what is left at their ends.
TEST(VectorizeForms, DepthsVaryAlongPaths) {
    Uniform random(seed_of_run());
    const double half = random(2.5, 4.0), least = random(0.1, 0.4);
    const Image map = image_of([&](double x, double y) {
        const double along = std::clamp((x - 20.0) / 216.0, 0.0, 1.0), wave = 1.0 - std::fabs(2.0 * along - 1.0);
        const auto wall = [&](double middle) { return std::clamp(half + 0.75 - std::fabs(y - middle), 0.0, 1.5) / 1.5; };
        const bool inside = x > 20.0 && x < 236.0;
        return 0.8 - (inside ? 0.6 * (wall(80.0) * (least + (1.0 - least) * along) + wall(170.0) * (least + (1.0 - least) * wave)) : 0.0);
    });
    const ConvertStats stats = found_in(map).stats;
    EXPECT_LE(stats.paths, 6);
    EXPECT_GT(stats.explained, 0.99);
}

// Clouds a sixth as strong as the scratches are no reason to miss one, nor to draw what is not there.
TEST(VectorizeForms, ScratchesOverClouds) {
    Uniform random(seed_of_run());
    DrawnMap map(1.0);
    for (int i = 0; i < 4; ++i)
        for (const double side : {-18.0, 18.0}) {
            const double along = random(0, 6.28);
            const Vec2 c = DrawnMap::field(i) + Vec2{side, side};
            map.draw(map.pens().groove(random(1.6, 2.2), random(0.3, 0.5)), bench::polyline({c - toward(along, 30), c + toward(along, 30)}));
        }
    const Pattern drawing = map.take();
    Image image = bench::map_of(drawing, kTexels, 16);
    bench::add_clouds(image, 0.05, 40.0, random);
    const bench::StructureScore found = bench::compare_structure(drawing, found_in(image).pattern, kTexels);
    std::printf("  paths %d/%d/%d\n", found.paths.authored, found.paths.recovered, found.paths.matched);
    EXPECT_GE(found.paths.matched, found.paths.authored - 1);
    EXPECT_LE(found.paths.recovered, found.paths.authored + 2);
}

}  // namespace
}  // namespace burin::testing
