// Which texels of a map a refinement looks at.
//
// Where a map is flat or rises evenly, neighbours say the same: one texel of a block speaks for all of it. Where it
// bends, every texel is asked. The choice depends on the map alone, so that the misfits of two patterns compare.
#pragma once

#include <cstdint>
#include <vector>

#include <burin/image.hpp>

namespace burin::refinement {

// How many texels each one speaks for: 0 where another speaks for it. The sum is the number of texels.
struct Sampling {
    int width = 0, height = 0;
    std::vector<std::uint8_t> weights;  // row-major

    int at(int x, int y) const { return weights[static_cast<std::size_t>(y) * width + x]; }
};

Sampling every_texel(int width, int height);

// One texel of every 4 x 4 or 2 x 2 where the map does not bend. `sparse`: and half of the others.
Sampling sample_map(const Image& map, bool sparse);

}  // namespace burin::refinement
