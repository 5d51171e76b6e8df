#include <burin/error_map.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace burin {
namespace {

constexpr int kShades = 127;  // on each side of white

std::uint32_t srgb_byte(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
    return static_cast<std::uint32_t>(std::lround(encoded * 255.0));
}

// Björn Ottosson's Oklab, from lightness, chroma and hue in degrees.
std::uint32_t from_oklch(double lightness, double chroma, double hue) {
    const double a = chroma * std::cos(hue * std::numbers::pi / 180.0);
    const double b = chroma * std::sin(hue * std::numbers::pi / 180.0);
    const auto cube = [](double v) { return v * v * v; };
    const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
    const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
    const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
    return srgb_byte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s) << 16 |
           srgb_byte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s) << 8 |
           srgb_byte(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s);
}

using Shades = std::array<std::uint32_t, 2 * kShades + 1>;

Shades make_shades() {
    constexpr double kRed = 28.0, kBlue = 258.0;
    Shades shades{};
    for (int i = -kShades; i <= kShades; ++i) {
        const double share = std::abs(i) / static_cast<double>(kShades);
        shades[static_cast<std::size_t>(i + kShades)] =
            from_oklch(1.0 - 0.55 * share, 0.17 * share, i > 0 ? kRed : kBlue);
    }
    return shades;
}

}  // namespace

double full_error(double p999) {
    constexpr double kSlack = 1.0 - 1e-9;
    for (double decade = 1e-3;; decade *= 10.0)
        for (const double step : {1.0, 2.0, 5.0})
            if (decade * step >= std::min(p999, 1.0) * kSlack) return decade * step;
}

std::uint32_t error_color(double share) {
    static const Shades shades = make_shades();
    const long shade = std::lround(std::clamp(share, -1.0, 1.0) * kShades);
    return shades[static_cast<std::size_t>(shade + kShades)];
}

RgbaImage draw_error(const Image& reconstruction, const Image& input, double full) {
    assert(reconstruction.width == input.width && reconstruction.height == input.height && full > 0.0);
    RgbaImage picture{input.width, input.height, {}};
    picture.texels.reserve(input.texels.size() * 4);
    for (std::size_t i = 0; i < input.texels.size(); ++i) {
        const std::uint32_t color =
            error_color((static_cast<double>(reconstruction.texels[i]) - static_cast<double>(input.texels[i])) / full);
        for (const int shift : {16, 8, 0}) picture.texels.push_back(static_cast<std::uint8_t>(color >> shift));
        picture.texels.push_back(255);
    }
    return picture;
}

}  // namespace burin
