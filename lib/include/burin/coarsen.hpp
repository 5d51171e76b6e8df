// Stage coarsen: a map drawn finer than its walls are sharp, at the resolution that still shows all of it.
//
//     HeightMap --[coarsen_map]--> the same heights in a quarter, a sixteenth, ... of the texels
//
// A texel's sample is the mean of the surface over it (`image.hpp`), so the mean of four texels is exactly the sample of
// one twice as large: what vectorizes and refines against the coarser map sees the same surface, in a quarter of the
// time. A map may lose every second texel where those that are left foretell the others: each half of a cell from the
// means of its neighbours, by the parabola-like average interpolation of fourth order (Harten 1996; the 1-5 wavelet).
#pragma once

#include <cstddef>
#include <optional>

#include <burin/heightmap.hpp>

namespace burin {

struct CoarsenOptions {
    // 99.9 % of the texels may be foretold wrong by this share of the map's range, and what the rounding to its bit depth
    // makes of it ...
    double most_error = 0.01;
    // ... and where the map slopes by this much of the height that it rises within a texel; the map is left alone above.
    double most_edge_error = 0.07;
    // Maps of fewer texels stay: they are quick as they are.
    std::size_t least_texels = 4u << 20;
    int threads = 0;  // 0: all cores; the result does not depend on it
};

struct Coarsened {
    std::optional<HeightMap> map;  // nothing: the given map as it is
    int halvings = 0;              // its sides are those of the given map over 2^halvings
};

// Means of two by two texels; the last column or row of an odd number is left out.
Image halve_image(const Image& fine, int threads = 0);

// Requires: values in [0, 1]. Sides that are odd are not halved.
// Ensures: no halving of what most_error and most_edge_error forbid; equal results for any number of threads.
// Cost: about 5 ns a texel.
Coarsened coarsen_map(const HeightMap& map, const CoarsenOptions& options = {});

}  // namespace burin
