#include "shade.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace burin::reference {
namespace {

// Seen from straight above, of what is no metal.
double straight_reflectance(const Paint& paint) {
    const double part = (paint.index - 1.0) / (paint.index + 1.0);
    return part * part;
}

glm::dvec3 fresnel_of(const Paint& paint, const glm::dvec3& to_light, const glm::dvec3& to_eye) {
    const glm::dvec3 f0 = glm::mix(glm::dvec3(straight_reflectance(paint)), paint.albedo, paint.metal);
    const double grazing = std::pow(1.0 - std::max(glm::dot(to_eye, glm::normalize(to_eye + to_light)), 0.0), 5.0);
    return f0 + (1.0 - f0) * grazing;
}

}  // namespace

glm::dvec3 soft_radiance(const glm::dvec3& direction, double strength) { return glm::dvec3(strength * (0.675 + 0.4875 * direction.y)); }

glm::dvec3 metallic_roughness(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye) {
    const glm::dvec3 halfway = glm::normalize(to_eye + to_light);
    const double nl = std::max(glm::dot(normal, to_light), 0.0), nv = std::max(glm::dot(normal, to_eye), 1e-3);
    const double nh = std::max(glm::dot(normal, halfway), 0.0);
    const double a2 = std::pow(std::max(paint.rough * paint.rough, 2e-3), 2.0);
    const double d = a2 / (std::numbers::pi * std::pow(nh * nh * (a2 - 1.0) + 1.0, 2.0));
    const double visible = 0.5 / (nl * std::sqrt(nv * nv * (1.0 - a2) + a2) + nv * std::sqrt(nl * nl * (1.0 - a2) + a2) + 1e-6);
    const glm::dvec3 fresnel = fresnel_of(paint, to_light, to_eye);
    const glm::dvec3 diffuse = paint.albedo * ((1.0 - paint.metal) * (1.0 - paint.transmission) / std::numbers::pi);
    return (diffuse * (1.0 - fresnel) + fresnel * (d * visible)) * nl;
}

glm::dvec3 soft_surround(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye, double strength) {
    const double sky = 0.5 + 0.5 * normal.y;
    const glm::dvec3 mirrored = fresnel_of(paint, to_light, to_eye) * (1.0 - 0.25 * paint.rough);
    const glm::dvec3 around = glm::mix(paint.albedo * (1.0 - paint.metal), mirrored, 0.1 + 0.9 * paint.metal);
    return around * (strength * paint.open * (0.35 + 0.65 * sky));
}

}  // namespace burin::reference
