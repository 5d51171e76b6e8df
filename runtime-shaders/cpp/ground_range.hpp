// What a reader finds out about a pattern when it loads it: the drops between which a ray can pass over a neighbour's
// ground. burin_map.ground_range of the shader and of the C++ decoder.
#pragma once

#include <array>

#include <burin/format/extension.hpp>
#include <burin/format/texels.hpp>

namespace burin {

// Drops in metres: of the highest surface of any cell, and of the lowest ground. Cost: one pass over cells and styles.
// Requires: sections that lie inside the data texture.
std::array<float, 2> ground_range(const PackedTextures& textures, const PathDetail& detail);

}  // namespace burin
