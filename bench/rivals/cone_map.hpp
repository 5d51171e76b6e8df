// Relaxed cones: for every texel the widest upright cone, its apex on the surface, in which no ray from above leaves the solid again
// once it has entered it. A ray may then go to the border of the cone at once: it has passed the surface once at most.
//
// A ray that falls leaves the solid only where the surface falls away from it more steeply than the ray does. So the cone must hold no
// such place: its ratio is the least of distance over height above the apex over them. Along one direction these places' upper
// hull, built from far to near, gives the ratio of every texel in turn, whatever the distance (no search radius, as preprocessing by
// pairs of texels needs).
// Source of the idea: F. Policarpo, M. M. Oliveira, Relaxed Cone Stepping for Relief Mapping, GPU Gems 3, 2007.
#pragma once

#include <cstdint>
#include <vector>

#include "surface_maps.hpp"

namespace burin::rivals {

inline constexpr double kWidestCone = 4.0;  // ratio of metres over the plane to metres of height; what a texel of 255 stands for

struct ConeOptions {
    int directions = 32;         // that rays are looked at from, a multiple of 4
    double steepest = 16.0;      // metres over the plane per metre of fall of the flattest ray that is promised for
};

// One byte per texel of the level: ratio = kWidestCone (byte / 255)^2, never rounded up. Cost: 10 ns per texel, direction and core. Equal
// bytes whatever the number of threads.
std::vector<std::uint8_t> make_relaxed_cones(const SurfaceMaps& maps, const MapLevel& level, const ConeOptions& options = {});

}  // namespace burin::rivals
