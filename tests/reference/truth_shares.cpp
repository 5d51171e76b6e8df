#include "truth_shares.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace burin::testing {
namespace {

struct Dice {
    std::mt19937_64 engine;
    explicit Dice(std::uint64_t seed) : engine(seed * 0x9e3779b97f4a7c15ull + 1) {}
    double between(double low, double high) { return low + (high - low) * (double(engine() >> 11) * 0x1p-53); }
    Vec2 direction() {
        const double a = between(0.0, 2.0 * std::numbers::pi);
        return {std::cos(a), std::sin(a)};
    }
};

bool holds(const reference::Footprint& footprint, Vec2 p) {
    const auto& c = footprint.corners;
    for (std::size_t i = 0; i < c.size(); ++i)
        if (cross(c[(i + 1) % c.size()] - c[i], p - c[i]) < 0.0) return false;
    return true;
}

RayHit trace(const Truth& truth, Vec2 at, double top, Vec2 slope) {
    Ray ray;
    ray.origin[0] = at.x, ray.origin[1] = at.y, ray.origin[2] = top;
    ray.direction[0] = slope.x, ray.direction[1] = slope.y, ray.direction[2] = -1.0;
    RayHit hit = truth.trace_ray(ray);
    if (hit.inside) hit.normal[0] = hit.normal[1] = 0.0, hit.normal[2] = 1.0;
    return hit;
}

bool is_lit(const Truth& truth, const RayHit& hit, double top, double depth, const reference::Slopes& slopes) {
    const double facing = hit.normal[2] - hit.normal[0] * slopes.light.x - hit.normal[1] * slopes.light.y;
    if (!slopes.lit || facing <= 0.0) return false;
    const double climb = top - hit.position[2];
    const RayHit blocker = trace(truth, Vec2{hit.position[0], hit.position[1]} - slopes.light * climb, top, slopes.light);
    return !(blocker.hit && blocker.t < climb - 1e-6 * depth);
}

Profile groove_profile(Dice& dice) {
    const double half = dice.between(0.001, 0.003), deep = dice.between(0.001, 0.003), flat = dice.between(0.0, 0.6) * half;
    if (dice.between(0, 1) < 0.4) return {{{-half, 0}, {dice.between(-0.4, 0.4) * half, -deep}, {half, 0}}, {}};
    return {{{-half, 0}, {-flat, -deep}, {flat, -deep}, {half, 0}}, {}};
}

Profile ridge_profile(Dice& dice) {
    Profile profile = groove_profile(dice);
    for (ProfilePoint& point : profile.points) point.h = -point.h;
    return profile;
}

struct Maker {
    Dice dice;
    Pattern pattern;
    const Vec2 middle{0.05, 0.05};

    explicit Maker(std::uint64_t seed) : dice(seed) {
        pattern.size = {0.1, 0.1};
        pattern.depth = 0.0065;
        pattern.base_offset = 0.0032;
        pattern.wrap = Wrap::clamp;
    }
    std::uint32_t profile(bool ridge) {
        pattern.profiles.push_back(ridge ? ridge_profile(dice) : groove_profile(dice));
        return std::uint32_t(pattern.profiles.size()) - 1;
    }
    void line(std::vector<Vec2> points, std::uint32_t profile) {
        Path path;
        path.profile = profile;
        for (std::size_t i = 0; i + 1 < points.size(); ++i) {
            Element element;
            element.p0 = points[i];
            element.p2 = points[i + 1];
            element.p1 = lerp(element.p0, element.p2, 0.5);
            path.elements.push_back(element);
        }
        pattern.paths.push_back(path);
    }
    void through(Vec2 at, Vec2 way, std::uint32_t profile) { line({at - way * 0.045, at + way * 0.045}, profile); }
    Vec2 turn(Vec2 d, double angle) const {
        return {d.x * std::cos(angle) - d.y * std::sin(angle), d.x * std::sin(angle) + d.y * std::cos(angle)};
    }

    void make(GrooveCase which) {
        const Vec2 d = dice.direction();
        const Vec2 e = turn(d, dice.between(0.6, 2.5));
        const bool ridge = which == GrooveCase::protruding;
        switch (which) {
            case GrooveCase::isolated:
                return through(middle, d, profile(false));
            case GrooveCase::parallel: {
                const std::uint32_t shared = profile(false);
                for (int i = -3; i <= 3; ++i) through(middle + normal_of(d) * (i * 0.0065), d, shared);
                return;
            }
            case GrooveCase::crossing:
            case GrooveCase::protruding:
                through(middle, d, profile(ridge));
                return through(middle, e, profile(ridge && dice.between(0, 1) < 0.7));
            case GrooveCase::intersected_end:
                through(middle, d, profile(false));
                return line({middle, middle + e * 0.04}, profile(false));
            case GrooveCase::isolated_end:
                return line({middle, middle + e * 0.04}, profile(dice.between(0, 1) < 0.3));
            case GrooveCase::corner:
                return line({middle + d * 0.04, middle, middle + e * 0.04}, profile(dice.between(0, 1) < 0.3));
            case GrooveCase::two_at_once:
                through(middle, d, profile(false));
                through(middle + normal_of(d) * 0.004 * dice.between(0.5, 1.5), e, profile(dice.between(0, 1) < 0.3));
                return line({middle + dice.direction() * 0.003, middle + dice.direction() * 0.03}, profile(false));
        }
    }
};

}  // namespace

const char* name_of(GrooveCase which) {
    constexpr const char* kNames[kGrooveCases] = {"isolated", "parallel", "crossing", "intersected end", "isolated end", "corner", "protruding", "two at once"};
    return kNames[int(which)];
}

std::string identifier_of(GrooveCase which) {
    std::string name = name_of(which);
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
}

reference::GroovedSurface grooved(const ResolvedPattern& pattern) { return reference::GroovedSurface(pattern, *build_grid(pattern)); }

ResolvedPattern make_case(GrooveCase which, std::uint64_t seed) {
    Maker maker(seed);
    maker.make(which);
    return *resolve_pattern(maker.pattern);
}

namespace {

Situation situation_at(Dice& dice, Vec2 at, double size, double drop) {
    Situation situation;
    const auto slope = [&] {
        const double elevation = dice.between(5.0, 90.0) * std::numbers::pi / 180.0;
        return dice.direction() * (1.0 / std::tan(elevation));
    };
    situation.slopes.view = slope();
    situation.slopes.light = slope();
    // As a round pixel lies on the plane: stretched along the view.
    const Vec2 along = unit(situation.slopes.view);
    const double stretch = std::min(std::hypot(1.0, length(situation.slopes.view)), 6.0);
    situation.footprint = reference::make_ellipse(at - situation.slopes.view * drop, along * (size * stretch), normal_of(along) * size);
    return situation;
}

}  // namespace

Situation make_situation(std::uint64_t seed) {
    Dice dice(seed ^ 0x5bd1e995u);
    const double size = 0.0004 * std::pow(30.0, dice.between(0.0, 1.0));
    return situation_at(dice, Vec2{0.05, 0.05} + dice.direction() * (0.003 * dice.between(0.0, 1.0)), size, 0.0032);
}

Situation make_situation_on(const ResolvedPattern& pattern, std::uint64_t seed) {
    Dice dice(seed ^ 0x3c6ef372u);
    const ResolvedElement& e = pattern.elements[std::size_t(dice.between(0.0, double(pattern.elements.size()) - 1e-6))];
    double reach = 0.1 * pattern.depth;
    for (const ProfilePoint& point : pattern.profiles[pattern.styles[e.style].profile].points) reach = std::max(reach, std::abs(point.b));
    const double s = dice.between(-0.1, 1.1);
    const Vec2 at = lerp(lerp(e.element.p0, e.element.p1, s), lerp(e.element.p1, e.element.p2, s), s) + dice.direction() * (reach * dice.between(0.0, 1.0));
    return situation_at(dice, at, reach * 0.15 * std::pow(20.0, dice.between(0.0, 1.0)), pattern.base_offset);
}

namespace {

// Walls are one thing, whatever they belong to.
std::pair<std::uint32_t, std::uint32_t> key_of(const ResolvedPattern& pattern, std::uint32_t element, std::uint32_t facet) {
    if (facet == kWall || element == kGround) return {kGround, facet};
    return {pattern.elements[element].path, facet};
}

}  // namespace

Shares shares_by_truth(const reference::GroovedSurface& surface, const Situation& situation, int side, std::uint64_t seed) {
    Dice dice(seed);
    const Box box = reference::box_of(situation.footprint);
    const ResolvedPattern& pattern = surface.pattern();
    Shares shares;
    double count = 0.0;
    for (int k = 0; k < side * side; ++k) {
        const Vec2 cell{(k % side + dice.between(0, 1)) / side, (k / side + dice.between(0, 1)) / side};
        const Vec2 at{box.low.x + (box.high.x - box.low.x) * cell.x, box.low.y + (box.high.y - box.low.y) * cell.y};
        if (!holds(situation.footprint, at)) continue;
        const RayHit hit = trace(surface.truth(), at, surface.top(), situation.slopes.view);
        FacetShare& share = shares[key_of(pattern, hit.element, hit.facet)];
        count += 1.0;
        share.seen += 1.0;
        if (is_lit(surface.truth(), hit, surface.top(), pattern.depth, situation.slopes)) share.lit += 1.0;
    }
    for (auto& [key, share] : shares) share.seen /= count, share.lit /= count;
    return shares;
}

Shares gather_shares(const ResolvedPattern& pattern, const std::vector<reference::Share>& list) {
    Shares shares;
    for (const reference::Share& one : list) {
        FacetShare& share = shares[key_of(pattern, one.element, one.facet)];
        share.seen += one.seen;
        share.lit += one.lit;
    }
    return shares;
}

ShareError compare_shares(const Shares& a, const Shares& b) {
    ShareError error;
    const auto one_way = [&](const Shares& x, const Shares& y, bool both) {
        for (const auto& [key, share] : x) {
            const auto other = y.find(key);
            if (other != y.end() && !both) continue;
            const FacetShare rest = other == y.end() ? FacetShare{} : other->second;
            error.seen += 0.5 * std::abs(share.seen - rest.seen);
            error.lit += 0.5 * std::abs(share.lit - rest.lit);
        }
    };
    one_way(a, b, true);
    one_way(b, a, false);
    return error;
}

reference::Beam beam_from(const reference::Share& share, const std::vector<reference::Vec3>& corners, std::uint64_t seed) {
    Dice dice(seed * 31 + 7);
    reference::Beam beam;
    for (std::uint32_t i = 0; i < share.corners; ++i) beam.corners.push_back(corners[share.first_corner + i]);
    beam.normal = share.normal;
    do {
        beam.direction = {dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1)};
        beam.direction = beam.direction * (1.0 / std::sqrt(dot(beam.direction, beam.direction)));
    } while (dot(beam.direction, beam.normal) < 0.1 || std::abs(beam.direction.z) < 0.06);
    return beam;
}

namespace {

using reference::Vec3;

// How far p lies inside the hit's polygon, seen along d; below 0: outside.
double depth_inside(const reference::Share& hit, const std::vector<Vec3>& corners, Vec3 p, Vec3 d) {
    double depth = 1e300, sign = 0.0;
    for (std::uint32_t i = 0; i < hit.corners; ++i) {
        const Vec3 a = corners[hit.first_corner + i], b = corners[hit.first_corner + (i + 1) % hit.corners];
        const Vec3 n = cross(b - a, d);
        const double l = std::sqrt(dot(n, n));
        if (l < 1e-12) continue;
        if (sign == 0.0) sign = dot(hit.place - a, n) < 0.0 ? -1.0 : 1.0;
        depth = std::min(depth, sign * dot(p - a, n) / l);
    }
    return depth;
}

}  // namespace

BeamCheck check_beam(const reference::GroovedSurface& surface, const reference::Beam& beam, const std::vector<reference::Share>& hits,
                     const std::vector<Vec3>& corners) {
    BeamCheck check;
    const ResolvedPattern& pattern = surface.pattern();
    Dice dice(beam.corners.size());
    for (int k = 0; k < 12; ++k) {
        Vec3 p;
        double sum = 0.0;
        for (const Vec3 corner : beam.corners) {
            const double weight = dice.between(0.05, 1.0);
            p = p + corner * weight;
            sum += weight;
        }
        p = p * (1.0 / sum) + beam.normal * 1e-9;
        Ray ray;
        const double origin[3] = {p.x, p.y, p.z}, way[3] = {beam.direction.x, beam.direction.y, beam.direction.z};
        std::copy(origin, origin + 3, ray.origin);
        std::copy(way, way + 3, ray.direction);
        const RayHit met = surface.truth().trace_ray(ray);
        if (met.inside || (met.hit && met.t < 1e-7)) continue;  // it left at a border
        // The hit that holds the ray well inside; near a border either answer may come.
        const reference::Share* held = nullptr;
        bool border = false;
        for (const reference::Share& hit : hits) {
            const double depth = depth_inside(hit, corners, p, beam.direction);
            if (depth > 1e-7) held = &hit;
            border = border || std::abs(depth) <= 1e-7;
        }
        if (border) continue;
        ++check.rays;
        if (!held)
            check.wrong += met.hit;
        else
            check.wrong += !met.hit || key_of(pattern, met.element, met.facet) != key_of(pattern, held->element, held->facet);
    }
    return check;
}

}  // namespace burin::testing
