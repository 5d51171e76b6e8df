// Patterns written as vectors for the question of this bench, and how to disturb them.
#pragma once

#include <vector>

#include <burin/pattern.hpp>

namespace burin::bench {

struct Walls {
    double groove = 8.0;  // width of grooves at half depth, texels
    double wall = 2.0;    // width of a wall, texels; 0: vertical
};

// Lines, arcs, X, T, corners, ends and plateaus on one square metre. `texels`: side of the map whose texels the
// widths are in. Grooves and steps are all half the depth high, so that the heights 1/4 and 3/4 of the map scale
// are half of every wall.
Pattern plate(int texels, const Walls& walls);

// The same kinds at random places.
Pattern random_plate(int texels, const Walls& walls, unsigned seed);

// The heights in map scale at which half of the pattern's walls stand, each once, lowest first.
std::vector<double> half_heights(const Pattern& pattern);

// Bends the plane smoothly by up to `texels_off` texels, with ends on lines staying on them, and makes profiles wider
// and deeper by up to `share`: a start as a tracer might give it.
Pattern disturbed(const Pattern& pattern, int texels, double texels_off, double share, unsigned seed);

}  // namespace burin::bench
