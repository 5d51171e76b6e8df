// Where grooves and ridges end, decided by the map: ends are drawn out, taken back, or joined.
//
// A tracer loses the stub beyond a crossing, runs an end on into a neighbour, or leaves a gap where two lines cross at a
// small angle. Along the last element and straight on, the map shows the path's section or it does not; where other
// paths lie over it, only the middle counts.
#pragma once

#include <burin/image.hpp>
#include <burin/pattern.hpp>

namespace burin::refinement {

// The pattern in texels, heights in map scale. Returns whether anything changed. May add a line to a path that ended
// in a quadratic, and takes away small closed steps that a drawn-out path now explains.
bool settle_ends(Pattern& pattern, const Image& map, Vec2 side);

}  // namespace burin::refinement
