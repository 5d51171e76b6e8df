// Reconstruct: the height map that two packed textures stand for.
//
//     PackedTextures + PathDetail --[reconstruct_heights]--> Image --[compare_heights]--> Comparison
//
// What is judged are the bytes that are stored, not the pattern that they were made from. Values and texels as in
// rasterize.hpp: box-filtered, 1 the object surface, 0 `depth` below it.
#pragma once

#include <burin/image.hpp>
#include <burin/pack.hpp>
#include <burin/result.hpp>

namespace burin {

struct ReconstructOptions {
    // Only step paths and the levels between them: the surface without its grooves and ridges.
    bool steps_only = false;
    int samples = 4;  // per texel side, as RasterizeOptions::samples
    int threads = 0;  // 0: as many as the machine has; the result does not depend on it
};

// Requires: width, height >= 1. Fails as unpack_textures: the textures need not be trusted.
// Ensures: equal bytes for any number of threads. Cost: that of rasterize_height.
Result<Image> reconstruct_heights(const PackedTextures& textures, const PathDetail& detail, int width, int height,
                                  const ReconstructOptions& options = {});

}  // namespace burin
