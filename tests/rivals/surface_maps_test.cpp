// Maps of a pattern against the truth, and their sizes against each other.
#include <cmath>

#include <gtest/gtest.h>

#include <rivals/surface_maps.hpp>
#include <scenes/scenes.hpp>

#include "../judge/judge.hpp"

namespace burin::rivals {
namespace {

ResolvedPattern resolved(const char* scene) { return testing::prepare_pattern(scenes::find_scene(scene)->make().parts.at(0).pattern)->resolved; }

constexpr const char* kScenes[] = {"crossing", "sine_path", "sunken_square", "tapered_cracks"};

TEST(SurfaceMaps, HoldTheTruth) {
    for (const char* scene : kScenes) {
        const ResolvedPattern pattern = resolved(scene);
        const Truth truth(pattern);
        const SurfaceMaps maps = map_surface(pattern, {}, 256, "", "");
        const MapLevel& level = maps.levels.front();
        int off = 0;
        for (int i = 0; i < 256 * 256; i += 97) {
            const SurfacePoint point = truth.surface_at({(i % 256 + 0.5) / 256 * pattern.size.x, (i / 256 + 0.5) / 256 * pattern.size.y});
            const double height = pattern.base_offset - maps.lowest + level.heights[std::size_t(i)] / 65535.0 * (maps.lowest - maps.highest);
            const std::int16_t* normal = &level.normals[2 * std::size_t(i)];
            const double lean = std::hypot(normal[0] / 32767.0 - point.normal[0], normal[1] / 32767.0 - point.normal[1]);
            off += std::abs(height - point.height) > 1e-3 * pattern.depth || lean > 0.02;
        }
        // A texel beside a tip may be taken from its neighbours.
        EXPECT_LE(off, 2) << scene;
    }
}

TEST(SurfaceMaps, AgreeInAllSizes) {
    for (const char* scene : kScenes) {
        const ResolvedPattern pattern = resolved(scene);
        const SurfaceMaps fine = map_surface(pattern, {}, 512, "", ""), coarse = map_surface(pattern, {}, 128, "", "");
        EXPECT_NEAR(fine.highest, coarse.highest, 0.05 * pattern.depth) << scene;
        EXPECT_NEAR(fine.lowest, coarse.lowest, 0.1 * pattern.depth) << scene;
        const MapLevel& mean = fine.levels[fine.level_of(128)];
        double sum = 0.0;
        for (std::size_t i = 0; i < mean.heights.size(); ++i) {
            const double a = fine.lowest - mean.heights[i] / 65535.0 * (fine.lowest - fine.highest);
            const double b = coarse.lowest - coarse.levels[0].heights[i] / 65535.0 * (coarse.lowest - coarse.highest);
            sum += std::abs(a - b);
        }
        EXPECT_LT(sum / double(mean.heights.size()), 0.01 * pattern.depth) << scene;
        EXPECT_EQ(fine.levels.size(), 10u) << scene;
        EXPECT_EQ(fine.levels.back().size, 1) << scene;
    }
}

}  // namespace
}  // namespace burin::rivals
