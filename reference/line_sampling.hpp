// Shares by a cross-section: for one groove, or several beside each other, that neither meet nor end in a footprint. [2008] 5
//
// All points are projected along the ray onto the line across the grooves; taken in the order in which the ray passes them,
// what lies before the farthest place so far is hidden. View and light are treated alike. [2008] takes every offset of the
// footprint for equally wide; here each counts with the footprint's own width, so that straight grooves are exact.
#pragma once

#include <vector>

#include "footprint.hpp"
#include "share.hpp"
#include "surface.hpp"

namespace burin::reference {

struct Gathered;
struct Slopes;

// A groove as it lies across: its path at `at`, metres along the common axis.
struct Crossed {
    std::uint32_t instance = 0;
    double at = 0.0, low = 0.0, high = 0.0;  // and its extent
    double width = 1.0, height = 1.0;
    double from = 0.0, to = 0.0;  // along the path: where its section holds
    bool turned = false;          // its path runs against the common direction
};

// A piece of the cross-section, from the smaller offset to the larger.
struct Segment {
    double x0, z0, x1, z1;
    std::uint32_t instance, facet;
    // Parts that rays of the eye and of the light reach, from 0 to 1 along it.
    double seen0 = 0.0, seen1 = 0.0, lit0 = 0.0, lit1 = 0.0;
};

// Share of the footprint at smaller offsets than some.
struct OffsetTable {
    struct Entry {
        double offset, width, below;
    };
    std::vector<Entry> entries;
    double below(double offset) const;
};

// Memory of one thread.
struct LineSampling {
    std::vector<Crossed> crossed;
    std::vector<Segment> segments;
    OffsetTable table;
};

// Adds to `out` and is true where a cross-section is enough: grooves that are straight within `tolerance`, metres, run the same way
// without an end, do not overlap, and keep their section. `whole`: the area that shares are parts of. Profiles that
// overhang are left to area sampling. Cost: linear in the grooves, some 0.3 us each.
bool sample_lines(const GroovedSurface& surface, const Gathered& gathered, const Footprint& footprint, const Slopes& slopes, double tolerance,
                  double whole, LineSampling& work, std::vector<Share>& out);

}  // namespace burin::reference
