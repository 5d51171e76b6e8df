// Borders of meshes whose charts are known.
#include <burin/charts.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace burin {
namespace {

struct Mesh {
    std::vector<float> positions, normals, uvs;
    std::vector<std::uint32_t> indices;
    SurfaceMesh view() const { return {positions, normals, uvs, indices}; }
    std::uint32_t add(std::array<double, 3> p, std::array<double, 3> n, Vec2 uv) {
        for (std::size_t k = 0; k < 3; ++k) {
            positions.push_back(float(p[k]));
            normals.push_back(float(n[k]));
        }
        uvs.insert(uvs.end(), {float(uv.x), float(uv.y)});
        return std::uint32_t(positions.size() / 3 - 1);
    }
};

// Two unit squares that meet at x = 0, the right one leading down by `angle`; uv of the right one by `lay` from (x, z).
template <typename Lay>
Mesh two_squares(double angle, Lay lay) {
    Mesh mesh;
    const double c = std::cos(angle), s = std::sin(angle);
    const std::array<double, 3> up{0, 1, 0}, right{s, c, 0};
    const std::uint32_t a = mesh.add({-1, 0, 0}, up, {0, 0}), b = mesh.add({0, 0, 0}, up, {1, 0}), d = mesh.add({-1, 0, 1}, up, {0, 1}),
                        e = mesh.add({0, 0, 1}, up, {1, 1});
    const std::uint32_t f = mesh.add({0, 0, 0}, right, lay(0, 0)), g = mesh.add({c, -s, 0}, right, lay(1, 0)), h = mesh.add({0, 0, 1}, right, lay(0, 1)),
                        i = mesh.add({c, -s, 1}, right, lay(1, 1));
    mesh.indices = {a, d, b, b, d, e, f, h, g, g, h, i};
    return mesh;
}

ChartSet charts_of(const Mesh& mesh, const ChartOptions& options = {}) {
    const SurfaceMesh view = mesh.view();
    return find_charts(std::span(&view, 1), options);
}

// Where a point just off the edge comes to lie on the other side.
Vec2 beyond(const ChartBorder& b, Vec2 p) {
    const Vec2 d = p - b.begin;
    return b.there + Vec2{b.map[0] * d.x + b.map[1] * d.y, b.map[2] * d.x + b.map[3] * d.y};
}

const ChartBorder& border_from(const ChartSet& set, std::uint32_t key) {
    for (const ChartBorder& border : set.borders)
        if (border.from == key) return border;
    ADD_FAILURE() << "no border of chart key " << key;
    return set.borders.front();
}

TEST(Charts, WhatGoesOnInUvIsOneChart) {
    const ChartSet set = charts_of(two_squares(0.0, [](double x, double z) { return Vec2{1 + x, z}; }));
    EXPECT_EQ(set.count, 1u);
    EXPECT_TRUE(set.borders.empty());
    EXPECT_FALSE(set.needed);
}

TEST(Charts, ATurnedAndStretchedChartIsUnfolded) {
    // A metre along x is half a unit along v, a metre along z two units against u.
    const auto lay = [](double x, double z) { return Vec2{5 - 2 * z, 3 + 0.5 * x}; };
    const ChartSet set = charts_of(two_squares(0.0, lay));
    ASSERT_EQ(set.count, 2u);
    ASSERT_EQ(set.borders.size(), 2u);
    EXPECT_TRUE(set.needed);
    EXPECT_EQ(set.charts[0], (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1}));
    const ChartBorder& border = set.borders[0].from / 2 == 0 ? set.borders[0] : set.borders[1];
    EXPECT_NEAR(border.scale, 1.0, 1e-6);
    EXPECT_EQ(border.angle, 0.0);
    for (const Vec2 p : {Vec2{1, 0.25}, Vec2{1.3, 0.7}}) {
        const Vec2 there = beyond(border, p), wanted = lay(p.x - 1, p.y);
        EXPECT_NEAR(there.x, wanted.x, 1e-6);
        EXPECT_NEAR(there.y, wanted.y, 1e-6);
    }
    // Outside is where the other square lies.
    const Vec2 t = border.end - border.begin;
    EXPECT_GT(-t.y, 0.0);
    // And back.
    const ChartBorder& back = border_from(set, border.to);
    const Vec2 home = beyond(back, beyond(border, {1.2, 0.4}));
    EXPECT_NEAR(home.x, 1.2, 1e-6);
    EXPECT_NEAR(home.y, 0.4, 1e-6);
}

TEST(Charts, SizesAreInTheMap) {
    const ChartSet set = charts_of(two_squares(0.0, [](double x, double z) { return Vec2{5 - 2 * z, 3 + 0.5 * x}; }), {{0.5, 4.0}, true, 0.8});
    ASSERT_EQ(set.borders.size(), 2u);
    const ChartBorder& border = set.borders[0].from / 2 == 0 ? set.borders[0] : set.borders[1];
    const Vec2 there = beyond(border, {0.5 * 1.3, 4.0 * 0.7});
    EXPECT_NEAR(there.x, 0.5 * (5 - 2 * 0.7), 1e-6);
    EXPECT_NEAR(there.y, 4.0 * (3 + 0.5 * 0.3), 1e-6);
    EXPECT_NEAR(border.scale, 2.0, 1e-6);
}

TEST(Charts, AMirroredHalfMeetsItselfInABorder) {
    Mesh mesh = two_squares(0.0, [](double x, double z) { return Vec2{1 - x, z}; });
    const ChartSet set = charts_of(mesh);
    // One part by its vertices; its halves are wound differently.
    EXPECT_EQ(set.count, 1u);
    ASSERT_EQ(set.borders.size(), 2u);
    EXPECT_NE(set.borders[0].from, set.borders[0].to);
    EXPECT_EQ(set.borders[0].from, set.borders[1].to);
    const Vec2 there = beyond(set.borders[0], {1.2, 0.5}), other = beyond(set.borders[1], {1.2, 0.5});
    EXPECT_NEAR(there.x, 0.8, 1e-6);
    EXPECT_NEAR(other.x, 0.8, 1e-6);
}

TEST(Charts, WholeTilesNeedNoBordersOfPatternsThatRepeat) {
    const Mesh mesh = two_squares(0.0, [](double x, double z) { return Vec2{x - 4, z + 2}; });
    EXPECT_FALSE(charts_of(mesh).needed);
    EXPECT_EQ(charts_of(mesh).borders.size(), 2u);
    EXPECT_TRUE(charts_of(mesh, {{1, 1}, false, 0.8}).needed);
    EXPECT_TRUE(charts_of(two_squares(0.0, [](double x, double z) { return Vec2{x - 4.5, z + 2}; })).needed);
}

TEST(Charts, ACreaseTurnsByItsAngle) {
    for (const double angle : {1.2, -1.2, 1.5707963}) {
        const ChartSet set = charts_of(two_squares(angle, [](double x, double z) { return Vec2{1 + x, z}; }));
        EXPECT_EQ(set.count, 1u);
        ASSERT_EQ(set.borders.size(), 2u) << angle;
        EXPECT_TRUE(set.needed);
        for (const ChartBorder& border : set.borders) EXPECT_NEAR(border.angle, angle, 1e-5);
    }
    // Normals that differ less count as smooth.
    EXPECT_TRUE(charts_of(two_squares(0.3, [](double x, double z) { return Vec2{1 + x, z}; })).borders.empty());
}

TEST(Charts, FoldedBackOnItselfIsAnEnd) {
    EXPECT_TRUE(charts_of(two_squares(3.1, [](double x, double z) { return Vec2{1 + x, z}; })).borders.empty());
    // A triangle wound the wrong way, with normals to match.
    Mesh mesh = two_squares(0.0, [](double x, double z) { return Vec2{3 + x, z}; });
    for (std::size_t i = 12; i < 24; i += 3) mesh.normals[i + 1] = -1.0f;
    EXPECT_TRUE(charts_of(mesh).borders.empty());
}

TEST(Charts, DegenerateTrianglesMakeNoBorder) {
    EXPECT_TRUE(charts_of(two_squares(0.0, [](double, double z) { return Vec2{7, z}; })).borders.empty());
    EXPECT_TRUE(charts_of(two_squares(0.0, [](double, double) { return Vec2{7, 7}; })).borders.empty());
    EXPECT_TRUE(charts_of(Mesh{}).borders.empty());
}

TEST(Charts, EveryCellListsWhatComesIntoIt) {
    std::vector<ChartBorder> borders;
    for (int i = 0; i < 40; ++i) {
        const double a = 0.37 * i;
        ChartBorder border;
        border.begin = {3 * std::cos(a), 2 * std::sin(1.7 * a)};
        border.end = border.begin + Vec2{std::sin(2.1 * a), 0.5 * std::cos(3.3 * a)};
        border.angle = i % 3 == 0 ? 1.0 : 0.0;
        borders.push_back(border);
    }
    const double depth = 0.05;
    const ChartTable table = pack_charts(borders, depth);
    const ChartLayout& l = table.layout;
    ASSERT_EQ(table.words.size(), 4u * std::size_t(l.width) * std::size_t(l.height));
    const auto listed = [&](Vec2 p, std::uint32_t border) {
        const int x = int(std::floor((p.x - l.origin[0]) / l.cell[0])), y = int(std::floor((p.y - l.origin[1]) / l.cell[1]));
        if (x < 0 || y < 0 || x >= l.columns || y >= l.rows) return false;
        const std::size_t cell = 4 * l.first_cell() + 2 * std::size_t(y * l.columns + x);
        for (std::uint32_t k = 0; k < table.words[cell + 1]; ++k)
            if (table.words[4 * l.first_reference() + table.words[cell] + k] == border) return true;
        return false;
    };
    for (std::uint32_t i = 0; i < borders.size(); ++i)
        for (int k = 0; k <= 50; ++k) {
            const ChartBorder& b = borders[i];
            const Vec2 t = (b.end - b.begin) * (1.0 / length(b.end - b.begin)), n{-t.y, t.x};
            const Vec2 p = b.begin + (b.end - b.begin) * (k / 50.0);
            const double off = depth * std::tan(0.5 * b.angle) / b.scale;
            EXPECT_TRUE(listed(p, i)) << i;
            EXPECT_TRUE(listed(p - n * off, i)) << i;
        }
}

}  // namespace
}  // namespace burin
