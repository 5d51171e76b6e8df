// Figure 8 of 2010: what lies on planes.
#include <cmath>

#include "build.hpp"
#include "scenes_2010.hpp"

namespace burin::scenes {

// A rope laid in loops: one closed path that crosses itself, its width and depth swelling like a sine.
Scene make_sine_path() {
    Pattern p = sheet({0.24, 0.24}, 0.0040, 0.0, Wrap::clamp);
    p.profiles = {trough(0.0034, 0.0010, 0.0026)};
    const auto at = [](double s) {
        const double a = 2.0 * kPi * s, r = 0.070 + 0.034 * std::cos(7.0 * a);
        return Vec2{0.12 + r * std::cos(2.0 * a), 0.12 + r * std::sin(2.0 * a)};
    };
    p.paths.push_back(with_sine(smooth(at, 63).close().path(0), 0.42, 0.42, 0.017));
    Scene scene = on_plane(std::move(p), {0.80f, 0.72f, 0.55f}, 0.0f, 0.5f);
    scene.view.elevation = 60.0;
    scene.view.zoom = 1.35;
    return scene;
}

// Waves of rails whose heads stand over their feet, and rings that are wider below than at their mouth.
Scene make_overhang() {
    Pattern p = sheet({0.2, 0.2}, 0.0075, 0.0045);
    p.profiles = {rail(0.0016, 0.0040, 0.0040), undercut(0.0024, 0.0044, 0.0030)};
    p.materials.push_back({true, {0.30f, 0.38f, 0.52f, 1.0f}, 0.0f, 0.4f});
    for (int row = 0; row < 5; ++row) {
        const double y = 0.02 + 0.04 * row;
        const auto wave = [=](double s) { return Vec2{0.2 * s, y + 0.008 * std::sin(4.0 * kPi * s + 0.9 * row)}; };
        p.paths.push_back(smooth(wave, 20).close_across().path(0, 1));
    }
    for (const Vec2 centre : {Vec2{0.05, 0.06}, Vec2{0.15, 0.06}, Vec2{0.10, 0.14}, Vec2{0.0, 0.14}})
        p.paths.push_back(circle(centre, 0.026).path(1));
    Scene scene = on_plane(std::move(p), {0.75f, 0.66f, 0.52f}, 0.0f, 0.5f);
    scene.view.elevation = 40.0;
    scene.view.zoom = 1.8;
    return scene;
}

Scene make_sunken_square() {
    Pattern p = sheet({0.1, 0.1}, 0.01, 0.0, Wrap::clamp);
    // Clockwise on screen: the inside is to the right, and lower.
    p.profiles = {{{{-0.004, 0}, {0, -0.003}, {0.002, -0.009}, {0.004, -0.009}}, {}}};
    p.paths.push_back(polygon({{0.025, 0.025}, {0.075, 0.025}, {0.075, 0.075}, {0.025, 0.075}}).path(0));
    Scene scene = on_plane(std::move(p), {0.65f, 0.25f, 0.2f}, 0.0f, 0.4f);
    scene.view.zoom = 1.35;
    return scene;
}

namespace {

// Grows one crack and its branches; each begins on a corner of its parent and thins to nothing.
struct CrackGrower {
    Pattern& pattern;
    Chance& chance;

    void grow(Vec2 start, double heading, double span, double width, int generation) const {
        const int steps = 4 + int(span / 0.006);
        std::vector<Vec2> points = {start};
        for (int i = 0; i < steps; ++i) {
            heading += chance.between(-0.55, 0.55);
            points.push_back(points.back() + Vec2{std::cos(heading), std::sin(heading)} * (span / steps * chance.between(0.7, 1.3)));
        }
        const auto thinning = [=](double s) { return width * (1.0 - s); };
        Path crack = scaled(polyline(points).path(0), thinning, thinning, 1.0);
        crack.start_cap = crack.end_cap = CapKind::butt;
        pattern.paths.push_back(crack);
        if (generation == 0) return;
        for (int i = 2; i + 2 < steps; i += 3) {
            const double side = chance.uniform() < 0.5 ? -1.0 : 1.0, left = 1.0 - double(i) / steps;
            const Vec2 way = points[std::size_t(i) + 1] - points[std::size_t(i)];
            // From the middle of a piece, not from its corner: a T.
            grow(lerp(points[std::size_t(i)], points[std::size_t(i) + 1], 0.5), std::atan2(way.y, way.x) + side * chance.between(0.7, 1.2),
                 span * left * chance.between(0.4, 0.7), width * left * 0.8, generation - 1);
        }
    }
};

}  // namespace

// Three cracks that branch twice, widths and depths running to zero.
Scene make_tapered_cracks() {
    Pattern p = sheet({0.2, 0.2}, 0.0040, 0.0, Wrap::clamp);
    p.profiles = {{{{-0.0022, 0}, {-0.0012, -0.0012}, {-0.0002, -0.0032}, {0.0007, -0.0014}, {0.0022, 0}}, {}}};
    Chance chance(41);
    const CrackGrower grower{p, chance};
    grower.grow({0.004, 0.052}, 0.25, 0.17, 1.0, 2);
    grower.grow({0.196, 0.10}, kPi + 0.15, 0.15, 0.9, 2);
    grower.grow({0.052, 0.196}, -1.1, 0.15, 0.85, 2);
    grower.grow({0.150, 0.004}, 1.9, 0.08, 0.7, 1);
    Scene scene = on_plane(std::move(p), {0.58f, 0.52f, 0.46f}, 0.0f, 0.8f);
    scene.view.azimuth = 10.0;
    scene.view.zoom = 1.5;
    return scene;
}

// An inscription that stands out of its slab, in a frame.
Scene make_letters() {
    Pattern p = sheet({0.24, 0.2}, 0.0010, 0.0026, Wrap::clamp);
    p.profiles = {moulding(0.0006, 0.0024), trough(0.0016, 0.0008, 0.0008)};
    const char* lines[] = {"ARS LONGA", "VITA BREVIS", "ET SIGNA", "BURINO INSTAR", "ARTE TENENT"};
    double y = 0.018;
    for (const char* line : lines) {
        const double high = 0.0235, width = width_of(line, high), fit = std::min(1.0, 0.208 / width);
        for (Path& path : outlines(line, high * fit, {0.12 - width * fit / 2, y}, 0)) p.paths.push_back(path);
        y += 0.0345;
    }
    p.paths.push_back(slab({0.12, 0.1}, {0.114, 0.094}, 0.008).path(1));
    Scene scene = on_plane(std::move(p), {0.72f, 0.70f, 0.66f}, 0.0f, 0.7f);
    scene.view.azimuth = 10.0;
    scene.view.zoom = 1.25;
    return scene;
}

}  // namespace burin::scenes
