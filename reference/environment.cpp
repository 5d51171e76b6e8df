#include "environment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/trigonometric.hpp>

#include <cpp/environment.hpp>

namespace burin::reference {
namespace {

std::vector<RadianceLevel> levels_of(const RadianceMap& map) { return radiance_levels(map, radiance_columns(map)); }

}  // namespace

EnvironmentLight::EnvironmentLight(const Environment& environment)
    : levels_(levels_of(environment.map ? *environment.map : neutral_environment())), cosine_(std::cos(glm::radians(environment.rotation))),
      sine_(std::sin(glm::radians(environment.rotation))), strength_(environment.strength) {}

glm::dvec3 EnvironmentLight::radiance(const glm::dvec3& d, double solid) const {
    const glm::vec3 turned(cosine_ * d.x - sine_ * d.z, d.y, sine_ * d.x + cosine_ * d.z);
    const double texel = 2.0 * std::numbers::pi * std::numbers::pi / (double(levels_[0].width) * levels_[0].height);
    const double level = solid > 0.0 ? std::max(0.0, 0.5 * std::log2(solid / texel)) : 0.0;
    return glm::dvec3(look_up(levels_, turned, float(level))) * strength_;
}

}  // namespace burin::reference
