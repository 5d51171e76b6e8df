#include "image_error.hpp"

#include <algorithm>
#include <cmath>

namespace burin::bench {
namespace {

double channel(const RgbaImage& picture, std::size_t pixel, std::size_t k) { return picture.texels[4 * pixel + k] / 255.0; }
double channel(const TruthPicture& truth, std::size_t pixel, std::size_t k) {
    return to_srgb(double(truth.linear[3 * pixel + k]));
}

template <typename Picture>
std::vector<double> luma_of(const Picture& picture, std::size_t count) {
    std::vector<double> luma(count);
    for (std::size_t i = 0; i < count; ++i)
        luma[i] = 0.2126 * channel(picture, i, 0) + 0.7152 * channel(picture, i, 1) + 0.0722 * channel(picture, i, 2);
    return luma;
}

// Structural similarity of the windows around one pixel; at the border the window is cut off.
double similarity(const std::vector<double>& a, const std::vector<double>& b, int width, int height, int x, int y) {
    double weight = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
    for (int j = std::max(y - 5, 0); j <= std::min(y + 5, height - 1); ++j)
        for (int i = std::max(x - 5, 0); i <= std::min(x + 5, width - 1); ++i) {
            const double w = std::exp(-((i - x) * (i - x) + (j - y) * (j - y)) / (2.0 * 1.5 * 1.5));
            const double p = a[std::size_t(j * width + i)], q = b[std::size_t(j * width + i)];
            weight += w, ma += w * p, mb += w * q, aa += w * p * p, bb += w * q * q, ab += w * p * q;
        }
    ma /= weight, mb /= weight;
    const double va = aa / weight - ma * ma, vb = bb / weight - mb * mb, cov = ab / weight - ma * mb;
    constexpr double kC1 = 1e-4, kC2 = 9e-4;
    return (2 * ma * mb + kC1) * (2 * cov + kC2) / ((ma * ma + mb * mb + kC1) * (va + vb + kC2));
}

}  // namespace

ImageError compare_pictures(const RgbaImage& picture, const TruthPicture& truth) {
    ImageError error;
    const std::size_t count = truth.feature.size();
    const std::vector<double> a = luma_of(picture, count), b = luma_of(truth, count);
    double squares = 0.0, ssim = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        if (truth.feature[i] == 0) continue;
        ++error.pixels;
        double most = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double off = std::abs(channel(picture, i, k) - channel(truth, i, k));
            squares += off * off / 3.0;
            most = std::max(most, off);
        }
        error.bad_pixels += most > 0.25;
        const int x = int(i) % truth.width, y = int(i) / truth.width;
        if (most > worst) worst = most, error.worst_x = x, error.worst_y = y;
        ssim += similarity(a, b, truth.width, truth.height, x, y);
    }
    if (error.pixels == 0) return error;
    error.psnr = squares > 0.0 ? std::min(99.0, -10.0 * std::log10(squares / double(error.pixels))) : 99.0;
    error.ssim = ssim / double(error.pixels);
    return error;
}

RgbaImage show_difference(const RgbaImage& picture, const TruthPicture& truth) {
    RgbaImage shown{truth.width * 3, truth.height, {}};
    shown.texels.assign(std::size_t(shown.width) * std::size_t(shown.height) * 4, 255);
    for (std::size_t i = 0; i < truth.feature.size(); ++i) {
        const std::size_t x = i % std::size_t(truth.width), y = i / std::size_t(truth.width);
        for (std::size_t k = 0; k < 3; ++k) {
            const double right = channel(truth, i, k), met = channel(picture, i, k);
            const double panels[] = {right, met, std::min(1.0, 8.0 * std::abs(right - met))};
            for (std::size_t panel = 0; panel < 3; ++panel)
                shown.texels[4 * (y * std::size_t(shown.width) + panel * std::size_t(truth.width) + x) + k] =
                    std::uint8_t(panels[panel] * 255.0 + 0.5);
        }
    }
    return shown;
}

}  // namespace burin::bench
