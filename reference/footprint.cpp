#include "footprint.hpp"

#include <cmath>
#include <numbers>

namespace burin::reference {

Footprint make_ellipse(Vec2 centre, Vec2 half_x, Vec2 half_y, int corners) {
    Footprint footprint;
    const double step = 2.0 * std::numbers::pi / corners;
    const double grown = std::sqrt(step / std::sin(step));  // the polygon's area is the ellipse's
    if (cross(half_x, half_y) < 0.0) half_y = -half_y;
    for (int i = 0; i < corners; ++i)
        footprint.corners.push_back(centre + (half_x * std::cos(step * i) + half_y * std::sin(step * i)) * grown);
    return footprint;
}

Footprint make_parallelogram(Vec2 centre, Vec2 along_x, Vec2 along_y) {
    if (cross(along_x, along_y) < 0.0) along_y = -along_y;
    const Vec2 x = along_x * 0.5, y = along_y * 0.5;
    return {{centre - x - y, centre + x - y, centre + x + y, centre - x + y}};
}

double area_of(const Footprint& footprint) {
    const auto& p = footprint.corners;
    double twice = 0.0;
    for (std::size_t i = 2; i < p.size(); ++i) twice += cross(p[i - 1] - p[0], p[i] - p[0]);
    return 0.5 * twice;
}

Vec2 middle_of(const Footprint& footprint) {
    const auto& p = footprint.corners;
    Vec2 sum;
    double twice = 0.0;
    for (std::size_t i = 2; i < p.size(); ++i) {
        const double part = cross(p[i - 1] - p[0], p[i] - p[0]);
        sum = sum + ((p[i - 1] - p[0]) + (p[i] - p[0])) * (part / 3.0);
        twice += part;
    }
    return twice > 0.0 ? p[0] + sum * (1.0 / twice) : p[0];
}

Box box_of(const Footprint& footprint) {
    Box box;
    for (const Vec2 p : footprint.corners) include(box, p);
    return box;
}

void halve(const Footprint& footprint, Footprint& first, Footprint& second) {
    const auto& p = footprint.corners;
    // The longest way between two corners is the longer extent.
    Vec2 along{1, 0};
    double longest = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t k = i + 1; k < p.size(); ++k)
            if (dot(p[k] - p[i], p[k] - p[i]) > longest) longest = dot(p[k] - p[i], p[k] - p[i]), along = p[k] - p[i];
    const Vec2 middle = middle_of(footprint);
    const HalfPlane cut{unit(along), dot(unit(along), middle)};
    first.corners.clear();
    second.corners.clear();
    for (std::size_t i = 0; i < p.size(); ++i) {
        const Vec2 a = p[i], b = p[(i + 1) % p.size()];
        const double at_a = beyond(cut, a), at_b = beyond(cut, b);
        if (at_a <= 0.0) first.corners.push_back(a);
        if (at_a >= 0.0) second.corners.push_back(a);
        if ((at_a < 0.0 && at_b > 0.0) || (at_a > 0.0 && at_b < 0.0)) {
            const Vec2 c = lerp(a, b, at_a / (at_a - at_b));
            first.corners.push_back(c);
            second.corners.push_back(c);
        }
    }
}

}  // namespace burin::reference
