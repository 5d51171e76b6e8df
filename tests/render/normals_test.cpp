// Which way the drawn surface leans, against the map that it was made of: paths, residual and fallback. A surface that is
// mirrored, or a channel with the wrong sign, explains its map as well in places where nobody looks at the sign.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include <nlohmann/json.hpp>

#include <cpp/decode.hpp>
#include <gl/render.hpp>

#include <burin/heightmap.hpp>

#include "../property/converted_map.hpp"
#include "../sampled_image.hpp"
#include "../shader/rays.hpp"
#include "../unit/temporary_folder.hpp"

namespace burin::testing {
namespace {

constexpr int kSide = 256;
constexpr double kDepth = 0.2;  // metres; the map is 1 m wide

// 1 at 0, 0 from `half` on.
double roof(double distance, double half) { return std::max(0.0, 1.0 - std::abs(distance) / half); }

// A plateau, a sunken plate, a groove with one steep and one gentle side, a ridge; all slant. x and y in texels.
double features(double x, double y) {
    const double disc = std::clamp((44.0 - std::hypot(x - 70.0, y - 72.0)) / 8.0, 0.0, 1.0);
    const double u = (x - 185.0) * 0.96 + (y - 70.0) * 0.28, v = (y - 70.0) * 0.96 - (x - 185.0) * 0.28;
    const double plate = std::clamp((36.0 - std::max(std::abs(u), std::abs(v))) / 8.0, 0.0, 1.0);
    const double across = (y - 180.0) - 0.2 * (x - 128.0);
    const double groove = roof(across, across < 0.0 ? 5.0 : 14.0);
    const double ridge = roof((y - 222.0) - 0.1 * (x - 128.0), 7.0);
    return 0.5 + 0.25 * disc - 0.25 * plate - 0.3 * groove + 0.3 * ridge;
}

// Ground too soft for paths.
double waves(double x, double y) {
    const double turn = 2.0 * 3.14159265358979 / kSide;
    return 0.12 * std::sin(turn * x) + 0.08 * std::sin(2.0 * turn * y);
}

double on_waves(double x, double y) { return 0.25 + 0.5 * features(x, y) + waves(x, y); }

using Surface = std::function<double(double x, double y)>;
using Place = std::pair<double, double>;  // texels

// Metres over metres, by which heights rise along u and along v.
Vec2 slopes_of(const Surface& surface, Place p) {
    constexpr double kStep = 0.25;
    const double to_slope = kDepth * kSide / (2.0 * kStep);
    return {(surface(p.first + kStep, p.second) - surface(p.first - kStep, p.second)) * to_slope,
            (surface(p.first, p.second + kStep) - surface(p.first, p.second - kStep)) * to_slope};
}

// Places on slopes, none nearer than three texels to where they bend.
std::vector<Place> places_on_slopes(const Surface& surface, double least) {
    std::vector<Place> places;
    for (int j = 4; j < kSide - 4; ++j)
        for (int i = 4; i < kSide - 4; ++i) {
            const Place p{i + 0.5, j + 0.5};
            const Vec2 here = slopes_of(surface, p);
            bool even = length(here) > least;
            for (const Place& d : {Place{3, 0}, Place{-3, 0}, Place{0, 3}, Place{0, -3}})
                even = even && length(slopes_of(surface, {p.first + d.first, p.second + d.second}) - here) < 0.3 * length(here);
            if (even) places.push_back(p);
        }
    return places;
}

// Mean cosine, seen from above, between the normals that are drawn and those of the surface: 1 where both lean the same
// way, -1 where one is mirrored.
double agreement(const Surface& surface, const std::vector<Place>& places, const std::function<Vec2(Place)>& slopes) {
    double sum = 0.0;
    for (const Place& p : places) {
        const Vec2 wanted = slopes_of(surface, p), drawn = slopes(p);
        const double lengths = length(wanted) * length(drawn);
        sum += lengths > 0.0 ? dot(wanted, drawn) / lengths : 0.0;
    }
    return sum / static_cast<double>(places.size());
}

Vec2 slopes_of_normal(const double (&n)[3]) { return {-n[0] / n[2], -n[1] / n[2]}; }

double agreement_of_paths(const Surface& surface, const PackedTextures& textures, const PathDetail& detail) {
    const Decoder decoder(textures, detail);
    return agreement(surface, places_on_slopes(surface, 0.2), [&](Place p) {
        return slopes_of_normal(decoder.trace({p.first / kSide, p.second / kSide}, {0, 0}).normal);
    });
}

Converted conversion_of(const Surface& surface) { return converted(sampled_image(kSide, kSide, 4, surface), kDepth); }

// The same pattern with every height below the object surface now above the deepest point.
Pattern mirrored(Pattern pattern) {
    for (Profile& profile : pattern.profiles)
        for (ProfilePoint& point : profile.points) point.h = -point.h;
    for (Path& path : pattern.paths) path.level = -path.level;
    pattern.outer_level = -pattern.outer_level;
    pattern.base_offset = pattern.depth - pattern.base_offset;
    return pattern;
}

TEST(Normals, PathsLeanAsTheirMapDoes) {
    const Converted made = conversion_of(features);
    ASSERT_FALSE(made.pattern.paths.empty());
    ASSERT_GT(places_on_slopes(features, 0.2).size(), 2000u);
    EXPECT_GT(agreement_of_paths(features, made.textures, made.detail), 0.98);
    // This test sees a mirrored surface.
    const PreparedPattern wrong = prepare(mirrored(made.pattern));
    EXPECT_LT(agreement_of_paths(features, wrong.textures, wrong.detail), -0.98);
}

// As the shader draws it, from straight above.
double agreement_of_drawing(const std::vector<Place>& places, const Asset& asset, const RgbaImage& residual) {
    std::vector<PatternRay> rays;
    for (const Place& p : places) rays.push_back({{static_cast<float>(p.first / kSide), static_cast<float>(p.second / kSide)}, {0, 0}});
    const auto hits = shade_rays(asset.materials[0].textures, asset.materials[0].detail, rays, Backend::osmesa, residual);
    EXPECT_TRUE(hits.ok()) << (hits ? "" : hits.error().message);
    std::size_t next = 0;
    return agreement(on_waves, places, [&](Place) {
        const float* const n = (*hits)[next++].normal;
        return slopes_of_normal({n[0], n[1], n[2]});
    });
}

RgbaImage with_channel_flipped(RgbaImage picture, std::size_t channel) {
    for (std::size_t i = channel; i < picture.texels.size(); i += 4) picture.texels[i] = static_cast<std::uint8_t>(255 - picture.texels[i]);
    return picture;
}

TEST(Normals, TheResidualLeansAsItsMapDoes) {
    if (!describe_backend(Backend::osmesa)) GTEST_SKIP() << "SKIPPED: no OSMesa";
    const Converted made = conversion_of(on_waves);
    const auto asset = read_asset(made.glb);
    ASSERT_TRUE(asset.ok());
    const RgbaImage& residual = asset->materials[0].residual;
    ASSERT_GT(residual.width, 0);
    std::vector<Place> soft;
    for (const Place& p : places_on_slopes(on_waves, 0.05))
        if (length(slopes_of(features, p)) == 0.0) soft.push_back(p);
    ASSERT_GT(soft.size(), 5000u);
    EXPECT_GT(agreement_of_drawing(soft, *asset, residual), 0.9);
    for (const std::size_t channel : {0u, 1u})
        EXPECT_LT(agreement_of_drawing(soft, *asset, with_channel_flipped(residual, channel)), 0.6) << channel;
}

// One channel of the picture that the core material's normalTexture shows, -1 to 1.
Image normal_texture(const Converted& made, Channel channel, const test::TemporaryFolder& folder) {
    std::uint32_t size = 0;
    for (int i = 3; i >= 0; --i) size = size << 8 | made.glb[static_cast<std::size_t>(12 + i)];
    const auto document = nlohmann::json::parse(made.glb.begin() + 20, made.glb.begin() + 20 + size);
    const std::size_t texture = document["materials"][0]["normalTexture"]["index"];
    const std::size_t image = document["textures"][texture]["source"];
    const auto& view = document["bufferViews"][document["images"][image]["bufferView"].get<std::size_t>()];
    const char* const begin = reinterpret_cast<const char*>(made.glb.data()) + 28 + size + view.value("byteOffset", 0);
    const std::string path = folder.file("normal.png");
    std::ofstream(path, std::ios::binary).write(begin, view["byteLength"].get<std::streamsize>());
    HeightMapOptions options;
    options.channel = channel;
    auto read = read_height_map(path, options);
    EXPECT_TRUE(read.ok()) << (read ? "" : read.error().message);
    if (!read) return Image(1, 1);
    for (float& value : read->image.texels) value = 2.0f * value - 1.0f;
    return std::move(read->image);
}

// glTF: red along u, green against v, which runs down the picture.
TEST(Normals, TheFallbackLeansAsItsMapDoes) {
    const Converted made = conversion_of(features);
    const test::TemporaryFolder folder;
    const Image red = normal_texture(made, Channel::red, folder), green = normal_texture(made, Channel::green, folder);
    const auto at = [&](const Image& image, Place p) {
        return static_cast<double>(image.at(static_cast<int>(p.first / kSide * image.width), static_cast<int>(p.second / kSide * image.height)));
    };
    const auto places = places_on_slopes(features, 0.2);
    EXPECT_GT(agreement(features, places, [&](Place p) { return Vec2{-at(red, p), at(green, p)}; }), 0.95);
    EXPECT_LT(agreement(features, places, [&](Place p) { return Vec2{-at(red, p), -at(green, p)}; }), 0.0);
}

}  // namespace
}  // namespace burin::testing
