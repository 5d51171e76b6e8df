// A house of few polygons: tiled roof with fine grooves along the tiles, brick walls, planks, panes, a paved yard.
#include "build.hpp"
#include "scenes_2008.hpp"

namespace burin::scenes {
namespace {

constexpr Vec2 kRoofTile{0.8, 0.8};

// Rows of tiles: each row rises to its lower edge and drops there; gaps between tiles end on the edge above. Every tile
// carries micro-grooves that run down with it.
Pattern tiles() {
    Pattern p = sheet(kRoofTile, 0.012, 0.032);
    p.profiles = {{{{-0.150, 0}, {-0.02, 0.026}, {0.004, 0.026}, {0.010, 0}}, {}}, trough(0.011, 0.006, 0.010), vee(0.0045, 0.0030)};
    p.materials.push_back({true, {0.20f, 0.24f, 0.34f, 1.0f}, 0.4f, 0.3f});
    constexpr int kRows = 4, kAcross = 4;
    for (int row = 0; row < kRows; ++row) {
        const double y = 0.8 * (row + 0.5) / kRows, high = 0.8 / kRows;
        // Leftwards, so that the side of the rise, left of the path, lies up the roof.
        p.paths.push_back(Stroke({0.8, y}).line({0.0, y}).close_across().path(0));
        std::swap(p.paths.back().elements.front().p0, p.paths.back().elements.front().p2);
        for (int k = 0; k < kAcross; ++k) {
            const double x = 0.8 * (k + 0.25 + 0.5 * (row % 2)) / kAcross;
            p.paths.push_back(polyline({{x, y - high}, {x, y}}).path(1));
        }
    }
    for (int k = 0; k < 48; ++k) {
        const double x = 0.8 * (k + 0.5) / 48;
        p.paths.push_back(Stroke({x, 0.0}).line({x, 0.8}).close_across().path(2, 1));
    }
    return p;
}

Pattern bricks() {
    Pattern p = sheet({1.0, 0.6}, 0.012, 0.0);
    p.profiles = {trough(0.011, 0.006, 0.010)};
    p.materials.push_back({true, {0.62f, 0.60f, 0.56f, 1.0f}, 0.0f, 0.9f});
    add_courses(p, 6, 4, 0, 1);
    return p;
}

Pattern planks() {
    Pattern p = sheet({1.0, 2.0}, 0.024, 0.0, Wrap::clamp);
    p.profiles = {vee(0.008, 0.008), {{{-0.012, 0}, {0, -0.008}, {0.012, -0.016}}, {}}, round_groove(0.02, 0.006, 8)};
    for (int k = 1; k < 6; ++k) p.paths.push_back(polyline({{k / 6.0, -0.1}, {k / 6.0, 2.1}}).path(0));
    for (const double y : {0.42, 1.42}) {
        Path panel = slab({0.5, y + 0.1}, {0.36, 0.30}, 0.04).path(1);
        p.paths.push_back(panel);
        p.paths.push_back(circle({0.5, y + 0.1}, 0.16).path(2, 0, -0.016));
    }
    return p;
}

Pattern panes() {
    Pattern p = sheet({0.8, 0.9}, 0.05, 0.0, Wrap::clamp);
    p.profiles = {{{{-0.015, 0}, {0, -0.01}, {0.004, -0.04}, {0.012, -0.04}}, {}}};
    for (const double x : {0.08, 0.43})
        for (const double y : {0.08, 0.48})
            p.paths.push_back(polygon({{x, y}, {x + 0.29, y}, {x + 0.29, y + 0.34}, {x, y + 0.34}}).path(0));
    return p;
}

Pattern cobbles() {
    Pattern p = sheet({1.2, 1.2}, 0.02, 0.0);
    p.profiles = {round_groove(0.028, 0.016, 6)};
    for (int k = 0; k < 6; ++k) {
        const double s = 0.2 * k;
        p.paths.push_back(Stroke({s, 0.0}).line({s + 1.2, 1.2}).close_across().path(0));
        p.paths.push_back(Stroke({s, 1.2}).line({s + 1.2, 0.0}).close_across().path(0));
    }
    return p;
}

}  // namespace

Scene make_house() {
    constexpr double kX = 2.0, kZ = 1.5, kEaves = 2.4, kRidge = 3.9, kOver = 0.3;
    Scene scene;
    scene.flat = false;
    // Both slopes reach over the walls by kOver.
    const double fall = (kRidge - kEaves) / kZ, low = kEaves - fall * kOver, run = kZ + kOver, drop = kRidge - low;
    Mesh roof = make_quad({-kX - kOver, kRidge, 0}, {2 * (kX + kOver), 0, 0}, {0, -drop, run}, kRoofTile);
    append(roof, make_quad({kX + kOver, kRidge, 0}, {-2 * (kX + kOver), 0, 0}, {0, -drop, -run}, kRoofTile));
    scene.parts.push_back({"roof", tiles(), std::move(roof), {0.60f, 0.22f, 0.14f}, 0.0f, 0.5f});

    const Vec2 brick{1.0, 0.6};
    Mesh brickwork = make_sides({-kX, 0, -kZ}, {kX, kEaves, kZ}, brick);
    append(brickwork, make_sides({0.9, 2.6, -0.5}, {1.4, 4.3, 0.0}, brick));
    for (const double side : {1.0, -1.0}) {
        // Gable: a quad whose upper corners meet in the ridge.
        Mesh gable = make_quad({side * kX, kRidge, side * kZ}, {0, 0, -2 * side * kZ}, {0, kEaves - kRidge, 0}, brick);
        for (const std::size_t top : {0, 1}) {
            gable.positions[3 * top + 2] = 0.0f;
            gable.uvs[2 * top] = float(kZ / brick.x);
        }
        append(brickwork, gable);
    }
    scene.parts.push_back({"walls", bricks(), std::move(brickwork), {0.52f, 0.24f, 0.17f}, 0.0f, 0.85f});
    scene.parts.push_back({"door", planks(), make_quad({-0.5, 2.0, kZ + 0.01}, {1, 0, 0}, {0, -2, 0}, {1, 2}), {0.32f, 0.20f, 0.11f}, 0.0f, 0.6f});
    Mesh windows = make_quad({-1.6, 1.8, kZ + 0.01}, {0.8, 0, 0}, {0, -0.9, 0}, {0.8, 0.9});
    append(windows, make_quad({0.8, 1.8, kZ + 0.01}, {0.8, 0, 0}, {0, -0.9, 0}, {0.8, 0.9}));
    append(windows, make_quad({kX + 0.01, 1.8, 0.4}, {0, 0, -0.8}, {0, -0.9, 0}, {0.8, 0.9}));
    scene.parts.push_back({"windows", panes(), std::move(windows), {0.82f, 0.82f, 0.78f}, 0.0f, 0.4f});
    scene.parts.push_back({"yard", cobbles(), make_quad({-4, 0, -3.5}, {8, 0, 0}, {0, 0, 7}, {1.2, 1.2}), {0.42f, 0.42f, 0.40f}, 0.0f, 0.8f});
    scene.view.azimuth = 32.0;
    scene.view.elevation = 14.0;
    scene.view.zoom = 1.8;
    scene.view.light_azimuth = -20.0;
    return scene;
}

}  // namespace burin::scenes
