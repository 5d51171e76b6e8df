// Light from all around, as beams see it that leave the grooves. [2008] 7
//
//     Environment --[EnvironmentLight]--> radiance by direction
//
// The picture itself, not what gl/environment.glsl makes of it for a whole lobe: here each direction is followed by a beam of its own. A
// direction that stands for many sees their mean, so that few of them show no noise that many would not.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include <cpp/radiance_levels.hpp>
#include <gl/render.hpp>

namespace burin::reference {

// Never changes once made; safe to ask from several threads.
class EnvironmentLight {
  public:
    // Cost: linear in the picture's texels.
    explicit EnvironmentLight(const Environment& environment);

    // From where the direction points; `solid`: steradians around it that it stands for, 0: none but itself.
    glm::dvec3 radiance(const glm::dvec3& direction, double solid) const;

  private:
    std::vector<RadianceLevel> levels_;
    double cosine_, sine_, strength_;
};

}  // namespace burin::reference
