// The plainest polyline that, seen through the texels, is the section that a profile shows.
#pragma once

#include <burin/pattern.hpp>

namespace burin::refinement {

// Replaces profiles by ones of fewer points, symmetric where that does, whose means over texels differ from theirs by at
// most `share` of their relief (root mean square). The middle of a symmetric one is where b is 0. Profiles with facets of
// given kinds stay. Lengths in texels. Returns whether any changed.
bool straighten_sections(Pattern& pattern, double share);

}  // namespace burin::refinement
