// Sums of a picture's samples, and what their spread says about where more are needed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <burin/image_io.hpp>

namespace burin::gl {

inline std::uint8_t to_srgb(float linear) {
    const float c = std::clamp(linear, 0.0f, 1.0f);
    const float s = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
    return std::uint8_t(s * 255.0f + 0.5f);
}

// How bright the eye sees a linear colour; a gamma of 2 stands in for it.
inline float brightness_of(const float* linear) { return std::sqrt(linear[0] + 2.0f * linear[1] + linear[2]) * 0.5f; }

class Accumulator {
  public:
    Accumulator(int width, int height)
        : width_(width),
          height_(height),
          sum_(count() * 4, 0.0f),
          low_(count(), 1e9f),
          high_(count(), -1e9f),
          samples_(count(), 0.0f),
          wanted_(count(), 255) {}

    // Pixels with wanted() == 0 are left alone.
    void add(const std::vector<float>& pixels) {
        for (std::size_t i = 0; i < count(); ++i) {
            if (wanted_[i] == 0) continue;
            for (std::size_t k = 0; k < 4; ++k) sum_[4 * i + k] += pixels[4 * i + k];
            samples_[i] += 1.0f;
            const float seen = brightness_of(&pixels[4 * i]);
            low_[i] = std::min(low_[i], seen);
            high_[i] = std::max(high_[i], seen);
        }
    }

    // Keeps the pixels whose samples, or whose neighbours' samples, differ by more than half a step of the
    // picture's 8 bits: an edge that no sample of a pixel caught shows in the one beside it.
    void keep_uneven() {
        constexpr float kStep = 1.0f / 255.0f;
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                float low = 1e9f, high = -1e9f;
                for (int dy = std::max(y - 1, 0); dy <= std::min(y + 1, height_ - 1); ++dy)
                    for (int dx = std::max(x - 1, 0); dx <= std::min(x + 1, width_ - 1); ++dx) {
                        low = std::min(low, low_[at(dx, dy)]);
                        high = std::max(high, high_[at(dx, dy)]);
                    }
                wanted_[at(x, y)] = high - low > kStep ? 255 : 0;
            }
    }
    const std::vector<std::uint8_t>& wanted() const { return wanted_; }

    RgbaImage image() const {
        RgbaImage image{width_, height_, std::vector<std::uint8_t>(count() * 4, 255)};
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x) {
                // The target's first row is the lowest one.
                const std::size_t from = at(x, height_ - 1 - y);
                for (std::size_t k = 0; k < 3; ++k)
                    image.texels[4 * at(x, y) + k] = to_srgb(sum_[4 * from + k] / samples_[from]);
            }
        return image;
    }

  private:
    std::size_t count() const { return std::size_t(width_) * std::size_t(height_); }
    std::size_t at(int x, int y) const { return std::size_t(y) * std::size_t(width_) + std::size_t(x); }

    int width_, height_;
    std::vector<float> sum_, low_, high_, samples_;
    std::vector<std::uint8_t> wanted_;  // 255 or 0 per pixel, lower row first
};

}  // namespace burin::gl
