// Where an element acts, as convex polygons: what the grid tests cells against. Private to lib.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <burin/resolve.hpp>

namespace burin::gridding {

// A convex polygon grown by `grow` that contains a part of where an element acts, with the heights possible
// there.
struct Shape {
    std::array<Vec2, 5> corners;
    int count = 0;
    double grow = 0.0;
    Box box;  // of the grown polygon

    // Body parts: b / width scale of a point lies within (p - origin).normal, widened by `blur`, over
    // [width_low, width_high].
    bool body = false;
    Vec2 origin, normal;
    double blur = 0.0, width_low = 1.0, width_high = 1.0;
    double height_low = 1.0, height_high = 1.0;  // height scales

    bool end_zone = false;  // belongs to an end that is no smooth joint
    // Body parts of a step: the arc from corner chord[0] to chord[1], within `sag`.
    bool path_line = false;
    Vec2 chord[2];
    double sag = 0.0;
};

// Which ends of an element are smooth joints with a listed neighbour.
struct Joints {
    bool start = false, end = false;
};

// Polygons of one element in its own place; bodies are cut to about `piece` metres so that their boxes stay
// tight. Conservative, and exact to about a thousandth of the profile's width. Cost: length / piece + turning
// / 0.06.
std::vector<Shape> shapes_of(const ResolvedPattern& pattern, const ResolvedElement& element, Joints joints,
                             double piece);

// Whether the grown polygon meets the rectangle.
bool meets(const Shape& shape, const Box& rectangle);
// Whether the segment, grown by `grow`, meets the rectangle.
bool segment_meets(Vec2 a, Vec2 b, double grow, const Box& rectangle);

// Height range of a facet set over an interval of profile offsets. `low` counts internal facets only; an
// empty range is low > high.
struct HeightRange {
    double low = 1e300, high = -1e300;
};
HeightRange profile_range(const ResolvedProfile& profile, double b_low, double b_high);

// Heights, above the level, that the element can give to points of the rectangle under this shape.
HeightRange heights_in(const Shape& shape, const ResolvedProfile& profile, const Box& rectangle);

}  // namespace burin::gridding
