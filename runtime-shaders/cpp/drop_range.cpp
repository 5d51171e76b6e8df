#include "cpp/drop_range.hpp"

#include <algorithm>

namespace burin {

std::array<float, 2> drop_range(const PackedTextures& textures, const PathDetail& detail) {
    double highest = 0.0, lowest = 1.0;  // values of the height range
    const auto cells = std::uint32_t(textures.grid.size() / 2);
    for (std::uint32_t k = 0; k < cells; ++k) {
        const CellCode cell = unpack_cell(cell_texel(textures, k));
        highest = std::max(highest, decode_unorm8(cell.highest));
        lowest = std::min(lowest, decode_unorm8(cell.lowest));
    }
    return {float(detail.depth * (1.0 - highest)), float(detail.depth * (1.0 - lowest))};
}

}  // namespace burin
