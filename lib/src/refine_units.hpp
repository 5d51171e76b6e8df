// Metres and texels: the refinement counts in what the map counts in.
#pragma once

#include <burin/pattern.hpp>

namespace burin::refinement {

// The pattern in texels of the map's width, heights in map scale: white 1, black 0. `texel`: its width in metres.
Pattern to_texels(const Pattern& pattern, double texel);

// Writes the refined paths and profiles back into the pattern in metres.
void from_texels(Pattern refined, double texel, Pattern& pattern);

}  // namespace burin::refinement
