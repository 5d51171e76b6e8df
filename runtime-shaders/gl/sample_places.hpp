// Where in a pixel rays and samples go. Places are -0.5 to 0.5, in pixels.
#pragma once

#include <vector>

#include <burin/geometry.hpp>

namespace burin::gl {

// Of a grid of side x side cells: their middles up to 2 x 2, which is what [2010] 5.7 asks for ("halfway to the corners"). From 4 x 4
// on each place moves within its cell, by a half of what would keep any two from sharing a row or a column. Edges within a few
// degrees of the picture's sides, as most are at grazing angles, are filtered 4 dB better than by the middles, others as well.
Vec2 spread_place(int column, int row, int side);

// A picture's samples, in an order whose first four spread. `filtered`: each stands for its cell, and so lies in the middle.
std::vector<Vec2> sample_places(int side, bool filtered);

// A sample's side x side rays, row by row, in units of its cell. `sample`: one of sample_places(samples, true).
std::vector<Vec2> ray_places(int side, Vec2 sample, int samples);

}  // namespace burin::gl
