// Pictures of the report: grey heights, smaller copies, the worst places.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "report_internal.hpp"

namespace burin::report {
namespace {

std::string base64(const std::vector<std::uint8_t>& bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

float block_value(const Image& image, int x0, int y0, int step, Shrink how) {
    const int x1 = std::min(image.width, x0 + step), y1 = std::min(image.height, y0 + step);
    double sum = 0.0;
    float farthest = 0.0f;
    for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
            const float v = image.at(x, y);
            sum += static_cast<double>(v);
            if (std::abs(v) > std::abs(farthest)) farthest = v;
        }
    return how == Shrink::farthest ? farthest : static_cast<float>(sum / ((x1 - x0) * (y1 - y0)));
}

// A window of `side` texels around a texel, moved into the map.
TexelRegion window_around(int x, int y, int side, const Image& image) {
    const int width = std::min(side, image.width), height = std::min(side, image.height);
    return {std::clamp(x - width / 2, 0, image.width - width), std::clamp(y - height / 2, 0, image.height - height),
            width, height};
}

bool overlap(const TexelRegion& a, const TexelRegion& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

// The texel of each block that errs most: enough to choose windows from, and few.
std::vector<Spot> candidates(const Image& error, int side) {
    constexpr int kBlock = 8;
    std::vector<Spot> spots;
    for (int y0 = 0; y0 < error.height; y0 += kBlock)
        for (int x0 = 0; x0 < error.width; x0 += kBlock) {
            Spot worst{{}, x0, y0, 0.0};
            for (int y = y0; y < std::min(error.height, y0 + kBlock); ++y)
                for (int x = x0; x < std::min(error.width, x0 + kBlock); ++x)
                    if (std::abs(error.at(x, y)) > std::abs(worst.error))
                        worst.x = x, worst.y = y, worst.error = static_cast<double>(error.at(x, y));
            worst.region = window_around(worst.x, worst.y, side, error);
            if (worst.error != 0.0) spots.push_back(worst);
        }
    return spots;
}

}  // namespace

std::string decimal(double value, int decimals) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    std::string digits = text;
    if (digits.find('.') != std::string::npos) {
        digits.erase(digits.find_last_not_of('0') + 1);
        if (digits.back() == '.') digits.pop_back();
    }
    return digits == "-0" ? "0" : digits;
}

Result<std::string> image_tag(const RgbaImage& picture, const std::string& description) {
    const auto png = encode_png(picture);
    if (!png) return png.error();
    return "<img alt=\"" + description + "\" width=\"" + std::to_string(picture.width) + "\" height=\"" +
           std::to_string(picture.height) + "\" src=\"data:image/png;base64," + base64(*png) + "\">";
}

RgbaImage draw_grey(const Image& heights, double low, double high) {
    RgbaImage picture{heights.width, heights.height, {}};
    picture.texels.reserve(heights.texels.size() * 4);
    const double scale = high > low ? 255.0 / (high - low) : 0.0;
    for (const float v : heights.texels) {
        const double grey = scale > 0.0 ? (static_cast<double>(v) - low) * scale : 128.0;
        const auto byte = static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0)));
        picture.texels.insert(picture.texels.end(), {byte, byte, byte, 255});
    }
    return picture;
}

Image crop(const Image& image, const TexelRegion& region) {
    Image part(region.width, region.height);
    for (int y = 0; y < region.height; ++y)
        for (int x = 0; x < region.width; ++x) part.at(x, y) = image.at(region.x + x, region.y + y);
    return part;
}

Image shrink(const Image& image, int most, Shrink how) {
    const int step = (std::max(image.width, image.height) + most - 1) / most;
    if (step <= 1) return image;
    Image small((image.width + step - 1) / step, (image.height + step - 1) / step);
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) small.at(x, y) = block_value(image, x * step, y * step, step, how);
    return small;
}

std::vector<Spot> worst_spots(const Image& error, int side, int most) {
    std::vector<Spot> found = candidates(error, side), spots;
    std::stable_sort(found.begin(), found.end(),
                     [](const Spot& a, const Spot& b) { return std::abs(a.error) > std::abs(b.error); });
    for (const Spot& spot : found) {
        if (static_cast<int>(spots.size()) == most) break;
        if (std::none_of(spots.begin(), spots.end(), [&](const Spot& s) { return overlap(s.region, spot.region); }))
            spots.push_back(spot);
    }
    return spots;
}

}  // namespace burin::report
