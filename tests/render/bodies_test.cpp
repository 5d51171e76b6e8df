// Pictures of bodies whose texture coordinates are cut: over every seam the shader shows what a march through the body meets. A gap
// or a smear is a patch of pixels of another material.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include <burin/image_io.hpp>
#include <gl/render.hpp>

#include "../judge/context.hpp"
#include "../shader/cut_setting.hpp"

namespace burin::testing {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr int kOutside = -1, kUnsure = -2;  // besides the numbers of materials: background; not asked
constexpr double kWall = 1e-5;              // metres by which the drop of what was met may differ from that of the relief

// The grooves red and green, the ridge blue, the ground grey.
Pattern coloured() {
    Pattern p = crossed_pattern();
    for (std::size_t i = 0; i < 3; ++i) {
        Material material;
        material.overrides = true;
        for (std::size_t k = 0; k < 3; ++k) material.base_color[k] = k == i ? 0.8f : 0.02f;
        material.metallic = 0.0f;
        p.materials.push_back(material);
        p.paths[i].material = std::uint32_t(i + 1);
    }
    return p;
}

Asset asset_of(const CutSetting& s, bool charted) {
    Asset asset;
    MaterialInfo material;
    material.base_color[0] = material.base_color[1] = material.base_color[2] = 0.4f;
    material.metallic = 0.0f;
    put_pattern(s.pattern, material);
    Primitive body;
    const BaseMesh& base = s.mesh.base;
    body.positions = base.positions, body.normals = base.normals, body.uvs = base.uvs, body.indices = base.indices, body.frames = base.frames;
    if (charted) {
        material.detail.charts = s.table.layout;
        material.charts = s.table.words;
        for (const std::uint32_t chart : s.mesh.charts) body.charts.push_back(float(chart));
    }
    asset.materials.push_back(material);
    asset.primitives.push_back(body);
    return asset;
}

// From near a seam, low over it.
struct Look {
    const char* body;
    Vec3 eye, target;
};
constexpr Look kLooks[] = {{"cube", {0.72, 0.64, 0.0}, {0.5, 0.49, 0.0}},
                           {"cube", {0.3, 0.66, 0.75}, {0.22, 0.49, 0.5}},
                           {"drum", {0.1, 0.44, 0.72}, {0.0, 0.29, 0.5}},
                           {"sphere of six charts", {0.68, 0.42, 0.15}, {0.42, 0.42, 0.0}},
                           {"torus", {0.3, 0.06, 0.72}, {0.0, 0.0, 0.62}}};

RenderOptions options_from(const Look& look) {
    RenderOptions options;
    options.width = kWidth, options.height = kHeight;
    options.camera = {.field_of_view = 30.0, .eye = look.eye, .target = look.target};
    options.light = {.strength = 0.0, .ambient = 1.0};
    options.shadows = false;
    options.background = {1, 0, 1};
    options.backend = backend();
    return options;
}

// What a picture shows, per pixel.
std::vector<int> read_materials(const RgbaImage& picture) {
    std::vector<int> found;
    for (std::size_t i = 0; i < picture.texels.size(); i += 4) {
        const int r = picture.texels[i], g = picture.texels[i + 1], b = picture.texels[i + 2], high = std::max({r, g, b}), low = std::min({r, g, b});
        if (std::min(r, b) > 2 * g + 40) found.push_back(kOutside);
        else if (high - low < high / 4) found.push_back(0);
        else found.push_back(high == r ? 1 : (high == g ? 2 : 3));
    }
    return found;
}

// What the body shows there.
std::vector<int> march_materials(const CutSetting& s, const Look& look) {
    const Truth truth(s.pattern.resolved);
    const Vec3 forward = normalized(look.target - look.eye), right = normalized(cross(forward, {0, 1, 0})), up = cross(right, forward);
    const double high = std::tan(15.0 * 3.14159265358979 / 180);
    std::vector<int> found(std::size_t(kWidth) * kHeight, kOutside);
    in_parallel(found.size(), [&](std::size_t i) {
        const double x = (double(i % kWidth) + 0.5) / kWidth * 2 - 1, y = 1 - (double(i / kWidth) + 0.5) / kHeight * 2;
        const Vec3 along = normalized(forward + right * (x * high * kWidth / kHeight) + up * (y * high));
        const EmbreeHit entry = s.base->trace(look.eye, along, 0.0);
        if (!(entry.distance < HUGE_VAL)) return;
        const Vec3 from = look.eye + along * entry.distance;
        const double way = march(s, truth, from, along);
        if (!(way < HUGE_VAL)) {
            found[i] = kUnsure;  // it leaves beside an outline, and may enter again
            return;
        }
        const BodyPlace place = s.body.locate(from + along * way);
        const Vec2 uv = s.body.patches[place.patch].uv(place.st);
        const SurfacePoint top = truth.surface_at({uv.x * kCutTile, uv.y * kCutTile});
        // Where two charts do not fit together there is a wall, which is of neither material.
        if (place.drop > s.detail.base_offset - top.height + kWall) {
            found[i] = kUnsure;
            return;
        }
        const ResolvedPattern& pattern = s.pattern.resolved;
        found[i] = top.element == kGround ? 0 : int(pattern.styles[pattern.elements[top.element].style].material);
    });
    return found;
}

// Pixels whose eight neighbours show what they do, in the truth.
std::vector<std::size_t> inner(const std::vector<int>& right) {
    std::vector<std::size_t> pixels;
    for (std::size_t y = 1; y + 1 < kHeight; ++y)
        for (std::size_t x = 1; x + 1 < kWidth; ++x) {
            const std::size_t at = y * kWidth + x;
            bool equal = right[at] >= 0;
            for (std::size_t k = 0; k < 9; ++k) equal = equal && right[at + (k / 3) * kWidth + k % 3 - kWidth - 1] == right[at];
            if (equal) pixels.push_back(at);
        }
    return pixels;
}

int count_wrong(const RgbaImage& picture, const std::vector<int>& right, const std::vector<std::size_t>& asked) {
    const std::vector<int> seen = read_materials(picture);
    int wrong = 0;
    for (const std::size_t i : asked) wrong += seen[i] != right[i];
    return wrong;
}

class Bodies : public ::testing::TestWithParam<Look> {};

TEST_P(Bodies, ShowNoSeam) {
    const Look look = GetParam();
    const std::vector<Body> bodies = cut_bodies(kCutTile);
    const auto body = std::find_if(bodies.begin(), bodies.end(), [&](const Body& b) { return b.name == look.body; });
    ASSERT_NE(body, bodies.end());
    const CutSetting s = prepare_cut(*body, coloured());
    RenderOptions options = options_from(look);
    const std::vector<int> right = march_materials(s, look);
    const std::vector<std::size_t> asked = inner(right);
    ASSERT_GT(asked.size(), 5000u);
    for (const Antialiasing kind : {Antialiasing::points, Antialiasing::regions}) {
        options.antialiasing = kind;
        options.samples = kind == Antialiasing::points ? 1 : 4;
        const auto whole = render_asset(asset_of(s, true), options);
        SKIP_WITHOUT_CONTEXT(whole);
        const auto torn = render_asset(asset_of(s, false), options);
        ASSERT_TRUE(torn.ok());
        const int wrong = count_wrong(*whole, right, asked), torn_wrong = count_wrong(*torn, right, asked);
        const char* name = kind == Antialiasing::points ? "points" : "areas";
        std::printf("%s, %s: %d of %zu pixels wrong, %d without borders\n", look.body, name, wrong, asked.size(), torn_wrong);
        if (const char* folder = std::getenv("BURIN_PICTURES")) {
            const std::string path = std::string(folder) + "/" + look.body + " " + name;
            (void)write_png(path + ".png", *whole);
            (void)write_png(path + " torn.png", *torn);
        }
        EXPECT_LE(wrong, 3);
        EXPECT_GT(torn_wrong, 5 * wrong + 20);
    }
}

INSTANTIATE_TEST_SUITE_P(Cut, Bodies, ::testing::ValuesIn(kLooks));

}  // namespace
}  // namespace burin::testing
