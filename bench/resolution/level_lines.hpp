// The map that an authored pattern gives, its surface at a higher resolution, and the level lines of such surfaces.
#pragma once

#include <vector>

#include <burin/image.hpp>
#include <burin/pattern.hpp>
#include <burin/resolve.hpp>

#include "contour.hpp"

namespace burin::bench {

// Exits with a message when the pattern cannot be resolved. `lenient`: as for traced patterns.
ResolvedPattern resolved_or_exit(const Pattern& pattern, bool lenient);

// Box-filtered by 40 x 40 samples a texel. `threads` as in RasterizeOptions.
Image map_of(const ResolvedPattern& pattern, int texels, int threads = 0);
// The same rounded to `bits`; exits as above.
Image map_of(const Pattern& pattern, int texels, int bits);

// The surface at zoom x zoom places, 6 x 6 samples each.
Image zoomed(const ResolvedPattern& pattern, int zoom, int threads = 0);
// The same of the map's bilinear interpolation.
Image zoomed(const Image& map, int zoom, Wrap wrap);

// Level lines at `heights` of a zoomed surface, in texels of a map of `texels`.
std::vector<Segment> lines_of(const Image& surface, const std::vector<double>& heights, int texels);
std::vector<Segment> lines_of(const Pattern& pattern, const std::vector<double>& heights, int zoom, int texels);

}  // namespace burin::bench
