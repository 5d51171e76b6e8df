// Shares by polygons: for grooves that meet, end, or turn. [2008] 6
//
// Faces are seen from a direction in the plane of the object surface, where a point's place is where its ray passes it.
// A face that looks away from the eye hides what lies behind it, and nothing else does ([2008] 6.3: only self-occluded facets
// cast); the same from the light.
#pragma once

#include <vector>

#include "carve.hpp"
#include "footprint.hpp"
#include "share.hpp"

namespace burin::reference {

// A piece as it lies in the plane of one direction.
struct Shown {
    std::uint32_t face = 0;
    Polygon polygon;  // in AreaSampling::plane, from x towards y
    Box box;
};

// Memory of one thread.
struct AreaSampling {
    Polygons<Vec2> plane;
    std::vector<Shown> front, hiding, shading, seen;
    std::vector<Polygon> kept, next;
    std::vector<Vec3> corners;  // of shares
};

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
};

struct AreaRequest {
    const Footprint* footprint = nullptr;  // in the plane of the direction; convex, from x towards y
    Direction direction;
    Slopes slopes;       // the light
    double whole = 1.0;  // area that shares are parts of
    bool corners = false;
    bool within = false;  // rays run in the solid and see facets from behind, up to the first that they leave it by
    // The facet that rays leave, of a beam: what lies behind it is not met.
    bool leaves = false;
    Vec3 normal, corner;
};

// Adds to `out` one share for each face that is seen, or with `corners` for each part of one. Requires: a carver of all that was
// gathered for this request.
void sample_areas(Carver& carver, const AreaRequest& request, AreaSampling& work, std::vector<Share>& out);

}  // namespace burin::reference
