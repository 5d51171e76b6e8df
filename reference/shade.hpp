// Colour of a facet in one light: glTF's metallic-roughness as the shader of runtime-shaders/gl has it, or any other.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

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

// Light that comes from one direction and goes to the eye: its radiance times `weight` is what it adds. [2008] 7
struct Scattered {
    glm::dvec3 direction;  // towards where it comes from, unit length, above the facet
    glm::dvec3 weight{0.0};
};

// Directions for what is not lit directly. `count` for each way in which the surface scatters, but one for a mirror; the same for
// equal seeds.
using Scatter = std::function<void(const Paint&, const glm::dvec3& normal, const glm::dvec3& to_eye, int count, std::uint64_t seed, std::vector<Scattered>& out)>;

// Of metallic_roughness: Lambert by the cosine, GGX by its half vectors.
void scatter_metallic_roughness(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_eye, int count, std::uint64_t seed,
                                std::vector<Scattered>& out);
// White paper: all that comes goes on, in every direction alike.
void scatter_white(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_eye, int count, std::uint64_t seed, std::vector<Scattered>& out);

// Radiance from a direction that gives a matt facet what soft_surround does.
glm::dvec3 soft_radiance(const glm::dvec3& direction, double strength);

}  // namespace burin::reference
