#include "cpp/ground_range.hpp"

#include <algorithm>

namespace burin {

std::array<float, 2> ground_range(const PackedTextures& textures, const PathDetail& detail) {
    double highest = 0.0, lowest_ground = 1.0;  // values of the height range
    const std::uint32_t cells = std::uint32_t(textures.grid_width) * std::uint32_t(textures.grid_height);
    for (std::uint32_t k = 0; k < cells; ++k) {
        const CellCode cell = unpack_cell(cell_texel(textures, k));
        highest = std::max(highest, decode_unorm8(cell.highest));
        lowest_ground = std::min(lowest_ground, decode_unorm16(cell.level));
    }
    const auto first = std::uint32_t(textures.sections.styles_begin());
    for (std::uint32_t k = 0; first + k < textures.sections.profiles_begin(); ++k) {
        const StyleCode style = unpack_style(data_texel(textures, first + k));
        lowest_ground = std::min({lowest_ground, decode_unorm16(style.level_left), decode_unorm16(style.level_right)});
    }
    return {float(detail.depth * (1.0 - highest)), float(detail.depth * (1.0 - lowest_ground))};
}

}  // namespace burin
