// What files do to height maps: few bits, and JPEG.
#pragma once

#include <string>

#include <burin/heightmap.hpp>

namespace burin::bench {

enum class Damage { sixteen_bit, eight_bit, jpeg };  // JPEG: quality 85

// The map written to a file in `folder` and read again. Exits with a message when that fails.
HeightMap damaged(const Image& map, Damage damage, const std::string& folder);

}  // namespace burin::bench
