// Where in a pixel rays and samples go. Places are -0.5 to 0.5, in pixels.
#pragma once

#include <vector>

#include <burin/geometry.hpp>

namespace burin::gl {

// A pixel's samples.
struct SampleGrid {
    int side = 1;                // side x side cells, or two of half a pixel each
    std::vector<Vec2> places;    // their middles
    Vec2 part{1.0, 1.0};         // width and height of what each filters, in pixels
};

// `count` rounded up to a square number, in an order whose first four spread. Two stay two: as areas the left and the right half of the
// pixel, as rays halfway to two corners.
SampleGrid sample_grid(int count, bool areas);

// Of a pixel's samples * side cells to a side, the first one of a sample.
struct RayCell {
    int column, row;
};
RayCell first_ray_cell(int side, Vec2 sample, int samples);

struct RayPlace {
    Vec2 middle;  // of the ray's cell
    Vec2 shift;   // from there, for rays at grazing angles
};

// A sample's side x side rays, the first four of them spread, one in each quarter row by row, in units of its cell; `sample` is one of a
// grid with `samples` to a side. Of up to 2 x 2 per pixel all lie in the middles of their cells, which is what [2010] 5.7 asks for ("halfway to the corners"). From 4 x 4 on they may be
// moved so that no two share a row or a column of the pixel. Middles are best for edges that run anyhow; but at grazing angles most
// run along the horizon, and rays that share no row meet them at side^2 places instead of side: 4 dB.
std::vector<RayPlace> ray_places(int side, Vec2 sample, int samples);

}  // namespace burin::gl
