// ResolvedPatterns made directly, without resolve: for tests of the truth and of all that reads resolved
// patterns.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <burin/resolve.hpp>

#include "../elements.hpp"
#include "random_pattern.hpp"

namespace burin::testing {

inline double undirected(double angle) {
    const double a = std::fmod(angle, std::numbers::pi);
    return a < 0.0 ? a + std::numbers::pi : a;
}
inline ElementEnd butt_end() { return {}; }
inline ElementEnd hip_end() { return {Priority::both, static_cast<std::uint8_t>(EndShape::hip), 0.0}; }
inline ElementEnd round_end() { return {Priority::both, static_cast<std::uint8_t>(EndShape::round), 0.0}; }
inline ElementEnd clip_end(double angle) {
    return {Priority::both, static_cast<std::uint8_t>(EndShape::clip), undirected(angle)};
}
inline ElementEnd tee_end(double angle) {
    return {Priority::both, static_cast<std::uint8_t>(EndShape::tee), undirected(angle)};
}
inline ElementEnd corner_end(Priority outer, CornerShape shape, double angle) {
    return {outer, static_cast<std::uint8_t>(shape), undirected(angle)};
}

// The clip line that two consecutive arms share: along the sum of their normals.
inline double bisector(Vec2 before, Vec2 after) {
    const Vec2 m = normal_of(unit(before)) + normal_of(unit(after));
    return undirected(std::atan2(m.y, m.x));
}

class ResolvedBuilder {
  public:
    ResolvedBuilder() {
        pattern.depth = 0.01;
        pattern.base_offset = 0.003;
        pattern.materials.push_back({});
    }

    std::uint32_t profile(std::vector<ProfilePoint> points, std::uint32_t internal_mask) {
        pattern.profiles.push_back({std::move(points), internal_mask});
        return static_cast<std::uint32_t>(pattern.profiles.size() - 1);
    }
    // Groove of half-width w at the top and `floor` at the bottom.
    std::uint32_t groove(double w, double floor, double depth) {
        return profile({{-w, 0}, {-floor, -depth}, {floor, -depth}, {w, 0}}, 7u);
    }
    std::uint32_t ridge(double w, double height) { return profile({{-w, 0}, {0, height}, {w, 0}}, 0u); }
    // Rises by `rise` from left to right; adds on its low side, cuts on its high side.
    std::uint32_t bevel_step(double w, double rise) {
        return profile({{-w, 0}, {0, 0.5 * rise}, {w, rise}}, rise > 0 ? 2u : 1u);
    }

    std::uint32_t style(std::uint32_t profile, double level = 0.0, bool step = false) {
        pattern.styles.push_back({profile, 0, level, step});
        return static_cast<std::uint32_t>(pattern.styles.size() - 1);
    }

    ResolvedElement& add(const Element& e, ElementEnd start, ElementEnd end, std::uint32_t style) {
        pattern.elements.push_back({e, start, end, style, 0});
        return pattern.elements.back();
    }

    // Closed polygon of lines with mitred corners, in the order given.
    void polygon(const std::vector<Vec2>& points, std::uint32_t style,
                 CornerShape shape = CornerShape::mitre) {
        const std::size_t n = points.size();
        const auto direction = [&](std::size_t i) { return points[(i + 1) % n] - points[i % n]; };
        const auto corner = [&](std::size_t i) {
            const Vec2 a = direction(i + n - 1), b = direction(i);
            return corner_end(cross(a, b) > 0 ? Priority::left : Priority::right, shape, bisector(a, b));
        };
        for (std::size_t i = 0; i < n; ++i)
            add(make_line(points[i], points[(i + 1) % n]), corner(i), corner((i + 1) % n), style);
    }

    // Circle of n quadratics; way +1 has its inside to the right.
    void circle(Vec2 centre, double radius, int n, int way, std::uint32_t style) {
        const double step = way * 2.0 * std::numbers::pi / n, far = radius / std::cos(0.5 * step);
        const auto on = [&](double i, double r) {
            const double a = i * step;
            return centre + Vec2{std::cos(a), std::sin(a)} * r;
        };
        for (int i = 0; i < n; ++i)
            add(make_arc(on(i, radius), on(i + 0.5, far), on((i + 1) % n, radius)), clip_end(i * step),
                clip_end((i + 1) % n * step), style);
    }

    ResolvedPattern pattern;
};

// Elements with every kind of end at random places, levels of nested step loops, scales, profiles of every
// kind; with `overhangs` also profiles that are no height fields. Ends need not fit together: the meaning is
// pointwise.
inline ResolvedPattern random_resolved(std::uint64_t seed, bool overhangs, Wrap wrap = Wrap::repeat) {
    Random random(seed);
    ResolvedBuilder builder;
    builder.pattern.wrap = wrap;
    const double w = 0.03;
    std::vector<double> levels{0.0};
    std::vector<std::uint32_t> profiles{
        builder.groove(w, 0.4 * w, 0.003),
        builder.groove(w, 0.0, 0.002),
        builder.ridge(0.8 * w, 0.0011),
        builder.profile({{-w, 0}, {-0.6 * w, 0.0006}, {0, -0.003}, {0.6 * w, 0.0006}, {w, 0}}, 6u),
        builder.profile({{-0.5 * w, 0}, {-0.5 * w, -0.001}, {0.7 * w, -0.002}, {0.7 * w, 0}}, 7u),
        builder.profile({{-w, 0}, {-0.7 * w, 0.0008}, {0, 0.0002}, {0.7 * w, 0.0008}, {w, 0}}, 6u)};
    if (overhangs) {
        profiles.push_back(builder.profile(  // dovetail groove
            {{-0.4 * w, 0}, {-w, -0.002}, {w, -0.002}, {0.4 * w, 0}}, 7u));
        profiles.push_back(builder.profile(  // mushroom
            {{-0.3 * w, 0},
             {-0.3 * w, 0.0006},
             {-w, 0.0006},
             {-w, 0.001},
             {w, 0.001},
             {w, 0.0006},
             {0.3 * w, 0.0006},
             {0.3 * w, 0}},
            0u));
    }
    // Two disjoint loops, one with a loop within.
    const double rises[] = {0.0007, -0.001};
    const Vec2 centres[] = {{0.3, 0.3}, {0.95, 0.75}};
    for (int i = 0; i < 2; ++i) {
        const Vec2 c = wrap == Wrap::repeat ? centres[i] : Vec2{0.3 + 0.4 * i, 0.3 + 0.4 * i};
        const int way = random.chance(0.5) ? 1 : -1;
        const double level = way > 0 ? 0.0 : rises[i], rise = way > 0 ? rises[i] : -rises[i];
        const std::uint32_t style = builder.style(builder.bevel_step(0.015, rise), level, true);
        if (random.chance(0.5)) {
            builder.circle(c, 0.17, 6, way, style);
        } else {
            std::vector<Vec2> points;
            for (int k = 0; k < 5; ++k) {
                const double a = way * 2.0 * std::numbers::pi * k / 5, r = random.between(0.12, 0.17);
                points.push_back(c + Vec2{std::cos(a), std::sin(a)} * r);
            }
            builder.polygon(points, style, static_cast<CornerShape>(random.below(3)));
        }
        levels.push_back(rises[i]);
        if (i == 1) continue;
        const std::uint32_t wall = builder.profile({{0, 0}, {0, -0.0009}}, 0u);
        builder.circle(c, 0.06, 5, 1, builder.style(wall, rises[i], true));
        levels.push_back(rises[i] + builder.pattern.profiles[wall].points[1].h);
    }
    const auto any_end = [&](Vec2 t) {
        const double normal = std::atan2(t.x, -t.y);
        switch (random.below(6)) {
            case 0:
                return butt_end();
            case 1:
                return hip_end();
            case 2:
                return round_end();
            case 3:
                return (random.chance(0.5) ? clip_end : tee_end)(normal + random.between(-1.0, 1.0));
            default:
                return corner_end(random.chance(0.5) ? Priority::left : Priority::right,
                                  static_cast<CornerShape>(random.below(3)),
                                  normal + random.between(-1.0, 1.0));
        }
    };
    const int count = 6 + random.below(14);
    for (int i = 0; i < count; ++i) {
        const Vec2 a{random.uniform(), random.uniform()}, t = random.direction();
        const double reach = random.between(0.03, 0.2);
        const Vec2 b = a + t * reach;
        Element e = make_line(a, b);
        if (random.chance(0.4))
            e = make_arc(
                a, lerp(a, b, random.between(0.3, 0.7)) + normal_of(t) * (reach * random.between(-0.4, 0.4)),
                b);
        if (random.chance(0.3)) {
            e.width0 = random.between(0.3, 1.3), e.width1 = random.between(0.0, 1.3);
            e.height0 = random.between(0.3, 1.0), e.height1 = random.between(0.0, 1.0);
        }
        const bool curved = e.kind == ElementKind::quadratic;
        const std::uint32_t which =
            profiles[static_cast<std::size_t>(random.below(static_cast<int>(profiles.size())))];
        const double level = levels[static_cast<std::size_t>(random.below(static_cast<int>(levels.size())))];
        builder.add(e, any_end(curved ? e.p1 - a : t), any_end(curved ? b - e.p1 : t),
                    builder.style(which, level));
    }
    return builder.pattern;
}

}  // namespace burin::testing
