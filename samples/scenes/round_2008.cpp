// Grooves on round things: a sphere and three vinyl records.
#include <cmath>

#include "build.hpp"
#include "scenes_2008.hpp"

namespace burin::scenes {

Scene make_grooved_sphere() {
    constexpr double kRadius = 0.1;
    constexpr int kGrooves = 36;
    const Vec2 size{2.0 * kPi * kRadius, kPi * kRadius};
    Pattern p = sheet(size, 0.0030, 0.0);
    p.profiles = {trough(0.0032, 0.0010, 0.0026)};
    for (int i = 0; i < kGrooves; ++i) {
        const double y = size.y * (i + 0.5) / kGrooves;
        p.paths.push_back(Stroke({0.0, y}).line({size.x, y}).close_across().path(0));
    }
    Scene scene;
    scene.flat = false;
    scene.parts.push_back({"ball", std::move(p), make_sphere(kRadius, 0.02), {0.28f, 0.42f, 0.62f}, 0.0f, 0.3f});
    scene.view.elevation = 25.0;
    return scene;
}

namespace {

constexpr double kInner = 0.060, kOuter = 0.146;
constexpr int kTiles = 24;  // around
constexpr int kGrooves = 120;

// Concentric grooves: straight lines in uv. `profile_of` chooses the section, `swing` bends each line like a recording.
template <typename Choose>
Scene record(std::vector<Profile> profiles, Choose profile_of, double swing) {
    const Vec2 size{2.0 * kPi * 0.5 * (kInner + kOuter) / kTiles, kOuter - kInner};
    Pattern p = sheet(size, 0.00042, 0.0);
    p.profiles = std::move(profiles);
    Chance chance(33);
    for (int i = 0; i < kGrooves; ++i) {
        const double y = size.y * (i + 0.5) / kGrooves, phase = chance.between(0.0, 2.0 * kPi);
        const int waves = 2 + chance.below(4);
        const auto at = [=](double s) { return Vec2{size.x * s, y + swing * std::sin(2.0 * kPi * waves * s + phase)}; };
        const std::uint32_t profile = profile_of(chance);
        Stroke line = swing > 0.0 ? smooth(at, 8 * waves) : Stroke({0.0, y}).line({size.x, y});
        p.paths.push_back(line.close_across().path(profile));
    }
    Scene scene;
    scene.flat = false;
    Mesh disc = make_ring(kInner, kOuter, 0.0008, kTiles);
    scene.parts.push_back({"vinyl", std::move(p), std::move(disc), {0.02f, 0.02f, 0.022f}, 0.0f, 0.25f});
    scene.view.elevation = 35.0;
    scene.view.light_elevation = 40.0;
    return scene;
}

constexpr double kHalf = 0.00030, kDeep = 0.00036;
std::vector<Profile> three_sections() {
    return {vee(kHalf, kDeep), {{{-kHalf, 0}, {-0.6 * kHalf, -kDeep}, {kHalf, 0}}, {}}, trough(kHalf, 0.5 * kHalf, 0.8 * kDeep)};
}

}  // namespace

Scene make_vinyl() {
    return record({vee(kHalf, kDeep)}, [](Chance&) { return 0u; }, 0.0);
}

Scene make_vinyl_three_profiles() {
    return record(three_sections(), [](Chance& chance) { return std::uint32_t(chance.below(3)); }, 0.0);
}

Scene make_vinyl_recorded() {
    return record(three_sections(), [](Chance& chance) { return std::uint32_t(chance.below(3)); }, 0.00003);
}

}  // namespace burin::scenes
