// Directions in which surfaces scatter light.
#include "shade.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <cpp/environment.hpp>

#include "spread.hpp"

namespace burin::reference {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMirror = 0.02;  // of alpha: what is smoother mirrors

void scatter_matt(const glm::dvec3& normal, const glm::dvec3& weight, int count, std::uint64_t seed, std::vector<Scattered>& out) {
    const Spread spread(seed);
    const glm::dmat3 frame = frame_about(normal);
    for (int i = 0; i < count; ++i) {
        const double r = std::sqrt(spread.x(i)), a = 2.0 * kPi * spread.y(i), cosine = std::sqrt(std::max(1e-12, 1.0 - r * r));
        out.push_back({frame * glm::dvec3(r * std::cos(a), r * std::sin(a), cosine), weight / double(count), kPi / (count * std::max(cosine, 0.05))});
    }
}

// Normal of a facet of GGX, z along the surface's, as often as the eye sees it (E. Heitz, Sampling the GGX Distribution of Visible Normals, 2018).
glm::dvec3 visible_normal(const glm::dvec3& eye, double alpha, double x, double y) {
    const glm::dvec3 v = glm::normalize(glm::dvec3(alpha * eye.x, alpha * eye.y, eye.z));
    const double flat = v.x * v.x + v.y * v.y;
    const glm::dvec3 u = flat > 0.0 ? glm::dvec3(-v.y, v.x, 0.0) / std::sqrt(flat) : glm::dvec3(1, 0, 0), w = glm::cross(v, u);
    const double r = std::sqrt(x), turn = 2.0 * kPi * y, s = 0.5 * (1.0 + v.z);
    const double p = r * std::cos(turn), q = (1.0 - s) * std::sqrt(std::max(0.0, 1.0 - p * p)) + s * r * std::sin(turn);
    const glm::dvec3 n = u * p + w * q + v * std::sqrt(std::max(0.0, 1.0 - p * p - q * q));
    return glm::normalize(glm::dvec3(alpha * n.x, alpha * n.y, std::max(1e-6, n.z)));
}

double smith_root(double cosine, double a2) { return std::sqrt(cosine * cosine * (1.0 - a2) + a2); }

// Of even light, what the surface mirrors once: as a part of f0, and besides.
glm::dvec2 mirrored_once(double cosine, double rough) {
    constexpr int kLast = ReflectanceTable::kSide - 1;
    const auto& terms = reflectance_table().terms;
    const double x = std::clamp(cosine, 0.0, 1.0) * kLast, y = std::clamp(rough, 0.0, 1.0) * kLast;
    const int i = std::min(int(x), kLast - 1), j = std::min(int(y), kLast - 1);
    const auto at = [&](int column, int row) {
        const std::size_t k = 2 * (std::size_t(row) * std::size_t(kLast + 1) + std::size_t(column));
        return glm::dvec2(terms[k], terms[k + 1]);
    };
    return glm::mix(glm::mix(at(i, j), at(i + 1, j), x - i), glm::mix(at(i, j + 1), at(i + 1, j + 1), x - i), y - j);
}

// What a surface does to what comes to the eye, which is on the side of `normal`.
struct Look {
    const Paint& paint;
    glm::dvec3 normal, to_eye;
    bool within = false;  // the eye is in the body
    int count = 1;
    std::uint64_t seed = 0;

    double ratio() const { return within && !paint.thin ? paint.index : 1.0 / paint.index; }
    glm::dvec3 straight() const {
        const double part = (paint.index - 1.0) / (paint.index + 1.0);
        return glm::mix(glm::dvec3(part * part), paint.albedo, paint.metal);
    }
    double cosine() const { return std::max(glm::dot(normal, to_eye), 1e-3); }
    // The part of even light: once, and what facets mirror again.
    glm::dvec3 mirrored() const {
        if (paint.is_glass()) return fresnel(cosine());
        const glm::dvec2 once = mirrored_once(cosine(), paint.rough);
        const glm::dvec3 again = straight() * (1.0 / std::max(once.x + once.y, 1e-3) - 1.0);
        return glm::min((straight() * once.x + once.y) * (1.0 + again), 1.0);
    }
    // At facets that the eye sees under this cosine.
    glm::dvec3 fresnel(double cosine) const {
        const glm::dvec3 f0 = straight(), schlick = f0 + (1.0 - f0) * std::pow(1.0 - std::clamp(cosine, 0.0, 1.0), 5.0);
        if (!paint.is_glass()) return schlick;
        return glm::mix(glm::dvec3(fresnel_reflectance(std::clamp(cosine, 0.0, 1.0), ratio())), schlick, paint.metal);
    }
};

// By one facet: mirrored and, of glass, bent. `kept`: part of what is mirrored that leaves; `solid` of what is mirrored.
void scatter_at(const Look& look, const glm::dvec3& half, double part, double kept, double solid, std::vector<Scattered>& out) {
    const double cosine = glm::dot(look.to_eye, half);
    const glm::dvec3 f = look.fresnel(cosine), mirrored = half * (2.0 * cosine) - look.to_eye;
    if (glm::dot(mirrored, look.normal) > 0.0 && f != glm::dvec3(0.0)) out.push_back({mirrored, f * (kept * part), solid});
    if (!look.paint.is_glass()) return;
    const double ratio = look.paint.thin ? 1.0 : look.ratio();
    const glm::dvec3 through = glm::refract(-look.to_eye, half, ratio), weight = (1.0 - f) * look.paint.albedo * (part * (1.0 - look.paint.metal) * look.paint.transmission);
    // A facet that turns by some angle turns what it bends by so much of what it turns the mirrored.
    const double turn = 0.5 * (1.0 - ratio);
    if (through != glm::dvec3(0.0) && weight != glm::dvec3(0.0)) out.push_back({glm::normalize(through), weight, solid * turn * turn});
}

// Makes those from `first` on bring together what is known of all of them, so that a few never bring more.
void scale_to(const glm::dvec3& whole, std::size_t first, std::vector<Scattered>& out) {
    glm::dvec3 sum(0.0);
    for (std::size_t k = first; k < out.size(); ++k) sum += out[k].weight;
    for (std::size_t k = first; k < out.size(); ++k)
        for (int c = 0; c < 3; ++c) out[k].weight[c] *= whole[c] / std::max(sum[c], 1e-12);
}

void scatter_rough(const Look& look, double alpha, std::vector<Scattered>& out) {
    const Spread spread(look.seed + 1);
    const glm::dmat3 frame = frame_about(look.normal);
    const glm::dvec3 eye = look.to_eye * frame;
    const double a2 = alpha * alpha, nv = look.cosine();
    const std::size_t before = out.size();
    for (int i = 0; i < look.count; ++i) {
        glm::dvec3 half = visible_normal({eye.x, eye.y, nv}, alpha, spread.x(i), spread.y(i));
        const double vh = std::max(glm::dot(glm::dvec3(eye.x, eye.y, nv), half), 0.0), nl = 2.0 * vh * half.z - nv;
        if (look.paint.is_glass()) {
            // What leaves under the surface, or comes to it again, is taken to go the way of the whole: nothing is lost.
            if (nl <= 1e-4) half = {0, 0, 1};
            scatter_at(look, frame * half, 1.0 / look.count, 1.0, 4.0 * kPi * a2 / look.count, out);
            continue;
        }
        if (nl <= 1e-4) continue;
        const double eye_root = smith_root(nv, a2), light_root = smith_root(nl, a2);
        // Smith's shadowing of both over that of the eye, which the choice of facets has.
        const double shown = nl * (nv + eye_root) / (nl * eye_root + nv * light_root);
        const double around = half.z * half.z * (a2 - 1.0) + 1.0, density = a2 / (kPi * around * around) / (2.0 * (nv + eye_root));
        scatter_at(look, frame * half, 1.0 / look.count, shown, 1.0 / (look.count * density), out);
    }
    if (!look.paint.is_glass()) scale_to(look.mirrored(), before, out);
}

}  // namespace

glm::dmat3 frame_about(const glm::dvec3& n) {
    const glm::dvec3 other = std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(other, n));
    return glm::dmat3(u, glm::cross(n, u), n);
}

double fresnel_reflectance(double cosine, double ratio) {
    const double sine2 = ratio * ratio * (1.0 - cosine * cosine);
    if (sine2 >= 1.0) return 1.0;
    const double other = std::sqrt(1.0 - sine2);
    const double across = (ratio * cosine - other) / (ratio * cosine + other), along = (cosine - ratio * other) / (cosine + ratio * other);
    return 0.5 * (across * across + along * along);
}

void scatter_white(const Paint&, const glm::dvec3& normal, const glm::dvec3& to_eye, int count, std::uint64_t seed, std::vector<Scattered>& out) {
    scatter_matt(glm::dot(normal, to_eye) < 0.0 ? -normal : normal, glm::dvec3(1.0), count, seed, out);
}

void scatter_metallic_roughness(const Paint& paint, const glm::dvec3& normal, const glm::dvec3& to_eye, int count, std::uint64_t seed,
                                std::vector<Scattered>& out) {
    const bool within = glm::dot(normal, to_eye) < 0.0;
    const Look look{paint, within ? -normal : normal, to_eye, within, count, seed};
    const double matt = (1.0 - paint.metal) * (1.0 - (paint.is_glass() ? paint.transmission : 0.0));
    if (matt > 0.0) scatter_matt(look.normal, paint.albedo * matt * (1.0 - look.mirrored()), count, seed, out);
    const double alpha = paint.rough * paint.rough;
    if (alpha > kMirror) return scatter_rough(look, alpha, out);
    scatter_at(look, look.normal, 1.0, 1.0, 0.0, out);
}

}  // namespace burin::reference
