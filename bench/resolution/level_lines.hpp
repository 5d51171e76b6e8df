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

// A square map of `side` texels, each the mean of samples x samples points. `threads` as in RasterizeOptions.
Image sampled(const ResolvedPattern& pattern, int side, int samples, int threads = 0);
// By 40 x 40 samples a texel, rounded to `bits`; exits as above.
Image map_of(const Pattern& pattern, int texels, int bits);

// The map's bilinear interpolation at zoom x zoom places.
Image zoomed(const Image& map, int zoom, Wrap wrap);

// Level lines at `heights` of a zoomed surface, in texels of a map of `texels`.
std::vector<Segment> lines_of(const Image& surface, const std::vector<double>& heights, int texels);
// The same of a pattern whose surface is drawn at `zoom`, 6 x 6 samples a place.
std::vector<Segment> lines_of(const Pattern& pattern, const std::vector<double>& heights, int zoom, int texels);

}  // namespace burin::bench
