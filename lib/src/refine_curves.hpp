// Elements where a path needs them: curves for polylines that go round, more pieces for arcs that are too few.
#pragma once

#include <vector>

#include <burin/pattern.hpp>

namespace burin::refinement {

// Runs of short lines that turn one way a little at every corner become G1 chains of fewer quadratics through some of
// their corners. Returns whether anything changed. Lengths in texels.
bool curve_polylines(Pattern& pattern);

// The last line of a path that leaves an arc at a small angle becomes a quadratic that goes on smoothly; a stray last
// element that leaves at a large angle and is shorter than the profile is wide goes. Returns whether anything changed.
bool tidy_tails(Pattern& pattern);

// Splits the quadratics (path, element) in two equal parts each.
struct ElementIndex {
    int path = 0, element = 0;
};
void split_quadratics(Pattern& pattern, const std::vector<ElementIndex>& which);

}  // namespace burin::refinement
