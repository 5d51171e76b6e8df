// Which elements matter to a footprint: those that it shows, and those that hide or shade what it shows. [2008] 4.1
//
// Footprints lie on the plane z = top() of the object surface. What a ray through a point q of it sees at height z lies at
// q + slope (top - z); so the footprint, swept by the view over the whole depth, holds all that is seen, and swept back
// towards the light, holds all that throws a shadow on it. The grid's cells list what acts in them, so that nothing need be
// enlarged by widths; every cell is read, not only those on its boundary, since paths may be shorter than it.
#pragma once

#include <vector>

#include "footprint.hpp"
#include "polygon.hpp"
#include "surface.hpp"

namespace burin::reference {

// Metres over the plane per metre of fall. Upright rays have none.
struct Slopes {
    Vec2 view;   // of the ray from the eye
    Vec2 light;  // of the ray from the light
    bool lit = true;  // the light stands above the plane
};

// Heights from which rays start, and which way they go: those of a footprint fall from the object surface.
struct Start {
    double low = 0.0, high = 0.0;
    bool rising = false;
    bool within = false;  // in the solid
};

// The part of the plane that may matter: a footprint, swept along the view and back along the light.
struct Region {
    Footprint footprint;
    Vec2 sweep[2];
    Box box;
    struct Slab {
        Vec2 n;
        double low, high;
    } slabs[2];  // across both sweeps, where the box is far larger than the region

    void bound();  // sets box and slabs from the rest
    // How far it reaches along n.
    void extent(Vec2 n, double& low, double& high) const;
    // False only where the two are apart.
    bool meets(const Box& other) const;
};

// One image of an element.
struct Instance {
    std::uint32_t element = 0;
    Vec2 shift;  // of the tile
};

struct Gathered {
    Region region;  // in plan: what rays of the footprint may meet, and what may lie on the light's way to it
    std::vector<Instance> instances;  // ascending by element, each once; act in the region
    bool from_top = false;            // rays start on the object surface and fall: of the ground only what they meet matters
    Vec2 view;                        // their slope
    bool steps = false;               // a step's path line meets the region
    double lowest = 0.0;              // nothing in the region lies lower
    double highest = 0.0;             // or higher
};

// Fills `out`, whose memory is used again. Cost: the cells of the region's box.
void gather_grooves(const GroovedSurface& surface, const Footprint& footprint, const Slopes& slopes, Gathered& out);
// The same for rays that start elsewhere; slopes.view is theirs, metres over the plane per metre of fall all the same. `footprint` is the plan of
// where they start and may have no area.
void gather_grooves(const GroovedSurface& surface, const Footprint& footprint, const Slopes& slopes, const Start& start, Gathered& out);

// Whether all of the region lies where the pattern is: everywhere when it repeats.
bool is_inside_map(const GroovedSurface& surface, const Region& region);

// The ground at p, by the cell's own rule (grid.hpp). Cost: the steps of one cell.
double ground_near(const GroovedSurface& surface, Vec2 p);

}  // namespace burin::reference
