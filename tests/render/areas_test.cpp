// Areas against rays: pictures of the same scenes by both. Where areas leave something out, or draw what is hidden, whole patches of
// pixels are off, which a mean over a picture does not tell; so they are counted.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include <gl/render.hpp>

#include "../../samples/scenes/build.hpp"
#include "../../samples/scenes/scenes.hpp"
#include "../../samples/write_scene.hpp"
#include "../judge/context.hpp"
#include "../judge/judge.hpp"
#include "part_asset.hpp"

namespace burin::testing {
namespace {

struct Look {
    const char* scene;
    double zoom, elevation;
    Vec2 center;
};

// What each of them holds, all with shadows: heads over their feet, grooves wider than their mouths that cut them, shadows over joints of
// curves; steps up, whose shadows end at the next letter, and mitred corners with bends in their ridges; a step down.
constexpr Look kLooks[] = {
    {"overhang", 6.0, 60.0, {0.4, 0.45}}, {"overhang", 2.0, 25.0, {0.5, 0.5}},       {"letters", 6.0, 60.0, {0.4, 0.45}},
    {"letters", 16.0, 75.0, {0.55, 0.6}}, {"sunken_square", 6.0, 60.0, {0.4, 0.45}},
};

RenderOptions options_from(const Camera& camera) {
    RenderOptions options;
    options.backend = backend();
    options.width = 160;
    options.height = 120;
    options.camera = camera;
    return options;
}

RenderOptions by_rays(RenderOptions options) {
    options.antialiasing = Antialiasing::points;
    options.samples = 16;
    return options;
}

// Pixels that differ by more than `most`.
int count_off(const RgbaImage& a, const RgbaImage& b, int most) {
    int off = 0;
    for (std::size_t i = 0; i < a.texels.size(); i += 4) off += std::abs(int(a.texels[i]) - int(b.texels[i])) > most;
    return off;
}

TEST(Areas, ShowWhatRaysMeet) {
    for (const Look& look : kLooks) {
        const Asset asset = asset_of(scenes::find_scene(look.scene)->make().parts.at(0));
        const RenderOptions options = options_from({.azimuth = 37.0, .elevation = look.elevation, .zoom = look.zoom, .center = look.center});
        const auto areas = render_asset(asset, options);
        SKIP_WITHOUT_CONTEXT(areas);
        const auto rays = render_asset(asset, by_rays(options));
        ASSERT_TRUE(rays.ok());
        const int off = count_off(*areas, *rays, 40);
        RecordProperty(std::string(look.scene) + "_" + std::to_string(int(look.elevation)), off);
        EXPECT_LE(off, 8) << look.scene << " from " << look.elevation << " degrees: pixels of 19200";
    }
}

// Two slabs with a gap between them: over the edge of the near one neither the far one's side shows, nor the shadow that it throws on the
// ground of the gap.
TEST(Areas, SlabsHideWhatLiesInTheGap) {
    Pattern pattern;
    pattern.size = {1.0, 1.0};
    pattern.depth = 0.02;
    pattern.wrap = Wrap::clamp;
    pattern.outer_level = -0.018;
    pattern.profiles = {scenes::rise(0.004, 0.018)};
    for (const double x : {0.05, 0.515})
        pattern.paths.push_back(scenes::polygon({{x, 0.05}, {x + 0.435, 0.05}, {x + 0.435, 0.95}, {x, 0.95}}).path(0, 0, -0.018));
    scenes::Part part{"slabs", pattern, scenes::on_plane(pattern, {0.8f, 0.8f, 0.8f}, 0.0f, 0.5f).parts[0].mesh};
    const Asset asset = asset_of(part);
    for (const double azimuth : {60.0, 100.0}) {
        const RenderOptions options = options_from({.azimuth = azimuth, .elevation = 10.0, .zoom = 3.0, .center = Vec2{0.53, 0.5}});
        const auto areas = render_asset(asset, options);
        SKIP_WITHOUT_CONTEXT(areas);
        const auto rays = render_asset(asset, by_rays(options));
        ASSERT_TRUE(rays.ok());
        const int off = count_off(*areas, *rays, 40);
        RecordProperty("slabs_" + std::to_string(int(azimuth)), off);
        EXPECT_LE(off, 30) << azimuth;
    }
}

// A shield with long thin triangles over which the normal turns fast: what is seen lies aside of where the ray passes the mesh, by
// more the deeper it is, and is shaded with the normal of its own place.
TEST(Areas, AreShadedAsRaysAreOnArmour) {
    const char* const path = BURIN_SHARED_DATA "/models/oga_knight_armor.gltf";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "SKIPPED: " << path << " is not there";
    auto model = read_model(path);
    ASSERT_TRUE(model.ok());
    const auto file = scenes::write_scene_on(scenes::find_scene("engraved_armour")->make(), *model);
    ASSERT_TRUE(file.ok()) << file.error().message;
    const auto asset = read_asset(file->bytes);
    ASSERT_TRUE(asset.ok());
    RenderOptions options = options_from({.azimuth = -25.0, .elevation = 12.0, .zoom = 14.0, .center = Vec2{0.098, 0.325}});
    options.light = {.azimuth = -70.0, .elevation = 40.0};
    const auto areas = render_asset(*asset, options);
    SKIP_WITHOUT_CONTEXT(areas);
    const auto rays = render_asset(*asset, by_rays(options));
    ASSERT_TRUE(rays.ok());
    EXPECT_LE(count_off(*areas, *rays, 3), 220) << "pixels of 19200";
}

}  // namespace
}  // namespace burin::testing
