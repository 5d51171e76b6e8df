// Fewer points for profiles that were measured through the blur of the map's texels.
#pragma once

#include <burin/pattern.hpp>

namespace burin::refinement {

// Makes profiles that are symmetric within a few percent exactly so. Returns whether any changed. Lengths in texels.
bool make_symmetric(Pattern& pattern);

// From a profile's lowest point to its highest.
double relief_of(const Profile& profile);

// Shares profiles, drops points that hardly bend a profile, and end facets that hardly leave the ground. Returns whether any changed.
bool simplify_profiles(Pattern& pattern);

}  // namespace burin::refinement
