// Raster helpers of stage vectorize: sampling, grain, distances, thinning.
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

namespace {

// Lower envelope of parabolas along one row: squared distances f become min over q of (p - q)^2 + f(q).
void transform_row(const std::vector<float>& f, std::vector<float>& out, std::vector<int>& site,
                   std::vector<float>& border, int n) {
    const float infinity = 1e20f;
    int k = 0;
    site[0] = 0;
    border[0] = -infinity;
    border[1] = infinity;
    for (int q = 1; q < n; ++q) {
        float s = 0.0f;
        for (;;) {
            const int v = site[k];
            s = ((f[q] + static_cast<float>(q) * q) - (f[v] + static_cast<float>(v) * v)) /
                (2.0f * static_cast<float>(q - v));
            if (s > border[k] || k == 0) break;
            --k;
        }
        if (s <= border[k]) {
            site[0] = q;
            k = 0;
            border[0] = -infinity;
        } else {
            ++k;
            site[k] = q;
            border[k] = s;
        }
        border[k + 1] = infinity;
    }
    k = 0;
    for (int p = 0; p < n; ++p) {
        while (border[k + 1] < static_cast<float>(p)) ++k;
        const float d = static_cast<float>(p - site[k]);
        out[p] = d * d + f[site[k]];
    }
}

}  // namespace

std::vector<float> distance_inside(const std::vector<std::uint8_t>& mask, const Lattice& lattice) {
    // Lines of interest are far narrower than this margin, so a wrapped copy of it makes distances exact on the torus.
    const int margin = lattice.wrap ? std::min(64, std::min(lattice.width, lattice.height)) : 0;
    const int w = lattice.width + 2 * margin, h = lattice.height + 2 * margin;
    std::vector<float> distance(static_cast<std::size_t>(w) * h);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            distance[static_cast<std::size_t>(y) * w + x] =
                mask[lattice.nearest(x - margin, y - margin)] ? 1e10f : 0.0f;
    const int longest = std::max(w, h);
    std::vector<float> line(longest), out(longest), border(longest + 2);
    std::vector<int> site(longest + 1);
    for (int x = 0; x < w; ++x) {
        for (int y = 0; y < h; ++y) line[y] = distance[static_cast<std::size_t>(y) * w + x];
        transform_row(line, out, site, border, h);
        for (int y = 0; y < h; ++y) distance[static_cast<std::size_t>(y) * w + x] = out[y];
    }
    std::vector<float> result(static_cast<std::size_t>(lattice.size()));
    for (int y = 0; y < lattice.height; ++y) {
        const float* row = &distance[static_cast<std::size_t>(y + margin) * w];
        std::copy(row, row + w, line.begin());
        transform_row(line, out, site, border, w);
        for (int x = 0; x < lattice.width; ++x)
            result[static_cast<std::size_t>(y) * lattice.width + x] = std::sqrt(out[x + margin]);
    }
    return result;
}

namespace {

// The eight neighbours in order around the texel, starting above.
constexpr int kAroundX[8] = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr int kAroundY[8] = {-1, -1, 0, 1, 1, 1, 0, -1};

// Guo and Hall 1989: true when the texel can go in sub-iteration `even` without breaking or shortening a line.
bool can_remove(const std::vector<std::uint8_t>& mask, const Lattice& lattice, int x, int y, bool even) {
    bool n[8];
    for (int k = 0; k < 8; ++k) {
        const int i = lattice.index(x + kAroundX[k], y + kAroundY[k]);
        n[k] = i >= 0 && mask[i];
    }
    const int crossings = (!n[0] && (n[1] || n[2])) + (!n[2] && (n[3] || n[4])) + (!n[4] && (n[5] || n[6])) +
                          (!n[6] && (n[7] || n[0]));
    const int n1 = (n[7] || n[0]) + (n[1] || n[2]) + (n[3] || n[4]) + (n[5] || n[6]);
    const int n2 = (n[0] || n[1]) + (n[2] || n[3]) + (n[4] || n[5]) + (n[6] || n[7]);
    const int least = std::min(n1, n2);
    const bool guard = even ? ((n[0] || n[1] || !n[3]) && n[2]) : ((n[4] || n[5] || !n[7]) && n[6]);
    return crossings == 1 && least >= 2 && least <= 3 && !guard;
}

}  // namespace

void thin_mask(std::vector<std::uint8_t>& mask, const Lattice& lattice) {
    std::vector<int> live;
    for (int i = 0; i < lattice.size(); ++i)
        if (mask[i]) live.push_back(i);
    std::vector<int> gone;
    int idle = 0;
    for (bool even = true; idle < 2; even = !even) {
        gone.clear();
        for (const int i : live)
            if (can_remove(mask, lattice, i % lattice.width, i / lattice.width, even)) gone.push_back(i);
        for (const int i : gone) mask[i] = 0;
        idle = gone.empty() ? idle + 1 : 0;
        if (!gone.empty())
            live.erase(std::remove_if(live.begin(), live.end(), [&](int i) { return !mask[i]; }), live.end());
    }
}

}  // namespace burin::vectorizing
