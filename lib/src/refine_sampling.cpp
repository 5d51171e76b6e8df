#include "refine_sampling.hpp"

#include <algorithm>
#include <cmath>

namespace burin::refinement {
namespace {

constexpr float kLeastBend = 0.006f;      // map scale: more than the steps of an 8-bit map make
constexpr float kMostBend = 0.03f;        // what bends more is never taken for grain
constexpr float kBendInDeviations = 5.0f;
constexpr int kBlock = 4;

// The second difference of three samples.
float bend_of(float a, float b, float c) { return std::abs(a - 2.0f * b + c); }

// Along rows and columns, whichever is more; 0 beyond the border.
std::vector<float> bends_of(const Image& map) {
    std::vector<float> bends(map.texels.size(), 0.0f);
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            float bend = 0.0f;
            const float here = map.at(x, y);
            if (x > 0 && x + 1 < map.width) bend = bend_of(map.at(x - 1, y), here, map.at(x + 1, y));
            if (y > 0 && y + 1 < map.height) bend = std::max(bend, bend_of(map.at(x, y - 1), here, map.at(x, y + 1)));
            bends[static_cast<std::size_t>(y) * map.width + x] = bend;
        }
    }
    return bends;
}

// What grain alone does not bend by.
float threshold_of(std::vector<float> bends) {
    const auto middle = bends.begin() + static_cast<std::ptrdiff_t>(bends.size() / 2);
    std::nth_element(bends.begin(), middle, bends.end());
    return std::clamp(kBendInDeviations * *middle, kLeastBend, kMostBend);
}

// Gives the texels of one block to those that speak for them.
class BlockSampler {
  public:
    BlockSampler(Sampling& out, const std::vector<float>& bends, float threshold, bool sparse)
        : out_(out), bends_(bends), threshold_(threshold), sparse_(sparse) {}

    void sample(int x, int y, int side) {
        const int right = std::min(x + side, out_.width), below = std::min(y + side, out_.height);
        if (x >= right || y >= below) return;
        if (!bends_near(x, y, right, below)) return choose(x, y, right, below);
        if (side == 2) return sparse_ ? every_second(x, y, right, below) : every_one(x, y, right, below);
        for (int quarter = 0; quarter < 4; ++quarter)
            sample(x + (quarter & 1) * side / 2, y + (quarter >> 1) * side / 2, side / 2);
    }

  private:
    // In the block or beside it.
    bool bends_near(int left, int top, int right, int below) const {
        for (int y = std::max(0, top - 1); y < std::min(below + 1, out_.height); ++y)
            for (int x = std::max(0, left - 1); x < std::min(right + 1, out_.width); ++x)
                if (bends_[static_cast<std::size_t>(y) * out_.width + x] > threshold_) return true;
        return false;
    }

    std::uint8_t& weight(int x, int y) { return out_.weights[static_cast<std::size_t>(y) * out_.width + x]; }

    // Another texel from block to block, without a rhythm: a row of them would meet a path that runs along it always or
    // never.
    static unsigned scattered(int x, int y) {
        unsigned bits = static_cast<unsigned>(x) * 0x9e3779b1u ^ static_cast<unsigned>(y) * 0x85ebca77u;
        bits = (bits ^ (bits >> 15)) * 0x2c1b3c6du;
        return bits >> 16;
    }

    void choose(int left, int top, int right, int below) {
        const int count = (right - left) * (below - top);
        const int place = static_cast<int>(scattered(left, top) % static_cast<unsigned>(count));
        weight(left + place % (right - left), top + place / (right - left)) = static_cast<std::uint8_t>(count);
    }

    void every_one(int left, int top, int right, int below) {
        for (int y = top; y < below; ++y)
            for (int x = left; x < right; ++x) weight(x, y) = 1;
    }

    void every_second(int left, int top, int right, int below) {
        if ((right - left) * (below - top) < 4) return every_one(left, top, right, below);
        const int slant = static_cast<int>(scattered(left, top) % 2);
        weight(left + slant, top) = weight(left + 1 - slant, top + 1) = 2;
    }

    Sampling& out_;
    const std::vector<float>& bends_;
    const float threshold_;
    const bool sparse_;
};

}  // namespace

Sampling every_texel(int width, int height) {
    return {width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height, 1)};
}

Sampling sample_map(const Image& map, bool sparse) {
    Sampling out{map.width, map.height, std::vector<std::uint8_t>(map.texels.size(), 0)};
    const std::vector<float> bends = bends_of(map);
    BlockSampler sampler(out, bends, threshold_of(bends), sparse);
    for (int y = 0; y < map.height; y += kBlock)
        for (int x = 0; x < map.width; x += kBlock) sampler.sample(x, y, kBlock);
    return out;
}

}  // namespace burin::refinement
