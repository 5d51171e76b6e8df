// An inner court: arcades on three sides around a tiled floor, friezes above them, brick walls and a door behind.
#include <algorithm>
#include <cmath>

#include "build.hpp"
#include "scenes_2010.hpp"

namespace burin::scenes {
namespace {

// Metres. A bay of the arcade is one arch and half a column on both sides of it.
constexpr double kBay = 2.0, kOpening = 0.70, kSpring = 2.72, kFaceTop = 3.95, kThick = 0.5;
constexpr double kHalfWidth = 3.0, kBack = -8.0, kGallery = 1.7;  // of the court; its back; depth behind the columns
constexpr int kSideBays = 6, kBackBays = 3, kVoussoirs = 13;
constexpr double kFront = kBack + kBay * kSideBays;
constexpr double kFriezeTop = 4.40, kWallTop = 5.95, kCorniceTop = 6.30;

Material paint(float red, float green, float blue, float roughness) { return {true, {red, green, blue, 1.0f}, 0.0f, roughness}; }

// ---- patterns ----

// Octagons of marble with dark squares inlaid where four of them meet, and a star in each.
Pattern floor_tiles() {
    constexpr double kTile = 0.8, kInlay = 0.115;
    Pattern p = sheet({kTile, kTile}, 0.009, 0.0);
    p.profiles = {trough(0.006, 0.003, 0.008), trough(kInlay, kInlay - 0.006, 0.003), trough(0.007, 0.004, 0.004)};
    p.materials.push_back(paint(0.17f, 0.15f, 0.13f, 0.9f));
    p.materials.push_back(paint(0.15f, 0.05f, 0.04f, 0.35f));
    const Vec2 middle{kTile / 2, kTile / 2};
    const double corner = kInlay * std::sqrt(2.0), edge = kTile - corner;
    p.paths.push_back(polyline({middle + Vec2{corner, 0.0}, middle + Vec2{edge, 0.0}}).path(0, 1));
    p.paths.push_back(polyline({middle + Vec2{0.0, corner}, middle + Vec2{0.0, edge}}).path(0, 1));
    // A short path with a wide section and hipped ends: a square whose floor has its own material.
    const Vec2 way{0.004, 0.004};
    p.paths.push_back(polyline({middle - way, middle + way}).path(1, 2));
    // A star of two squares in a ring.
    for (const double turn : {0.0, kPi / 4}) {
        std::vector<Vec2> points;
        for (int k = 0; k < 4; ++k) points.push_back(Vec2{std::cos(turn + kPi / 2 * k), std::sin(turn + kPi / 2 * k)} * 0.185);
        p.paths.push_back(polygon(points).path(2, 2));
    }
    p.paths.push_back(circle({0.0, 0.0}, 0.225).path(2, 2));
    return p;
}

// Flutes with round ends between two bands; the tile is the shaft unrolled.
Pattern flutes(double circumference, double high) {
    Pattern p = sheet({circumference, high}, 0.021, 0.006);
    p.profiles = {round_groove(0.029, 0.020 * 0.7, 8), round_groove(0.018, -0.006, 6)};
    constexpr int kFlutes = 18;
    for (int k = 0; k < kFlutes; ++k) {
        const double x = circumference * (k + 0.5) / kFlutes;
        Path flute = polyline({{x, 0.11}, {x, high - 0.11}}).path(0);
        flute.start_cap = flute.end_cap = CapKind::round;
        p.paths.push_back(flute);
    }
    for (const double y : {0.03, high - 0.03}) p.paths.push_back(Stroke({0.0, y}).line({circumference, y}).close_across().path(1));
    return p;
}

// Two rows of leaves with veins, as on a capital.
Pattern leaves(double circumference, double high) {
    Pattern p = sheet({circumference, high}, 0.016, 0.004);
    p.profiles = {vee(0.010, 0.012), vee(0.005, 0.006), ridge(0.012, 0.006, 0.004)};
    constexpr int kLeaves = 10;
    const double wide = circumference / kLeaves;
    for (int row = 0; row < 2; ++row)
        for (int k = 0; k < kLeaves; ++k) {
            const double x = wide * (k + 0.5 * row + 0.25), foot = high * (0.97 - 0.40 * row), tip = foot - 0.50 * high;
            p.paths.push_back(Stroke({x - 0.40 * wide, foot}).curve({x - 0.55 * wide, std::lerp(foot, tip, 0.8)}, {x, tip})
                                  .curve({x + 0.55 * wide, std::lerp(foot, tip, 0.8)}, {x + 0.40 * wide, foot}).path(0));
            p.paths.push_back(polyline({{x, foot - 0.01}, {x, std::lerp(foot, tip, 0.75)}}).path(1));
        }
    p.paths.push_back(Stroke({0.0, 0.012}).line({circumference, 0.012}).close_across().path(2));
    return p;
}

// Lines along a plinth or slab.
Pattern mouldings() {
    Pattern p = sheet({0.62, 0.14}, 0.012, 0.0);
    p.profiles = {round_groove(0.014, 0.012, 6)};
    for (const double y : {0.042, 0.098}) p.paths.push_back(Stroke({0.0, y}).line({0.62, y}).close_across().path(0));
    return p;
}

// The wall over one bay: wedge stones around the arch, a moulded ring about them, courses beyond it.
Pattern arch_face() {
    constexpr double kOuter = 1.02, kRing = kOpening + 0.05;
    const double high = kFaceTop - kSpring;
    Pattern p = sheet({kBay, high}, 0.024, 0.010);
    p.profiles = {trough(0.007, 0.003, 0.010), round_groove(0.022, -0.010, 6), {{{-0.02, 0}, {-0.006, -0.012}, {0.006, -0.012}, {0.02, 0}}, {}}};
    const Vec2 centre{kBay / 2, high};
    const auto at = [&](double radius, double angle) { return centre + Vec2{std::cos(angle), -std::sin(angle)} * radius; };
    for (const double radius : {kRing, kOuter}) {
        const double low = radius == kOuter ? std::acos(kBay / 2 / kOuter) : -0.05;
        Stroke ring(at(radius, kPi - low));
        ring.arc(centre, kPi - 2.0 * low);
        p.paths.push_back(ring.path(radius == kRing ? 1 : 0));
    }
    for (int k = 0; k <= kVoussoirs; ++k) {
        const double angle = kPi * k / kVoussoirs;
        const double far = std::min(kOuter, k == 0 || k == kVoussoirs ? kBay / 2 : kOuter);
        p.paths.push_back(polyline({at(kRing + 0.022, angle), at(far, angle)}).path(0));
    }
    // A disc in the corner between two arches, halved by the bays' border, and a panel line along the top.
    p.paths.push_back(circle({0.0, 0.36}, 0.155).path(2));
    p.paths.push_back(circle({0.0, 0.36}, 0.065).path(1));
    for (const double y : {0.035, 0.075}) p.paths.push_back(Stroke({0.0, y}).line({kBay, y}).close_across().path(0));
    return p;
}

// Underside of an arch: a sunken panel to every other stone.
Pattern arch_under(double along) {
    Pattern p = sheet({along, kThick}, 0.030, 0.0);
    p.profiles = {trough(0.007, 0.003, 0.010), {{{-0.004, 0}, {0.004, -0.006}, {0.010, -0.006}, {0.022, -0.022}}, {}}};
    for (int k = 0; k < kVoussoirs; ++k) {
        const double wide = along / kVoussoirs, x = wide * (k + 0.5);
        p.paths.push_back(polyline({{wide * k, -0.02}, {wide * k, kThick + 0.02}}).path(0));
        p.paths.push_back(slab({x, kThick / 2}, {0.30 * wide, 0.17}, 0.02).path(1));
    }
    return p;
}

// Leaves on both sides of a wave, and a spiral in every bow of it.
Pattern scrolls() {
    constexpr double kLong = 2.0, kHigh = kFriezeTop - kFaceTop, kWaves = 2.0;
    Pattern p = sheet({kLong, kHigh}, 0.018, 0.004);
    p.profiles = {trough(0.013, 0.005, 0.013), vee(0.013, 0.013), ridge(0.014, 0.008, 0.004)};
    const auto wave = [](double s) { return Vec2{kLong * s, kHigh / 2 + 0.115 * std::sin(2.0 * kPi * kWaves * s)}; };
    p.paths.push_back(smooth(wave, 32).close_across().path(0));
    for (int bow = 0; bow < int(2 * kWaves); ++bow) {
        const double hand = bow % 2 == 0 ? -1.0 : 1.0, from = (bow + 0.02) / (2.0 * kWaves);
        const Vec2 centre{kLong * (bow + 0.5) / (2.0 * kWaves), kHigh / 2 - hand * 0.005};
        const Vec2 spoke = wave(from) - centre;
        const double angle = std::atan2(spoke.y, spoke.x), radius = 0.125;
        const auto spiral = [=](double s) {
            const double r = radius * std::pow(1.0 - s, 1.1) + 0.014, a = angle + hand * (0.45 + 4.1 * kPi * s);
            return centre + Vec2{std::cos(a), std::sin(a)} * r;
        };
        const auto thin = [](double s) { return 1.0 - 0.55 * s; };
        p.paths.push_back(scaled(smooth(spiral, 22).path(1), thin, thin, 0.4));
    }
    for (const double y : {0.028, kHigh - 0.028}) p.paths.push_back(Stroke({0.0, y}).line({kLong, y}).close_across().path(2));
    return p;
}

// Capitals cut into a band as long as the back of the court.
Pattern inscription() {
    constexpr double kLong = 2.0 * kHalfWidth, kHigh = kFriezeTop - kFaceTop;
    Pattern p = sheet({kLong, kHigh}, 0.020, 0.004);
    p.profiles = {{{{-0.006, 0}, {0, -0.007}, {0.006, -0.014}}, {}}, ridge(0.014, 0.008, 0.004)};
    const char* text = "ARS LONGA VITA BREVIS";
    const double high = 0.235, width = width_of(text, high), fit = std::min(1.0, (kLong - 0.5) / width);
    for (Path& path : outlines(text, high * fit, {(kLong - width * fit) / 2, (kHigh - high * fit) / 2}, 0)) p.paths.push_back(std::move(path));
    for (const double y : {0.028, kHigh - 0.028}) p.paths.push_back(Stroke({0.0, y}).line({kLong, y}).close_across().path(1));
    return p;
}

Pattern brickwork() {
    Pattern p = sheet({1.0, 0.6}, 0.012, 0.0);
    p.profiles = {trough(0.009, 0.005, 0.010)};
    p.materials.push_back(paint(0.55f, 0.50f, 0.43f, 0.9f));
    add_courses(p, 8, 4, 0, 1);
    return p;
}

// Teeth under the eaves.
Pattern dentils() {
    constexpr double kLong = 0.25, kHigh = kCorniceTop - kWallTop;
    Pattern p = sheet({kLong, kHigh}, 0.046, 0.0);
    p.outer_level = -0.036;
    p.profiles = {rise(0.006, 0.034), trough(0.008, 0.004, 0.010)};
    p.paths.push_back(slab({kLong / 2, 0.20}, {0.075, 0.085}, 0.006).path(0, 0, -0.036));
    for (const double y : {0.05, 0.325}) p.paths.push_back(Stroke({0.0, y}).line({kLong, y}).close_across().path(1, 0, -0.036));
    return p;
}

// A blind window: an arched field, sunken in two steps, with lozenges of lead.
Pattern window() {
    const Vec2 size{0.9, 1.15};
    Pattern p = sheet(size, 0.052, 0.0, Wrap::clamp);
    p.profiles = {{{{-0.010, 0}, {0, -0.012}, {0.006, -0.038}, {0.014, -0.038}}, {}}, vee(0.008, 0.008), trough(0.012, 0.006, 0.010)};
    p.materials.push_back(paint(0.08f, 0.09f, 0.10f, 0.4f));
    const auto arched = [&](double half, double foot) {
        const double shoulder = 0.44;
        return Stroke({0.45 - half, foot}).line({0.45 - half, shoulder}).arc({0.45, shoulder}, kPi).line({0.45 + half, foot}).close();
    };
    p.paths.push_back(arched(0.29, 1.06).path(0));
    p.paths.push_back(arched(0.36, 1.12).path(2));
    const auto in_field = [](Vec2 q) {
        constexpr double kHalf = 0.262;  // up to the foot of the step
        return q.y < 0.44 ? std::hypot(q.x - 0.45, q.y - 0.44) < kHalf : std::abs(q.x - 0.45) < kHalf && q.y < 1.03;
    };
    for (int k = -7; k <= 7; ++k)
        for (const double hand : {1.0, -1.0}) {
            std::vector<Vec2> inside;
            for (double s = -0.3; s < 0.3; s += 0.004)
                if (const Vec2 q{0.45 + s, 0.58 + 0.14 * k + 0.75 * hand * s}; in_field(q)) inside.push_back(q);
            if (inside.size() > 10) p.paths.push_back(polyline({inside.front(), inside.back()}).path(1, 1, -0.038));
        }
    return p;
}

// Ceiling: coffers, one within another.
Pattern coffers() {
    Pattern p = sheet({1.0, kGallery / 2}, 0.09, 0.0);
    p.profiles = {{{{-0.01, 0}, {0, -0.03}, {0.01, -0.04}, {0.02, -0.04}}, {}}};
    const Vec2 middle = p.size * 0.5;
    p.paths.push_back(slab(middle, {0.40, 0.33}, 0.02).path(0));
    p.paths.push_back(slab(middle, {0.26, 0.19}, 0.02).path(0, 0, -0.04));
    return p;
}

// Two leaves of three panels each, planks' joints, and a ring to knock with.
Pattern door() {
    Pattern p = sheet({1.5, 2.6}, 0.040, 0.010, Wrap::clamp);
    p.profiles = {trough(0.010, 0.005, 0.016), {{{-0.016, 0}, {-0.006, 0.010}, {0.006, 0}, {0.014, -0.014}}, {}}, round_groove(0.016, -0.010, 6),
                  vee(0.006, 0.006)};
    p.materials.push_back({true, {0.75f, 0.52f, 0.20f, 1.0f}, 0.9f, 0.35f});
    p.paths.push_back(polyline({{0.75, -0.05}, {0.75, 2.65}}).path(0));
    for (const double x : {0.39, 1.11}) {
        for (const auto& [y, half] : {std::pair{0.48, 0.34}, {1.28, 0.34}, {2.10, 0.36}}) {
            p.paths.push_back(slab({x, y}, {0.25, half}, 0.03).path(1));
            p.paths.push_back(polygon({{x, y - half + 0.10}, {x + 0.16, y}, {x, y + half - 0.10}, {x - 0.16, y}}).path(3, 0, -0.014));
        }
        p.paths.push_back(circle({x, 1.28}, 0.09).path(2, 1, -0.014));
    }
    p.paths.push_back(slab({0.75, 1.3}, {0.70, 1.25}, 0.02).path(3));
    return p;
}

// ---- the court ----

// All patterns' triangles; a storey is drawn facing +z in the plane z = 0, and turned to its side of the court.
struct Court {
    Mesh floor, columns, capitals, plinths, faces, unders, scrolls, inscription, bricks, cornice, windows, ceiling, door;
};

// The wall over one bay, bounded below by its arch; uv (0,0) at its upper left.
Mesh arch_wall(double middle) {
    constexpr int kSteps = 24;
    const auto across = [](double u) { return u <= 0.0 ? -kBay / 2 : u >= 1.0 ? kBay / 2 : -kOpening * std::cos(kPi * (u * (kSteps + 2) - 1.0) / kSteps); };
    Mesh mesh = make_sheet(kSteps + 2, 1, [&](double u, double v) {
        const double x = across(u), low = kSpring + std::sqrt(std::max(0.0, kOpening * kOpening - x * x));
        return SurfacePoint3{{middle + x, kFaceTop + (low - kFaceTop) * v, 0.0}, {0, 0, 1}};
    });
    for (std::size_t i = 0; 2 * i < mesh.uvs.size(); ++i) {
        mesh.uvs[2 * i] = float((double(mesh.positions[3 * i]) - middle) / kBay + 0.5);
        mesh.uvs[2 * i + 1] = float((kFaceTop - double(mesh.positions[3 * i + 1])) / (kFaceTop - kSpring));
    }
    return mesh;
}

Mesh arch_underside(double middle) {
    return make_sheet(24, 1, [&](double u, double v) {
        const double angle = kPi * u, c = std::cos(angle), s = std::sin(angle);
        return SurfacePoint3{{middle - kOpening * c, kSpring + kOpening * s, -kThick * v}, {c, -s, 0}};
    });
}

constexpr double kShaftLow = 0.30, kShaftHigh = 2.32, kShaftRadius = 0.21;
constexpr double kAround = 2.0 * kPi * kShaftRadius, kCapitalHigh = 0.27, kCapitalAround = 2.0 * kPi * 0.255;
constexpr Vec2 kSlab{0.62, 0.14}, kBrick{1.0, 0.6};

// A column whose axis stands at x, in the middle of the wall's thickness.
void add_column(Court& court, double x) {
    const double z = -kThick / 2;
    append(court.columns, placed(make_column(0.95 * kShaftRadius, 1.05 * kShaftRadius, kShaftHigh - kShaftLow), 0.0, {x, (kShaftLow + kShaftHigh) / 2, z}));
    append(court.capitals, placed(make_column(0.30, 0.205, kCapitalHigh), 0.0, {x, kShaftHigh + kCapitalHigh / 2, z}));
    const double half = kSlab.x / 2, slab_low = kShaftHigh + kCapitalHigh;
    append(court.plinths, make_sides({x - half, slab_low, z - half}, {x + half, kSpring, z + half}, kSlab));
    append(court.plinths, make_sides({x - half, 0.0, z - half}, {x + half, kSlab.y, z + half}, kSlab));
    append(court.plinths, make_quad({x - half, kSlab.y, z - half}, {2 * half, 0, 0}, {0, 0, 2 * half}, {10.0, 10.0}));
    append(court.plinths, make_quad({x - half, slab_low, z + half}, {2 * half, 0, 0}, {0, 0, -2 * half}, {10.0, 10.0}));
    append(court.plinths, placed(make_column(0.235, 0.29, kShaftLow - kSlab.y, {2.0, 1.0}), 0.0, {x, (kShaftLow + kSlab.y) / 2, z}));
}

// One side of the court, `bays` wide; columns from `first` to `last` of its bays' borders. The gallery's wall goes on into the corners, its
// ceiling `beyond` the side at both ends.
Court make_side(int bays, int first, int last, double beyond) {
    Court side;
    const double half = bays * kBay / 2, behind = -kThick - kGallery;
    for (int i = 0; i < bays; ++i) {
        const double x = -half + kBay * (i + 0.5);
        append(side.faces, arch_wall(x));
        append(side.unders, arch_underside(x));
        append(side.windows, make_quad({x - 0.45, kFriezeTop + 1.35, 0.04}, {0.9, 0, 0}, {0, -1.15, 0}, {0.9, 1.15}));
    }
    for (int i = first; i <= last; ++i) add_column(side, -half + kBay * i);
    const auto strip = [&](double low, double high, Vec2 tile) { return make_quad({-half, high, 0}, {2 * half, 0, 0}, {0, low - high, 0}, tile); };
    side.scrolls = strip(kFaceTop, kFriezeTop, {2.0, kFriezeTop - kFaceTop});
    side.inscription = strip(kFaceTop, kFriezeTop, {2.0 * kHalfWidth, kFriezeTop - kFaceTop});
    side.bricks = strip(kFriezeTop, kWallTop, kBrick);
    side.cornice = strip(kWallTop, kCorniceTop, {0.25, kCorniceTop - kWallTop});
    append(side.bricks, make_quad({-half + behind, kFaceTop, behind}, {2 * (half - behind), 0, 0}, {0, -kFaceTop, 0}, kBrick));
    side.ceiling = make_quad({-half - beyond, kFaceTop, -kThick}, {2 * (half + beyond), 0, 0}, {0, 0, -kGallery}, {1.0, kGallery / 2});
    return side;
}

void append_side(Court& court, const Court& side, double turn, Vec3 by) {
    for (Mesh Court::*part : {&Court::columns, &Court::capitals, &Court::plinths, &Court::faces, &Court::unders, &Court::scrolls,
                              &Court::inscription, &Court::bricks, &Court::cornice, &Court::windows, &Court::ceiling})
        append(court.*part, placed(side.*part, turn, by));
}

Court build_court() {
    Court court;
    constexpr double kMiddle = (kBack + kFront) / 2, kBehind = kThick + kGallery;
    Court side = make_side(kSideBays, 0, kSideBays, 0.0);
    side.inscription = {};
    append_side(court, side, 90.0, {-kHalfWidth, 0, kMiddle});
    append_side(court, side, -90.0, {kHalfWidth, 0, kMiddle});
    Court back = make_side(kBackBays, 1, kBackBays - 1, kBehind);
    back.scrolls = {};
    append_side(court, back, 0.0, {0, 0, kBack});
    const double wide = kHalfWidth + kBehind, deep = kFront - kBack + kBehind;
    court.floor = make_quad({-wide, 0, kFront - deep}, {2 * wide, 0, 0}, {0, 0, deep}, {0.8, 0.8});
    court.door = make_quad({-0.75, 2.6, kBack - kBehind + 0.02}, {1.5, 0, 0}, {0, -2.6, 0}, {1.5, 2.6});
    return court;
}

}  // namespace

Scene make_atrium() {
    Court court = build_court();
    Scene scene;
    scene.flat = false;
    auto& parts = scene.parts;
    parts.push_back({"floor", floor_tiles(), std::move(court.floor), {0.66f, 0.60f, 0.50f}, 0.0f, 0.45f});
    parts.push_back({"columns", flutes(kAround, kShaftHigh - kShaftLow), std::move(court.columns), {0.80f, 0.73f, 0.60f}, 0.0f, 0.6f});
    parts.push_back({"capitals", leaves(kCapitalAround, kCapitalHigh), std::move(court.capitals), {0.80f, 0.73f, 0.60f}, 0.0f, 0.6f});
    parts.push_back({"plinths", mouldings(), std::move(court.plinths), {0.74f, 0.66f, 0.54f}, 0.0f, 0.65f});
    parts.push_back({"arches", arch_face(), std::move(court.faces), {0.78f, 0.66f, 0.47f}, 0.0f, 0.8f});
    parts.push_back({"undersides", arch_under(kPi * kOpening), std::move(court.unders), {0.74f, 0.62f, 0.45f}, 0.0f, 0.8f});
    parts.push_back({"scrolls", scrolls(), std::move(court.scrolls), {0.74f, 0.58f, 0.40f}, 0.0f, 0.7f});
    parts.push_back({"inscription", inscription(), std::move(court.inscription), {0.74f, 0.58f, 0.40f}, 0.0f, 0.7f});
    parts.push_back({"bricks", brickwork(), std::move(court.bricks), {0.46f, 0.22f, 0.14f}, 0.0f, 0.85f});
    parts.push_back({"cornice", dentils(), std::move(court.cornice), {0.76f, 0.65f, 0.48f}, 0.0f, 0.75f});
    parts.push_back({"windows", window(), std::move(court.windows), {0.74f, 0.66f, 0.54f}, 0.0f, 0.7f});
    parts.push_back({"ceiling", coffers(), std::move(court.ceiling), {0.24f, 0.14f, 0.08f}, 0.0f, 0.6f});
    parts.push_back({"door", door(), std::move(court.door), {0.12f, 0.22f, 0.18f}, 0.0f, 0.5f});
    scene.view.stand = View::Stand{{0.75, 1.75, 3.4}, {-0.25, 2.45, -8.0}, 56.0};
    scene.view.room = true;
    scene.view.light_azimuth = -38.0;
    scene.view.light_elevation = 42.0;
    return scene;
}

}  // namespace burin::scenes
