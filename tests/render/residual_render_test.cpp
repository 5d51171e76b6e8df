// A residual on patterns: the normals that the shader gives, against those of the surface that it was measured on.
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include <burin/rasterize.hpp>
#include <burin/residual.hpp>
#include <gl/render.hpp>

#include "../judge/context.hpp"
#include "../shader/patterns.hpp"
#include "../shader/rays.hpp"

namespace burin::testing {
namespace {

constexpr double kPi = 3.14159265358979;

// A hill of 16 mm in the lower right of the middle, and how it rises along x and y.
constexpr double kHillHeight = 0.016, kHillWidth = 0.05;
constexpr Vec2 kHill{0.55, 0.6};

double hill(Vec2 p) {
    const Vec2 d = p - kHill;
    return kHillHeight * std::exp(-dot(d, d) / (2 * kHillWidth * kHillWidth));
}

Vec2 hill_slopes(Vec2 p) { return (p - kHill) * (-hill(p) / (kHillWidth * kHillWidth)); }

Residual hill_residual(const PreparedPattern& p) {
    RasterizeOptions options;
    options.level_tolerance = 4e-5;
    const Image paths = rasterize_height(p.stored, 256, 256, options);
    Image map = paths;
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x)
            map.at(x, y) += static_cast<float>(hill({(x + 0.5) / 256, (y + 0.5) / 256}) / p.detail.depth);
    const Wrap wrap = p.detail.repeat ? Wrap::repeat : Wrap::clamp;
    auto residual = bake_residual(map, paths, {p.detail.size_u, p.detail.size_v}, p.detail.depth, wrap, {.tolerance = 0.05, .unneeded = 0.05});
    EXPECT_TRUE(residual.ok());
    return residual ? std::move(*residual) : Residual{};
}

double degrees_between(const float* a, const double* b) {
    const double cosine = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / std::sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    return std::acos(std::min(1.0, cosine)) * 180 / kPi;
}

TEST(RenderResidual, AddsTheHillToTheFacetThatIsMet) {
    const PreparedPattern p = prepare(crossing_pattern());
    ASSERT_EQ(p.detail.size_u, 1.0);
    const Residual residual = hill_residual(p);
    ASSERT_GT(residual.picture.width, 0);
    EXPECT_LE(residual.picture.width, 64);
    PathDetail detail = p.detail;
    detail.residual_scale = residual.scale;
    std::vector<PatternRay> rays;
    // From aslant, so that a residual looked up where the ray enters would be off by up to 8 mm.
    for (int k = 0; k < 4096; ++k) rays.push_back({{0.3f + 0.5f * (k % 64) / 64.0f, 0.35f + 0.5f * (k / 64) / 64.0f}, {0.4f, -0.3f}});
    const auto bare = shade_rays(p.textures, detail, rays, backend());
    SKIP_WITHOUT_CONTEXT(bare);
    const auto shaded = shade_rays(p.textures, detail, rays, backend(), residual.picture);
    ASSERT_TRUE(shaded.ok()) << shaded.error().message;
    double sum = 0.0, untouched = 0.0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const double drop = (*bare)[i].drop;
        const Vec2 place{rays[i].origin[0] + rays[i].slope[0] * drop, rays[i].origin[1] + rays[i].slope[1] * drop};
        const Vec2 s = hill_slopes(place);
        const float* n = (*bare)[i].normal;
        const double up = std::max(0.0, double(n[2]));
        const double expected[3] = {n[0] - up * s.x, n[1] - up * s.y, n[2]};
        const double angle = degrees_between((*shaded)[i].normal, expected);
        EXPECT_LT(angle, 2.0) << "at " << place.x << " " << place.y;
        sum += angle * angle;
        untouched += std::pow(degrees_between(n, expected), 2);
    }
    const double rms = std::sqrt(sum / 4096), without = std::sqrt(untouched / 4096);
    EXPECT_GT(without, 2.5);
    EXPECT_LT(rms, 0.1 * without);
}

// One texel that leans: brightness of level ground from straight above, for a light along each axis.
TEST(RenderResidual, LeansAwayFromWhereItRises) {
    const PreparedPattern p = prepare(crossing_pattern());
    Asset asset;
    MaterialInfo material;
    material.base_color[0] = material.base_color[1] = material.base_color[2] = 0.5f;
    material.metallic = 0.0f;
    put_pattern(p, material);
    // Red and green of a quarter: the surface rises along u and falls along v, a quarter of the scale each.
    material.residual = {1, 1, {96, 96, 255, 255}};
    material.detail.residual_scale = 1.2;
    const double slope = 1.2 * (1 - 96 / 127.5);
    asset.materials.push_back(material);
    asset.primitives.push_back({{-0.5f, 0, -0.5f, 0.5f, 0, -0.5f, 0.5f, 0, 0.5f, -0.5f, 0, 0.5f},
                                {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}, {0, 0, 1, 0, 1, 1, 0, 1}, {0, 2, 1, 0, 3, 2}, 0});
    RenderOptions options;
    options.width = options.height = 16;
    options.samples = 1;
    options.camera = {.azimuth = 0, .elevation = 90, .zoom = 16, .orthographic = true, .center = Vec2{0.12, 0.12}};
    options.light.ambient = 0.0;
    options.shadows = false;
    options.backend = backend();
    for (const double azimuth : {90.0, -90.0, 0.0, 180.0}) {
        options.light.azimuth = azimuth;
        const auto picture = render_asset(asset, options);
        SKIP_WITHOUT_CONTEXT(picture);
        ASSERT_TRUE(picture.ok()) << picture.error().message;
        // World x is u, world z is v.
        const double a = azimuth * kPi / 180, e = options.light.elevation * kPi / 180;
        const double cosine = (-slope * std::sin(a) * std::cos(e) + slope * std::cos(a) * std::cos(e) + std::sin(e)) /
                              std::sqrt(1 + 2 * slope * slope);
        const double seen = picture->texels[4 * (8 * 16 + 8)] / 255.0;
        const double linear = std::pow((seen + 0.055) / 1.055, 2.4), diffuse = 0.5 / kPi * options.light.strength * cosine;
        // The specular part of a rough dielectric adds a little.
        EXPECT_GT(linear, diffuse * 0.9) << azimuth;
        EXPECT_LT(linear, diffuse * 1.2 + 0.02) << azimuth;
    }
}

TEST(RenderResidual, UprightAndUndercutFacetsKeepTheirNormals) {
    const PreparedPattern p = prepare(overhang_pattern());
    const RgbaImage picture{1, 1, {30, 200, 255, 255}};
    std::vector<PatternRay> rays;
    for (int k = 0; k < 4096; ++k) rays.push_back({{(k % 64 + 0.5f) / 64.0f, (k / 64 + 0.5f) / 64.0f}, {2.5f, 1.5f}});
    const auto bare = shade_rays(p.textures, p.detail, rays, backend());
    SKIP_WITHOUT_CONTEXT(bare);
    const auto shaded = shade_rays(p.textures, p.detail, rays, backend(), picture);
    ASSERT_TRUE(shaded.ok());
    int upright = 0, up = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const float *a = (*bare)[i].normal, *b = (*shaded)[i].normal;
        const bool same = std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) < 1e-4f;
        EXPECT_EQ(same, a[2] <= 1e-5f) << a[2];
        (a[2] <= 1e-5f ? upright : up) += 1;
    }
    EXPECT_GT(upright, 20);
    EXPECT_GT(up, 1000);
}

}  // namespace
}  // namespace burin::testing
