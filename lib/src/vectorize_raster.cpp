// Raster helpers of stage vectorize: sampling, grain, margins.
#include "vectorize_internal.hpp"

#include <algorithm>
#include <cmath>

#include "parallel.hpp"

namespace burin::vectorizing {

namespace {

int mirrored(int a, int n) {
    const int m = Lattice::modulo(a, 2 * n);
    return m < n ? m : 2 * n - 1 - m;
}

}  // namespace

Image mirror_margin(const Image& map, int margin) {
    if (margin == 0) return map;
    Image out(map.width + 2 * margin, map.height + 2 * margin);
    std::vector<int> column(out.width);
    for (int x = 0; x < out.width; ++x) column[x] = mirrored(x - margin, map.width);
    for (int y = 0; y < out.height; ++y) {
        const float* row = &map.texels[static_cast<std::size_t>(mirrored(y - margin, map.height)) * map.width];
        for (int x = 0; x < out.width; ++x) out.at(x, y) = row[column[x]];
    }
    return out;
}

Image crop_margin(const Image& map, int margin, const Lattice& lattice) {
    if (margin == 0) return map;
    Image out(lattice.width, lattice.height);
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) out.at(x, y) = map.at(x + margin, y + margin);
    return out;
}

namespace {

// The mask (1 -2 1; -2 4 -2; 1 -2 1) removes planes and straight edges along the axes; its response to white noise of
// deviation s has deviation 6 s.
float second_difference(const Image& map, const Lattice& lattice, int x, int y) {
    float sum = 0.0f;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const int weight = (dx == 0 ? 2 : -1) * (dy == 0 ? 2 : -1);
            sum += static_cast<float>(weight) * map.texels[lattice.nearest(x + dx, y + dy)];
        }
    return sum;
}

// Greatest less least value of the texels [x0, x1] x [y0, y1].
float range_of(const Image& map, const Lattice& lattice, int x0, int y0, int x1, int y1) {
    float least = 1e30f, most = -1e30f;
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const float v = map.texels[lattice.nearest(x, y)];
            least = std::min(least, v), most = std::max(most, v);
        }
    return most - least;
}

}  // namespace

// The median of the second differences ignores the texels that lie on features.
double estimate_noise(const Image& map, const Lattice& lattice) {
    // Every second texel of every second row.
    const int in_row = (lattice.width + 1) / 2, rows = (lattice.height + 1) / 2;
    std::vector<float> responses(static_cast<std::size_t>(in_row) * rows, -1.0f);
    for_each_band(rows, lattice.threads, [&](const Band& band) {
        for (int row = band.begin; row < band.end; ++row)
            for (int x = row % 2, k = 0; x < lattice.width; x += 2, ++k)
                responses[static_cast<std::size_t>(row) * in_row + k] = std::fabs(second_difference(map, lattice, x, 2 * row));
    });
    std::erase(responses, -1.0f);  // odd rows of a map of odd width hold one less
    if (responses.empty()) return 0.0;
    const auto middle = responses.begin() + static_cast<std::ptrdiff_t>(responses.size() / 2);
    std::nth_element(responses.begin(), middle, responses.end());
    return *middle / 0.6745 / 6.0;
}

double estimate_ringing(const Image& map, const Lattice& lattice) {
    constexpr int kBlock = 8;  // of JPEG, whose ringing ends with the block that an edge lies in
    constexpr float kEdge = 0.2f, kQuiet = 0.1f;
    const int rows = lattice.height / kBlock, columns = lattice.width / kBlock;
    std::vector<std::pair<double, std::size_t>> sums(static_cast<std::size_t>(rows), {0.0, 0});  // of squares; of texels
    for_each_band(rows, lattice.threads, [&](const Band& band) {
        for (int row = band.begin; row < band.end; ++row)
            for (int column = 0; column < columns; ++column) {
                const int x0 = column * kBlock, y0 = row * kBlock;
                if (range_of(map, lattice, x0, y0, x0 + kBlock - 1, y0 + kBlock - 1) < kEdge) continue;
                for (int k = 0; k < kBlock * kBlock; k += 2) {
                    const int y = y0 + k / kBlock, x = x0 + k % kBlock + y % 2;
                    if (range_of(map, lattice, x - 2, y - 2, x + 2, y + 2) > kQuiet) continue;
                    const double d = second_difference(map, lattice, x, y) / 6.0;
                    sums[row].first += d * d, ++sums[row].second;
                }
            }
    });
    double squares = 0.0;
    std::size_t texels = 0;
    for (const auto& [sum, count] : sums) squares += sum, texels += count;
    return texels > 0 ? std::sqrt(squares / static_cast<double>(texels)) : 0.0;
}

}  // namespace burin::vectorizing
