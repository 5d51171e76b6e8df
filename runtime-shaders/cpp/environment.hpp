// Light from all around, prepared for a shader that looks it up once per facet.
//
//     RadianceMap --[prepare_environment]--> PreparedEnvironment --> a texture with levels, nine vectors
//     [reflectance_table] --> what part of even light a microfacet surface mirrors
//
// The split sum (B. Karis, Real Shading in Unreal Engine 4, 2013): radiance blurred as a surface of some roughness blurs it,
// looked up in the mirrored direction, times the part that such a surface mirrors of even light. What falls on a matt surface comes from
// spherical harmonics up to the second order (R. Ramamoorthi, P. Hanrahan, An Efficient Representation for Irradiance
// Environment Maps, 2001): within 1 % in the mean of natural skies, up to a tenth under a single small lamp, which the
// directional light is for.
#pragma once

#include <array>
#include <vector>

#include "cpp/radiance_levels.hpp"

namespace burin {

struct PreparedEnvironment {
    // Level 0 is the picture, its sides powers of two; each further level has half the sides. Level k is blurred as by
    // roughness k / (levels - 1); the last is 16 x 8.
    std::vector<RadianceLevel> levels;
    // Irradiance over pi, as terms of 1, y, z, x, x y, y z, 3 z z - 1, x z, x x - y y of the normal; never asked below 0.
    std::array<std::array<float, 3>, 9> irradiance{};
};

// Requires: a map as read_radiance gives it. Cost: about a second for 2048 x 1024, linear in the texels.
PreparedEnvironment prepare_environment(const RadianceMap& map);

// A grey room without a file: bright above, darker below, a broad lamp overhead and one at each side. A white matt surface that
// faces up gathers about 0.22.
RadianceMap neutral_environment();

// For cosine of view i / (kSide - 1) along x and roughness j / (kSide - 1) along y: (a, b) such that f0 a + b of even light is mirrored
// once by a surface of GGX facets with Smith's shadowing; f0 its reflectance seen from straight above.
struct ReflectanceTable {
    static constexpr int kSide = 64;
    std::vector<float> terms;  // 2 * kSide * kSide
};
const ReflectanceTable& reflectance_table();

}  // namespace burin
