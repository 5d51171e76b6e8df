// Stage residual: what the paths do not explain, as a normal map of a size chosen by its content.
//
//     HeightMap + reconstruction of the packed pattern --[bake_residual]--> Residual --[write_glb]--> residualTexture
//
// A renderer adds the residual's slopes to those of the facet that it meets (format/SPECIFICATION.md, section 13), so
// that grain, soft ground and small things show although no path holds them.
//
// THE FIGURE. The angle in a texel is that between the normal of the map and the normal of what is drawn. Both come
// from the same operator: central differences over two texels of height, in metres; across the seam of a map that
// repeats, one-sided at other borders. What is drawn is the reconstruction (box-filtered heights, rasterize.hpp) plus
// the residual's slopes, decoded from its 8 bits and interpolated bilinearly. Grain counts as content of the map. The
// figure is the root mean square over the texels; of maps beyond 2^20 texels one in every block is asked, at a place
// that looks random and never changes, which moves the figure by less than 1 %.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <burin/image.hpp>
#include <burin/image_io.hpp>
#include <burin/pattern.hpp>
#include <burin/result.hpp>

namespace burin {

struct ResidualOptions {
    double tolerance = 4.5;  // RMS angle that must be kept, degrees, [0, 90]
    double unneeded = 1.0;   // paths that come as near as this need no residual, degrees, [0, 90]
    // Share of the error that a residual must take away where the paths keep the tolerance, [0, 1].
    double worthwhile = 0.2;
    // Most texels; sides are those of the map divided by 1, 2, 4, ..., and at most 4096. 0: no residual.
    std::size_t most_texels = static_cast<std::size_t>(-1);
    std::size_t most_bytes = static_cast<std::size_t>(-1);  // of the PNG
    int threads = 0;  // 0: as many as the machine has; the result does not depend on it
};

struct Residual {
    // Tangent space as in glTF: red +x along u, green +y against v, blue out of the surface; linear. The slope along u is
    // -scale * red / blue and the slope along v is scale * green / blue, each channel code / 127.5 - 1. Blue is 255
    // throughout, so that slopes are interpolated as they are. Width 0: none is needed, or none helps.
    RgbaImage picture;
    double scale = 1.0;              // > 0; textureInfo's `scale`
    std::vector<std::uint8_t> png;   // of the picture; empty without
    double error_without = 0.0;      // RMS angle of the paths alone, degrees
    double error = 0.0;              // with the residual; the same without one
    bool is_short = false;           // but for `most_bytes` a larger one would have been taken
};

// Requires (asserted): maps of equal size, not empty, heights from 0 to 1 (1 = object surface, 0 = `depth` metres below
// it) over `size` metres; size and depth > 0 and finite; options in their ranges.
// Ensures: where the paths alone err by more than the tolerance, the smallest size that keeps it, or, where none does, the
// smallest that comes within a twentieth of the best one; no residual where that takes less than a twentieth of the error
// away. Where the paths keep the tolerance but are not as near as `unneeded`: by the same rule, a size of at most 1/64 of
// the map's texels, if that is worthwhile. A size whose PNG takes more than `most_bytes` is none that could be chosen. One of the map's own size has codes as coarse as half the tolerance allows. A map equal to its reconstruction gives none.
// Equal input gives equal bytes, whatever the number of threads. Fails as encode_png.
// Cost: some 30 ns a texel and thread, and 6 bytes of memory a texel (16 where sides may be those of the map); slopes are
// fitted by least squares, weighted by how far they turn a normal.
Result<Residual> bake_residual(const Image& map, const Image& reconstruction, Vec2 size, double depth, Wrap wrap,
                               const ResidualOptions& options = {});

}  // namespace burin
