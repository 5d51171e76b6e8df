#include "shade.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

namespace burin::reference {
namespace {

glm::dvec3 fresnel_of(const Paint& paint, const glm::dvec3& to_light, const glm::dvec3& to_eye) {
    const glm::dvec3 f0 = glm::mix(glm::dvec3(0.04), paint.albedo, paint.metal);
    const double grazing = std::pow(1.0 - std::max(glm::dot(to_eye, glm::normalize(to_eye + to_light)), 0.0), 5.0);
    return f0 + (1.0 - f0) * grazing;
}

// Numbers in [0, 1): a place of the plane's unit square for each of `count`, well spread, turned by the seed.
struct Spread {
    double turn_x, turn_y;
    explicit Spread(std::uint64_t seed) {
        std::uint64_t z = seed * 0x9e3779b97f4a7c15ull + 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        z ^= z >> 31;
        turn_x = double(z >> 32) * 0x1p-32;
        turn_y = double(z & 0xffffffffu) * 0x1p-32;
    }
    // Of two: the plastic number's rank-one lattice.
    double x(int i) const { return fraction(turn_x + 0.7548776662466927 * i); }
    double y(int i) const { return fraction(turn_y + 0.5698402909980532 * i); }
    static double fraction(double v) { return v - std::floor(v); }
};

glm::dmat3 frame_about(const glm::dvec3& n) {
    const glm::dvec3 other = std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(other, n));
    return glm::dmat3(u, glm::cross(n, u), n);
}

void scatter_matt(const glm::dvec3& normal, const glm::dvec3& weight, int count, std::uint64_t seed, std::vector<Scattered>& out) {
    const Spread spread(seed);
    const glm::dmat3 frame = frame_about(normal);
    for (int i = 0; i < count; ++i) {
        const double r = std::sqrt(spread.x(i)), a = 2.0 * std::numbers::pi * spread.y(i);
        out.push_back({frame * glm::dvec3(r * std::cos(a), r * std::sin(a), std::sqrt(std::max(1e-12, 1.0 - r * r))), weight / double(count)});
    }
}

constexpr double kMirror = 0.02;  // of alpha: what is smoother mirrors

}  // namespace

void scatter_white(const Paint&, const glm::dvec3& normal, const glm::dvec3&, int count, std::uint64_t seed, std::vector<Scattered>& out) {
    scatter_matt(normal, glm::dvec3(1.0), count, seed, out);
}

void scatter_metallic_roughness(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_eye, int count, std::uint64_t seed,
                                std::vector<Scattered>& out) {
    const glm::dvec3 f0 = glm::mix(glm::dvec3(0.04), paint.albedo, paint.metal);
    const double nv = std::max(glm::dot(normal, to_eye), 1e-3);
    const glm::dvec3 fresnel = f0 + (1.0 - f0) * std::pow(1.0 - nv, 5.0);
    if (paint.metal < 1.0) scatter_matt(normal, paint.albedo * (1.0 - paint.metal) * (1.0 - fresnel), count, seed, out);
    const double alpha = paint.rough * paint.rough;
    if (alpha <= kMirror) {
        const glm::dvec3 direction = glm::reflect(-to_eye, normal);
        if (glm::dot(direction, normal) > 0.0) out.push_back({direction, fresnel});
        return;
    }
    const Spread spread(seed + 1);
    const glm::dmat3 frame = frame_about(normal);
    for (int i = 0; i < count; ++i) {
        const double u = spread.x(i), a = 2.0 * std::numbers::pi * spread.y(i), a2 = alpha * alpha;
        const double cosine = std::sqrt((1.0 - u) / (1.0 + (a2 - 1.0) * u)), sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
        const glm::dvec3 half = frame * glm::dvec3(sine * std::cos(a), sine * std::sin(a), cosine);
        const double vh = glm::dot(to_eye, half);
        const glm::dvec3 direction = half * (2.0 * vh) - to_eye;
        const double nl = glm::dot(normal, direction);
        if (vh <= 0.0 || nl <= 1e-4) continue;
        // Smith's shadowing of both, over the density of half vectors.
        const double shadow = 2.0 * nl / (nl * std::sqrt(nv * nv * (1.0 - a2) + a2) + nv * std::sqrt(nl * nl * (1.0 - a2) + a2));
        const glm::dvec3 f = f0 + (1.0 - f0) * std::pow(1.0 - vh, 5.0);
        out.push_back({direction, f * std::min(1.0, shadow * vh / cosine) / double(count)});
    }
}

glm::dvec3 soft_radiance(const glm::dvec3& direction, double strength) { return glm::dvec3(strength * (0.675 + 0.4875 * direction.y)); }

glm::dvec3 metallic_roughness(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye) {
    const glm::dvec3 halfway = glm::normalize(to_eye + to_light);
    const double nl = std::max(glm::dot(normal, to_light), 0.0), nv = std::max(glm::dot(normal, to_eye), 1e-3);
    const double nh = std::max(glm::dot(normal, halfway), 0.0);
    const double a2 = std::pow(std::max(paint.rough * paint.rough, 2e-3), 2.0);
    const double d = a2 / (std::numbers::pi * std::pow(nh * nh * (a2 - 1.0) + 1.0, 2.0));
    const double visible = 0.5 / (nl * std::sqrt(nv * nv * (1.0 - a2) + a2) + nv * std::sqrt(nl * nl * (1.0 - a2) + a2) + 1e-6);
    const glm::dvec3 fresnel = fresnel_of(paint, to_light, to_eye);
    const glm::dvec3 diffuse = paint.albedo * ((1.0 - paint.metal) / std::numbers::pi);
    return (diffuse * (1.0 - fresnel) + fresnel * (d * visible)) * nl;
}

glm::dvec3 soft_surround(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye, double strength) {
    const double sky = 0.5 + 0.5 * normal.y;
    const glm::dvec3 mirrored = fresnel_of(paint, to_light, to_eye) * (1.0 - 0.25 * paint.rough);
    const glm::dvec3 around = glm::mix(paint.albedo * (1.0 - paint.metal), mirrored, 0.1 + 0.9 * paint.metal);
    return around * (strength * paint.open * (0.35 + 0.65 * sky));
}

}  // namespace burin::reference
