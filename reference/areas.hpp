// How much of a footprint shows each facet, and how much of that the light reaches: the core of the renderer. [2008] 5 and 6
//
//     footprint, view, light --[find_areas]--> shares of the footprint by facet
//
// Where all that matters is one groove or several beside each other, the cross-section is enough (line sampling, [2008] 5, with
// the footprint's own width at each offset in place of a mean one, so that shares are exact for straight grooves); where
// grooves meet or end, faces are polygons (area sampling, [2008] 6). Large footprints with many grooves are divided.
#pragma once

#include <vector>

#include "area_sampling.hpp"
#include "footprint.hpp"
#include "gather.hpp"
#include "line_sampling.hpp"
#include "share.hpp"

namespace burin::reference {

struct AreasOptions {
    double tolerance = 0.004;  // of the footprint's width: how far bent grooves may lie from the straight pieces that stand for them
    double width = 0.0;        // of the pixel that the footprint is a part of, metres; 0: the root of the footprint's area
    int most_elements = 24;    // more near a footprint: it is divided
    bool lines = true;         // false: area sampling everywhere
    bool corners = false;      // shares with the polygons that are seen, one for each; area sampling everywhere
};

// Memory of one thread. Blocks of surfaces that were asked stay, and with them a pointer to each surface: one that is asked again must lie where it
// lay before.
struct AreasWork {
    Gathered gathered;
    Blocks blocks;
    AreaSampling area;
    LineSampling line;
    long by_line = 0, by_area = 0;  // footprints, or parts of them, that each has done
};

// Fills `out`: shares that sum to 1, in the order of elements and facets within a part of the footprint; the same facet may
// stand there more than once. Requires: a footprint of positive area. Cost: 1 us for a groove, some 3 us where two cross and neighbours have
// been asked before; 20 to 110 us where none has.
void find_areas(const GroovedSurface& surface, const Footprint& footprint, const Slopes& slopes, const AreasOptions& options,
                AreasWork& work, std::vector<Share>& out);

// The same for rays that come from below, through the solid: what they see of facets from behind. `footprint` is where they would
// pass the object surface, `slope` theirs, metres over the plane per metre of fall. Nothing is lit; options.corners counts as set.
void find_areas_within(const GroovedSurface& surface, const Footprint& footprint, Vec2 slope, const AreasOptions& options, AreasWork& work,
                       std::vector<Share>& out);

// What leaves a facet in one direction. [2008] 7
struct Beam {
    std::vector<Vec3> corners;  // of the part of the facet that it leaves, convex and flat, in pattern space
    Vec3 normal;                // of the facet
    Vec3 direction;             // of any length, not level; away from the solid
    bool within = false;        // or into it, and what it meets is seen from behind
};

// What the beam meets, as shares of it with corners; the rest of it leaves the relief: that part is returned. `slopes.view` is not
// used. Cost: as area sampling.
double find_hits(const GroovedSurface& surface, const Beam& beam, const Slopes& slopes, const AreasOptions& options, AreasWork& work,
                 std::vector<Share>& out);

}  // namespace burin::reference
