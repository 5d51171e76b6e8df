// Light from all around: as the shader has it where nothing hides it, and never more of it than there is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <glm/geometric.hpp>

#include <reference/environment.hpp>
#include <reference/render.hpp>

#include "../judge/context.hpp"
#include "../render/part_asset.hpp"

namespace burin::testing {
namespace {

using reference::EnvironmentLight;
using reference::ReferenceOptions;
using reference::render_reference;

struct Finish {
    const char* name;
    float grey, metallic, roughness;
};

Asset finished(Asset asset, const Finish& finish) {
    MaterialInfo& material = asset.materials[0];
    for (int c = 0; c < 3; ++c) material.base_color[c] = finish.grey;
    material.metallic = finish.metallic;
    material.roughness = finish.roughness;
    return asset;
}

Asset scene(const char* name, const Finish& finish) { return finished(asset_of(scenes::find_scene(name)->make().parts.at(0)), finish); }

RenderOptions lit_view(int width, int height, std::shared_ptr<const RadianceMap> map = nullptr) {
    RenderOptions options;
    options.backend = backend();
    options.width = width;
    options.height = height;
    options.camera = {.azimuth = 37.0, .elevation = 50.0, .zoom = 5.0};
    options.light.strength = 0.0;
    options.environment = Environment{std::move(map), 40.0, 1.2};
    return options;
}

double mean(const RgbaImage& picture) {
    double sum = 0.0;
    for (std::size_t i = 0; i < picture.texels.size(); i += 4) sum += double(picture.texels[i]);
    return sum / double(picture.texels.size() / 4);
}

class EachFinish : public ::testing::TestWithParam<Finish> {};

// The shader has the light of a whole lobe from tables, and what a matt surface gathers to within some per cent; here it is many directions.
TEST_P(EachFinish, OnAPlaneIsThatOfTheShader) {
    Asset asset = scene("parallel_grooves", GetParam());
    asset.materials[0].has_detail = false;
    ReferenceOptions options{lit_view(32, 24)};
    options.directions = 256;
    const auto exact = render_reference(asset, options);
    ASSERT_TRUE(exact) << exact.error().message;
    const auto drawn = render_asset(asset, options.view);
    SKIP_WITHOUT_CONTEXT(drawn);
    EXPECT_NEAR(mean(exact->image()), mean(*drawn), 3.0);  // of 255
    EXPECT_GT(mean(*drawn), 20.0);
}

INSTANTIATE_TEST_SUITE_P(Finishes, EachFinish,
                         ::testing::Values(Finish{"matt", 0.8f, 0.0f, 1.0f}, Finish{"glossy", 0.3f, 0.0f, 0.3f}, Finish{"mirror", 0.9f, 1.0f, 0.0f}),
                         [](const auto& one) { return std::string(one.param.name); });

// For the lobes of rough metals, which the shader has as seen from straight above: the lamp's own formula, for each of many lamps that make
// up the room.
TEST(Environment, OnRoughMetalIsTheSumOfAllItsLamps) {
    for (const Finish finish : {Finish{"brushed", 0.9f, 1.0f, 0.4f}, Finish{"half", 0.9f, 1.0f, 0.6f}}) {
        Asset asset = scene("parallel_grooves", finish);
        asset.materials[0].has_detail = false;
        ReferenceOptions options{lit_view(8, 6)};
        options.view.camera.orthographic = true;
        options.directions = 1024;
        const auto picture = render_reference(asset, options);
        ASSERT_TRUE(picture) << picture.error().message;
        const reference::Paint paint{glm::dvec3(0.9), 1.0, double(finish.roughness)};
        const EnvironmentLight light(*options.view.environment);
        const double a = 37.0 * M_PI / 180.0, e = 50.0 * M_PI / 180.0;
        const glm::dvec3 to_eye(std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)), up(0, 1, 0);
        const reference::Paint white{glm::dvec3(1.0), 1.0, double(finish.roughness)};
        double sum = 0.0, once = 0.0;
        constexpr int kRings = 400;
        for (int i = 0; i < kRings; ++i)
            for (int k = 0; k < 4 * kRings; ++k) {
                const double fall = (i + 0.5) / kRings * M_PI / 2.0, turn = (k + 0.5) / (4 * kRings) * 2.0 * M_PI;
                const glm::dvec3 d(std::sin(fall) * std::cos(turn), std::cos(fall), std::sin(fall) * std::sin(turn));
                const double solid = std::sin(fall) * (M_PI / 2.0 / kRings) * (2.0 * M_PI / (4 * kRings));
                sum += reference::metallic_roughness(paint, up, d, to_eye).x * light.radiance(d, 0.0).x * solid;
                once += reference::metallic_roughness(white, up, d, to_eye).x * solid;
            }
        // A lamp's formula leaves out what facets mirror more than once; a white metal then gives all back.
        const double expected = sum * (1.0 + 0.9 * (1.0 / once - 1.0));
        EXPECT_NEAR(double(picture->linear[0]), expected, 0.02 * expected) << finish.name;
    }
}

// However rough: a white metal gives all back.
TEST(Scattering, OfWhiteThingsLosesNothing) {
    for (const double metal : {0.0, 1.0})
        for (const double rough : {0.0, 0.3, 0.6, 1.0})
            for (const double cosine : {0.15, 0.5, 0.9}) {
                std::vector<reference::Scattered> out;
                reference::scatter_metallic_roughness({glm::dvec3(1.0), metal, rough}, {0, 0, 1}, {std::sqrt(1.0 - cosine * cosine), 0.0, cosine}, 1024, 5, out);
                double sum = 0.0;
                for (const auto& way : out) sum += way.weight.x;
                EXPECT_NEAR(sum, 1.0, rough > 0.0 ? 1e-9 : 0.005) << metal << " " << rough << " " << cosine;
            }
}

// One bright texel of a picture, where the axes of radiance.hpp say.
TEST(EnvironmentLight, LiesWhereThePictureSays) {
    auto map = std::make_shared<RadianceMap>();
    map->width = 64, map->height = 32;
    map->texels.assign(std::size_t(64 * 32 * 3), 0.0f);
    const int column = 40, row = 10;
    for (std::size_t c = 0; c < 3; ++c) map->texels[3 * (std::size_t(row) * 64 + std::size_t(column)) + c] = 5.0f;
    const double pi = 3.14159265358979, turn = (2.0 * (column + 0.5) / 64.0 - 1.0) * pi, fall = (row + 0.5) / 32.0 * pi;
    const glm::dvec3 there(std::sin(fall) * std::cos(turn), std::cos(fall), std::sin(fall) * std::sin(turn));
    const EnvironmentLight light({map, 0.0, 2.0});
    EXPECT_NEAR(light.radiance(there, 0.0).x, 10.0, 1e-4);
    EXPECT_EQ(light.radiance(-there, 0.0).x, 0.0);
    // Of all directions together it is the mean over the sphere.
    const double part = 2.0 * pi / 64.0 * pi / 32.0 * std::sin(fall) / (4.0 * pi);
    EXPECT_LT(light.radiance(there, 4.0 * pi).x, 10.0 * part * 16.0);
    // Turned towards larger azimuths.
    const EnvironmentLight turned({map, 90.0, 2.0});
    EXPECT_NEAR(turned.radiance({there.z, there.y, -there.x}, 0.0).x, 10.0, 1e-4);
}

// White facets in even light swallow nothing: each bounce leaves less out, and none makes more of it.
TEST(Environment, IsNeverMadeBrighterByGrooves) {
    auto even = std::make_shared<RadianceMap>(RadianceMap{32, 16, std::vector<float>(32 * 16 * 3, 1.0f)});
    for (const Finish finish : {Finish{"matt", 1.0f, 0.0f, 1.0f}, Finish{"mirror", 1.0f, 1.0f, 0.0f}, Finish{"brushed", 1.0f, 1.0f, 0.5f}}) {
        const Asset asset = scene("parallel_grooves", finish);
        double before = 0.0;
        for (const int bounces : {0, 2, 6}) {
            ReferenceOptions options{lit_view(24, 18, even)};
            options.view.environment->strength = 1.0;
            options.bounces = bounces;
            options.directions = 32;
            const auto picture = render_reference(asset, options);
            ASSERT_TRUE(picture) << picture.error().message;
            double sum = 0.0;
            for (const float value : picture->linear) {
                EXPECT_LE(value, 1.0f + 1e-5f) << finish.name;
                sum += double(value);
            }
            EXPECT_GE(sum / double(picture->linear.size()), before) << finish.name;
            before = sum / double(picture->linear.size());
        }
        EXPECT_GT(before, 0.97) << finish.name;
    }
}

}  // namespace
}  // namespace burin::testing
