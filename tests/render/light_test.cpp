// Materials and light from all around: pictures against brute force.
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include <cpp/decode.hpp>
#include <cpp/environment.hpp>
#include <gl/render.hpp>

#include "../judge/context.hpp"
#include "../shader/patterns.hpp"
#include "../shader/rays.hpp"

namespace burin::testing {
namespace {

using Vec3 = std::array<double, 3>;
constexpr double kPi = std::numbers::pi;

double dot3(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 unit3(const Vec3& a) {
    const double l = std::sqrt(dot3(a, a));
    return {a[0] / l, a[1] / l, a[2] / l};
}

double to_linear(int code) {
    const double s = code / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

// A plane of 1 m, u along +x and v along +z.
Asset plane(const MaterialInfo& material) {
    Asset asset;
    asset.materials.push_back(material);
    asset.primitives.push_back({{-0.5f, 0, -0.5f, 0.5f, 0, -0.5f, 0.5f, 0, 0.5f, -0.5f, 0, 0.5f},
                                {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}, {0, 0, 1, 0, 1, 1, 0, 1}, {0, 2, 1, 0, 3, 2}, 0});
    return asset;
}

MaterialInfo plain(float albedo, float metallic, float roughness) {
    MaterialInfo material;
    for (int i = 0; i < 3; ++i) material.base_color[i] = albedo;
    material.metallic = metallic;
    material.roughness = roughness;
    return material;
}

// Lit by nothing else, one ray a pixel, parallel.
RenderOptions view_of(double azimuth, double elevation, int side, double zoom) {
    RenderOptions options;
    options.width = options.height = side;
    options.samples = 1;
    options.antialiasing = Antialiasing::points;
    options.camera = {.azimuth = azimuth, .elevation = elevation, .zoom = zoom, .orthographic = true};
    options.light.strength = 0.0;
    options.light.ambient = 0.0;
    options.backend = backend();
    return options;
}

// A map whose texels look at these radiances.
std::shared_ptr<const RadianceMap> map_of(int width, const std::function<Vec3(const Vec3&)>& radiance) {
    auto map = std::make_shared<RadianceMap>(RadianceMap{width, width / 2, {}});
    for (int y = 0; y < map->height; ++y)
        for (int x = 0; x < width; ++x) {
            const double turn = (2 * (x + 0.5) / width - 1) * kPi, fall = (y + 0.5) / map->height * kPi;
            for (const double value : radiance({std::sin(fall) * std::cos(turn), std::cos(fall), std::sin(fall) * std::sin(turn)}))
                map->texels.push_back(float(value));
        }
    return map;
}

std::shared_ptr<const RadianceMap> even_map(double value) {
    return map_of(32, [=](const Vec3&) { return Vec3{value, value, value}; });
}

// Bright towards one side, with a second hill.
Vec3 hills(const Vec3& d) {
    const double a = std::max(0.0, dot3(d, unit3({0.5, 0.6, 0.3}))), b = std::max(0.0, dot3(d, unit3({-0.7, 0.5, -0.6})));
    return {0.2 + 0.5 * a * a, 0.2 + 0.4 * b * b, 0.3 + 0.2 * d[1]};
}

Vec3 pixel(const RgbaImage& picture, int x, int y) {
    const std::uint8_t* t = &picture.texels[4 * std::size_t(y * picture.width + x)];
    return {to_linear(t[0]), to_linear(t[1]), to_linear(t[2])};
}
Vec3 middle(const RgbaImage& picture) { return pixel(picture, picture.width / 2, picture.height / 2); }

TEST(RenderLight, WhiteThingsInAnEvenRoomAreNotSeen) {
    for (const float metallic : {0.0f, 1.0f})
        for (const float roughness : {0.0f, 0.2f, 0.5f, 1.0f})
            for (const double elevation : {90.0, 40.0, 8.0}) {
                RenderOptions options = view_of(20, elevation, 8, 8);
                options.environment = Environment{even_map(0.5)};
                const auto picture = render_asset(plane(plain(1.0f, metallic, roughness)), options);
                SKIP_WITHOUT_CONTEXT(picture);
                ASSERT_TRUE(picture.ok()) << picture.error().message;
                EXPECT_NEAR(middle(*picture)[1], 0.5, 0.006) << metallic << " " << roughness << " " << elevation;
            }
}

// The bilinear filter of a map, written anew.
Vec3 looked_up(const RadianceMap& map, const Vec3& d) {
    const double x = (0.5 + std::atan2(d[2], d[0]) / (2 * kPi)) * map.width - 0.5, y = std::acos(d[1]) / kPi * map.height - 0.5;
    Vec3 sum{0, 0, 0};
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const int column = int(std::floor(x)) + i, row = int(std::floor(y)) + j;
            const double weight = (1 - std::abs(x - column)) * (1 - std::abs(y - row));
            const std::size_t at = 3 * std::size_t(std::clamp(row, 0, map.height - 1) * map.width + (column + map.width) % map.width);
            for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * double(map.texels[at + c]);
        }
    return sum;
}

TEST(RenderLight, AMirrorShowsThePictureSharp) {
    // Every texel of another colour than its neighbours.
    int count = 0;
    const auto map = map_of(64, [&](const Vec3&) {
        const int k = count++;
        return Vec3{0.1 + 0.8 * (k * 7 % 11) / 11.0, 0.1 + 0.8 * (k * 5 % 13) / 13.0, 0.1 + 0.8 * (k % 3) / 3.0};
    });
    for (const double rotation : {0.0, 70.0}) {
        RenderOptions options = view_of(0, 60, 48, 1);
        options.environment = Environment{map, rotation, 0.9};
        options.camera.eye = {0.1, 0.5, 0.3};
        options.camera.target = {0, 0, 0};
        options.camera.orthographic = false;
        options.camera.field_of_view = 70;
        const auto picture = render_asset(plane(plain(1.0f, 1.0f, 0.0f)), options);
        SKIP_WITHOUT_CONTEXT(picture);
        ASSERT_TRUE(picture.ok()) << picture.error().message;
        const Vec3 eye = *options.camera.eye, forward = unit3({-eye[0], -eye[1], -eye[2]});
        const Vec3 right = unit3({-forward[2], 0, forward[0]});
        const Vec3 up{right[1] * forward[2] - right[2] * forward[1], right[2] * forward[0] - right[0] * forward[2],
                      right[0] * forward[1] - right[1] * forward[0]};
        const double tangent = std::tan(35 * kPi / 180), turn = rotation * kPi / 180;
        int seen = 0;
        for (int y = 4; y < 44; ++y)
            for (int x = 4; x < 44; ++x) {
                const double across = (2 * (x + 0.5) / 48 - 1) * tangent, upwards = (1 - 2 * (y + 0.5) / 48) * tangent;
                Vec3 way;
                for (std::size_t i = 0; i < 3; ++i) way[i] = forward[i] + across * right[i] + upwards * up[i];
                way = unit3(way);
                const double t = eye[1] / -way[1];
                if (way[1] >= 0 || std::abs(eye[0] + t * way[0]) > 0.49 || std::abs(eye[2] + t * way[2]) > 0.49) continue;
                const Vec3 d{std::cos(turn) * way[0] - std::sin(turn) * way[2], -way[1], std::sin(turn) * way[0] + std::cos(turn) * way[2]};
                const Vec3 expected = looked_up(*map, d), found = pixel(*picture, x, y);
                for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], 0.9 * expected[c], 0.02) << x << " " << y;
                ++seen;
            }
        EXPECT_GT(seen, 600);
    }
}

// What a surface that faces up sends to the eye from a map, by GGX with Smith's correlated shadowing and Lambert.
Vec3 brute_force(const std::function<Vec3(const Vec3&)>& radiance, const Vec3& to_eye, double f0, double roughness, double matt) {
    const double a2 = std::pow(roughness, 4), nv = to_eye[1];
    Vec3 sum{0, 0, 0};
    constexpr int kRows = 400;
    for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < 2 * kRows; ++x) {
            const double fall = (y + 0.5) / kRows * kPi / 2, turn = (x + 0.5) / kRows * kPi;
            const Vec3 d{std::sin(fall) * std::cos(turn), std::cos(fall), std::sin(fall) * std::sin(turn)};
            const double nl = d[1], part = std::sin(fall) * (kPi / 2 / kRows) * (kPi / kRows);
            const Vec3 half = unit3({d[0] + to_eye[0], d[1] + to_eye[1], d[2] + to_eye[2]});
            const double g = half[1] * half[1] * (a2 - 1) + 1;
            const double shown = 0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
            const double fresnel = f0 + (1 - f0) * std::pow(1 - dot3(half, d), 5);
            const double value = (fresnel * a2 / (kPi * g * g) * shown + matt / kPi) * nl * part;
            const Vec3 light = radiance(d);
            for (std::size_t c = 0; c < 3; ++c) sum[c] += value * light[c];
        }
    return sum;
}

TEST(RenderLight, RoughAndMattSurfacesGatherWhatBruteForceDoes) {
    const auto map = map_of(128, hills);
    for (const double elevation : {90.0, 45.0}) {
        const double e = elevation * kPi / 180;
        const Vec3 to_eye{std::sin(0.6) * std::cos(e), std::sin(e), std::cos(0.6) * std::cos(e)};
        for (const float roughness : {0.25f, 0.6f}) {
            RenderOptions options = view_of(0.6 * 180 / kPi, elevation, 8, 8);
            options.environment = Environment{map, 0.0, 12.0};
            const auto mirrored = render_asset(plane(plain(0.0f, 0.0f, roughness)), options);
            SKIP_WITHOUT_CONTEXT(mirrored);
            ASSERT_TRUE(mirrored.ok()) << mirrored.error().message;
            const Vec3 lobe = brute_force(hills, to_eye, 0.04, double(roughness), 0.0);
            // The split sum blurs as seen from straight above and without Fresnel; aslant the lobe is another one.
            const double tolerance = elevation > 80 ? 0.06 : 0.13;
            for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(middle(*mirrored)[c] / (12 * lobe[c]), 1.0, tolerance) << elevation << " " << roughness << " " << c;
        }
        RenderOptions options = view_of(0.6 * 180 / kPi, elevation, 8, 8);
        options.environment = Environment{map, 0.0, 1.0};
        const auto white = render_asset(plane(plain(1.0f, 0.0f, 1.0f)), options), black = render_asset(plane(plain(0.0f, 0.0f, 1.0f)), options);
        ASSERT_TRUE(white.ok() && black.ok());
        // What is not mirrored is scattered: all but 4 % to 10 % of the light.
        const Vec3 gathered = brute_force(hills, to_eye, 0.0, 1.0, 1.0), fresnel = brute_force([](const Vec3&) { return Vec3{1, 1, 1}; }, to_eye, 0.04, 1.0, 0.0);
        const Vec3 nothing = brute_force(hills, to_eye, 0.0, 1.0, 0.0);
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR((middle(*white)[c] - middle(*black)[c]) / ((gathered[c] - nothing[c]) * (1 - fresnel[c])), 1.0, 0.03) << elevation << " " << c;
    }
}

Pattern long_groove(const Profile& profile) {
    Pattern p = base();
    p.depth = 0.06;
    p.profiles = {profile};
    p.paths = {polyline({{0.45, 0.02}, {0.55, 0.98}}, 0)};
    return p;
}

// Share of an even sky's light, by the cosine, that reaches what is met under a point.
double open_share(const PreparedPattern& p, Vec2 at, const DecodedHit& hit) {
    const Decoder decoder(p.textures, p.detail);
    const Vec3 n{hit.normal[0], hit.normal[1], hit.normal[2]};
    double open = 0.0, all = 0.0;
    constexpr int kRows = 24;
    for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < 4 * kRows; ++x) {
            const double rise = (y + 0.5) / kRows, turn = (x + 0.5) / kRows * kPi / 2, flat = std::sqrt(1 - rise * rise);
            const Vec3 d{flat * std::cos(turn), flat * std::sin(turn), rise};
            const double cosine = std::max(0.0, dot3(n, d));
            all += cosine * (kPi / 2 / kRows) / kRows;
            const Vec2 slope{-d[0] / d[2], -d[1] / d[2]};
            if (cosine > 0.0 && decoder.trace(at - slope * hit.drop, slope).drop >= hit.drop - 0.004 * p.detail.depth)
                open += cosine * (kPi / 2 / kRows) / kRows;
        }
    EXPECT_LT(all, kPi * 1.02);
    return open / kPi;
}

TEST(RenderLight, AGrooveGetsTheLightThatItsWallsLetIn) {
    for (const Profile& profile : {groove(0.05, 0.05), vee(0.05, 0.05)}) {
        const PreparedPattern p = prepare(long_groove(profile));
        const double albedo = 0.5;
        MaterialInfo material = plain(float(albedo), 0.0f, 1.0f);
        put_pattern(p, material);
        RenderOptions options = view_of(0, 90, 24, 8);
        options.environment = Environment{even_map(1.0)};
        double worst = 0.0, darkest = 1.0;
        for (const Antialiasing way : {Antialiasing::points, Antialiasing::regions}) {
            options.antialiasing = way;
            const auto picture = render_asset(plane(material), options);
            SKIP_WITHOUT_CONTEXT(picture);
            ASSERT_TRUE(picture.ok()) << picture.error().message;
            for (int y = 8; y < 12; ++y)
                for (int x = 0; x < 24; ++x) {
                    const double side = 1.03 / 8;
                    const Vec2 at{0.5 + ((x + 0.5) / 24 - 0.5) * side, 0.5 + ((y + 0.5) / 24 - 0.5) * side};
                    const Decoder decoder(p.textures, p.detail);
                    const DecodedHit hit = decoder.trace(at, {0, 0});
                    bool edge = false;
                    for (const double off : {-0.003, 0.003}) edge = edge || decoder.trace(at + Vec2{off, 0}, {0, 0}).facet != hit.facet;
                    if (edge) continue;
                    const double open = open_share(p, at, hit);
                    // Walls as bright as the place itself; what they hide and the rest mirror alike but for a little.
                    const double expected = albedo * open / (1 - (1 - open) * albedo), found = pixel(*picture, x, y)[1];
                    const double mirrored = albedo < 1 ? 0.04 : 0.0;
                    worst = std::max(worst, std::abs(found - expected) - mirrored);
                    darkest = std::min(darkest, found);
                    EXPECT_NEAR(found, expected, 0.02 + mirrored) << at.x << " " << at.y << " open " << open;
                }
        }
        EXPECT_LT(darkest, 0.4);
    }
}

// Squares of 1/16 of the tile.
MaterialTexture checker(int set) {
    auto image = std::make_shared<RgbaImage>(RgbaImage{256, 256, {}});
    for (int y = 0; y < 256; ++y)
        for (int x = 0; x < 256; ++x) {
            const bool on = (x / 16 + y / 16) % 2 == 1;
            image->texels.insert(image->texels.end(), {std::uint8_t(on ? 255 : 0), std::uint8_t(x), std::uint8_t(y), 255});
        }
    MaterialTexture texture;
    texture.image = image;
    texture.tex_coord = set;
    return texture;
}

// Seen by its glow alone.
MaterialInfo glowing(const PreparedPattern& p) {
    MaterialInfo material = plain(0.0f, 1.0f, 1.0f);
    for (float& value : material.emissive) value = 1.0f;
    put_pattern(p, material);
    material.emissive_texture = checker(0);
    return material;
}

TEST(RenderLight, TexturesLieWhereTheRayMeetsTheRelief) {
    const PreparedPattern p = prepare(long_groove(groove(0.1, 0.055)));
    RenderOptions options = view_of(90, 40, 64, 3);
    const auto points = render_asset(plane(glowing(p)), options);
    SKIP_WITHOUT_CONTEXT(points);
    ASSERT_TRUE(points.ok()) << points.error().message;
    options.antialiasing = Antialiasing::regions;
    const auto areas = render_asset(plane(glowing(p)), options);
    ASSERT_TRUE(areas.ok()) << areas.error().message;
    const Decoder decoder(p.textures, p.detail);
    // The camera looks along -x and down; 1.03 times the larger side, an eighth of it, is the picture's height.
    const double e = 40 * kPi / 180, side = 1.03 / 3;
    int asked = 0, wrong = 0, of_areas = 0, unmoved = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const double right = ((x + 0.5) / 64 - 0.5) * side, up = (0.5 - (y + 0.5) / 64) * side;
            // Right is -z, up is -x as the plane shows it.
            const Vec2 at{0.5 - up / std::sin(e), 0.5 - right}, slope{-1 / std::tan(e), 0};
            const DecodedHit hit = decoder.trace(at, slope);
            const Vec2 place = at + slope * hit.drop;
            const auto border = [](double v) { return std::abs(v * 16 - std::round(v * 16)) < 0.1; };
            if (border(place.x) || border(place.y)) continue;
            bool edge = false;
            for (const double off : {-0.008, 0.008}) edge = edge || decoder.trace(at + Vec2{off, 0}, slope).facet != hit.facet;
            if (edge) continue;
            ++asked;
            const auto on = [](Vec2 q) { return (int(std::floor(q.x * 16)) + int(std::floor(q.y * 16))) % 2 != 0; };
            wrong += (pixel(*points, x, y)[0] > 0.5) != on(place);
            of_areas += (pixel(*areas, x, y)[0] > 0.5) != on(place);
            unmoved += on(at) != on(place);
        }
    EXPECT_GT(asked, 1500);
    EXPECT_GT(unmoved, 200);  // else the relief would not matter
    EXPECT_EQ(wrong, 0);
    EXPECT_LE(of_areas, asked / 200);
}

// The same texture by another uv set that is turned, and a transform that turns it back.
TEST(RenderLight, OtherSetsAndTransformsLeadToTheSamePlace) {
    const PreparedPattern p = prepare(long_groove(groove(0.1, 0.055)));
    const RenderOptions options = view_of(60, 45, 48, 3);
    Asset one = plane(glowing(p)), other = one;
    MaterialTexture& texture = other.materials[0].emissive_texture;
    texture.tex_coord = 1;
    // Set 1 is (2 v - 0.3, 0.5 u + 0.1).
    texture.transform = {0, 2, -0.2f, 0.5f, 0, 0.15f};
    const std::vector<float>& uvs = other.primitives[0].uvs;
    for (std::size_t i = 0; i < uvs.size(); i += 2)
        for (const float value : {uvs[i], uvs[i + 1], 2 * uvs[i + 1] - 0.3f, 0.5f * uvs[i] + 0.1f}) other.primitives[0].texture_uvs.push_back(value);
    const auto a = render_asset(one, options);
    SKIP_WITHOUT_CONTEXT(a);
    const auto b = render_asset(other, options);
    ASSERT_TRUE(a.ok() && b.ok());
    int off = 0;
    for (std::size_t i = 0; i < a->texels.size(); ++i) off += std::abs(a->texels[i] - b->texels[i]) > 3;
    EXPECT_LE(off, 12);
}

TEST(RenderLight, APathsOwnMaterialStandsInPlaceOfTheTextures) {
    Pattern pattern = long_groove(groove(0.1, 0.055));
    pattern.materials.resize(2);
    pattern.materials[1] = {true, {0.1f, 0.6f, 0.2f, 1.0f}, 0.0f, 1.0f};
    pattern.paths[0].material = 1;
    const PreparedPattern p = prepare(pattern);
    MaterialInfo material = glowing(p);
    RenderOptions options = view_of(0, 90, 32, 3);
    options.light.ambient = 0.5;
    for (const Antialiasing way : {Antialiasing::points, Antialiasing::regions}) {
        options.antialiasing = way;
        const auto picture = render_asset(plane(material), options);
        SKIP_WITHOUT_CONTEXT(picture);
        ASSERT_TRUE(picture.ok()) << picture.error().message;
        const Vec3 inside = middle(*picture);
        EXPECT_GT(inside[1], 4 * inside[0]);
        EXPECT_LT(inside[2], 0.5 * inside[1]);
        bool glows = false;
        for (int x = 0; x < 8; ++x) glows = glows || pixel(*picture, x, 16)[0] > 0.9;
        EXPECT_TRUE(glows);
    }
}

double difference(const RgbaImage& a, const RgbaImage& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) sum += std::pow(double(a.texels[i]) - double(b.texels[i]), 2);
    return std::sqrt(sum / double(a.texels.size()));
}

// Both ways of antialiasing give textures and surroundings the same look.
TEST(RenderLight, AreasAreTheMeanOfRaysInAnEnvironment) {
    const PreparedPattern p = prepare(crossing_pattern());
    MaterialInfo material = plain(0.8f, 0.7f, 0.35f);
    put_pattern(p, material);
    material.base_color_texture = checker(0);
    const Asset asset = plane(material);
    for (const double elevation : {70.0, 30.0}) {
        RenderOptions options = view_of(20, elevation, 48, 6);
        options.light.strength = 1.5;
        options.environment = Environment{map_of(64, hills), 0.0, 0.8};
        options.samples = 36;
        const auto rays = render_asset(asset, options);
        SKIP_WITHOUT_CONTEXT(rays);
        options.samples = 1;
        options.antialiasing = Antialiasing::regions;
        options.rays = 16;
        const auto areas = render_asset(asset, options);
        ASSERT_TRUE(rays.ok() && areas.ok());
        // The checker's borders, which a pixel's one lookup blurs and rays do not, are most of it.
        EXPECT_LT(difference(*areas, *rays), 2.0) << elevation;
    }
}

// From where a cell is a few pixels to where a pixel is many cells.
TEST(RenderLight, MeanLightOfAnEnvironmentStaysFromFarAway) {
    const PreparedPattern p = prepare(crossing_pattern());
    MaterialInfo material = plain(0.6f, 0.5f, 0.5f);
    put_pattern(p, material);
    const Asset asset = plane(material);
    RenderOptions options = view_of(0, 90, 96, 1.03);
    options.antialiasing = Antialiasing::regions;
    options.samples = 4;  // a pixel as wide as the plane is seen from more than one direction
    options.environment = Environment{map_of(64, hills)};
    double first = 0.0;
    for (const int side : {96, 24, 6, 3, 1}) {
        options.width = options.height = side;
        const auto picture = render_asset(asset, options);
        SKIP_WITHOUT_CONTEXT(picture);
        ASSERT_TRUE(picture.ok()) << picture.error().message;
        double sum = 0.0;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) sum += pixel(*picture, x, y)[1];
        const double mean = sum / (side * side);
        if (first == 0.0) first = mean;
        EXPECT_NEAR(mean / first, 1.0, 0.01) << side << " pixels";
    }
}

// Level ground that a residual of one slope leans gathers what a slope of the kind does.
TEST(RenderLight, TheResidualLeansWhatGathersLight) {
    const PreparedPattern p = prepare(long_groove(vee(0.01, 0.01)));
    MaterialInfo material = plain(0.8f, 0.0f, 1.0f);
    put_pattern(p, material);
    material.residual = {1, 1, {30, 200, 255, 255}};
    RenderOptions options = view_of(0, 90, 16, 16);
    options.camera.center = Vec2{0.2, 0.2};
    options.environment = Environment{map_of(64, hills)};
    Vec3 seen[2];
    for (const double scale : {0.3, 1e-6}) {
        material.detail.residual_scale = scale;
        const auto picture = render_asset(plane(material), options);
        SKIP_WITHOUT_CONTEXT(picture);
        ASSERT_TRUE(picture.ok()) << picture.error().message;
        // Slopes along x and y; of the sky, what stands over the ground falls in.
        const Vec3 n = unit3({scale * (30 / 127.5 - 1), 1, -scale * (200 / 127.5 - 1)});
        const auto sky = [&](const Vec3& d) {
            const double more = std::max(0.0, dot3(n, d)) / d[1];
            const Vec3 light = hills(d);
            return Vec3{light[0] * more, light[1] * more, light[2] * more};
        };
        const Vec3 gathered = brute_force(sky, {0, 1, 0}, 0.0, 1.0, 1.0), lobe = brute_force(sky, {0, 1, 0}, 0.0, 1.0, 0.0);
        const double open = 0.5 * (1 + n[1]);
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(middle(*picture)[c] / (0.8 * (gathered[c] - lobe[c]) / (1 - (1 - open) * 0.8)), 1.0, 0.06) << scale << " " << c;
        seen[scale > 0.1 ? 0 : 1] = middle(*picture);
    }
    EXPECT_GT(std::abs(seen[0][0] / seen[1][0] - 1), 0.05);
}

}  // namespace
}  // namespace burin::testing
