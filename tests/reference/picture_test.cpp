// Pictures of the reference renderer: against the shader's, whatever the number of threads, and what it refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <reference/coverage.hpp>
#include <reference/render.hpp>

#include "../judge/context.hpp"
#include "../judge/pictures.hpp"
#include "../render/part_asset.hpp"

namespace burin::testing {
namespace {

using reference::ReferenceOptions;
using reference::render_reference;

Asset scene(const char* name) { return asset_of(scenes::find_scene(name)->make().parts.at(0)); }

RenderOptions view(double elevation, double zoom) {
    RenderOptions options;
    options.backend = backend();
    options.width = 128;
    options.height = 96;
    options.camera = {.azimuth = 37.0, .elevation = elevation, .zoom = zoom, .center = Vec2{0.4, 0.45}};
    return options;
}

struct Look {
    const char* scene;
    double elevation, zoom;
};

class EachLook : public ::testing::TestWithParam<Look> {};

// Two renderers that share no way to what they show: one by exact areas in double precision, one by many rays in textures.
TEST_P(EachLook, IsThatOfTheShader) {
    const Asset asset = scene(GetParam().scene);
    RenderOptions options = view(GetParam().elevation, GetParam().zoom);
    const auto exact = render_reference(asset, {options});
    ASSERT_TRUE(exact) << exact.error().message;
    EXPECT_LE(exact->stats.mean_sum, 2e-5);
    options.samples = 16;
    options.rays = 16;
    const auto drawn = render_asset(asset, options);
    SKIP_WITHOUT_CONTEXT(drawn);
    EXPECT_GE(psnr(exact->image(), *drawn), 45.0);
}

INSTANTIATE_TEST_SUITE_P(Looks, EachLook,
                         ::testing::Values(Look{"crossing", 60.0, 6.0}, Look{"parallel_grooves", 30.0, 2.0}, Look{"letters", 60.0, 6.0},
                                           Look{"sunken_square", 40.0, 6.0}, Look{"tapered_cracks", 60.0, 8.0}, Look{"isolated_end", 30.0, 6.0}, Look{"overhang", 60.0, 6.0}),
                         [](const auto& one) { return std::string(one.param.scene); });

TEST(Picture, IsTheSameForAnyNumberOfThreads) {
    const Asset asset = scene("crossing");
    ReferenceOptions options{view(50.0, 4.0)};
    options.threads = 1;
    const auto one = render_reference(asset, options);
    options.threads = 3;
    double last = 0.0;
    options.progress = [&](double done) { last = done; };
    const auto three = render_reference(asset, options);
    ASSERT_TRUE(one && three);
    EXPECT_EQ(one->linear, three->linear);
    EXPECT_EQ(last, 1.0);
}

// Any surface may be given: here one that shows how much of it the light reaches.
TEST(Picture, TakesAnotherSurface) {
    Asset asset = scene("parallel_grooves");
    ReferenceOptions options{view(60.0, 2.0)};
    options.view.light.ambient = 0.0;
    options.view.light.strength = 1.0;
    options.brdf = [](const reference::Paint&, const glm::dvec3&, const glm::dvec3&, const glm::dvec3&) { return glm::dvec3(1.0); };
    const auto picture = render_reference(asset, options);
    ASSERT_TRUE(picture) << picture.error().message;
    for (const float value : picture->linear) {
        ASSERT_GE(value, 0.0f);
        ASSERT_LE(value, 1.0f + 1e-6f);
    }
    options.view.shadows = false;
    const auto bright = render_reference(asset, options);
    ASSERT_TRUE(bright);
    const std::size_t middle = bright->linear.size() / 2 + 3 * 64;
    EXPECT_NEAR(bright->linear[middle], 1.0f, 1e-6f);
}

TEST(Picture, NeedsAnAssetAndOptionsInRange) {
    ReferenceOptions options{view(60.0, 2.0)};
    EXPECT_EQ(render_reference(Asset{}, options).error().code, ErrorCode::invalid_input);
    const Asset asset = scene("parallel_grooves");
    options.tolerance = 0.0;
    EXPECT_EQ(render_reference(asset, options).error().code, ErrorCode::invalid_argument);
    options.tolerance = 0.01;
    options.passes = 1;
    EXPECT_EQ(render_reference(asset, options).error().code, ErrorCode::invalid_argument);
    options.passes = 12;
    options.view.width = 0;
    EXPECT_EQ(render_reference(asset, options).error().code, ErrorCode::invalid_argument);
}

// A white furnace: all around the same light, which nothing swallows. What facets show then is as bright, but for what is lost after
// the last bounce; never brighter.
class Furnace : public ::testing::TestWithParam<const char*> {
  protected:
    static ReferenceOptions furnace(int bounces) {
        ReferenceOptions options{view(50.0, 6.0)};
        options.view.width = 32;
        options.view.height = 24;
        options.view.light.strength = 0.0;
        options.bounces = bounces;
        options.directions = 6;
        options.scatter = reference::scatter_white;
        options.surround = [](const glm::dvec3&) { return glm::dvec3(1.0); };
        return options;
    }
    static double darkest(const reference::ReferencePicture& picture) { return double(*std::min_element(picture.linear.begin(), picture.linear.end())); }
    static double mean(const reference::ReferencePicture& picture) {
        double sum = 0.0;
        for (const float value : picture.linear) sum += double(value);
        return sum / double(picture.linear.size());
    }
};

TEST_P(Furnace, NothingIsBrighterThanTheLight) {
    const Asset asset = scene(GetParam());
    double before = 0.0;  // what each bounce leaves out is a part of what the one before did
    for (const int bounces : {1, 2, 3}) {
        const auto picture = render_reference(asset, furnace(bounces));
        ASSERT_TRUE(picture) << picture.error().message;
        EXPECT_LE(double(*std::max_element(picture->linear.begin(), picture->linear.end())), 1.0 + 1e-5);
        EXPECT_LT(1.0 - mean(*picture), 0.7 * (1.0 - before));
        before = mean(*picture);
    }
    EXPECT_GT(before, 0.95);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Furnace, ::testing::Values("crossing", "parallel_grooves", "sunken_square"),
                         [](const auto& one) { return std::string(one.param); });

// Mirrors: what leaves a groove after two bounces or three is all there is.
TEST(Bounces, AMirrorShowsAllThatSurroundsIt) {
    Asset asset = scene("parallel_grooves");
    for (float& channel : asset.materials[0].base_color) channel = 1.0f;
    asset.materials[0].metallic = 1.0f;
    asset.materials[0].roughness = 0.0f;
    ReferenceOptions options{view(50.0, 6.0)};
    options.view.light.strength = 0.0;
    options.bounces = 4;
    options.surround = [](const glm::dvec3&) { return glm::dvec3(1.0); };
    const auto picture = render_reference(asset, options);
    ASSERT_TRUE(picture) << picture.error().message;
    for (const float value : picture->linear) ASSERT_NEAR(value, 1.0f, 1e-4f);
}

// Two triangles that share an edge, and one before them.
TEST(Coverage, PartsOfAPixelDoNotOverlapAndLeaveNothingOut) {
    Asset asset;
    asset.materials.emplace_back();
    Primitive back, front;
    back.positions = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    back.indices = {0, 1, 2, 0, 2, 3};
    front.positions = {-0.3f, -0.4f, 0.5f, 0.6f, -0.2f, 0.5f, 0.1f, 0.7f, 0.5f};
    front.indices = {0, 1, 2};
    asset.primitives = {back, front};
    const reference::CoverageMap map(asset, glm::dmat4(1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1), 37, 23);
    reference::CoverageWork work;
    double seen_front = 0.0;
    for (int y = 0; y < 23; ++y)
        for (int x = 0; x < 37; ++x) {
            map.cover_pixel(x, y, work);
            double sum = 0.0;
            for (const reference::Covered& part : work.seen) {
                const double area = area_of(work.plane, part.polygon);
                sum += area;
                if (part.triangle->primitive == 1) seen_front += area;
            }
            EXPECT_NEAR(sum, 1.0, 1e-9) << x << ", " << y;
        }
    // Half of the cross product, in pixels of a picture that is two units wide and high.
    EXPECT_NEAR(seen_front, 0.5 * (0.9 * 1.1 - 0.4 * 0.2) * 37 * 23 / 4.0, 1e-3);
}

}  // namespace
}  // namespace burin::testing
