// Glass: by the formulas of Fresnel and Snell alone, as slabs whose light is known in closed form, and in a white furnace.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <reference/render.hpp>

#include "../render/part_asset.hpp"

namespace burin::testing {
namespace {

using reference::Paint;
using reference::ReferenceOptions;
using reference::ReferencePicture;
using reference::render_reference;
using reference::Scattered;

Asset scene(const char* name) { return asset_of(scenes::find_scene(name)->make().parts.at(0)); }

// Clear glass; `thickness` 0: a thin sheet.
Asset glass(Asset asset, float thickness, float index = 1.5f) {
    MaterialInfo& material = asset.materials[0];
    for (float& channel : material.base_color) channel = 1.0f;
    material.metallic = material.roughness = 0.0f;
    material.transmission = 1.0f;
    material.thickness = thickness;
    material.ior = index;
    return asset;
}

Asset smooth(Asset asset) {
    asset.materials[0].has_detail = false;
    return asset;
}

ReferenceOptions small_view(double elevation, double zoom) {
    ReferenceOptions options;
    options.view.width = 24;
    options.view.height = 18;
    options.view.camera = {.azimuth = 37.0, .elevation = elevation, .zoom = zoom, .orthographic = true};
    options.view.light.strength = 0.0;
    options.passes = 12;
    return options;
}

ReferencePicture draw(const Asset& asset, const ReferenceOptions& options) {
    auto picture = render_reference(asset, options);
    EXPECT_TRUE(picture) << picture.error().message;
    return picture ? *picture : ReferencePicture{};
}

glm::dvec3 middle(const ReferencePicture& picture) {
    const std::size_t at = 3 * (std::size_t(picture.height / 2) * std::size_t(picture.width) + std::size_t(picture.width / 2));
    return {double(picture.linear[at]), double(picture.linear[at + 1]), double(picture.linear[at + 2])};
}

// A surround that says by its colour where it is looked at.
glm::dvec3 coded(const glm::dvec3& d) { return d * 0.5 + 0.5; }

glm::dvec3 toward_eye(double azimuth, double elevation) {
    const double a = glm::radians(azimuth), e = glm::radians(elevation);
    return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

std::vector<Scattered> scatter(const Paint& paint, const glm::dvec3& to_eye) {
    std::vector<Scattered> out;
    reference::scatter_metallic_roughness(paint, {0, 0, 1}, to_eye, 16, 7, out);
    return out;
}

Paint clear_glass(double index, double rough = 0.0) {
    Paint paint;
    paint.index = index;
    paint.transmission = 1.0;
    paint.rough = rough;
    return paint;
}

TEST(Fresnel, AgreesWithClosedForms) {
    for (const double n : {1.1, 1.33, 1.5, 2.4}) {
        EXPECT_NEAR(reference::fresnel_reflectance(1.0, 1.0 / n), std::pow((n - 1.0) / (n + 1.0), 2.0), 1e-12);
        EXPECT_NEAR(reference::fresnel_reflectance(1.0, n), std::pow((n - 1.0) / (n + 1.0), 2.0), 1e-12);
        // Brewster's angle: one polarization is not mirrored, and the other by cos² of twice the angle.
        const double brewster = std::atan(n);
        EXPECT_NEAR(reference::fresnel_reflectance(std::cos(brewster), 1.0 / n), 0.5 * std::pow(std::cos(2.0 * brewster), 2.0), 1e-12);
        EXPECT_NEAR(reference::fresnel_reflectance(1e-9, 1.0 / n), 1.0, 1e-6);
        const double critical = std::asin(1.0 / n);
        EXPECT_EQ(reference::fresnel_reflectance(std::cos(critical + 1e-6), n), 1.0);
        EXPECT_LT(reference::fresnel_reflectance(std::cos(critical - 1e-3), n), 1.0);
        // The same both ways along one ray.
        const double outside = std::cos(0.7), inside = std::sqrt(1.0 - std::pow(std::sin(0.7) / n, 2.0));
        EXPECT_NEAR(reference::fresnel_reflectance(outside, 1.0 / n), reference::fresnel_reflectance(inside, n), 1e-12);
    }
}

TEST(Scattering, OfGlassBendsBySnellsLawAndLosesNothing) {
    for (const double angle : {0.0, 0.3, 0.9, 1.4})
        for (const bool within : {false, true}) {
            const glm::dvec3 to_eye(std::sin(angle), 0.0, within ? -std::cos(angle) : std::cos(angle));
            const auto ways = scatter(clear_glass(1.5), to_eye);
            double sum = 0.0;
            for (const Scattered& way : ways) {
                sum += way.weight.x;
                const bool passes = way.direction.z * to_eye.z < 0.0;
                EXPECT_NEAR(way.direction.x, -std::sin(angle) * (!passes ? 1.0 : within ? 1.5 : 1.0 / 1.5), 1e-12);
                EXPECT_NEAR(glm::length(way.direction), 1.0, 1e-12);
            }
            EXPECT_NEAR(sum, 1.0, 1e-12);
            EXPECT_EQ(ways.size(), within && std::sin(angle) > 1.0 / 1.5 ? 1u : 2u) << angle << within;
        }
}

TEST(Scattering, OfRoughAndThinGlassLosesNothing) {
    for (const double rough : {0.3, 0.7, 1.0})
        for (const bool within : {false, true})
            for (const bool thin : {false, true}) {
                Paint paint = clear_glass(1.5, rough);
                paint.thin = thin;
                double sum = 0.0;
                for (const Scattered& way : scatter(paint, glm::normalize(glm::dvec3(0.5, 0.2, within ? -0.6 : 0.6)))) sum += way.weight.x;
                EXPECT_NEAR(sum, 1.0, 1e-9);
            }
}

// What a slab mirrors and lets through after all that happens between its sides.
struct SlabLight {
    double mirrored, through;
};
SlabLight slab_light(double elevation, double index) {
    const double r = reference::fresnel_reflectance(std::sin(glm::radians(elevation)), 1.0 / index);
    return {2.0 * r / (1.0 + r), (1.0 - r) / (1.0 + r)};
}

// A plane without another side, and no pattern: parallel sides.
TEST(Slab, ShowsWhatIsBehindItInTheUnrefractedDirection) {
    const Asset asset = glass(smooth(scene("parallel_grooves")), 0.002f, 1.7f);
    for (const double elevation : {80.0, 50.0, 20.0}) {
        ReferenceOptions options = small_view(elevation, 4.0);
        options.surround = coded;
        const glm::dvec3 to_eye = toward_eye(37.0, elevation), mirrored(-to_eye.x, to_eye.y, -to_eye.z);
        const SlabLight light = slab_light(elevation, 1.7);
        const glm::dvec3 expected = coded(mirrored) * light.mirrored + coded(-to_eye) * light.through, shown = middle(draw(asset, options));
        // The faintest beams are followed by lot.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], expected[c], 1e-3) << elevation;
    }
}

// A thin wall does not bend light, and is passed once.
TEST(Slab, ThatIsThinShowsWhatIsBehindIt) {
    const Asset asset = glass(smooth(scene("parallel_grooves")), 0.0f);
    ReferenceOptions options = small_view(50.0, 4.0);
    options.surround = coded;
    const glm::dvec3 to_eye = toward_eye(37.0, 50.0), mirrored(-to_eye.x, to_eye.y, -to_eye.z);
    const double r = reference::fresnel_reflectance(std::sin(glm::radians(50.0)), 1.0 / 1.5);
    const glm::dvec3 expected = coded(mirrored) * r + coded(-to_eye) * (1.0 - r), shown = middle(draw(asset, options));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], expected[c], 1e-6);
}

// Half of the light is left after each attenuation distance in the glass.
TEST(Slab, TakesLightAwayByBeersLaw) {
    Asset asset = glass(smooth(scene("parallel_grooves")), 0.002f, 1.0001f);  // hardly mirrors
    asset.materials[0].attenuation_distance = 0.001f;
    for (float& channel : asset.materials[0].attenuation_color) channel = 0.5f;
    ReferenceOptions options = small_view(30.0, 4.0);
    options.surround = [](const glm::dvec3&) { return glm::dvec3(1.0); };
    EXPECT_NEAR(middle(draw(asset, options)).x, std::pow(0.5, 2.0 / std::sin(glm::radians(30.0))), 1e-3);
}

// Close to one facet of a groove, which with the flat side behind makes a prism: what comes through it comes from where Snell's law says.
TEST(Prism, OfAFacetAndAFlatSideBendsAsSnellsLawSays) {
    const double slope = 0.4, half = 0.05, index = 1.5;
    scenes::Part part = scenes::find_scene("parallel_grooves")->make().parts.at(0);
    part.pattern.profiles = {Profile{{{-half, 0.0}, {0.0, -half * slope}, {half, 0.0}}, {}}};
    part.pattern.depth = half * slope;
    part.pattern.size = {0.4, 0.4};
    part.pattern.paths = {scenes::Stroke({0.2, 0.0}).line({0.2, 0.4}).close_across().path(0)};
    part.mesh = scenes::make_rectangle({0.4, 0.4});
    const Asset asset = glass(asset_of(part), 0.01f);
    ReferenceOptions options = small_view(90.0, 400.0);
    options.view.camera.azimuth = 0.0;
    options.view.camera.center = Vec2{0.5 + 0.5 * half / 0.4, 0.5};
    // From above onto the facet that rises to the right; x of the world is x of the pattern.
    const double on = std::atan(slope), bent = std::asin(std::sin(on) / index), down = on - bent, out = std::asin(std::sin(down) * index);
    // To the side where the glass is thicker.
    const glm::dvec3 expected(std::sin(out), -std::cos(out), 0.0);
    options.surround = [&](const glm::dvec3& d) { return glm::dvec3(glm::dot(d, expected) > std::cos(1e-4) ? 1.0 : 0.0); };
    const double enters = 1.0 - reference::fresnel_reflectance(std::cos(on), 1.0 / index), leaves = 1.0 - reference::fresnel_reflectance(std::cos(down), index);
    EXPECT_NEAR(middle(draw(asset, options)).x, enters * leaves, 1e-5);
}

// Lossless glass in even light can not be seen, whatever its shape.
class GlassFurnace : public ::testing::TestWithParam<const char*> {};

TEST_P(GlassFurnace, IsAsBrightAsTheLightEverywhere) {
    for (const float thickness : {0.0f, 0.01f})
        for (const float rough : {0.0f, 0.5f}) {
            Asset asset = glass(scene(GetParam()), thickness);
            asset.materials[0].roughness = rough;
            ReferenceOptions options = small_view(40.0, 3.0);
            options.directions = 2;
            options.passes = 24;
            options.view.background = {1.0f, 1.0f, 1.0f};
            options.surround = [](const glm::dvec3&) { return glm::dvec3(1.0); };
            const ReferencePicture picture = draw(asset, options);
            for (const float value : picture.linear) ASSERT_NEAR(value, 1.0f, 2e-3f) << thickness << rough;
            // What was cut off counts as bright, too: it must be little for this to say anything.
            EXPECT_LT(picture.stats.cut_off, 0.02) << thickness << rough;
        }
}

INSTANTIATE_TEST_SUITE_P(Scenes, GlassFurnace, ::testing::Values("parallel_grooves", "crossing", "sunken_square", "grooved_sphere"),
                         [](const auto& one) { return std::string(one.param); });

TEST(Glass, IsTheSameForAnyNumberOfThreads) {
    const Asset asset = glass(scene("grooved_sphere"), 0.2f);
    ReferenceOptions options = small_view(25.0, 1.0);
    options.surround = coded;
    options.threads = 1;
    const ReferencePicture one = draw(asset, options);
    options.threads = 3;
    EXPECT_EQ(one.linear, draw(asset, options).linear);
}

}  // namespace
}  // namespace burin::testing
