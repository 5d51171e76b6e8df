// Drawn polylines as lines on the surface. For the sources of this library only.
#pragma once

#include <vector>

#include "stroke_surface.hpp"

namespace burin::stroking {

// A line on the surface: segment i, from points[i] to points[i + 1], lies in triangles[i].
struct Trace {
    std::vector<Point3> points;
    std::vector<std::uint32_t> triangles;
    std::vector<bool> drawn;  // per point: nearest to one that was drawn, rather than where a side is crossed
    bool closed = false;      // the last point is the first
    int gaps = 0;             // of the stroke it belongs to, before it: places where the surface is missing
};

struct TraceOptions {
    double max_distance = 0.0;  // of drawn points from the surface, metres
    double fine = 0.0;          // what is shorter, in metres, need not be followed
};

// One trace, or several where the stroke runs over the open border of the mesh and comes back. `farthest` grows to the greatest distance of a
// drawn point. Fails with invalid_input where it is above max_distance; `name` begins the message.
Result<std::vector<Trace>> trace_stroke(const Surface& surface, const Stroke& stroke, const std::string& name, const TraceOptions& options,
                                        double& farthest);

}  // namespace burin::stroking
