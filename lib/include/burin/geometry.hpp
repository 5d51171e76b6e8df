// Points, lines and quadratic Béziers in the plane. Double precision, no dependency.
//
// Axes: x along u, y along v, v down as in glTF. A tangent t has the normal n = (-t.y, t.x); on screen n points to
// the right of the way the path runs. The unit is whatever the caller's points have; nothing here depends on it.
#pragma once

#include <cmath>

namespace burin {

// A point or a difference of points.
struct Vec2 {
    double x = 0.0;
    double y = 0.0;
};

// Componentwise; a negative scale turns round.
inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
inline Vec2 operator*(Vec2 a, double s) { return {a.x * s, a.y * s}; }
inline Vec2 operator*(double s, Vec2 a) { return {a.x * s, a.y * s}; }
// Bit by bit but for the sign of zero: ends that are meant to meet are copies of each other.
inline bool operator==(Vec2 a, Vec2 b) { return a.x == b.x && a.y == b.y; }
// The cosine of the angle between a and b, times both lengths.
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
// The sine of the angle from a to b, times both lengths; > 0 when b lies on a's right on screen, y down.
inline double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
// Without overflow or underflow on the way.
inline double length(Vec2 a) { return std::hypot(a.x, a.y); }
// As long as t, a quarter turn towards b > 0.
inline Vec2 normal_of(Vec2 t) { return {-t.y, t.x}; }
// a at s = 0; b at s = 1 up to rounding; s may lie outside [0, 1].
inline Vec2 lerp(Vec2 a, Vec2 b, double s) { return a + (b - a) * s; }

// Unit vector along a; (1, 0) for a vector of length 0, so that degenerate input stays finite.
inline Vec2 unit(Vec2 a) {
    const double l = length(a);
    return l > 0.0 ? a * (1.0 / l) : Vec2{1.0, 0.0};
}

// An axis-parallel rectangle, both borders included; empty as it is made, so that points can be taken in one by one.
struct Box {
    Vec2 low{1e300, 1e300};
    Vec2 high{-1e300, -1e300};
};

}  // namespace burin
