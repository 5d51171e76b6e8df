// Pictures of contours over the map they were found in.
#pragma once

#include <string>
#include <vector>

#include <burin/image.hpp>
#include <burin/pattern.hpp>

#include "contour.hpp"

namespace burin::bench {

// Chords of the paths, in texels of a map of `texels`.
std::vector<Segment> chords_of(const Pattern& pattern, int texels);

// Writes `side` x `side` texels of the map from `corner` on as a PNG of 16 pixels a texel, with the true lines green,
// ours red, and our paths blue. Exits with a message when the file cannot be written.
void write_close_up(const std::string& file, const Image& map, Vec2 corner, int side, const std::vector<Segment>& truth,
                    const std::vector<Segment>& ours, const std::vector<Segment>& paths);

}  // namespace burin::bench
