// Parallel rays over the plan, and where on it they show things.
#pragma once

#include <algorithm>

#include "polygon.hpp"

namespace burin::reference {

// Rays that fall along a slope, or rise against it, and are known by where they pass the height `top`.
struct Direction {
    Vec2 slope;
    double top = 0.0;
    bool rising = false;

    Vec2 show(Vec3 p) const { return plan(p) - slope * (top - p.z); }
    double lean(Vec3 normal) const { return normal.z - dot(plan(normal), slope); }
    // How much a face turns towards where the rays come from; below 0: away.
    double facing(Vec3 normal) const { return rising ? -lean(normal) : lean(normal); }
    // Where the ray through q meets the plane through `corner`.
    Vec3 meet(Vec3 normal, Vec3 corner, Vec2 q) const {
        const double z = (dot(normal, corner) - dot(plan(normal), q + slope * top)) / lean(normal);
        const Vec2 p = q + slope * (top - z);
        return {p.x, p.y, z};
    }
    // Where a box that reaches from one height to another may be shown.
    Box show(const Box& box, double low, double high) const {
        const Vec2 a = slope * (low - top), b = slope * (high - top);
        return {{box.low.x + std::min(a.x, b.x), box.low.y + std::min(a.y, b.y)}, {box.high.x + std::max(a.x, b.x), box.high.y + std::max(a.y, b.y)}};
    }
};

// Where something is shown: a box, and a strip that cuts off its corners where what is shown is long and aslant.
struct Window {
    Vec2 n{1, 0};  // across the strip
    Box box;
    double low = 1e300, high = -1e300;

    void include(Vec2 p) {
        burin::reference::include(box, p);
        low = std::min(low, dot(n, p)), high = std::max(high, dot(n, p));
    }
    bool meets(const Box& other) const {
        if (!meet(box, other)) return false;
        const Vec2 centre = lerp(other.low, other.high, 0.5), half = (other.high - other.low) * 0.5;
        const double at = dot(centre, n), reach = std::abs(n.x) * half.x + std::abs(n.y) * half.y;
        return at + reach >= low && at - reach <= high;
    }
};

}  // namespace burin::reference
