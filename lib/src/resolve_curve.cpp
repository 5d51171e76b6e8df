#include "resolve_curve.hpp"

#include <algorithm>
#include <cmath>

namespace burin::curve {

Vec2 point(const Element& element, double s) {
    if (element.kind == ElementKind::line) return lerp(element.p0, element.p2, s);
    const double r = 1.0 - s;
    return element.p0 * (r * r) + element.p1 * (2.0 * r * s) + element.p2 * (s * s);
}

Vec2 derivative(const Element& element, double s) {
    if (element.kind == ElementKind::line) return element.p2 - element.p0;
    return 2.0 * lerp(element.p1 - element.p0, element.p2 - element.p1, s);
}

Vec2 tangent(const Element& element, double s) {
    const Vec2 d = derivative(element, s);
    const Vec2 chord = element.p2 - element.p0;
    // At a cusp or a doubled control point the limit of the direction is that of the chord to the other end.
    return length(d) > 1e-12 * length(chord) ? unit(d) : unit(chord);
}

Element part(const Element& element, double s0, double s1) {
    Element piece = element;
    piece.p0 = s0 <= 0.0 ? element.p0 : point(element, s0);
    piece.p2 = s1 >= 1.0 ? element.p2 : point(element, s1);
    if (element.kind == ElementKind::quadratic) {
        // Blossom of the quadratic at (s0, s1).
        piece.p1 = element.p0 * ((1.0 - s0) * (1.0 - s1)) + element.p1 * (s0 * (1.0 - s1) + s1 * (1.0 - s0)) +
                   element.p2 * (s0 * s1);
    }
    const auto scale = [](double a, double b, double s) {
        return s <= 0.0 ? a : s >= 1.0 ? b : a + (b - a) * s;
    };
    piece.width0 = scale(element.width0, element.width1, s0);
    piece.width1 = scale(element.width0, element.width1, s1);
    piece.height0 = scale(element.height0, element.height1, s0);
    piece.height1 = scale(element.height0, element.height1, s1);
    piece.argument0 = argument(element, s0);
    piece.argument1 = argument(element, s1);
    return piece;
}

Element translated(const Element& element, Vec2 by) {
    Element moved = element;
    moved.p0 = element.p0 + by;
    moved.p1 = element.p1 + by;
    moved.p2 = element.p2 + by;
    return moved;
}

double nearest(const Element& element, Vec2 p) {
    if (element.kind == ElementKind::line) {
        const Vec2 d = element.p2 - element.p0;
        const double dd = dot(d, d);
        return dd > 0.0 ? std::clamp(dot(p - element.p0, d) / dd, 0.0, 1.0) : 0.0;
    }
    // The squared distance is a quartic with at most two minima: sample, then polish the best samples by
    // Newton.
    const auto gap = [&](double s) {
        const Vec2 r = point(element, s) - p;
        return dot(r, r);
    };
    const Vec2 second = 2.0 * (element.p0 - 2.0 * element.p1 + element.p2);
    constexpr int kSamples = 16;
    double best = 0.0, best_gap = gap(0.0);
    for (int i = 1; i <= kSamples; ++i) {
        const double s = static_cast<double>(i) / kSamples;
        if (gap(s) < best_gap) best_gap = gap(s), best = s;
    }
    double s = best;
    for (int i = 0; i < 12; ++i) {
        const Vec2 r = point(element, s) - p, d = derivative(element, s);
        const double slope = dot(r, d), curvature = dot(d, d) + dot(r, second);
        const double step = curvature > 0.0 ? slope / curvature : (slope > 0.0 ? 0.01 : -0.01);
        const double next = std::clamp(s - step, 0.0, 1.0);
        if (next == s) break;
        s = next;
    }
    return gap(s) <= best_gap ? s : best;
}

Box control_box(const Element& element) {
    Box box;
    const auto add = [&](Vec2 p) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
    };
    add(element.p0);
    add(element.p2);
    if (element.kind == ElementKind::quadratic) add(element.p1);
    return box;
}

double arc_length(const Element& element) {
    if (element.kind == ElementKind::line) return length(element.p2 - element.p0);
    // Gauss-Legendre, five points, on eight equal parts.
    constexpr double kNode[5] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                 0.9061798459386640};
    constexpr double kWeight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                   0.4786286704993665, 0.2369268850561891};
    double sum = 0.0;
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 5; ++k)
            sum += kWeight[k] / 16.0 * length(derivative(element, (i + 0.5 + 0.5 * kNode[k]) / 8.0));
    return sum;
}

double argument(const Element& element, double s) {
    if (s <= 0.0) return element.argument0;
    if (s >= 1.0) return element.argument1;
    const double span = element.argument1 - element.argument0;
    if (element.kind == ElementKind::line || span == 0.0) return element.argument0 + span * s;
    const auto metres = [&](double to) {
        constexpr double kOff = 0.7745966692414834;  // sqrt(3 / 5)
        const auto speed = [&](double at) { return length(derivative(element, 0.5 * to * at)); };
        return to * (5.0 * speed(1.0 - kOff) + 8.0 * speed(1.0) + 5.0 * speed(1.0 + kOff));
    };
    const double whole = metres(1.0);
    return element.argument0 + span * (whole > 0.0 ? metres(s) / whole : s);
}

int chord_count(const Element& element, double tolerance) {
    if (element.kind == ElementKind::line) return 1;
    // A quadratic leaves its chord by |p0 - 2 p1 + p2| / 4, and by a square less on each of n parts.
    const double sag = length(element.p0 - 2.0 * element.p1 + element.p2) / 4.0;
    return std::clamp(static_cast<int>(std::ceil(std::sqrt(sag / tolerance))), 1, 256);
}

double turning(const Element& element) {
    const Vec2 a = tangent(element, 0.0), b = tangent(element, 1.0);
    return element.kind == ElementKind::line ? 0.0 : std::atan2(std::abs(cross(a, b)), dot(a, b));
}

}  // namespace burin::curve
