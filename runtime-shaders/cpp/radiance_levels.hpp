// A picture of light all around, and the same ever coarser: what is looked up for a cone of directions.
//
//     RadianceMap --[radiance_levels]--> levels --[look_up]--> radiance
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include <burin/radiance.hpp>

namespace burin {

// Equirectangular, laid out as a RadianceMap.
struct RadianceLevel {
    int width = 0, height = 0;
    std::vector<float> texels;  // red, green and blue, rows from straight up

    static RadianceLevel of(int width, int height);
    glm::vec3 texel(int x, int y) const;
    void set(int x, int y, glm::vec3 value);
    glm::vec3 direction(int x, int y) const;  // what a texel's middle looks at
};

inline constexpr int kMostRadianceColumns = 2048;
// Of level 0 for a map: the power of two that is not less, from 32 on.
int radiance_columns(const RadianceMap& map);

// Level 0 is the map with sides that are powers of two, `columns` and half of it; each further one has half the sides, down to 4 x 2, and texels that are
// means by the part of the sphere that each covers. Cost: linear in the texels.
std::vector<RadianceLevel> radiance_levels(const RadianceMap& map, int columns);

// Between texels and levels; from 0 to the last, which stands for all beyond. `d`: unit length.
glm::vec3 look_up(const std::vector<RadianceLevel>& levels, glm::vec3 d, float level);

}  // namespace burin
