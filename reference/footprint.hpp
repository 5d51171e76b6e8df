// What a pixel sees of the object surface: a convex polygon of the plane, in metres of the pattern. [2008] 4
#pragma once

#include <vector>

#include "polygon.hpp"

namespace burin::reference {

struct Footprint {
    std::vector<Vec2> corners;  // three or more, convex, from x towards y
};

// The ellipse with these half axes, as a polygon of its area. Requires: axes that are not parallel.
Footprint make_ellipse(Vec2 centre, Vec2 half_x, Vec2 half_y, int corners = 32);
// The parallelogram with these sides.
Footprint make_parallelogram(Vec2 centre, Vec2 along_x, Vec2 along_y);

double area_of(const Footprint& footprint);
Vec2 middle_of(const Footprint& footprint);  // of its area
Box box_of(const Footprint& footprint);
// Divides along its longer extent by the line through its middle.
void halve(const Footprint& footprint, Footprint& first, Footprint& second);

}  // namespace burin::reference
