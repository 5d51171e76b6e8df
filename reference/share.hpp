// A facet's part in a footprint.
#pragma once

#include <cstdint>

#include "polygon.hpp"

namespace burin::reference {

struct Share {
    std::uint32_t element = 0;  // of the pattern; kGround: none (evaluate.hpp)
    std::uint32_t facet = 0;    // of its profile; kGround, kWall
    Vec3 normal;                // of the pattern's space, unit length
    double seen = 0.0;          // share of the footprint that shows it, [0, 1]
    double lit = 0.0;           // and that the light reaches, [0, seen]
    Vec3 place;                 // in the middle of what is seen
    std::uint32_t first_corner = 0, corners = 0;  // of what is seen, a convex polygon; where it was asked for (AreasWork::corners)
};

}  // namespace burin::reference
