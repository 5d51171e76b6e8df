// Figure 8 of 2010, top row.
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
    p.paths.push_back(with_sine(smooth(at, 84).close().path(0), 0.42, 0.42, 0.017));
    Scene scene = on_plane(std::move(p), {0.80f, 0.72f, 0.55f}, 0.0f, 0.5f);
    scene.view.elevation = 60.0;
    return scene;
}

Scene make_sunken_square() {
    Pattern p = sheet({0.1, 0.1}, 0.01, 0.0, Wrap::clamp);
    // Clockwise on screen: the inside is to the right, and lower.
    p.profiles = {{{{-0.004, 0}, {0, -0.003}, {0.002, -0.009}, {0.004, -0.009}}, {}}};
    p.paths.push_back(polygon({{0.025, 0.025}, {0.075, 0.025}, {0.075, 0.075}, {0.025, 0.075}}).path(0));
    Scene scene = on_plane(std::move(p), {0.65f, 0.25f, 0.2f}, 0.0f, 0.4f);
    return scene;
}

}  // namespace burin::scenes
