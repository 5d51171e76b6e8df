#include "spoil.hpp"

#include <algorithm>
#include <array>
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

namespace {

constexpr int kBlock = 8;
using Block = std::array<std::array<double, kBlock>, kBlock>;

// The orthonormal cosine transform of the columns of a block, or its inverse.
Block transformed(const Block& in, bool inverse) {
    Block out{};
    for (int u = 0; u < kBlock; ++u)
        for (int k = 0; k < kBlock; ++k) {
            const int frequency = inverse ? k : u, place = inverse ? u : k;
            const double scale = frequency == 0 ? std::sqrt(1.0 / kBlock) : std::sqrt(2.0 / kBlock);
            const double wave = scale * std::cos((2 * place + 1) * frequency * 3.14159265358979 / (2 * kBlock));
            for (int column = 0; column < kBlock; ++column) out[u][column] += wave * in[k][column];
        }
    return out;
}

Block turned(const Block& in) {
    Block out;
    for (int i = 0; i < kBlock; ++i)
        for (int k = 0; k < kBlock; ++k) out[k][i] = in[i][k];
    return out;
}

}  // namespace

void ring_in_blocks(Image& map) {
    // Steps of the luminance at quality 50; at 85 they are 0.3 times as wide.
    constexpr int kSteps[kBlock][kBlock] = {
        {16, 11, 10, 16, 24, 40, 51, 61},     {12, 12, 14, 19, 26, 58, 60, 55},     {14, 13, 16, 24, 40, 57, 69, 56},
        {14, 17, 22, 29, 51, 87, 80, 62},     {18, 22, 37, 56, 68, 109, 103, 77},   {24, 35, 55, 64, 81, 104, 113, 92},
        {49, 64, 78, 87, 103, 121, 120, 101}, {72, 92, 95, 98, 112, 100, 103, 99}};
    for (int y0 = 0; y0 + kBlock <= map.height; y0 += kBlock)
        for (int x0 = 0; x0 + kBlock <= map.width; x0 += kBlock) {
            Block block;
            for (int y = 0; y < kBlock; ++y)
                for (int x = 0; x < kBlock; ++x) block[y][x] = std::round(255.0 * map.at(x0 + x, y0 + y)) - 128.0;
            block = transformed(turned(transformed(block, false)), false);
            for (int v = 0; v < kBlock; ++v)
                for (int u = 0; u < kBlock; ++u) {
                    const double step = std::max(1.0, std::round(0.3 * kSteps[u][v]));
                    block[v][u] = step * std::round(block[v][u] / step);
                }
            block = transformed(turned(transformed(block, true)), true);
            for (int y = 0; y < kBlock; ++y)
                for (int x = 0; x < kBlock; ++x)
                    map.at(x0 + x, y0 + y) = static_cast<float>(std::clamp(std::round(block[y][x] + 128.0), 0.0, 255.0) / 255.0);
        }
}

}  // namespace burin::bench
