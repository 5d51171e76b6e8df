// Where meshes end in a picture, or have an edge: what areas know nothing about.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace burin::gl {

// Whether three depths in a row do not lie on one line, as those of a flat mesh do.
inline bool is_kinked(float a, float b, float c) {
    constexpr float kRounding = 1.0e-6f;
    const float before = b - a, after = c - b;
    return std::abs(after - before) > 0.5f * std::min(std::abs(before), std::abs(after)) + kRounding;
}

// Sets the fourth channel to 1, where it is 0, of the pixels whose depth, [0, 1], does not go on as on both sides, or above and below.
inline void mark_outlines(const std::vector<float>& depths, int width, int height, std::vector<float>& pixels) {
    const auto at = [&](int x, int y) { return std::size_t(y) * std::size_t(width) + std::size_t(x); };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const bool across = x > 0 && x + 1 < width && is_kinked(depths[at(x - 1, y)], depths[at(x, y)], depths[at(x + 1, y)]);
            const bool along = y > 0 && y + 1 < height && is_kinked(depths[at(x, y - 1)], depths[at(x, y)], depths[at(x, y + 1)]);
            float& mark = pixels[4 * at(x, y) + 3];
            if (across || along) mark = std::max(mark, 1.0f);
        }
}

}  // namespace burin::gl
