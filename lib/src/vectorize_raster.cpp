// Raster helpers of stage vectorize: sampling, grain, margins.
#include "vectorize_internal.hpp"

#include <algorithm>
#include <cmath>

namespace burin::vectorizing {

float sample(const Image& image, const Lattice& lattice, Vec2 p) {
    const double x = p.x - 0.5, y = p.y - 0.5;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    const float fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
    const float* t = image.texels.data();
    const float a = t[lattice.nearest(x0, y0)], b = t[lattice.nearest(x0 + 1, y0)];
    const float c = t[lattice.nearest(x0, y0 + 1)], d = t[lattice.nearest(x0 + 1, y0 + 1)];
    const float top = a + (b - a) * fx, bottom = c + (d - c) * fx;
    return top + (bottom - top) * fy;
}

namespace {

int mirrored(int a, int n) {
    const int m = Lattice::modulo(a, 2 * n);
    return m < n ? m : 2 * n - 1 - m;
}

}  // namespace

Image mirror_margin(const Image& map, int margin) {
    if (margin == 0) return map;
    Image out(map.width + 2 * margin, map.height + 2 * margin);
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x)
            out.at(x, y) = map.at(mirrored(x - margin, map.width), mirrored(y - margin, map.height));
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
    std::vector<float> responses;
    responses.reserve(static_cast<std::size_t>(lattice.size()) / 4 + 1);
    for (int y = 0; y < lattice.height; y += 2)
        for (int x = (y / 2) % 2; x < lattice.width; x += 2) {
            float sum = 0.0f;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int weight = (dx == 0 ? 2 : -1) * (dy == 0 ? 2 : -1);
                    sum += static_cast<float>(weight) * map.texels[lattice.nearest(x + dx, y + dy)];
                }
            responses.push_back(std::fabs(sum));
        }
    if (responses.empty()) return 0.0;
    const auto middle = responses.begin() + static_cast<std::ptrdiff_t>(responses.size() / 2);
    std::nth_element(responses.begin(), middle, responses.end());
    return *middle / 0.6745 / 6.0;
}

}  // namespace burin::vectorizing
