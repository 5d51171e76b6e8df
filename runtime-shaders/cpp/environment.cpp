#include "cpp/environment.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace burin {
namespace {

using Level = RadianceLevel;
using glm::vec2;
using glm::vec3;

constexpr float kPi = std::numbers::pi_v<float>;

// Points that fill the unit square evenly: Hammersley's.
vec2 even_point(std::uint32_t i, std::uint32_t count) {
    std::uint32_t bits = i;
    bits = (bits << 16) | (bits >> 16);
    bits = ((bits & 0x00ff00ffu) << 8) | ((bits & 0xff00ff00u) >> 8);
    bits = ((bits & 0x0f0f0f0fu) << 4) | ((bits & 0xf0f0f0f0u) >> 4);
    bits = ((bits & 0x33333333u) << 2) | ((bits & 0xccccccccu) >> 2);
    bits = ((bits & 0x55555555u) << 1) | ((bits & 0xaaaaaaaau) >> 1);
    return {(float(i) + 0.5f) / float(count), (float(bits) + 0.5f) / 4294967296.0f};
}

// Normal of a facet, z along the surface's, distributed as GGX times its cosine.
vec3 facet_normal(vec2 point, float alpha) {
    const float cosine = std::sqrt((1.0f - point.y) / (1.0f + (alpha * alpha - 1.0f) * point.y));
    const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)), turn = 2.0f * kPi * point.x;
    return {sine * std::cos(turn), sine * std::sin(turn), cosine};
}

float ggx(float cosine, float alpha) {
    const float a2 = alpha * alpha, d = cosine * cosine * (a2 - 1.0f) + 1.0f;
    return a2 / (kPi * d * d);
}

// One direction of light that a surface seen from straight above mirrors.
struct LobeSample {
    vec3 light;
    float weight;
    float level;  // of the source, whose texels are as wide as the sample's share of the lobe
};

std::vector<LobeSample> lobe_samples(float roughness, const Level& finest) {
    const float alpha = roughness * roughness;
    const std::uint32_t count = std::uint32_t(64.0f + 448.0f * roughness);
    const float texel_size = 2.0f * kPi * kPi / (float(finest.width) * float(finest.height));
    std::vector<LobeSample> samples;
    for (std::uint32_t i = 0; i < count; ++i) {
        const vec3 half = facet_normal(even_point(i, count), alpha);
        const vec3 light = 2.0f * half.z * half - vec3(0.0f, 0.0f, 1.0f);
        if (light.z <= 0.0f) continue;
        const float density = ggx(half.z, alpha) / 4.0f;  // straight above the view's cosine is the facet's
        const float level = 0.5f * std::log2(1.0f / (float(count) * density * texel_size)) + 1.0f;
        samples.push_back({light, light.z, std::max(level, 0.0f)});
    }
    return samples;
}

Level blur(const std::vector<Level>& chain, const Level& size, float roughness) {
    Level level = RadianceLevel::of(size.width, size.height);
    const std::vector<LobeSample> samples = lobe_samples(roughness, chain[0]);
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x) {
            const vec3 n = level.direction(x, y);
            const vec3 side = glm::normalize(glm::cross(std::abs(n.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0), n)), other = glm::cross(n, side);
            vec3 sum{0.0f};
            float weights = 0.0f;
            for (const LobeSample& s : samples) {
                sum += s.weight * look_up(chain, side * s.light.x + other * s.light.y + n * s.light.z, s.level);
                weights += s.weight;
            }
            level.set(x, y, sum / weights);
        }
    return level;
}

// The nine functions without their factors; z of the usual form is what is here the up axis's neighbour, and no matter.
std::array<double, 9> harmonics(glm::dvec3 d) {
    return {1.0, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3.0 * d.z * d.z - 1.0, d.x * d.z, d.x * d.x - d.y * d.y};
}

// Squares of their factors times what a cosine lobe, over pi, keeps of their order.
constexpr std::array<double, 9> harmonic_weights() {
    constexpr double pi = std::numbers::pi, first = 3.0 / (4.0 * pi) * (2.0 / 3.0), second = 15.0 / (4.0 * pi) * 0.25;
    return {1.0 / (4.0 * pi), first, first, first, second, second, 5.0 / (16.0 * pi) * 0.25, second, 15.0 / (16.0 * pi) * 0.25};
}

std::array<std::array<float, 3>, 9> irradiance_of(const Level& level) {
    std::array<glm::dvec3, 9> sums{};
    double sphere = 0.0;
    for (int y = 0; y < level.height; ++y) {
        const double part = std::sin((y + 0.5) / level.height * std::numbers::pi);
        for (int x = 0; x < level.width; ++x) {
            const auto basis = harmonics(glm::dvec3(level.direction(x, y)));
            for (std::size_t k = 0; k < 9; ++k) sums[k] += glm::dvec3(level.texel(x, y)) * (basis[k] * part);
            sphere += part;
        }
    }
    std::array<std::array<float, 3>, 9> terms{};
    for (std::size_t k = 0; k < 9; ++k)
        for (int c = 0; c < 3; ++c) terms[k][std::size_t(c)] = float(sums[k][c] * harmonic_weights()[k] * 4.0 * std::numbers::pi / sphere);
    return terms;
}

// Mean over the facets that GGX distributes, as seen from a cosine.
vec2 mirrored_part(float cosine, float roughness) {
    constexpr std::uint32_t kSamples = 256;
    const float nv = std::max(cosine, 1e-3f), alpha = std::max(roughness * roughness, 1e-4f), a2 = alpha * alpha;
    const vec3 view(std::sqrt(1.0f - nv * nv), 0.0f, nv);
    vec2 sum{0.0f};
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const vec3 half = facet_normal(even_point(i, kSamples), alpha);
        const float vh = glm::dot(view, half);
        const float nl = 2.0f * vh * half.z - view.z;
        if (nl <= 0.0f || vh <= 0.0f) continue;
        // The height-correlated form that the light of one lamp is shaded with.
        const float lambda_v = std::sqrt(nv * nv * (1.0f - a2) + a2), lambda_l = std::sqrt(nl * nl * (1.0f - a2) + a2);
        const float shown = 2.0f * nl * nv / (nl * lambda_v + nv * lambda_l) * vh / (half.z * nv);
        const float grazing = std::pow(1.0f - vh, 5.0f);
        sum += vec2((1.0f - grazing) * shown, grazing * shown);
    }
    return sum / float(kSamples);
}

ReflectanceTable make_table() {
    ReflectanceTable table;
    constexpr float kLast = float(ReflectanceTable::kSide - 1);
    for (int y = 0; y < ReflectanceTable::kSide; ++y)
        for (int x = 0; x < ReflectanceTable::kSide; ++x) {
            const vec2 part = mirrored_part(float(x) / kLast, float(y) / kLast);
            table.terms.insert(table.terms.end(), {part.x, part.y});
        }
    return table;
}

}  // namespace

PreparedEnvironment prepare_environment(const RadianceMap& map) {
    const int width = radiance_columns(map);
    const std::vector<Level> chain = radiance_levels(map, width);
    PreparedEnvironment environment;
    environment.levels.push_back(chain[0]);
    const int count = int(std::bit_width(unsigned(width))) - 5;  // behind level 0
    for (int k = 1; k <= count; ++k) environment.levels.push_back(blur(chain, chain[std::size_t(k)], float(k) / float(count)));
    environment.irradiance = irradiance_of(chain[std::min<std::size_t>(chain.size() - 1, std::size_t(std::max(count - 3, 0)))]);
    return environment;
}

RadianceMap neutral_environment() {
    RadianceMap map{256, 128, {}};
    Level level = RadianceLevel::of(map.width, map.height);
    const auto lamp = [](vec3 d, vec3 toward, float inner, float outer) {
        const float at = std::clamp((glm::dot(d, glm::normalize(toward)) - outer) / (inner - outer), 0.0f, 1.0f);
        return at * at * (3.0f - 2.0f * at);
    };
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const vec3 d = level.direction(x, y);
            const float rise = std::clamp(0.5f + 2.5f * d.y, 0.0f, 1.0f);
            float value = 0.05f + 0.12f * rise;
            value += 0.5f * lamp(d, {0.0f, 1.0f, 0.0f}, 0.95f, 0.8f);
            value += 0.7f * lamp(d, {-1.0f, 0.45f, 0.5f}, 0.97f, 0.9f) + 0.4f * lamp(d, {1.0f, 0.35f, -0.3f}, 0.97f, 0.9f);
            level.set(x, y, vec3(value));
        }
    map.texels = std::move(level.texels);
    return map;
}

const ReflectanceTable& reflectance_table() {
    static const ReflectanceTable table = make_table();
    return table;
}

}  // namespace burin
