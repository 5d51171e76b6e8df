// Pictures of round surfaces and of depth: what stands in the relief is hidden by the relief alone, and outlines are those
// of the displaced surface.
#include <cmath>

#include <gtest/gtest.h>

#include <gl/render.hpp>

#include "../judge/context.hpp"
#include "../shader/patterns.hpp"
#include "../shader/rays.hpp"
#include "../shader/surfaces.hpp"

namespace burin::testing {
namespace {

MaterialInfo grey(float value) {
    MaterialInfo material;
    material.base_color[0] = material.base_color[1] = material.base_color[2] = value;
    material.metallic = 0.0f;
    material.roughness = 1.0f;
    return material;
}

MaterialInfo patterned(const PreparedPattern& p) {
    MaterialInfo material = grey(0.9f);
    put_pattern(p, material);
    return material;
}

// A square of 1 m at height y, seen from above.
Primitive square(float y, int material) {
    Primitive plane;
    plane.positions = {-0.5f, y, -0.5f, 0.5f, y, -0.5f, 0.5f, y, 0.5f, -0.5f, y, 0.5f};
    for (int i = 0; i < 4; ++i) plane.normals.insert(plane.normals.end(), {0, 1, 0});
    plane.uvs = {0, 0, 1, 0, 1, 1, 0, 1};
    plane.indices = {0, 2, 1, 0, 3, 2};
    plane.material = material;
    return plane;
}

double dark_share(const RgbaImage& image) {
    std::size_t dark = 0;
    for (std::size_t i = 0; i < image.texels.size(); i += 4) dark += image.texels[i] < 40;
    return double(dark) / (double(image.width) * image.height);
}

TEST(RenderDepth, ASheetStandsInTheGroovesThatAreDeeper) {
    Pattern pattern = base();
    pattern.profiles = {vee(0.2, kDepth)};
    pattern.paths = {polyline({{0.0, 0.5}, {1.0, 0.5}}, 0)};
    Asset asset;
    asset.materials = {patterned(prepare(pattern)), grey(0.0f)};
    // Where the groove is deeper than a quarter of the depth it is 0.3 m wide.
    asset.primitives = {square(0.0f, 0), square(float(-kDepth / 4), 1)};
    for (const bool orthographic : {false, true}) {
        RenderOptions options;
        options.width = options.height = 100;
        options.samples = 1;
        options.shadows = false;
        options.light.ambient = 1.0;
        options.camera.elevation = 90.0;
        options.camera.azimuth = 0.0;
        options.camera.orthographic = orthographic;
        const auto without = render_asset(asset, options);
        SKIP_WITHOUT_CONTEXT(without);
        options.correct_depth = true;
        const auto with = render_asset(asset, options);
        ASSERT_TRUE(without.ok() && with.ok());
        EXPECT_EQ(dark_share(*without), 0.0) << orthographic;
        const double square_share = 1.0 / (1.03 * 1.03);
        EXPECT_NEAR(dark_share(*with), 0.3 * square_share, 0.015) << orthographic;
    }
}

// A ball of ridges over a ground that lies deeper: its outline is not the mesh's.
TEST(RenderOutline, OfABallIsThatOfItsGround) {
    constexpr double kGround = 0.1;
    Pattern pattern;
    pattern.size = {0.25, 0.25};
    pattern.depth = 0.12;
    pattern.base_offset = kGround;
    pattern.profiles = {ridge(0.01, 0.002)};
    pattern.paths = {polyline({{0.1, 0.1}, {0.15, 0.1}}, 0)};
    const RoundSurface ball = round_surfaces()[1];
    const BaseMesh mesh = mesh_of(ball);
    Primitive primitive;
    primitive.positions = mesh.positions;
    primitive.normals = mesh.normals;
    primitive.uvs = mesh.uvs;
    primitive.indices = mesh.indices;
    primitive.frames = mesh.frames;
    // The mesh of the test faces inwards.
    for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
    Asset asset;
    asset.materials = {patterned(prepare(pattern))};
    asset.primitives = {primitive};
    RenderOptions options;
    options.width = options.height = 256;
    options.samples = 1;
    options.shadows = false;
    options.camera.orthographic = true;
    options.camera.elevation = 0.0;
    options.background = {1, 0, 0};
    const auto picture = render_asset(asset, options);
    SKIP_WITHOUT_CONTEXT(picture);
    ASSERT_TRUE(picture.ok()) << picture.error().message;
    std::size_t seen = 0;
    for (std::size_t i = 0; i < picture->texels.size(); i += 4) seen += 2 * picture->texels[i + 1] > picture->texels[i];
    const double radius = std::sqrt(double(seen) / 3.14159265) / (256 / 2 / 1.03);
    // The ray runs 0.4 m over the ball, where the second order itself is 0.003 m off.
    EXPECT_NEAR(radius, 1.0 - kGround, 0.009);
}

}  // namespace
}  // namespace burin::testing
