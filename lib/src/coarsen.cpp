#include <burin/coarsen.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "parallel.hpp"

namespace burin {
namespace {

constexpr int kBins = 4096;    // of errors, from 0 to kMostBinned of the whole range
constexpr double kMostBinned = 0.25;
constexpr int kReach = 2;      // cells that the foretelling of a half looks at on each side

// By how much the second half of a cell lies above the cell's mean, from the means of the cells beside it.
float foretold_rise(float two_before, float before, float after, float two_after) {
    return (22.0f * (after - before) - 3.0f * (two_after - two_before)) * (1.0f / 128.0f);
}

// What the texels of a band differ by from what their cells foretell.
struct Surprise {
    std::array<std::uint32_t, kBins> bins{};  // of cells, by their error
    double on_slopes = 0.0, slopes = 0.0;     // squared error times squared slope; squared slope squared
    float low = 1.0f, high = 0.0f;            // of the cells

    void add(float squared_error, float squared_slope) {
        const int bin = static_cast<int>(std::sqrt(squared_error) * static_cast<float>(kBins / kMostBinned));
        ++bins[static_cast<std::size_t>(std::min(bin, kBins - 1))];
        on_slopes += double(squared_error) * squared_slope;
        slopes += double(squared_slope) * squared_slope;
    }
    void add(const Surprise& other) {
        for (int i = 0; i < kBins; ++i) bins[i] += other.bins[i];
        on_slopes += other.on_slopes, slopes += other.slopes;
        low = std::min(low, other.low), high = std::max(high, other.high);
    }
};

void surprise_of_row(const Image& fine, const Image& coarse, int y, std::vector<float>& rises, Surprise& surprise) {
    const int width = coarse.width;
    const auto row = [&](int dy) { return &coarse.texels[std::size_t(y + dy) * width]; };
    const float *up2 = row(-2), *up = row(-1), *mean = row(0), *down = row(1), *down2 = row(2);
    const float *upper = &fine.texels[std::size_t(2 * y) * fine.width], *lower = upper + fine.width;
    for (int x = 0; x < width; ++x) rises[x] = foretold_rise(up2[x], up[x], down[x], down2[x]);
    for (int x = kReach; x < width - kReach; ++x) {
        const float a = upper[2 * x], b = upper[2 * x + 1], c = lower[2 * x], d = lower[2 * x + 1];
        const float right = 0.25f * ((b + d) - (a + c)) - foretold_rise(mean[x - 2], mean[x - 1], mean[x + 1], mean[x + 2]);
        const float below = 0.25f * ((c + d) - (a + b)) - rises[x];
        const float across = 0.25f * ((a + d) - (b + c)) - foretold_rise(rises[x - 2], rises[x - 1], rises[x + 1], rises[x + 2]);
        const float along_x = 0.25f * (mean[x + 1] - mean[x - 1]), along_y = 0.25f * (down[x] - up[x]);
        surprise.add(right * right + below * below + across * across, along_x * along_x + along_y * along_y);
        surprise.low = std::min(surprise.low, mean[x]), surprise.high = std::max(surprise.high, mean[x]);
    }
}

Surprise surprise_of(const Image& fine, const Image& coarse, int threads) {
    constexpr int kBands = 64;
    std::vector<Surprise> parts(kBands);
    for_each_band(coarse.height, kBands, threads, [&](const Band& band) {
        std::vector<float> rises(static_cast<std::size_t>(coarse.width));
        for (int y = std::max(band.begin, kReach); y < std::min(band.end, coarse.height - kReach); ++y)
            surprise_of_row(fine, coarse, y, rises, parts[band.index]);
    });
    Surprise all;
    for (const Surprise& part : parts) all.add(part);
    return all;
}

// The error that one cell in a thousand exceeds.
double p999_of(const Surprise& surprise) {
    std::uint64_t count = 0;
    for (const std::uint32_t n : surprise.bins) count += n;
    std::uint64_t above = count / 1000;
    int bin = kBins - 1;
    while (bin > 0 && surprise.bins[bin] <= above) above -= surprise.bins[bin--];
    return (bin + 1) * kMostBinned / kBins;
}

// What rounded texels are foretold wrong by at most in 99.9 % of the cells: their three differences have together a
// quarter of a step's standard deviation each way.
double rounding_of(const HeightMap& map) {
    constexpr double kSteps = 0.6;
    return map.is_float || map.bit_depth > 16 ? 0.0 : kSteps / (std::exp2(map.bit_depth) - 1.0);
}

bool shows_all(const Image& fine, const Image& coarse, double rounding, const CoarsenOptions& options) {
    const Surprise surprise = surprise_of(fine, coarse, options.threads);
    const double range = double(surprise.high) - surprise.low;
    if (!(range > 0.0) || surprise.slopes <= 0.0) return false;
    return p999_of(surprise) <= options.most_error * range + rounding &&
           std::sqrt(surprise.on_slopes / surprise.slopes) <= options.most_edge_error;
}

}  // namespace

Image halve_image(const Image& fine, int threads) {
    Image coarse(fine.width / 2, fine.height / 2);
    for_each_band(coarse.height, threads, [&](const Band& band) {
        for (int y = band.begin; y < band.end; ++y) {
            const float *upper = &fine.texels[std::size_t(2 * y) * fine.width], *lower = upper + fine.width;
            float* out = &coarse.texels[std::size_t(y) * coarse.width];
            for (int x = 0; x < coarse.width; ++x)
                out[x] = 0.25f * ((upper[2 * x] + upper[2 * x + 1]) + (lower[2 * x] + lower[2 * x + 1]));
        }
    });
    return coarse;
}

Coarsened coarsen_map(const HeightMap& map, const CoarsenOptions& options) {
    Coarsened out;
    const Image* fine = &map.image;
    while (fine->texels.size() >= options.least_texels && fine->width % 2 == 0 && fine->height % 2 == 0) {
        Image coarse = halve_image(*fine, options.threads);
        if (!shows_all(*fine, coarse, rounding_of(map), options)) break;
        if (!out.map) out.map.emplace();
        out.map->image = std::move(coarse);
        fine = &out.map->image;
        ++out.halvings;
    }
    return out;
}

}  // namespace burin
