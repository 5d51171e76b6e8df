// Figures 5 to 7 of 2010, one by one: what happens where features meet and end.
#include "build.hpp"
#include "scenes_2010.hpp"

namespace burin::scenes {
namespace {

Pattern small_sheet() { return sheet({0.06, 0.06}, 0.0050, 0.0025, Wrap::clamp); }

Scene show(Pattern pattern) {
    Scene scene = on_plane(std::move(pattern), {0.55f, 0.60f, 0.68f}, 0.0f, 0.45f);
    scene.view.elevation = 48.0;
    scene.view.zoom = 1.35;
    return scene;
}

}  // namespace

// Two grooves of different depth, and one that bends through both.
Scene make_crossing() {
    Pattern p = small_sheet();
    p.profiles = {vee(0.0060, 0.0042), vee(0.0045, 0.0026), trough(0.0022, 0.0012, 0.0018)};
    p.paths = {polyline({{-0.01, 0.032}, {0.07, 0.024}}).path(0), polyline({{0.024, -0.01}, {0.036, 0.07}}).path(1),
               Stroke({0.006, 0.052}).curve({0.034, 0.050}, {0.054, 0.008}).path(2)};
    return show(std::move(p));
}

// Grooves with lips, and a ridge: all that is added comes before anything is cut.
Scene make_crossing_protruding() {
    Pattern p = small_sheet();
    p.profiles = {lipped(0.0060, 0.0034, 0.0018), lipped(0.0040, 0.0022, 0.0011), ridge(0.0032, 0.0012, 0.0016)};
    p.paths = {polyline({{-0.01, 0.036}, {0.07, 0.028}}).path(0), polyline({{0.020, -0.01}, {0.030, 0.07}}).path(1),
               polyline({{0.040, -0.01}, {0.050, 0.07}}).path(2)};
    return show(std::move(p));
}

// Ends on the line of another groove: the far half of that one stays whole, even under a deeper end.
Scene make_intersected_end() {
    Pattern p = small_sheet();
    p.profiles = {trough(0.0050, 0.0020, 0.0026), vee(0.0040, 0.0042), lipped(0.0040, 0.0020, 0.0012)};
    p.paths = {polyline({{-0.01, 0.030}, {0.07, 0.030}}).path(0), polyline({{0.016, -0.01}, {0.018, 0.030}}).path(1),
               polyline({{0.044, 0.07}, {0.040, 0.030}}).path(2)};
    return show(std::move(p));
}

// Every cap there is, on a groove and on a ridge.
Scene make_isolated_end() {
    Pattern p = small_sheet();
    p.profiles = {trough(0.0026, 0.0010, 0.0026), ridge(0.0026, 0.0010, 0.0018)};
    const CapKind caps[] = {CapKind::hip, CapKind::butt, CapKind::round, CapKind::taper};
    for (int i = 0; i < 4; ++i)
        for (std::uint32_t profile = 0; profile < 2; ++profile) {
            const double y = 0.010 + 0.0133 * i, x = 0.0125 + 0.028 * profile;
            Path path = polyline({{x, y}, {x + 0.006, y + 0.001}}).path(profile);
            path.start_cap = path.end_cap = caps[i];
            p.paths.push_back(path);
        }
    return show(std::move(p));
}

// Every join there is, on a groove, a ridge and a groove with lips.
Scene make_corner() {
    Pattern p = small_sheet();
    p.profiles = {trough(0.0026, 0.0010, 0.0030), ridge(0.0024, 0.0010, 0.0018), lipped(0.0030, 0.0024, 0.0010)};
    const JoinKind joins[] = {JoinKind::mitre, JoinKind::round, JoinKind::bevel};
    for (int i = 0; i < 3; ++i)
        for (std::uint32_t profile = 0; profile < 3; ++profile) {
            const double x = 0.004 + 0.0185 * profile, y = 0.004 + 0.0185 * i;
            Path path = polyline({{x, y + 0.004}, {x + 0.012, y + 0.002}, {x + 0.004, y + 0.008}, {x + 0.012, y + 0.013}}).path(profile);
            path.join = joins[i];
            p.paths.push_back(path);
        }
    return show(std::move(p));
}

}  // namespace burin::scenes
