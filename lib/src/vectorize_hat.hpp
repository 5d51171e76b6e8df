// What a closing fills and an opening takes away. Part of stage vectorize.
#pragma once

#include "vectorize_internal.hpp"

namespace burin::vectorizing {

double least_response(double noise);  // of a hat: what the grain does not show
int square_radius(double radius);     // texels to each side of a square

// Depth of each texel below the closing of the map with a square of 2 radius + 1 texels (grooves), or height above its
// opening (ridges). Where the map is flat within `least` all around, it is 0.
Image hat_response(const Image& map, const Lattice& lattice, ChainKind kind, int radius, double least);

// The same, at some texels: hat_at(map, ..., texels)[k] belongs to texels[k].
std::vector<float> hat_at(const Image& map, const Lattice& lattice, ChainKind kind, int radius, double least,
                          const std::vector<int>& texels);

// Texels above a good part of the strongest response around them, and above the grain. Where two lines cross, the map is
// often twice as deep: with a half instead of 0.4 the lines would lose touch with their crossing.
std::vector<std::uint8_t> strong_mask(const Image& response, const Lattice& lattice, int radius, double least);

}  // namespace burin::vectorizing
