#include "cpp/radiance_levels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace burin {
namespace {

using glm::vec3;
using Level = RadianceLevel;

constexpr float kPi = std::numbers::pi_v<float>;

vec3 bilinear(const Level& level, vec3 d) {
    const float x = (0.5f + std::atan2(d.z, d.x) / (2.0f * kPi)) * float(level.width) - 0.5f;
    const float y = std::acos(std::clamp(d.y, -1.0f, 1.0f)) / kPi * float(level.height) - 0.5f;
    const int column = int(std::floor(x)), row = int(std::floor(y));
    const float along = x - float(column), down = y - float(row);
    const int left = (column + level.width) % level.width, right = (column + 1) % level.width;
    const int above = std::max(row, 0), below = std::min(row + 1, level.height - 1);
    const vec3 upper = level.texel(left, above) * (1.0f - along) + level.texel(right, above) * along;
    const vec3 lower = level.texel(left, below) * (1.0f - along) + level.texel(right, below) * along;
    return upper * (1.0f - down) + lower * down;
}

// Another size along one side by a triangle filter, as wide as the coarser of the two; the same size changes nothing.
template <typename Read, typename Write>
void resample_line(int from, int to, bool wraps, Read read, Write write) {
    const double scale = double(from) / to, radius = std::max(scale, 1.0);
    for (int i = 0; i < to; ++i) {
        const double middle = (i + 0.5) * scale - 0.5;
        glm::dvec3 sum{0.0};
        double weights = 0.0;
        for (int k = int(std::ceil(middle - radius)); k <= int(std::floor(middle + radius)); ++k) {
            const double weight = 1.0 - std::abs(k - middle) / radius;
            if (weight <= 0.0) continue;
            sum += weight * glm::dvec3(read(wraps ? ((k % from) + from) % from : std::clamp(k, 0, from - 1)));
            weights += weight;
        }
        write(i, vec3(sum / weights));
    }
}

Level resample(const RadianceMap& map, int width, int height) {
    const Level source{map.width, map.height, map.texels};
    Level wide = RadianceLevel::of(width, map.height), level = RadianceLevel::of(width, height);
    for (int y = 0; y < map.height; ++y)
        resample_line(map.width, width, true, [&](int x) { return source.texel(x, y); }, [&](int x, vec3 v) { wide.set(x, y, v); });
    for (int x = 0; x < width; ++x)
        resample_line(map.height, height, false, [&](int y) { return wide.texel(x, y); }, [&](int y, vec3 v) { level.set(x, y, v); });
    return level;
}

// Means of two by two texels, each as large as the part of the sphere that it covers.
Level halve(const Level& fine) {
    Level coarse = RadianceLevel::of(fine.width / 2, fine.height / 2);
    for (int y = 0; y < coarse.height; ++y) {
        const float upper = std::sin((2.0f * float(y) + 0.5f) / float(fine.height) * kPi), lower = std::sin((2.0f * float(y) + 1.5f) / float(fine.height) * kPi);
        for (int x = 0; x < coarse.width; ++x)
            coarse.set(x, y, (upper * (fine.texel(2 * x, 2 * y) + fine.texel(2 * x + 1, 2 * y)) +
                                     lower * (fine.texel(2 * x, 2 * y + 1) + fine.texel(2 * x + 1, 2 * y + 1))) / (2.0f * (upper + lower)));
    }
    return coarse;
}

}  // namespace

Level Level::of(int width, int height) { return {width, height, std::vector<float>(std::size_t(width) * std::size_t(height) * 3)}; }

vec3 Level::texel(int x, int y) const {
    const std::size_t at = 3 * (std::size_t(y) * std::size_t(width) + std::size_t(x));
    return {texels[at], texels[at + 1], texels[at + 2]};
}

void Level::set(int x, int y, vec3 value) {
    const std::size_t at = 3 * (std::size_t(y) * std::size_t(width) + std::size_t(x));
    for (int c = 0; c < 3; ++c) texels[at + std::size_t(c)] = value[c];
}

vec3 Level::direction(int x, int y) const {
    const float turn = (2.0f * (float(x) + 0.5f) / float(width) - 1.0f) * kPi, fall = (float(y) + 0.5f) / float(height) * kPi;
    return {std::sin(fall) * std::cos(turn), std::cos(fall), std::sin(fall) * std::sin(turn)};
}

int radiance_columns(const RadianceMap& map) { return int(std::clamp(std::bit_ceil(unsigned(map.width)), 32u, unsigned(kMostRadianceColumns))); }

std::vector<Level> radiance_levels(const RadianceMap& map, int columns) {
    std::vector<Level> chain{resample(map, columns, columns / 2)};
    while (chain.back().width > 4) chain.push_back(halve(chain.back()));
    return chain;
}

vec3 look_up(const std::vector<Level>& chain, vec3 d, float level) {
    const float at = std::min(level, float(chain.size() - 1));
    const int lower = int(at);
    const float rest = at - float(lower);
    const vec3 fine = bilinear(chain[std::size_t(lower)], d);
    return rest > 0.0f ? fine * (1.0f - rest) + bilinear(chain[std::size_t(lower + 1)], d) * rest : fine;
}

}  // namespace burin
