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
};

// Adds to `out` one share for each face that is seen, as parts of `whole`, an area. Requires: a carver of all that was gathered
// for this footprint. `top`: where footprints lie.
void sample_areas(Carver& carver, const Footprint& footprint, double top, const Slopes& slopes, double whole, AreaSampling& work,
                  std::vector<Share>& out);

}  // namespace burin::reference
