// Parallel grooves and crossing scratches.
#include <algorithm>
#include <cmath>

#include "build.hpp"
#include "scenes_2008.hpp"

namespace burin::scenes {

Scene make_parallel_grooves() {
    Pattern p = sheet({0.2, 0.2}, 0.0022, 0.0);
    p.profiles = {{{{-0.0020, 0}, {-0.0006, -0.0020}, {0.0004, -0.0020}, {0.0020, 0}}, {}}};
    constexpr int kGrooves = 40;
    for (int i = 0; i < kGrooves; ++i) {
        const double x = 0.2 * (i + 0.5) / kGrooves;
        p.paths.push_back(Stroke({x, 0.0}).line({x, 0.2}).close_across().path(0));
    }
    Scene scene = on_plane(std::move(p), {0.75f, 0.45f, 0.25f}, 0.0f, 0.45f);
    scene.view.azimuth = 60.0;
    scene.view.zoom = 1.8;
    return scene;
}

Scene make_crossing_scratches() {
    Pattern p = sheet({0.25, 0.25}, 0.0016, 0.0004);
    for (const double half : {0.0022, 0.0012, 0.0006, 0.0003}) p.profiles.push_back(lipped(half, 0.6 * half, 0.15 * half));
    Chance chance(1608);
    const int counts[] = {6, 14, 40, 110};
    for (std::uint32_t size = 0; size < 4; ++size)
        for (int i = 0; i < counts[size]; ++i) {
            const Vec2 middle{chance.between(0.0, 0.25), chance.between(0.0, 0.25)};
            const double angle = chance.between(0.0, kPi), half = chance.between(0.015, 0.05) * (4.0 - size) / 2.5;
            const Vec2 way = Vec2{std::cos(angle), std::sin(angle)} * std::min(half, 0.1);
            const Vec2 bow = normal_of(way) * chance.between(-0.2, 0.2);
            // A stroke of the hand begins and ends in nothing.
            const auto pressure = [](double s) { return std::min(1.0, 6.0 * std::min(s, 1.0 - s)); };
            Path stroke = Stroke(middle - way).curve(middle + bow, middle + way).path(size);
            stroke.start_cap = stroke.end_cap = CapKind::butt;
            p.paths.push_back(scaled(stroke, pressure, pressure, 0.2));
        }
    Scene scene = on_plane(std::move(p), {0.6f, 0.62f, 0.65f}, 0.9f, 0.35f);
    scene.view.azimuth = 20.0;
    scene.view.zoom = 2.0;
    return scene;
}

}  // namespace burin::scenes
