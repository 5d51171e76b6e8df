// Rays of the pixels that areas do not suffice for: their sums, and which pixels want more than the first four.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gl/accumulator.hpp"
#include "gl/pixel_window.hpp"

namespace burin::gl {

class MarkedRays {
  public:
    // `pixels`: four floats each, the fourth 1 where rays are wanted, 2 where all of them are, and 0 elsewhere.
    MarkedRays(int width, int height, const std::vector<float>& pixels)
        : width_(width), height_(height), sum_(count() * 3, 0.0f), rays_(count(), 0.0f), wanted_(count()), thin_(count()), seen_(count()) {
        for (std::size_t i = 0; i < count(); ++i) {
            wanted_[i] = pixels[4 * i + 3] > 0.0f ? 255 : 0;
            thin_[i] = pixels[4 * i + 3] > 1.0f;
            seen_[i].fill(brightness_of(&pixels[4 * i]));
        }
    }

    const std::vector<std::uint8_t>& wanted() const { return wanted_; }
    bool any_wanted() const { return any_wanted({0, 0, width_, height_}); }

    // What ray `k` of each pixel met; the first four lie in the quarters, row by row.
    void add(const std::vector<float>& pixels, std::size_t k) {
        for (std::size_t i = 0; i < count(); ++i) {
            if (wanted_[i] != 0) add_ray(i, k, &pixels[4 * i]);
        }
    }

    bool any_wanted(const PixelWindow& window) const {
        for (int y = window.low; y < window.low + window.height; ++y) {
            const auto row = wanted_.begin() + std::ptrdiff_t(at(window.left, y));
            if (std::any_of(row, row + window.width, [](std::uint8_t one) { return one != 0; })) return true;
        }
        return false;
    }

    // What the rays of each pixel of `window` met, as the target has them, from a pixel on: those before were added before.
    void add(const std::vector<float>& texels, const PixelWindow& window, int left, int low) {
        const int across = window.across;
        for (int y = low; y < window.low + window.height; ++y)
            for (int x = left; x < window.left + window.width; ++x) {
                const std::size_t i = at(x, y);
                if (wanted_[i] == 0) continue;
                for (int k = 0; k < across * across; ++k) {
                    const int u = (x - window.left) * across + k % across, v = (y - window.low) * across + k / across;
                    const std::size_t texel = std::size_t(v) * std::size_t(window.width * across) + std::size_t(u);
                    // Of more than 2 x 2 none stands for a quarter.
                    add_ray(i, across == 2 ? std::size_t(k) : kNoQuarter, &texels[4 * texel]);
                }
            }
    }

    // Keeps the pixels that want all, and those whose four rays, or the rays next to these in the pixels around, differ by more than kStep.
    void keep_uneven() {
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x)
                if (wanted_[at(x, y)] != 0 && !thin_[at(x, y)] && range_around(x, y) <= kStep) wanted_[at(x, y)] = 0;
    }

    void put_means(std::vector<float>& pixels) const {
        for (std::size_t i = 0; i < count(); ++i)
            if (rays_[i] > 0.0f)
                for (std::size_t c = 0; c < 3; ++c) pixels[4 * i + c] = sum_[3 * i + c] / rays_[i];
    }

  private:
    static constexpr float kStep = 4.0f / 255.0f;
    static constexpr std::size_t kNoQuarter = 4;

    // `quarter`: that it stands for; kNoQuarter or more: none.
    void add_ray(std::size_t i, std::size_t quarter, const float* met) {
        for (std::size_t c = 0; c < 3; ++c) sum_[3 * i + c] += met[c];
        rays_[i] += 1.0f;
        if (quarter < kNoQuarter) seen_[i][quarter] = brightness_of(met);
    }

    // Of 4 x 4 quarters: the pixel's own and those around them.
    float range_around(int x, int y) const {
        float low = 1e9f, high = -1e9f;
        for (int v = std::max(2 * y - 1, 0); v <= std::min(2 * y + 2, 2 * height_ - 1); ++v)
            for (int u = std::max(2 * x - 1, 0); u <= std::min(2 * x + 2, 2 * width_ - 1); ++u) {
                const float seen = seen_[at(u / 2, v / 2)][std::size_t(u % 2 + 2 * (v % 2))];
                low = std::min(low, seen);
                high = std::max(high, seen);
            }
        return high - low;
    }
    std::size_t count() const { return std::size_t(width_) * std::size_t(height_); }
    std::size_t at(int x, int y) const { return std::size_t(y) * std::size_t(width_) + std::size_t(x); }

    int width_, height_;
    std::vector<float> sum_, rays_;
    std::vector<std::uint8_t> wanted_;         // 255 or 0 per pixel, lower row first
    std::vector<bool> thin_;                   // shows what a few rays may miss
    std::vector<std::array<float, 4>> seen_;   // brightness of each quarter
};

}  // namespace burin::gl
