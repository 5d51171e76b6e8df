#include "spoil.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace burin::bench {
namespace {

// The sum of twelve uniform numbers is as good as normal here.
double normal(Uniform& random) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += random(0, 1);
    return sum;
}

}  // namespace

Image clouds(int width, int height, double period, Uniform& random) {
    const int columns = static_cast<int>(width / period) + 3, rows = static_cast<int>(height / period) + 3;
    std::vector<double> values(static_cast<std::size_t>(columns) * rows);
    for (double& v : values) v = random(0, 1);
    const auto ease = [](double t) { return t * t * (3.0 - 2.0 * t); };
    Image out(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const int i = static_cast<int>(x / period), j = static_cast<int>(y / period);
            const double s = ease(x / period - i), t = ease(y / period - j);
            const auto at = [&](int a, int b) { return values[static_cast<std::size_t>(b) * columns + a]; };
            const double upper = std::lerp(at(i, j), at(i + 1, j), s), lower = std::lerp(at(i, j + 1), at(i + 1, j + 1), s);
            out.at(x, y) = static_cast<float>(std::lerp(upper, lower, t));
        }
    }
    return out;
}

void add_clouds(Image& map, double amplitude, double period, Uniform& random) {
    const Image cloud = clouds(map.width, map.height, period, random);
    for (std::size_t i = 0; i < map.texels.size(); ++i)
        map.texels[i] = std::clamp(map.texels[i] + static_cast<float>(amplitude * (2.0 * cloud.texels[i] - 1.0)), 0.0f, 1.0f);
}

void add_grain(Image& map, double deviation, Uniform& random) {
    for (float& v : map.texels) v = std::clamp(v + static_cast<float>(deviation * normal(random)), 0.0f, 1.0f);
}

void keep_few_levels(Image& map) {
    for (float& v : map.texels) v = (219.0f + std::round(36.0f * v)) / 255.0f;
}

}  // namespace burin::bench
