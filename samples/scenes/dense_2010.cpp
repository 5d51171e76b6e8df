// The scenes of 2010 with thousands of elements: a scratched sphere and an engraved plate.
#include <algorithm>
#include <cmath>

#include "build.hpp"
#include "scenes_2010.hpp"

namespace burin::scenes {

// Scratches of a hard grain, criss-cross on a ball: seven-point sections with lips.
Scene make_scratched_sphere() {
    constexpr double kRadius = 0.1;
    const Vec2 size{2.0 * kPi * kRadius, kPi * kRadius};
    Pattern p = sheet(size, 0.0016, 0.0005);
    for (const double half : {0.0018, 0.0010, 0.0006}) p.profiles.push_back(scratch(half, 0.75 * half, 0.22 * half));
    Chance chance(2500);
    const auto pressure = [](double s) { return std::min(1.0, 5.0 * std::min(s, 1.0 - s)); };
    for (int i = 0; i < 420; ++i) {
        const Vec2 middle{chance.uniform() * size.x, chance.between(0.14, 0.86) * size.y};
        const double heading = chance.between(0.0, 2.0 * kPi), span = chance.between(0.05, 0.16), bend = chance.between(-1.1, 1.1);
        const auto at = [=](double s) {
            const double along = (s - 0.5) * span, angle = heading + bend * (s - 0.5);
            return middle + Vec2{std::cos(angle), std::sin(angle)} * along;
        };
        Path path = smooth(at, 6).path(std::uint32_t(i % 7 == 0 ? 0 : 1 + i % 2));
        path.start_cap = path.end_cap = CapKind::butt;
        p.paths.push_back(scaled(path, pressure, pressure, 0.25));
    }
    Scene scene;
    scene.flat = false;
    scene.parts.push_back({"ball", std::move(p), make_sphere(kRadius), {0.80f, 0.80f, 0.82f}, 0.9f, 0.32f});
    scene.view.elevation = 15.0;
    return scene;
}

namespace {

constexpr Vec2 kPlate{0.40, 0.50};
constexpr std::uint32_t kFrame = 0, kStem = 1, kFine = 2, kHair = 3;

// Engraves every stroke twice, once in the mirror.
class Engraver {
  public:
    explicit Engraver(Pattern& pattern) : pattern_(pattern) {}

    void once(Path path) { pattern_.paths.push_back(std::move(path)); }
    void twice(Path path) {
        path.start_cap = path.end_cap = CapKind::butt;
        once(mapped(path, [](Vec2 q) { return Vec2{kPlate.x - q.x, q.y}; }));
        once(std::move(path));
    }

  private:
    Pattern& pattern_;
};

// A volute: a spiral that thins towards its eye. The outermost point lies at `angle`.
Path volute(Vec2 centre, double radius, double angle, double hand) {
    const auto at = [=](double s) {
        const double r = radius * std::pow(1.0 - s, 1.25) + 0.06 * radius, a = angle + hand * 2.2 * 2.0 * kPi * s;
        return centre + Vec2{std::cos(a), std::sin(a)} * r;
    };
    const auto thin = [](double s) { return 1.0 - 0.75 * s; };
    return scaled(smooth(at, 26).path(kStem), thin, thin, 0.5);
}

// A pointed leaf of two curved edges, with a vein; `tip` from its foot.
void add_leaf(Engraver& engraver, Vec2 foot, Vec2 tip, double bend) {
    const Vec2 side = normal_of(tip);
    const Vec2 end = foot + tip, belly = foot + tip * 0.45;
    const auto swell = [](double s) { return 0.35 + 1.3 * s * (1.0 - s) * 2.0; };
    for (const double hand : {1.0, -1.0}) {
        const Vec2 bow = belly + side * (0.26 * hand + bend), shoulder = foot + tip * 0.8 + side * (0.12 * hand + bend);
        engraver.twice(scaled(Stroke(foot).curve(lerp(foot, bow, 0.7) + side * (0.10 * hand), bow).curve(shoulder, end).path(kFine), swell, swell, 0.4));
    }
    const auto fade = [](double s) { return 1.0 - 0.9 * s; };
    engraver.twice(scaled(Stroke(lerp(foot, end, 0.12)).curve(belly + side * bend, foot + tip * 0.85).path(kHair), fade, fade, 0.5));
}

void add_scrolls(Engraver& engraver) {
    constexpr double kCell = 0.0395;
    for (int row = 0; row < 10; ++row)
        for (int column = 0; column < 3; ++column) {
            const Vec2 centre{0.0625 + kCell * column, 0.0725 + kCell * row};
            const double hand = (row + column) % 2 == 0 ? 1.0 : -1.0, angle = kPi / 2 * hand;
            engraver.twice(volute(centre, 0.0158, angle, hand));
            for (int k = 0; k < 5; ++k) {
                const double a = angle + hand * (0.5 + 1.22 * k), r = 0.0140 - 0.0010 * k;
                const Vec2 out{std::cos(a), std::sin(a)}, on{-std::sin(a) * hand, std::cos(a) * hand};
                add_leaf(engraver, centre + out * r, out * 0.0060 + on * 0.0080, 0.16 * hand);
            }
        }
    for (int column = 0; column < 4; ++column) {
        const double x = 0.0428 + kCell * column;
        const auto stem = [=](double s) { return Vec2{x + 0.0026 * std::sin(2.0 * kPi * 10.0 * s + kPi * column), 0.052 + 0.396 * s}; };
        engraver.twice(smooth(stem, 60).path(kFine));
    }
}

// Two waves that braid along a band from one point to another.
void add_braid(Engraver& engraver, Vec2 from, Vec2 to, int waves) {
    const Vec2 side = normal_of(unit(to - from)) * 0.0052;
    for (const double hand : {1.0, -1.0}) {
        const auto at = [=](double s) { return lerp(from, to, s) + side * (hand * std::sin(2.0 * kPi * waves * s)); };
        engraver.once(smooth(at, 4 * waves).path(kStem));
    }
}

void add_frame(Engraver& engraver) {
    engraver.once(slab(kPlate * 0.5, {0.192, 0.242}, 0.010).path(kFrame));
    engraver.once(slab(kPlate * 0.5, {0.160, 0.210}, 0.006).path(kFrame));
    const double x = 0.024, y = 0.024;
    add_braid(engraver, {0.040, y}, {0.360, y}, 16);
    add_braid(engraver, {0.040, kPlate.y - y}, {0.360, kPlate.y - y}, 16);
    add_braid(engraver, {x, 0.040}, {x, 0.460}, 21);
    add_braid(engraver, {kPlate.x - x, 0.040}, {kPlate.x - x, 0.460}, 21);
}

void add_rosette(Engraver& engraver, Vec2 centre, double radius) {
    engraver.once(circle(centre, radius).path(kStem));
    engraver.once(circle(centre, 0.30 * radius).path(kStem));
    constexpr int kPetals = 12;
    for (int k = 0; k < kPetals; ++k) {
        const double a = 2.0 * kPi * k / kPetals, wide = kPi / kPetals * 0.85;
        const auto at = [=](double r, double angle) { return centre + Vec2{std::cos(angle), std::sin(angle)} * (r * radius); };
        engraver.once(Stroke(at(0.36, a)).curve(at(0.62, a - 1.5 * wide), at(0.80, a - 0.5 * wide)).curve(at(0.9, a), at(0.80, a + 0.5 * wide))
                          .curve(at(0.62, a + 1.5 * wide), at(0.36, a)).close().path(kFine));
        for (int ray = -1; ray <= 1; ++ray)
            engraver.once(polyline({at(0.50, a + 0.22 * wide * ray), at(0.72, a + 0.30 * wide * ray)}).path(kHair));
    }
}

// Hatching between the rosettes, as a graver darkens a field.
void add_hatching(Engraver& engraver) {
    Chance chance(1510);
    for (int k = 0; k < 230; ++k) {
        const double y = 0.056 + 0.388 * k / 229.0;
        const double from = 0.1735 + 0.003 * chance.uniform(), half = 0.0022 + 0.0012 * chance.uniform();
        engraver.twice(polyline({{from - half, y}, {from + half, y - 0.0009}}).path(kHair));
    }
}

}  // namespace

// A breastplate's field: scrolls with leaves and stems, mirrored, rosettes in the middle, a braided border.
Scene make_engraved_armour() {
    Pattern p = sheet(kPlate, 0.0014, 0.0, Wrap::clamp);
    p.profiles = {trough(0.0019, 0.0009, 0.0012), vee(0.00125, 0.0011), vee(0.00075, 0.0007), vee(0.0004, 0.0004)};
    Engraver engraver(p);
    add_frame(engraver);
    add_scrolls(engraver);
    for (int k = 0; k < 8; ++k) add_rosette(engraver, {0.2, 0.0725 + 0.0507 * k}, 0.0205);
    add_hatching(engraver);
    Scene scene = on_plane(std::move(p), {0.66f, 0.62f, 0.56f}, 0.5f, 0.42f);
    scene.view = {.azimuth = 8.0, .elevation = 55.0, .zoom = 3.0, .center = Vec2{0.38, 0.3}};
    return scene;
}

}  // namespace burin::scenes
