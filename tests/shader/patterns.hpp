// Authored patterns that between them hold every kind of element, profile, end and junction the decoder
// knows.
//
// Metres; tile 1 x 1 unless said, depth 0.02, base_offset 0.008 where something rises above the ground.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include <burin/pattern.hpp>

#include "../elements.hpp"

namespace burin::testing {

inline constexpr double kDepth = 0.02;
inline constexpr double kRise = 0.008;

struct NamedPattern {
    std::string name;
    Pattern pattern;
};

inline Profile groove(double half, double deep) {
    return {{{-half, 0}, {-half * 0.4, -deep}, {half * 0.4, -deep}, {half, 0}}, {}};
}
inline Profile vee(double half, double deep) { return {{{-half, 0}, {0, -deep}, {half, 0}}, {}}; }
inline Profile ridge(double half, double high) {
    return {{{-half, 0}, {-half * 0.5, high}, {half * 0.5, high}, {half, 0}}, {}};
}
// A groove between two raised lips: adds outside, cuts inside.
inline Profile lipped(double half, double deep, double high) {
    return {{{-half, 0}, {-half * 0.7, high}, {0, -deep}, {half * 0.7, high}, {half, 0}}, {}};
}
// A rail whose head stands over its foot: not a height field.
inline Profile rail(double half, double high) {
    return {{{-half * 0.3, 0},
             {-half * 0.3, high * 0.5},
             {-half, high * 0.5},
             {-half, high},
             {half, high},
             {half, high * 0.5},
             {half * 0.3, high * 0.5},
             {half * 0.3, 0}},
            {}};
}
// A groove that is wider below than at its mouth.
inline Profile undercut(double half, double deep) {
    return {{{-half * 0.5, 0}, {-half, -deep}, {half, -deep}, {half * 0.5, 0}},
            {FacetClass::internal, FacetClass::internal, FacetClass::internal}};
}
// Down from left to right by `drop`.
inline Profile step(double half, double drop) { return {{{-half, 0}, {0, -drop * 0.5}, {half, -drop}}, {}}; }
inline Profile cliff(double half, double drop) {
    return {{{-half, 0}, {0, 0}, {0, -drop}, {half, -drop}}, {}};
}

inline Path polyline(const std::vector<Vec2>& points, std::uint32_t profile, bool closed = false) {
    Path path;
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
        path.elements.push_back(make_line(points[i], points[i + 1]));
    if (closed) path.elements.push_back(make_line(points.back(), points.front()));
    path.closed = closed;
    path.profile = profile;
    return path;
}

// Circle of eight quadratics, clockwise on screen when r > 0.
inline Path circle(Vec2 c, double r, std::uint32_t profile, bool reversed = false) {
    Path path;
    const int n = 8;
    const double step_angle = (reversed ? -1.0 : 1.0) * 2.0 * 3.14159265358979323846 / n;
    auto at = [&](double k, double radius) {
        return Vec2{c.x + radius * std::cos(k * step_angle), c.y + radius * std::sin(k * step_angle)};
    };
    for (int i = 0; i < n; ++i)
        path.elements.push_back(
            make_arc(at(i, r), at(i + 0.5, r / std::cos(step_angle * 0.5)), at((i + 1) % n, r)));
    path.closed = true;
    path.profile = profile;
    return path;
}

inline Pattern base(double rise = 0.0) {
    Pattern p;
    p.depth = kDepth;
    p.base_offset = rise;
    return p;
}

inline Path with_caps(Path path, CapKind cap) {
    path.start_cap = path.end_cap = cap;
    return path;
}
inline Path with_join(Path path, JoinKind join) {
    path.join = join;
    return path;
}

inline Pattern crossing_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.03, 0.010), vee(0.04, 0.006), ridge(0.03, 0.006)};
    p.paths = {polyline({{0.1, 0.3}, {0.9, 0.35}}, 0), polyline({{0.3, 0.1}, {0.35, 0.9}}, 1),
               polyline({{0.1, 0.7}, {0.9, 0.6}}, 2), polyline({{0.7, 0.1}, {0.6, 0.9}}, 2)};
    return p;
}

// Tops in the object surface itself, where rays begin: of lines, of a curve, of an end, tapering.
inline Pattern flush_pattern() {
    Pattern p = base(kRise);
    p.profiles = {ridge(0.05, kRise), ridge(0.03, kRise), lipped(0.06, 0.010, kRise)};
    p.paths = {polyline({{0.1, 0.3}, {0.9, 0.35}}, 0), polyline({{0.3, 0.1}, {0.35, 0.9}}, 1), polyline({{0.1, 0.75}, {0.9, 0.7}}, 2)};
    Path bow;
    bow.profile = 1;
    bow.elements = {make_arc({0.6, 0.5}, {0.75, 0.4}, {0.85, 0.55})};
    p.paths.push_back(bow);
    return p;
}

inline Pattern tee_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.03, 0.010), groove(0.02, 0.006), vee(0.03, 0.011), ridge(0.02, 0.005)};
    p.paths = {polyline({{0.1, 0.5}, {0.9, 0.5}}, 0), polyline({{0.3, 0.1}, {0.3, 0.5}}, 1),
               polyline({{0.5, 0.9}, {0.6, 0.5}}, 2), polyline({{0.8, 0.1}, {0.7, 0.5}}, 3)};
    return p;
}

inline Pattern corner_pattern(JoinKind join) {
    Pattern p = base(kRise);
    p.profiles = {groove(0.02, 0.009), ridge(0.02, 0.006), lipped(0.03, 0.008, 0.004)};
    p.paths = {with_join(polyline({{0.1, 0.1}, {0.4, 0.1}, {0.4, 0.4}, {0.2, 0.25}}, 0), join),
               with_join(polyline({{0.6, 0.1}, {0.9, 0.3}, {0.6, 0.4}, {0.55, 0.25}}, 1), join),
               with_join(polyline({{0.2, 0.6}, {0.8, 0.65}, {0.75, 0.9}, {0.3, 0.85}}, 2, true), join)};
    return p;
}

inline Pattern star_pattern() {
    Pattern p = base();
    p.profiles = {groove(0.025, 0.008), vee(0.02, 0.006)};
    const Vec2 a{0.3, 0.3}, b{0.7, 0.65};
    p.paths = {polyline({a, {0.5, 0.32}}, 0), polyline({a, {0.2, 0.1}}, 0), polyline({{0.15, 0.5}, a}, 0),
               polyline({b, {0.9, 0.7}}, 1),  polyline({b, {0.8, 0.9}}, 1), polyline({{0.6, 0.9}, b}, 1),
               polyline({{0.5, 0.55}, b}, 1), polyline({b, {0.85, 0.5}}, 1)};
    return p;
}

// Sixteen lines within a fiftieth of the tile, so that one cell lists them all.
inline Pattern wheel_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.02, 0.009), vee(0.03, 0.006), ridge(0.02, 0.005), ridge(0.03, 0.003)};
    for (std::uint32_t k = 0; k < 16; ++k) {
        const double angle = 3.14159265358979 * (k + 0.3) / 16.0;
        const Vec2 along{0.35 * std::cos(angle), 0.35 * std::sin(angle)}, middle{0.5 + 0.01 * std::cos(5.0 * k), 0.5 + 0.01 * std::sin(3.0 * k)};
        p.paths.push_back(polyline({middle - along, middle + along}, k % 4));
    }
    return p;
}

inline Pattern ends_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.03, 0.010), ridge(0.03, 0.007)};
    double y = 0.12;
    for (std::uint32_t profile : {0u, 1u})
        for (CapKind cap : {CapKind::hip, CapKind::butt, CapKind::round, CapKind::taper}) {
            p.paths.push_back(with_caps(polyline({{0.15, y}, {0.4, y + 0.01}}, profile), cap));
            Path bent = polyline({{0.0, 0.0}, {1.0, 1.0}}, profile);
            bent.elements = {make_arc({0.55, y}, {0.7, y - 0.03}, {0.85, y + 0.02})};
            p.paths.push_back(with_caps(bent, cap));
            y += 0.1;
        }
    return p;
}

inline Pattern curve_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.02, 0.008), ridge(0.015, 0.006), lipped(0.03, 0.008, 0.004)};
    p.paths = {circle({0.3, 0.3}, 0.2, 0), circle({0.7, 0.3}, 0.15, 1, true), circle({0.6, 0.7}, 0.22, 2)};
    Path snake;
    snake.profile = 0;
    snake.elements = {make_arc({0.05, 0.9}, {0.15, 0.7}, {0.25, 0.9}), make_arc({0.25, 0.9}, {0.35, 1.1}, {0.45, 0.9})};
    p.paths.push_back(snake);
    return p;
}

// Lines that leave the tile on every side and come back in.
inline Pattern wrapped_pattern() {
    Pattern p = base();
    p.profiles = {groove(0.02, 0.008), vee(0.03, 0.009)};
    p.paths = {polyline({{0.8, 0.2}, {1.2, 0.25}, {1.3, 0.4}}, 0), polyline({{0.5, 0.9}, {0.55, 1.2}}, 1),
               polyline({{0.95, 0.6}, {0.99, 0.8}}, 1), polyline({{0.0, 0.5}, {0.4, 0.5}}, 0)};
    return p;
}

inline Pattern plateau_pattern() {
    Pattern p = base();
    p.size = {1.0, 0.8};
    p.profiles = {step(0.015, 0.006), cliff(0.01, 0.005), groove(0.02, 0.004)};
    // Clockwise on screen: the inside lies to the right, and is lower.
    Path outer = polyline({{0.15, 0.1}, {0.85, 0.12}, {0.8, 0.7}, {0.2, 0.65}}, 0, true);
    Path inner = polyline({{0.35, 0.25}, {0.65, 0.3}, {0.6, 0.5}, {0.4, 0.5}}, 1, true);
    inner.level = -0.006;
    Path disc = circle({0.25, 0.55}, 0.05, 0);
    disc.level = -0.006;
    Path across = polyline({{0.05, 0.4}, {0.95, 0.38}}, 2);
    p.paths = {outer, inner, disc, across};
    return p;
}

// Plateaus on ground at the lowest point there is, as white letters on black make it; a pit that reaches it too.
inline Pattern floor_pattern() {
    Pattern p = base(kDepth);
    p.profiles = {cliff(0.01, -kDepth), cliff(0.01, kDepth), step(0.02, -0.5 * kDepth)};
    p.paths = {polyline({{0.1, 0.1}, {0.6, 0.12}, {0.55, 0.6}, {0.15, 0.55}}, 0, true),
               polyline({{0.25, 0.25}, {0.45, 0.25}, {0.45, 0.45}, {0.25, 0.45}}, 1, true), circle({0.75, 0.75}, 0.15, 2)};
    p.paths[1].level = kDepth;
    return p;
}

// Steps through the centres of cells of a tenth: upright and level, along diagonals, and corners that meet there.
inline Pattern stripes_pattern() {
    Pattern p = base();
    p.profiles = {cliff(0.002, 0.006)};
    p.paths = {polyline({{0.15, 0.15}, {0.35, 0.15}, {0.35, 0.85}, {0.15, 0.85}}, 0, true),
               polyline({{0.55, 0.15}, {0.75, 0.15}, {0.75, 0.85}, {0.55, 0.85}}, 0, true)};
    return p;
}
inline Pattern diamonds_pattern() {
    Pattern p = base();
    p.profiles = {cliff(0.002, 0.006)};
    p.paths = {polyline({{0.25, 0.05}, {0.45, 0.25}, {0.25, 0.45}, {0.05, 0.25}}, 0, true),
               polyline({{0.65, 0.35}, {0.95, 0.65}, {0.65, 0.95}, {0.35, 0.65}}, 0, true)};
    return p;
}
inline Pattern checker_pattern() {
    Pattern p = base();
    p.profiles = {cliff(0.002, 0.006)};
    p.paths = {polyline({{0.15, 0.15}, {0.45, 0.15}, {0.45, 0.45}, {0.15, 0.45}}, 0, true),
               polyline({{0.45, 0.45}, {0.75, 0.45}, {0.75, 0.75}, {0.45, 0.75}}, 0, true)};
    return p;
}

inline Pattern overhang_pattern() {
    Pattern p = base(kRise);
    p.profiles = {rail(0.03, 0.007), undercut(0.03, 0.010), groove(0.02, 0.006)};
    p.paths = {polyline({{0.1, 0.2}, {0.9, 0.25}}, 0), polyline({{0.1, 0.6}, {0.9, 0.55}}, 1),
               polyline({{0.5, 0.1}, {0.55, 0.9}}, 2), circle({0.25, 0.8}, 0.1, 0)};
    return p;
}

inline Pattern scaled_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.03, 0.008), ridge(0.02, 0.006)};
    auto scaled = [](Path path, double w0, double w1, double h0, double h1) {
        path.elements.front().width0 = w0;
        path.elements.front().height0 = h0;
        path.elements.back().width1 = w1;
        path.elements.back().height1 = h1;
        return path;
    };
    Path bent = polyline({{0, 0}, {1, 1}}, 0);
    bent.elements = {make_arc({0.1, 0.7}, {0.4, 0.5}, {0.7, 0.8})};
    p.paths = {scaled(polyline({{0.1, 0.1}, {0.9, 0.15}}, 0), 0.3, 1.4, 0.3, 1.3),
               scaled(polyline({{0.9, 0.35}, {0.1, 0.3}}, 1), 1.5, 0.5, 1.0, 0.4),
               scaled(bent, 1.2, 0.4, 0.5, 1.2)};
    return p;
}

inline Pattern clamped_pattern() {
    Pattern p = base();
    p.wrap = Wrap::clamp;
    p.outer_level = 0.0;
    p.profiles = {groove(0.03, 0.010), vee(0.02, 0.008)};
    p.paths = {polyline({{-0.1, 0.4}, {1.1, 0.45}}, 0),
               polyline({{0.5, -0.05}, {0.45, 0.6}, {0.8, 0.95}}, 1)};
    return p;
}

}  // namespace burin::testing

#include "perturbed_patterns.hpp"

namespace burin::testing {

inline std::vector<NamedPattern> authored_patterns() {
    return {{"crossing", crossing_pattern()},
            {"tee", tee_pattern()},
            {"flush", flush_pattern()},
            {"mitre", corner_pattern(JoinKind::mitre)},
            {"round", corner_pattern(JoinKind::round)},
            {"bevel", corner_pattern(JoinKind::bevel)},
            {"star", star_pattern()},
            {"wheel", wheel_pattern()},
            {"ends", ends_pattern()},
            {"curves", curve_pattern()},
            {"wrapped", wrapped_pattern()},
            {"plateaus", plateau_pattern()},
            {"floor", floor_pattern()},
            {"overhang", overhang_pattern()},
            {"scaled", scaled_pattern()},
            {"clamped", clamped_pattern()},
            {"sine", sine_pattern()},
            {"waved_curves", waved_curve_pattern()},
            {"noise", noise_pattern()},
            {"polynomial", polynomial_pattern()},
            {"fine_waves", fine_waves_pattern()},
            {"waved_junctions", waved_junctions_pattern()}};
}

}  // namespace burin::testing
