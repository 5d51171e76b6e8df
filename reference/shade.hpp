// Colour of a facet in one light: glTF's metallic-roughness as the shader of runtime-shaders/gl has it, or any other.
#pragma once

#include <functional>

#include <glm/vec3.hpp>

namespace burin::reference {

struct Paint {
    glm::dvec3 albedo{1.0};  // linear
    double metal = 0.0, rough = 1.0;
    glm::dvec3 glow{0.0};
    double open = 1.0;  // occlusion of the material's own
};

// Radiance towards the eye for light of irradiance pi from one direction, times the cosine: f cos. Directions of the world, unit
// length, away from the surface.
using Brdf = std::function<glm::dvec3(const Paint&, const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye)>;

// Lambert and GGX with Smith's shadowing.
glm::dvec3 metallic_roughness(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye);

// A soft surround, brighter above; `strength` as Light::ambient.
glm::dvec3 soft_surround(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye, double strength);

}  // namespace burin::reference
