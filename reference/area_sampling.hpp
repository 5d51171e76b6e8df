// Shares by polygons: for grooves that meet, end, or turn. [2008] 6
//
// Faces are seen from a direction in the plane of the object surface, where a point's place is where its ray passes it.
// A face that looks away from the eye hides what lies behind it, and nothing else does ([2008] 6.3: only self-occluded facets
// cast); the same from the light.
#pragma once

#include <vector>

#include "blocks.hpp"
#include "footprint.hpp"
#include "share.hpp"

namespace burin::reference {

// A piece as it lies in the plane of one direction.
struct Shown {
    std::uint32_t face = 0;  // in the order in which they were met
    std::uint32_t element = 0, facet = 0;
    Vec3 normal, corner;  // of the face's plane
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

struct AreaRequest {
    const Footprint* footprint = nullptr;  // in the plane of the direction; convex, from x towards y
    Direction direction;
    Slopes slopes;       // the light
    double whole = 1.0;  // area that shares are parts of
    double lowest = 0.0, highest = 0.0;  // of all that may be met
    double fine = 0.0;  // heights and places nearer than this are equal, metres
    bool corners = false;
    bool within = false;  // rays run in the solid and see facets from behind, up to the first that they leave it by
    // The facet that rays leave, of a beam: what lies behind it is not met.
    bool leaves = false;
    Vec3 normal, corner;
};

// Adds to `out` one share for each face that is seen, or with `corners` for each part of one. Asks the blocks that were
// chosen.
void sample_areas(Blocks& blocks, const AreaRequest& request, AreaSampling& work, std::vector<Share>& out);

}  // namespace burin::reference
