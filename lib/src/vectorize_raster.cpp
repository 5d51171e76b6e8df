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

// The mask (1 -2 1; -2 4 -2; 1 -2 1) removes planes and straight edges along the axes; its response to white noise of
// deviation s has deviation 6 s. The median of its magnitude ignores the texels that lie on features.
double estimate_noise(const Image& map, const Lattice& lattice) {
    // Every second texel of every second row.
    const int in_row = (lattice.width + 1) / 2, rows = (lattice.height + 1) / 2;
    std::vector<float> responses(static_cast<std::size_t>(in_row) * rows, -1.0f);
    for_each_band(rows, lattice.threads, [&](const Band& band) {
        for (int row = band.begin; row < band.end; ++row)
            for (int x = row % 2, k = 0; x < lattice.width; x += 2, ++k) {
                float sum = 0.0f;
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx) {
                        const int weight = (dx == 0 ? 2 : -1) * (dy == 0 ? 2 : -1);
                        sum += static_cast<float>(weight) * map.texels[lattice.nearest(x + dx, 2 * row + dy)];
                    }
                responses[static_cast<std::size_t>(row) * in_row + k] = std::fabs(sum);
            }
    });
    std::erase(responses, -1.0f);  // odd rows of a map of odd width hold one less
    if (responses.empty()) return 0.0;
    const auto middle = responses.begin() + static_cast<std::ptrdiff_t>(responses.size() / 2);
    std::nth_element(responses.begin(), middle, responses.end());
    return *middle / 0.6745 / 6.0;
}

}  // namespace burin::vectorizing
