// The plainest polyline that, seen through the texels, is the section that a profile shows.
#pragma once

#include <cstdint>
#include <vector>

#include <burin/pattern.hpp>

namespace burin::refinement {

// Replaces profiles by ones of fewer points, symmetric where that does, whose means over texels differ from theirs by at
// most `share` of their relief (root mean square). The middle of a symmetric one is where b is 0. Profiles with facets of
// given kinds stay, and so do those that `stay` marks by 1. Lengths in texels. Returns whether any changed.
bool straighten_sections(Pattern& pattern, double share, const std::vector<std::uint8_t>& stay);

// The pattern with the other's profiles, levels and scales but where a profile has to `stay`. Its paths stay where they
// are, since they meet there. Requires: the same paths and elements in both.
Pattern with_sections(Pattern pattern, const Pattern& other, const std::vector<std::uint8_t>& stay);

}  // namespace burin::refinement
