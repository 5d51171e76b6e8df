// Pictures of the off-screen renderer against pictures made by the decoder on the CPU, and top views against
// heights.
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <set>

#include <gtest/gtest.h>

#include <burin/rasterize.hpp>
#include <cpp/decode.hpp>
#include <gl/render.hpp>

#include "../judge/context.hpp"
#include "../judge/pictures.hpp"
#include "../shader/patterns.hpp"
#include "../shader/rays.hpp"

namespace burin::testing {
namespace {

// A plane as make_plane lays it out, with the pattern on it.
Asset plane_with(const PreparedPattern& p, bool patterned = true) {
    Asset asset;
    MaterialInfo material;
    material.base_color[0] = material.base_color[1] = material.base_color[2] = 0.5f;
    material.metallic = 0.0f;
    material.roughness = 1.0f;
    put_pattern(p, material);
    material.has_detail = patterned;
    asset.materials.push_back(material);
    const float x = float(p.detail.size_u / 2), z = float(p.detail.size_v / 2);
    Primitive plane;
    plane.positions = {-x, 0, -z, x, 0, -z, x, 0, z, -x, 0, z};
    for (int i = 0; i < 4; ++i) plane.normals.insert(plane.normals.end(), {0, 1, 0});
    plane.uvs = {0, 0, 1, 0, 1, 1, 0, 1};
    plane.indices = {0, 2, 1, 0, 3, 2};
    asset.primitives.push_back(plane);
    return asset;
}

TEST(RenderTop, EqualsDecoder) {
    for (const Pattern& pattern : {corner_pattern(JoinKind::round), plateau_pattern(), clamped_pattern()}) {
        const PreparedPattern p = prepare(pattern);
        // Wider than one tile of the renderer, and neither side a multiple of it.
        auto top = render_top(plane_with(p), 700, 530, {.backend = backend()});
        SKIP_WITHOUT_CONTEXT(top);
        ASSERT_TRUE(top.ok()) << top.error().message;
        const Image expected = decode_top(p.textures, p.detail, 700, 530);
        int off = 0;
        for (std::size_t i = 0; i < expected.texels.size(); ++i)
            off += std::abs(expected.texels[i] - top->texels[i]) > 1e-4f;
        // Points on the edge of a wall may fall to either side.
        EXPECT_LE(off, 8);
    }
}

TEST(RenderTop, BoxOfSamplesEqualsRasterizer) {
    const PreparedPattern p = prepare(crossing_pattern());
    auto top = render_top(plane_with(p), 128, 128, {.samples = 4, .backend = backend()});
    SKIP_WITHOUT_CONTEXT(top);
    ASSERT_TRUE(top.ok()) << top.error().message;
    RasterizeOptions options;
    options.level_tolerance = 4e-5;
    const Image expected = rasterize_height(p.stored, 128, 128, options);
    double worst = 0.0;
    for (std::size_t i = 0; i < expected.texels.size(); ++i)
        worst = std::max(worst, double(std::abs(expected.texels[i] - top->texels[i])));
    // Both average 4 x 4 points; texels of one plane are exact in the rasterizer.
    EXPECT_LT(worst, 0.03);
}

// What the picture of a plane from straight above by an orthographic camera has at a point of the pattern:
// Lambert and the sky, shadow by the decoder.
double expected_light(const PreparedPattern& p, Vec2 at, const RenderOptions& options, bool& edge) {
    const Decoder decoder(p.textures, p.detail);
    const DecodedHit hit = decoder.trace(at, {0, 0});
    const double a = options.light.azimuth * 3.14159265358979 / 180,
                 e = options.light.elevation * 3.14159265358979 / 180;
    // World x is pattern x, world z is pattern y, world y is up.
    const double light[3] = {std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e)};
    const double cosine = hit.normal[0] * light[0] + hit.normal[1] * light[1] + hit.normal[2] * light[2];
    const Vec2 slope{-light[0] / light[2], -light[1] / light[2]};
    const auto blocked = [&](double drop) {
        return decoder.trace(at - slope * drop, slope).drop < drop - 0.004 * p.detail.depth;
    };
    const bool shadow = blocked(hit.drop);
    for (const Vec2 way : {Vec2{0.002, 0}, Vec2{-0.002, 0}, Vec2{0, 0.002}, Vec2{0, -0.002}}) {
        const DecodedHit near = decoder.trace(at + way, {0, 0});
        const bool near_shadow =
            decoder.trace(at + way - slope * near.drop, slope).drop < near.drop - 0.004 * p.detail.depth;
        edge = edge || near.facet != hit.facet || near.element != hit.element || near_shadow != shadow;
    }
    return cosine > 0.0 && !shadow ? cosine : 0.0;
}

TEST(RenderAsset, LightAndShadowAsTheDecoderSays) {
    for (const Pattern& pattern : {crossing_pattern(), plateau_pattern(), overhang_pattern()}) {
        const PreparedPattern p = prepare(pattern);
        RenderOptions options;
        options.width = options.height = 96;
        options.samples = 1;
        options.antialiasing = Antialiasing::points;
        options.camera.orthographic = true;
        options.camera.azimuth = 0;
        options.camera.elevation = 90;
        options.light.ambient = 0.0;
        options.backend = backend();
        auto picture = render_asset(plane_with(p), options);
        SKIP_WITHOUT_CONTEXT(picture);
        ASSERT_TRUE(picture.ok()) << picture.error().message;
        // The camera shows 1.03 times the larger side.
        const double view = 1.03 * std::max(p.detail.size_u, p.detail.size_v);
        int asked = 0, wrong = 0, dark = 0;
        for (int y = 0; y < options.height; ++y)
            for (int x = 0; x < options.width; ++x) {
                const Vec2 at{p.detail.size_u / 2 + ((x + 0.5) / options.width - 0.5) * view,
                              p.detail.size_v / 2 + ((y + 0.5) / options.height - 0.5) * view};
                if (at.x < 0.01 || at.y < 0.01 || at.x > p.detail.size_u - 0.01 ||
                    at.y > p.detail.size_v - 0.01)
                    continue;
                bool edge = false;
                const double cosine = expected_light(p, at, options, edge);
                if (edge) continue;
                const double seen = picture->texels[4 * std::size_t(y * options.width + x)];
                // Diffuse part alone: the specular part of a rough dielectric adds a little.
                const double linear = std::pow((seen / 255.0 + 0.055) / 1.055, 2.4);
                const double diffuse = 0.5 / 3.14159265 * options.light.strength * cosine;
                ++asked;
                dark += cosine == 0.0;
                wrong += cosine == 0.0 ? seen > 1 : linear < diffuse * 0.85 || linear > diffuse * 1.35 + 0.02;
            }
        EXPECT_GT(asked, 4000);
        EXPECT_LE(wrong, asked / 500) << "of " << asked << ", dark " << dark;
    }
}

// Root mean square of the difference of two pictures, in steps of 8 bits.
double difference(const RgbaImage& a, const RgbaImage& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) {
        const double d = double(a.texels[i]) - double(b.texels[i]);
        sum += d * d;
    }
    return std::sqrt(sum / double(a.texels.size()));
}

// Features as areas against so many rays that their own error is small.
TEST(RenderAsset, RegionsAreTheMeanOfRays) {
    for (const Pattern& pattern : {crossing_pattern(), plateau_pattern(), overhang_pattern(), sine_pattern()})
        for (const double elevation : {90.0, 50.0, 15.0}) {
            RenderOptions options;
            options.width = options.height = 48;
            options.camera.azimuth = 20;
            options.camera.elevation = elevation;
            options.camera.zoom = elevation > 20.0 ? 3.0 : 8.0;  // no border of the plane: that is the mesh's, not the pattern's
            options.backend = backend();
            options.samples = 1;
            options.rays = 16;
            const Asset plane = plane_with(prepare(pattern));
            const auto regions = render_asset(plane, options);
            SKIP_WITHOUT_CONTEXT(regions);
            options.antialiasing = Antialiasing::points;
            options.samples = 36;
            const auto rays = render_asset(plane, options);
            options.samples = 1;
            const auto single = render_asset(plane, options);
            ASSERT_TRUE(regions.ok() && rays.ok() && single.ok());
            const double error = difference(*regions, *rays);
            EXPECT_LT(error, 1.3) << "elevation " << elevation;
            EXPECT_LT(error, 0.6 * difference(*single, *rays)) << "elevation " << elevation;
        }
}

// A groove with lips runs squarely into another one: light and sight pass through where it opens, and its lips throw shadows
// down into what it opens to.
TEST(RenderAsset, RegionsEndAtATee) {
    Pattern pattern = base(kRise);
    pattern.profiles = {groove(0.05, 0.012), lipped(0.04, 0.010, 0.006)};
    pattern.paths = {polyline({{0.1, 0.5}, {0.9, 0.5}}, 0), polyline({{0.5, 0.9}, {0.5, 0.5}}, 1)};
    const Asset plane = plane_with(prepare(pattern));
    for (const double azimuth : {20.0, 110.0, 200.0, 290.0}) {
        RenderOptions options;
        options.width = options.height = 48;
        options.camera.azimuth = azimuth;
        options.camera.elevation = 60.0;
        options.camera.zoom = 5.0;
        options.light.elevation = 35.0;
        options.light.azimuth = azimuth + 60.0;
        options.backend = backend();
        options.samples = 1;
        options.rays = 16;
        const auto regions = render_asset(plane, options);
        SKIP_WITHOUT_CONTEXT(regions);
        options.antialiasing = Antialiasing::points;
        options.samples = 36;
        const auto rays = render_asset(plane, options);
        ASSERT_TRUE(regions.ok() && rays.ok());
        int off = 0;
        for (std::size_t i = 0; i < rays->texels.size(); ++i) off += std::abs(int(regions->texels[i]) - int(rays->texels[i])) > 24;
        EXPECT_EQ(off, 0) << "azimuth " << azimuth;
        EXPECT_LT(difference(*regions, *rays), 0.8) << "azimuth " << azimuth;
    }
}

// At the outline of a plain square a pixel has as many shades as samples can lie in it, and one more.
TEST(RenderAsset, TwoSamplesAreTwo) {
    const Asset plane = plane_with(prepare(crossing_pattern()), false);
    RenderOptions options{.width = 64, .height = 48, .samples = 2, .antialiasing = Antialiasing::points, .backend = backend()};
    options.camera.orthographic = true;
    options.light.strength = 0.0;
    for (const Antialiasing kind : {Antialiasing::points, Antialiasing::regions}) {
        options.antialiasing = kind;
        const auto picture = render_asset(plane, options);
        SKIP_WITHOUT_CONTEXT(picture);
        std::set<int> shades;
        for (std::size_t i = 0; i < picture->texels.size(); i += 4) shades.insert(picture->texels[i]);
        EXPECT_EQ(shades.size(), 3u);
    }
}

// As areas the two halves of a pixel come to what the whole pixel does, but for the plane's own outline, which one sample asks rays for.
TEST(RenderAsset, TwoSamplesAreTheHalvesOfAPixel) {
    const Asset plane = plane_with(prepare(crossing_pattern()));
    RenderOptions options{.width = 120, .height = 90, .backend = backend()};
    const auto drawn = [&](int samples) {
        options.samples = samples;
        return render_asset(plane, options);
    };
    const auto best = drawn(16), two = drawn(2), one = drawn(1);
    SKIP_WITHOUT_CONTEXT(two);
    ASSERT_TRUE(best.ok() && one.ok());
    const double error_of_two = psnr(*two, *best), error_of_one = psnr(*one, *best);
    std::printf("two samples %.1f dB, one %.1f dB\n", error_of_two, error_of_one);
    EXPECT_GT(error_of_two, 36.0);
    EXPECT_GT(error_of_one, 50.0);
}

// What an engine does in one run of the shader, and what suits a CPU. Seen in parallel, since one run takes a pixel's rays parallel, and
// so near that the plane's own outline, for which runs of rays ask besides, is not seen.
void expect_one_run_draws_the_same(RenderOptions options) {
    options.camera.orthographic = true;
    const Asset plane = plane_with(prepare(crossing_pattern()));
    const auto runs = render_asset(plane, options);
    SKIP_WITHOUT_CONTEXT(runs);
    options.one_run = true;
    const auto one = render_asset(plane, options);
    ASSERT_TRUE(runs.ok() && one.ok());
    for (std::size_t i = 0; i < runs->texels.size(); ++i) EXPECT_NEAR(runs->texels[i], one->texels[i], 1) << i;
}

TEST(RenderAsset, OneRunDrawsTheSame) {
    RenderOptions options{.width = 48, .height = 48, .samples = 1, .rays = 4, .backend = backend()};
    options.camera.zoom = 3.0;
    expect_one_run_draws_the_same(options);
}

// Where the rays of a pixel leave the middles of their cells, and belong to several samples.
TEST(RenderAsset, OneRunMovesTheSameRays) {
    RenderOptions options{.width = 48, .height = 48, .samples = 4, .rays = 4, .backend = backend()};
    options.camera.elevation = 12.0;
    options.camera.zoom = 8.0;
    expect_one_run_draws_the_same(options);
}

// From where a cell is a few pixels to where a pixel is many cells.
TEST(RenderAsset, MeanLightStaysFromFarAway) {
    const PreparedPattern p = prepare(crossing_pattern());
    const Asset plane = plane_with(p);
    RenderOptions options;
    options.camera.orthographic = true;
    options.camera.elevation = 90;
    options.camera.azimuth = 0;
    options.camera.zoom = 1.03;  // the plane and nothing else
    options.samples = 1;
    options.backend = backend();
    double first = 0.0;
    for (const int side : {96, 24, 6, 3, 2, 1}) {
        options.width = options.height = side;
        const auto picture = render_asset(plane, options);
        SKIP_WITHOUT_CONTEXT(picture);
        ASSERT_TRUE(picture.ok()) << picture.error().message;
        double sum = 0.0;
        for (std::size_t i = 0; i < picture->texels.size(); i += 4)
            sum += std::pow((picture->texels[i] / 255.0 + 0.055) / 1.055, 2.4);
        const double mean = sum / double(side * side);
        if (first == 0.0) first = mean;
        EXPECT_NEAR(mean / first, 1.0, 0.01) << side << " pixels";
    }
}

// The ground lies below the object surface, so that slanted rays leave a clamped map above it. What they meet outside is
// level and lit.
TEST(RenderAsset, GroundOutsideClampedMapsIsLit) {
    Pattern pattern = clamped_pattern();
    pattern.paths.clear();
    pattern.base_offset = 0.5 * pattern.depth;
    const PreparedPattern p = prepare(pattern);
    RenderOptions options;
    options.width = options.height = 96;
    options.camera.elevation = 40.0;
    options.antialiasing = Antialiasing::points;
    options.samples = 1;
    options.backend = backend();
    const auto shadowed = render_asset(plane_with(p), options);
    SKIP_WITHOUT_CONTEXT(shadowed);
    ASSERT_TRUE(shadowed.ok()) << shadowed.error().message;
    options.shadows = false;
    const auto plain = render_asset(plane_with(p), options);
    ASSERT_TRUE(plain.ok()) << plain.error().message;
    EXPECT_EQ(shadowed->texels, plain->texels);
}

TEST(RenderAsset, ModelWithoutDetailIsShadedByItsMesh) {
    const PreparedPattern p = prepare(crossing_pattern());
    RenderOptions options;
    options.width = 40;
    options.height = 30;
    options.samples = 4;
    options.backend = backend();
    auto picture = render_asset(plane_with(p, false), options);
    SKIP_WITHOUT_CONTEXT(picture);
    ASSERT_TRUE(picture.ok()) << picture.error().message;
    const std::uint8_t* middle = &picture->texels[4 * std::size_t(15 * 40 + 20)];
    const std::uint8_t* corner = &picture->texels[0];
    EXPECT_NEAR(corner[0], 0.93 * 255, 1.5);
    EXPECT_NE(middle[0], corner[0]);
}

// From straight above a ray over bare ground asks one cell and nothing else; a groove asks for elements, and its shadows for more.
TEST(CountFetches, CountsWhatThePixelsAsk) {
    Pattern bare = base(), grooved = base();
    bare.profiles = grooved.profiles = {groove(0.2, 0.015)};
    grooved.paths = {polyline({{0.0, 0.5}, {1.0, 0.5}}, 0)};
    RenderOptions options;
    options.width = options.height = 32;
    options.camera = {.azimuth = 0.0, .elevation = 90.0, .orthographic = true};
    options.antialiasing = Antialiasing::points;
    options.shadows = false;
    options.backend = backend();
    const auto ground = count_fetches(plane_with(prepare(bare)), options);
    SKIP_WITHOUT_CONTEXT(ground);
    EXPECT_GT(ground->pixels, 900.0);
    EXPECT_LE(ground->pixels, 1024.0);
    EXPECT_GE(ground->cells, 1.0);
    EXPECT_EQ(ground->elements + ground->lists, 0.0);
    const auto groove = count_fetches(plane_with(prepare(grooved)), options);
    options.shadows = true;
    const auto shadowed = count_fetches(plane_with(prepare(grooved)), options);
    ASSERT_TRUE(groove.ok() && shadowed.ok());
    EXPECT_GT(groove->elements, 0.1);
    EXPECT_GT(groove->others, groove->elements);
    EXPECT_GT(shadowed->all(), 1.2 * groove->all());
}

TEST(RenderAsset, RefusesWhatItCannotDraw) {
    const PreparedPattern p = prepare(crossing_pattern());
    const Asset plane = plane_with(p);
    RenderOptions wide;
    wide.width = 9000;
    EXPECT_EQ(render_asset(plane, wide).error().code, ErrorCode::invalid_argument);
    RenderOptions zoomed;
    zoomed.camera.zoom = 0.0;
    EXPECT_EQ(render_asset(plane, zoomed).error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(render_asset(Asset{}, {}).error().code, ErrorCode::invalid_input);
    EXPECT_EQ(render_top(plane_with(p, false), 8, 8).error().code, ErrorCode::invalid_input);
    EXPECT_EQ(render_top(plane, 8, 8, {.material = 5}).error().code, ErrorCode::invalid_argument);
}

}  // namespace
}  // namespace burin::testing
