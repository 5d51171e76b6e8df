// Where grooves and ridges end, decided by the map: ends are drawn out, taken back, or joined.
//
// A tracer loses the stub beyond a crossing, runs an end on into a neighbour, or leaves a gap where two lines cross at a
// small angle. Along the last element and straight on, the map shows the path's section or it does not; where other
// paths lie over it, only the middle counts.
#pragma once

#include <cstdint>
#include <vector>

#include <burin/image.hpp>
#include <burin/pattern.hpp>

namespace burin::refinement {

// An end that was moved, and the part of the plane where that shows.
struct MovedEnd {
    std::size_t end = 0;  // counted over the starts and ends of the pattern's open grooves and ridges, in order
    Box window;
};

// The pattern in texels, heights in map scale. May add a line to a path that ended in a quadratic, and takes away small
// closed steps that a drawn-out path explains. `held`: ends that stay, by number; missing ones may move.
std::vector<MovedEnd> settle_ends(Pattern& pattern, const Image& map, Vec2 side, const std::vector<std::uint8_t>& held);

}  // namespace burin::refinement
