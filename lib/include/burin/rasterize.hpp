// Rasterize: the height map that a ResolvedPattern stands for.
//
//     ResolvedPattern --[rasterize_height]--> Image
//
// The map covers the tile [0, size]; texel convention and box filter as in image.hpp; value = 1 + (z -
// base_offset) / depth, so 1 is the object surface and 0 is `depth` below it. Heights beyond the
// range are cut off, as a reader's rays do. The surface is the truth's (evaluate.hpp), asked through buckets of its own so that few elements are tried per
// texel.
#pragma once

#include <burin/evaluate.hpp>
#include <burin/image.hpp>
#include <burin/result.hpp>

namespace burin {

// Texels [x, x + width) x [y, y + height) of the map.
struct TexelRegion {
    int x = 0, y = 0;
    int width = 0, height = 0;
};

struct RasterizeOptions {
    int samples = 4;     // per texel side, [1, 64]: each texel is the mean of samples x samples points
    int threads = 0;     // 0: as many as the machine has
    TexelRegion region;  // width 0: the whole map; else only this part, which is then the size of the image
    // Texels where the surface is one plane (or one gentle curve whose mean differs by less than this, as a
    // fraction of depth) are sampled once, in the middle, which gives the same mean. 0 switches that off for
    // curves.
    double curve_tolerance = 2e-6;
    double level_tolerance = 1e-9;  // as in TruthOptions
};

// Requires: width, height >= 1; options in their ranges; a region that lies within the map; a pattern as
// Truth needs. Ensures: equal bytes for any number of threads; a region equals the same part of the whole
// map, bit by bit. Cost: near features about samples^2 times elements at the point; flat texels cost next to
// nothing.
Image rasterize_height(const ResolvedPattern& pattern, int width, int height,
                       const RasterizeOptions& options = {});

}  // namespace burin
