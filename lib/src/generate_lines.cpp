// Families of parallel lines: hatching, knurls, and threads that go over and under each other.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "generate_internal.hpp"

namespace burin::generating {
namespace {

// Lines across the whole tile: `count` of them, each from start(k) by `way`.
struct Family {
    Vec2 way;
    double apart = 0.0;  // metres, across
    int count = 0;
};

constexpr int kMostTiles = 16;  // that one line of a family crosses along u or v before it comes back
constexpr double kMostLines = 100000;

// The family of lines that comes back on itself and is nearest to an angle (degrees) and a distance between lines. Lines of a tile
// that repeats run from lattice point to lattice point, so that there are only so many.
Family closed_family(Vec2 size, double angle, double apart) {
    const Vec2 wanted = steady::direction(angle / kFullTurn);
    Family best;
    double least = 1e300;
    for (int p = -kMostTiles; p <= kMostTiles; ++p)
        for (int q = 0; q <= kMostTiles; ++q) {
            if (std::gcd(p, q) != 1 || (q == 0 && p < 0)) continue;
            const Vec2 way{p * size.x, q * size.y};
            const double length = steady::distance(way), across = size.x * size.y / length;
            const int count = std::max(1, int(std::round(across / apart)));
            // Sine of the angle between both, and how far the distance is off: a tenth of it weighs as much as three degrees.
            const double cost = std::abs(cross(way, wanted)) / length + 0.5 * std::abs(across / count - apart) / apart;
            if (cost < least) least = cost, best = {way, across / count, count};
        }
    return best;
}

// The part of the line through p along `way` that lies in the tile; false where it misses.
bool clipped(Vec2 size, Vec2 p, Vec2 way, Vec2& from, Vec2& to) {
    double first = -1e300, last = 1e300;
    const auto bound = [&](double at, double rate, double limit) {
        if (rate == 0.0) return at > 0.0 && at < limit;
        const double a = -at / rate, b = (limit - at) / rate;
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
        return true;
    };
    if (!bound(p.x, way.x, size.x) || !bound(p.y, way.y, size.y) || last <= first) return false;
    from = p + way * first;
    to = p + way * last;
    return true;
}

class Hatcher {
  public:
    Hatcher(Work& work, double width, double jitter, double uneven)
        : work_(work), width_(width), jitter_(jitter), noise_(work.add_noise(uneven, uneven, 10.0 * work.value("spacing"))) {}

    Status add_layer(double angle, int layer) {
        Chance chance(work_.spec.seed, std::uint64_t(layer));
        const double apart = work_.value("spacing");
        if (steady::distance(work_.pattern.size) / apart > kMostLines) return refuse(work_, "spacing " + parameter_text(apart) + " gives more than 100000 lines");
        const Family family = work_.repeats() ? closed_family(work_.pattern.size, angle, apart) : open_family(angle, apart);
        const auto profile = work_.add_section(width_ * family.apart / apart, -work_.value("depth"));
        if (!profile) return profile.error();
        const double length = steady::distance(family.way), first = family.apart * chance.uniform();
        const Vec2 across = normal_of(family.way) * (1.0 / length);
        for (int k = 0; k < family.count; ++k) {
            const double b = first + family.apart * (k + jitter_ * chance.between(-0.5, 0.5));
            const Vec2 origin = work_.repeats() ? Vec2{} : work_.pattern.size * 0.5 - across * (0.5 * family.count * family.apart);
            add_line(origin + across * b, family.way, *profile);
        }
        return Done{};
    }

  private:
    // Enough lines to cover the tile from corner to corner.
    Family open_family(double angle, double apart) const {
        const double diagonal = steady::distance(work_.pattern.size);
        return {steady::direction(angle / kFullTurn) * diagonal, apart, int(std::ceil(diagonal / apart)) + 1};
    }

    void add_line(Vec2 at, Vec2 way, std::uint32_t profile) {
        Path path;
        path.profile = profile;
        path.perturbation = noise_;
        Vec2 from = at, to = at + way;
        if (work_.repeats()) {
            path.closed = true;
        } else if (!clipped(work_.pattern.size, at, way, from, to)) {
            return;
        }
        path.elements = {straight(from, to)};
        work_.pattern.paths.push_back(std::move(path));
    }

    Work& work_;
    double width_, jitter_;
    std::uint32_t noise_;
};

// One thread of a weave along `way`, the distance between two threads that it meets. Threads that tile begin a quarter of it before
// the first that they meet, so that they are level over it; others three quarters earlier, outside the tile, and end there.
Path thread(Vec2 start, Vec2 way, int crossings, bool over_first, double under, std::uint32_t profile, bool closed) {
    const auto height = [&](int crossing) { return (crossing % 2 == 0) == over_first ? 1.0 : under; };
    Path path;
    path.profile = profile;
    path.closed = closed;
    for (int k = closed ? 0 : -1; k < crossings; ++k) {
        const Vec2 from = start + way * (k + 0.25), middle = start + way * (k + 0.75), to = start + way * (k + 1.25);
        // Level over or under the other thread, then down or up to the next crossing.
        Element flat = straight(path.elements.empty() ? from : path.elements.back().p2, middle), slope = straight(middle, to);
        flat.height0 = flat.height1 = slope.height0 = height(k);
        slope.height1 = height(k + 1);
        path.elements.push_back(flat);
        path.elements.push_back(slope);
    }
    return path;
}

}  // namespace

Status make_hatch(Work& work) {
    Hatcher hatcher(work, work.value("width"), work.value("jitter"), work.value("uneven"));
    for (int layer = 0; layer < work.count("layers"); ++layer)
        if (const Status added = hatcher.add_layer(work.value("angle") + layer * work.value("turn"), layer); !added) return added;
    return Done{};
}

// Grooves as wide as they lie apart leave pyramids.
Status make_knurl(Work& work) {
    Hatcher hatcher(work, work.value("spacing") * (1.0 - work.value("land")), 0.0, 0.0);
    for (const double side : {-1.0, 1.0})
        if (const Status added = hatcher.add_layer(work.value("angle") + side * 0.5 * work.value("crossing"), 0); !added) return added;
    return Done{};
}

// Warp runs along v, weft along u; where two cross, one is high and the other low.
Status make_weave(Work& work) {
    const int warp = 2 * work.count("warp"), weft = 2 * work.count("weft");
    const Vec2 size = work.pattern.size, pitch{size.x / warp, size.y / weft};
    const double share = work.value("width"), under = work.value("under");
    const auto upright = work.add_section(share * pitch.x, work.value("height"));
    const auto level = work.add_section(share * pitch.y, work.value("height"));
    if (!upright || !level) return (upright ? level : upright).error();
    for (int i = 0; i < warp; ++i)
        work.pattern.paths.push_back(thread({(i + 0.5) * pitch.x, 0.0}, {0.0, pitch.y}, weft, i % 2 == 0, under, *upright, work.repeats()));
    for (int k = 0; k < weft; ++k)
        work.pattern.paths.push_back(thread({0.0, (k + 0.5) * pitch.y}, {pitch.x, 0.0}, warp, k % 2 == 1, under, *level, work.repeats()));
    return Done{};
}

}  // namespace burin::generating
