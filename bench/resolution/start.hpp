// What the whole pipeline makes of a map.
#pragma once

#include <burin/image.hpp>
#include <burin/pattern.hpp>

namespace burin::bench {

// The map traced from nothing; `like` tells size, depth and wrap. Exits with a message when it cannot be.
Pattern vectorized(const Image& map, const Pattern& like);

}  // namespace burin::bench
