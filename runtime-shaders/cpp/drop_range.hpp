// What a reader finds out about a pattern when it loads it: burin_map.drop_range of the shader and of the C++ decoder.
#pragma once

#include <array>

#include <burin/format/extension.hpp>
#include <burin/format/texels.hpp>

namespace burin {

// Drops in metres of the highest and the lowest surface of any cell: a ray can meet nothing outside them. Cost: one pass
// over the cells.
std::array<float, 2> drop_range(const PackedTextures& textures, const PathDetail& detail);

}  // namespace burin
