// Areas against rays: pictures of the same scenes by both. Where areas leave something out, or draw what is hidden, whole patches of
// pixels are off, which a mean over a picture does not tell; so they are counted.
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include <gl/render.hpp>

#include "../../samples/scenes/scenes.hpp"
#include "../judge/judge.hpp"

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

Asset asset_of(const std::string& name) {
    scenes::Scene scene;
    for (const scenes::SceneEntry& entry : scenes::scene_table())
        if (entry.name == name) scene = entry.make();
    const scenes::Part& part = scene.parts.at(0);
    auto prepared = prepare_pattern(part.pattern, {});
    EXPECT_TRUE(prepared.ok());
    MaterialInfo material = scenes::material_of(part);
    material.has_detail = true;
    material.detail = prepared->detail;
    material.textures = prepared->textures;
    Primitive primitive;
    primitive.positions = part.mesh.positions;
    primitive.normals = part.mesh.normals;
    primitive.uvs = part.mesh.uvs;
    primitive.indices = part.mesh.indices;
    Asset asset;
    asset.materials.push_back(std::move(material));
    asset.primitives.push_back(std::move(primitive));
    return asset;
}

TEST(Areas, ShowWhatRaysMeet) {
    const char* wanted = std::getenv("BURIN_BACKEND");
    for (const Look& look : kLooks) {
        const Asset asset = asset_of(look.scene);
        RenderOptions options;
        options.backend = wanted != nullptr && std::string(wanted) == "egl" ? Backend::egl : Backend::osmesa;
        options.width = 160;
        options.height = 120;
        options.camera = {.azimuth = 37.0, .elevation = look.elevation, .zoom = look.zoom, .center = look.center};
        const auto areas = render_asset(asset, options);
        if (!areas && areas.error().code == ErrorCode::unavailable) GTEST_SKIP() << "SKIPPED: " << areas.error().message;
        options.antialiasing = Antialiasing::points;
        options.samples = 16;
        const auto rays = render_asset(asset, options);
        ASSERT_TRUE(areas.ok() && rays.ok());
        int off = 0;
        for (std::size_t i = 0; i < rays->texels.size(); i += 4) off += std::abs(int(areas->texels[i]) - int(rays->texels[i])) > 40;
        RecordProperty(std::string(look.scene) + "_" + std::to_string(int(look.elevation)), off);
        EXPECT_LE(off, 8) << look.scene << " from " << look.elevation << " degrees: pixels of 19200";
    }
}

}  // namespace
}  // namespace burin::testing
