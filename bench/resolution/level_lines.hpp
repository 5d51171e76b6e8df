// The map that an authored pattern gives, and the half-height level lines of patterns and maps.
#pragma once

#include <vector>

#include <burin/image.hpp>
#include <burin/pattern.hpp>

#include "contour.hpp"

namespace burin::bench {

// Box-filtered by 40 x 40 samples a texel, rounded to `bits`. Exits with a message when the pattern cannot be resolved.
Image map_of(const Pattern& pattern, int texels, int bits);

// Level lines at kHalfHeights in texels of a map of `texels`, of the surface sampled at zoom x zoom places.
std::vector<Segment> lines_of(const Pattern& pattern, int zoom, int texels);

// The same of the map's bilinear interpolation.
std::vector<Segment> lines_of(const Image& map, int zoom);

}  // namespace burin::bench
