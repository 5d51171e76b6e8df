// Which elements matter to a footprint: those that it shows, and those that hide or shade what it shows. [2008] 4.1
//
// Footprints lie on the plane z = top() of the object surface. What a ray through a point q of it sees at height z lies at
// q + slope (top - z); so the footprint's box, swept by the view over the whole depth, holds all that is seen, and swept back
// towards the light all that throws a shadow on it. The grid's cells list what acts in them, so that the box need not be
// enlarged by widths; every cell of the box is read, not only those on its boundary, since paths may be shorter than it.
#pragma once

#include <vector>

#include "polygon.hpp"
#include "surface.hpp"

namespace burin::reference {

// Metres over the plane per metre of fall. Upright rays have none.
struct Slopes {
    Vec2 view;   // of the ray from the eye
    Vec2 light;  // of the ray from the light
    bool lit = true;  // the light stands above the plane
};

// One image of an element.
struct Instance {
    std::uint32_t element = 0;
    Vec2 shift;  // of the tile
};

struct Gathered {
    Box seen;    // in plan: what rays of the footprint may meet
    Box domain;  // and what may lie on the light's way to it
    std::vector<Instance> instances;  // ascending by element, each once; act in the domain
    bool steps = false;               // a step's path line meets the domain
    double lowest = 0.0;              // nothing in the domain lies lower
    double highest = 0.0;             // or higher
};

// `footprint` in plan, a polygon's box. Fills `out`, whose memory is used again. Cost: the cells of the domain.
void gather_grooves(const GroovedSurface& surface, const Box& footprint, const Slopes& slopes, Gathered& out);

// The ground at p, by the cell's own rule (grid.hpp). Cost: the steps of one cell.
double ground_near(const GroovedSurface& surface, Vec2 p);

}  // namespace burin::reference
