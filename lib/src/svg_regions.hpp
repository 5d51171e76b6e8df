// Filled shapes to the steps between levels of ground.
//
//     regions, painted one over the other --[trace_steps]--> runs of elements with a level on either side
//
// What is painted later covers what lies below it, as in the drawing; regions of one level that meet become one. Outlines are united
// as polygons on a fine integer grid (Clipper), which is robust against edges that coincide, and found again as the curves they
// came from: a run holds parts of the drawing's own lines and quadratics, not chords.
#pragma once

#include <cstddef>
#include <vector>

#include <burin/path_data.hpp>

namespace burin::svg {

inline constexpr std::size_t kNone = static_cast<std::size_t>(-1);

struct Region {
    const std::vector<Subpath>* outline = nullptr;  // open subpaths are closed by a line
    bool even_odd = false;
    double level = 0.0;      // ground within, metres; 0 takes away what lies below
    std::size_t style = 0;   // of its edge: the caller's business
};

// Where a piece of a run comes from: element `element` of the outline's subpath, from parameter `from` to `to` (either order).
// subpath kNone: a chord, where the source is not known.
struct StepSource {
    std::size_t region = kNone, subpath = kNone, element = kNone;
    double from = 0.0, to = 0.0;
};

struct StepRun {
    std::vector<Element> elements;     // consecutive bit by bit
    std::vector<StepSource> sources;   // of each
    std::vector<std::size_t> pieces;   // of the tracer's own, that each was made from
    bool closed = false;
    double left = 0.0, right = 0.0;    // ground on either side, left below right
    std::size_t style = 0;
};

struct StepOptions {
    Vec2 size;                // of the page, metres
    double tolerance = 0.0;   // farthest that a chord may lie from its curve, metres
    int threads = 0;          // 0: all cores; the result does not depend on it
};

// Ensures: runs meet only at their ends. Cost: about n log n in chords where few regions lie on one another; among those that do,
// every two of different levels are looked at once.
std::vector<StepRun> trace_steps(const std::vector<Region>& regions, const StepOptions& options);

}  // namespace burin::svg
