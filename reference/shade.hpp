// Colour of a facet in one light: glTF's metallic-roughness as the shader of runtime-shaders/gl has it, or any other.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace burin::reference {

struct Paint {
    glm::dvec3 albedo{1.0};  // linear
    double metal = 0.0, rough = 1.0;
    glm::dvec3 glow{0.0};
    double open = 1.0;  // occlusion of the material's own
    double index = 1.5;         // of refraction, of what is no metal
    double transmission = 0.0;  // part of what it neither mirrors nor is metal that goes through
    bool thin = false;          // what goes through keeps its direction

    bool is_glass() const { return transmission > 0.0 && metal < 1.0; }
};

// Radiance towards the eye for light of irradiance pi from one direction, times the cosine: f cos. Directions of the world, unit
// length, away from the surface.
using Brdf = std::function<glm::dvec3(const Paint&, const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye)>;

// Lambert and GGX with Smith's shadowing.
glm::dvec3 metallic_roughness(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye);

// A soft surround, brighter above; `strength` as Light::ambient.
glm::dvec3 soft_surround(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye, double strength);

// Part of unpolarized light that a smooth surface of a dielectric mirrors. `cosine`: of incidence, [0, 1]; `ratio`: index of the side it comes
// from over that of the other. 1 where nothing passes.
double fresnel_reflectance(double cosine, double ratio);

// Light that comes from one direction and goes to the eye: its radiance times `weight` is what it adds. [2008] 7
struct Scattered {
    glm::dvec3 direction;  // towards where it comes from, unit length; on the other side of the facet than the eye: through it
    glm::dvec3 weight{0.0};
    double solid = 0.0;  // steradians that it stands for; 0: a mirror's
};

// Directions for what is not lit directly. `count` for each way in which the surface scatters, but one for a mirror; the same for
// equal seeds. The eye may be below the facet, in glass.
using Scatter = std::function<void(const Paint&, const glm::dvec3& normal, const glm::dvec3& to_eye, int count, std::uint64_t seed, std::vector<Scattered>& out)>;

// Of metallic_roughness: Lambert by the cosine, GGX by the facets of it that the eye sees, with what they mirror more than once (E. Turquin,
// Practical Multiple Scattering Compensation for Microfacet Models, 2019). Glass splits light by Fresnel's formulas and bends it by Snell's law;
// it loses nothing.
void scatter_metallic_roughness(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_eye, int count, std::uint64_t seed,
                                std::vector<Scattered>& out);
// White paper: all that comes goes on, in every direction alike.
void scatter_white(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_eye, int count, std::uint64_t seed, std::vector<Scattered>& out);

// Columns: two directions beside n, and n.
glm::dmat3 frame_about(const glm::dvec3& n);

// Radiance from a direction that gives a matt facet what soft_surround does.
glm::dvec3 soft_radiance(const glm::dvec3& direction, double strength);

}  // namespace burin::reference
