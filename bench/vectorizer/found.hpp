// What burin makes of a map: the pattern as found, and as its textures store it.
#pragma once

#include <cstddef>
#include <string>

#include <burin/heightmap.hpp>
#include <burin/pattern.hpp>
#include <burin/resolve.hpp>

namespace burin::bench {

struct Found {
    Pattern pattern;
    ResolvedPattern stored;         // read back from the textures
    std::size_t texture_bytes = 0;  // both textures
    std::size_t elements = 0;
    double explained = 0.0;  // of the damaged map (DESIGN 7)
    double seconds = 0.0;    // processor time of the calling thread, from the map to the textures and their figures
};

// All of a conversion but the model, on one thread and within its usual budget of bytes; `like` tells size, depth and wrap.
// Exits with a message when a stage fails.
Found found_in(const HeightMap& map, const Pattern& like);

}  // namespace burin::bench
