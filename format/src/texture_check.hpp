// The data texture decoded into codes while it is checked; the grid's checks look elements up in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <burin/format/extension.hpp>
#include <burin/format/texels.hpp>

#include "report.hpp"

namespace burin {

struct DecodedData {
    static constexpr std::uint32_t kNone = 0xFFFFFFFFu;

    std::vector<ElementCode> elements;
    std::vector<std::uint32_t> element_texel;  // texel of each element
    std::vector<std::uint32_t> element_at;     // per texel of the section: index into `elements`, or kNone
    std::vector<StyleCode> styles;
    std::vector<std::uint8_t> is_function;  // per texel of the function section: a function begins there

    // Style of the element, nullptr when its index is out of range.
    const StyleCode* style_of(const ElementCode& element) const {
        return element.style < styles.size() ? &styles[element.style] : nullptr;
    }
};

// 4060-4063: the function section; fills `data.is_function`.
void check_functions(const PackedTextures& textures, DecodedData& data, Reporter& reporter);
// 4012-4014: what an element says of its function. Requires: check_functions went before.
void check_function_of(const PackedTextures& textures, const DecodedData& data, const ElementCode& element,
                       const std::string& place, Reporter& reporter);

// 4001-4048 and 4053: sections elements, styles, profiles, materials, and what follows the last one.
DecodedData check_data(const PackedTextures& textures, const PathDetail& detail, Reporter& reporter);

// 3001-3009: every cell by itself and beside its neighbours. 4050-4052: the lists that cells refer to.
void check_grid(const PackedTextures& textures, const PathDetail& detail, const DecodedData& data,
                Reporter& reporter);

// 3010: every cell that a step's path line passes through lists it and says so.
void check_steps(const PackedTextures& textures, const PathDetail& detail, const DecodedData& data,
                 Reporter& reporter);

}  // namespace burin
