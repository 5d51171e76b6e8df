// Slopes of height maps and their least-squares fit on small grids; for the sources of stage residual only.
//
//     map, reconstruction --[measure_field]--> SlopeField --[halve]--> SlopeField ... --[fit_slopes]--> SlopeGrid
//
// A slope is metres of height per metre along x (u) and along y (v, downwards).
#pragma once

#include <vector>

#include <burin/geometry.hpp>
#include <burin/image.hpp>
#include <burin/pattern.hpp>

namespace burin::residual {

struct Slope {
    float x = 0.0f, y = 0.0f;
};

// Central differences of a map: over two texels, across the seam of a map that repeats, over one at other borders.
class SlopeReader {
  public:
    SlopeReader(const Image& heights, Vec2 size, double depth, Wrap wrap);
    Slope at(int x, int y) const {
        const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
        return {(heights_.at(along_.after[i], y) - heights_.at(along_.before[i], y)) * along_.factor[i],
                (heights_.at(x, down_.after[j]) - heights_.at(x, down_.before[j])) * down_.factor[j]};
    }

  private:
    struct Axis {
        std::vector<int> before, after;
        std::vector<float> factor;  // slope of a difference of 1
    };
    static Axis make_axis(int texels, double metres, double depth, Wrap wrap);

    const Image& heights_;
    Axis along_, down_;
};

// What is to be fitted: over blocks of texels, the sum of the weights and of the weighted slopes that the paths leave.
//
// The weight of a texel is 1 / ((1 + |a|^2) (1 + |b|^2)), a and b the slopes of reconstruction and map: to first order
// the squared angle that a unit of slope turns the normal by. A wall that stands a little off is steep in both and
// counts for next to nothing, so that it does not tilt the ground beside it.
struct SlopeField {
    int width = 0, height = 0;
    std::vector<float> weight, x, y;
    SlopeField(int w, int h)
        : width(w), height(h), weight(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)), x(weight.size()), y(x.size()) {}
};

// Blocks of equal numbers of texels, or of one more where the sides do not divide.
SlopeField measure_field(const SlopeReader& map, const SlopeReader& paths, int map_width, int map_height, int width,
                         int height, int threads);
SlopeField halve(const SlopeField& field);

// A picture of slopes; a texel's value stands at its middle, bilinear between.
struct SlopeGrid {
    int width = 0, height = 0;
    std::vector<Slope> slopes;
    SlopeGrid(int w, int h) : width(w), height(h), slopes(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
};

// A grid of the map's own size: what the paths leave, texel by texel.
SlopeGrid measure_difference(const SlopeReader& map, const SlopeReader& paths, int width, int height, int threads);

// The grid that, interpolated, comes nearest to the field in the weighted least-squares sense.
SlopeGrid fit_slopes(const SlopeField& field, int width, int height, Wrap wrap, int threads);

// Index of a texel beyond the border.
int wrapped(int i, int count, Wrap wrap);

}  // namespace burin::residual
