// What the whole pipeline makes of a map.
#pragma once

#include <burin/image.hpp>
#include <burin/pattern.hpp>

namespace burin::bench {

// The map traced from nothing; `like` tells size, depth and wrap. Exits with a message when it cannot be.
// `refined`: with the least-squares fit after it.
Pattern vectorized(const Image& map, const Pattern& like, bool refined);

}  // namespace burin::bench
