// Pictures over cuts of the texture coordinates, against those of the same pattern in one piece.
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include <burin/charts.hpp>
#include <burin/image_io.hpp>
#include <gl/render.hpp>

#include "../judge/context.hpp"
#include "../judge/pictures.hpp"
#include "../shader/patterns.hpp"
#include "../shader/rays.hpp"

namespace burin::testing {
namespace {

constexpr double kCut = 0.53;    // of the plane's width
constexpr double kMargin = 0.014;  // by which both halves are drawn beyond the cut, where their lines end bluntly

struct Line {
    Vec2 from, to;
    std::uint32_t profile;
};

// Lines from one side of a square metre to the other.
std::vector<Line> drawing() {
    return {{{0, 0.2}, {1, 0.2}, 1}, {{0, 0.85}, {1, 0.62}, 0}, {{0.40, 0}, {0.36, 1}, 0}, {{0, 0.42}, {1, 0.5}, 2}, {{0.2, 0}, {0.2, 1}, 1}, {{0.8, 0}, {0.7, 1}, 2}};
}

// The second half lies elsewhere in uv: turned by a quarter, mirrored, moved.
Vec2 laid_aside(Vec2 p) { return {3.2 - p.y, 3.1 - p.x}; }

Pattern blank(double size) {
    Pattern p = base(kRise);
    p.size = {size, size};
    p.wrap = Wrap::clamp;
    p.profiles = {groove(0.05, 0.012), vee(0.04, 0.010), ridge(0.05, kRise)};
    return p;
}

// Part of a line within low <= x <= high.
Line clipped(const Line& line, double low, double high) {
    const auto at = [&](double x) { return line.from + (line.to - line.from) * ((x - line.from.x) / (line.to.x - line.from.x)); };
    Line part = line;
    if (line.from.x < low) part.from = at(low);
    if (line.to.x > high) part.to = at(high);
    return part;
}

Path blunt(const std::vector<Vec2>& points, std::uint32_t profile) {
    Path path = polyline(points, profile);
    path.start_cap = path.end_cap = CapKind::butt;
    return path;
}

Pattern in_one_piece() {
    Pattern p = blank(4.0);
    for (const Line& line : drawing()) p.paths.push_back(blunt({line.from, line.to}, line.profile));
    return p;
}

Pattern in_two_pieces() {
    Pattern p = blank(4.0);
    for (const Line& line : drawing()) {
        if (std::min(line.from.x, line.to.x) < kCut + kMargin) {
            const Line left = clipped(line, -1, kCut + kMargin);
            p.paths.push_back(blunt({left.from, left.to}, left.profile));
        }
        if (std::max(line.from.x, line.to.x) < kCut - kMargin) continue;
        // Mirrored, so that it runs the other way for its left to stay its left.
        const Line right = clipped(line, kCut - kMargin, 2);
        p.paths.push_back(blunt({laid_aside(right.to), laid_aside(right.from)}, right.profile));
    }
    return p;
}

enum class Cut { none, with_borders, without_borders };

// A square metre, in two pieces where it is cut.
Asset plane_with(const PreparedPattern& p, Cut cut) {
    Asset asset;
    MaterialInfo material;
    material.base_color[0] = material.base_color[1] = material.base_color[2] = 0.5f;
    material.metallic = 0.0f;
    material.roughness = 1.0f;
    put_pattern(p, material);
    Primitive plane;
    for (const auto& [low, high] : {std::pair{0.0, kCut}, std::pair{kCut, 1.0}}) {
        const auto first = std::uint32_t(plane.positions.size() / 3);
        for (const Vec2 at : {Vec2{low, 0}, Vec2{high, 0}, Vec2{high, 1}, Vec2{low, 1}}) {
            plane.positions.insert(plane.positions.end(), {float(at.x - 0.5), 0.0f, float(at.y - 0.5)});
            plane.normals.insert(plane.normals.end(), {0, 1, 0});
            const Vec2 uv = (cut != Cut::none && low > 0.0 ? laid_aside(at) : at) * 0.25;
            plane.uvs.insert(plane.uvs.end(), {float(uv.x), float(uv.y)});
        }
        for (const std::uint32_t i : {0u, 2u, 1u, 0u, 3u, 2u}) plane.indices.push_back(first + i);
    }
    if (cut == Cut::with_borders) {
        const SurfaceMesh view{plane.positions, plane.normals, plane.uvs, plane.indices};
        const ChartSet set = find_charts(std::span(&view, 1), {{p.detail.size_u, p.detail.size_v}, p.detail.repeat, 0.8});
        const ChartTable table = pack_charts(set.borders, p.detail.depth);
        material.detail.charts = table.layout;
        material.charts = table.words;
        for (const std::uint32_t chart : set.charts[0]) plane.charts.push_back(float(chart));
    }
    asset.materials.push_back(material);
    asset.primitives.push_back(plane);
    return asset;
}

TEST(ChartsRender, ACutLeavesNoTrace) {
    const PreparedPattern whole = prepare(in_one_piece()), halves = prepare(in_two_pieces());
    for (const Antialiasing kind : {Antialiasing::points, Antialiasing::regions})
        for (const double azimuth : {90.0, -60.0}) {
            RenderOptions options;
            options.width = 200, options.height = 150;
            options.camera = {.azimuth = azimuth, .elevation = 33.0, .zoom = 1.5};
            options.antialiasing = kind;
            options.rays = 16;
            options.backend = backend();
            const auto one = render_asset(plane_with(whole, Cut::none), options);
            SKIP_WITHOUT_CONTEXT(one);
            ASSERT_TRUE(one.ok()) << one.error().message;
            const auto two = render_asset(plane_with(halves, Cut::with_borders), options),
                       lost = render_asset(plane_with(halves, Cut::without_borders), options);
            ASSERT_TRUE(two.ok() && lost.ok());
            const double with = psnr(*one, *two), without = psnr(*one, *lost);
            std::printf("%s, azimuth %.0f: %.1f dB, without borders %.1f dB\n", kind == Antialiasing::points ? "points" : "areas", azimuth, with, without);
            if (const char* folder = std::getenv("BURIN_PICTURES")) {
                (void)write_png(std::string(folder) + "/one.png", *one);
                (void)write_png(std::string(folder) + "/two.png", *two);
                (void)write_png(std::string(folder) + "/lost.png", *lost);
            }
            EXPECT_GT(with, 42.0);
            EXPECT_GT(with, without + 3.0);
        }
}

}  // namespace
}  // namespace burin::testing
