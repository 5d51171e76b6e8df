// Stage bake: the fallback that a viewer without burin's shader shows. A tangent-space normal map and an
// occlusion map are baked from the height map itself, so that what the paths leave out is still there.
//
//     heights --[bake_fallback]--> Fallback --[write_glb]--> normalTexture, occlusionTexture of the core
//     material
//
// Convention of glTF 2.0: red +x along u, green +y against v (up in the picture), blue out of the surface;
// code = round((n + 1) / 2 * 255); linear.
#pragma once

#include <burin/image.hpp>
#include <burin/image_io.hpp>
#include <burin/pattern.hpp>

namespace burin {

struct FallbackOptions {
    int max_side = 256;  // longer side of the normal map, texels, [1, 4096]
    // A smaller normal map is taken while its normals, interpolated, stay within this RMS angle of the
    // largest one's, degrees, [0, 90].
    double normal_tolerance = 2.0;
    bool occlusion = true;  // the occlusion map has at most half the side of the normal map
};

struct Fallback {
    RgbaImage normal;           // empty (width 0): nothing to show, no texture is written
    RgbaImage occlusion;        // grey; red counts, as in glTF; empty: no texture is written
    double normal_error = 0.0;  // RMS angle to the largest size considered, degrees
};

// Bakes `height01` (1 = object surface, 0 = `depth` metres below it), that covers `size` metres.
// Slopes are means over each texel of the result (box filter), so that a small map keeps the mean normal.
// Requires: height01 not empty, size and depth > 0 and finite, options within their ranges.
// Ensures: a constant map gives an empty fallback; equal input gives equal bytes.
// Cost: one pass over the map; the rest depends on max_side only.
Fallback bake_fallback(const Image& height01, Vec2 size, double depth, Wrap wrap,
                       const FallbackOptions& options = {});

}  // namespace burin
