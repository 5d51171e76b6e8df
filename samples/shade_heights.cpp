// Draws a part of a height map as lit relief, so that maps of any resolution can be compared under one light.
//
//     shade_heights MAP U,V,WIDTH PIXELS RELIEF OUT.png
//
// MAP is read by burin's own reader and magnified bilinearly, as graphics hardware does. The part is the square of side
// WIDTH around (U, V), all in uv; PIXELS is the side of the picture; RELIEF is depth divided by the map's extent.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <burin/heightmap.hpp>
#include <burin/image_io.hpp>

namespace {

// Towards the light, z up; from the upper left, as drawings are lit.
constexpr double kLight[3] = {-0.5, -0.5, 0.7071};

// Bilinear interpolation between texel centres, borders repeated.
double sample(const burin::Image& map, double u, double v) {
    const double x = std::clamp(u * map.width - 0.5, 0.0, map.width - 1.0);
    const double y = std::clamp(v * map.height - 0.5, 0.0, map.height - 1.0);
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, map.width - 1), y1 = std::min(y0 + 1, map.height - 1);
    const double fx = x - x0, fy = y - y0;
    const double above = map.at(x0, y0) * (1 - fx) + map.at(x1, y0) * fx;
    const double below = map.at(x0, y1) * (1 - fx) + map.at(x1, y1) * fx;
    return above * (1 - fy) + below * fy;
}

// The part as side x side heights in units of the map's extent.
burin::Image magnify(const burin::Image& map, double u, double v, double width, int side, double relief) {
    burin::Image heights(side, side);
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
            heights.at(i, j) = static_cast<float>(
                relief * sample(map, u + width * ((i + 0.5) / side - 0.5), v + width * ((j + 0.5) / side - 0.5)));
    return heights;
}

bool in_shadow(const burin::Image& heights, int i, int j, double step, double highest) {
    const double across = std::hypot(kLight[0], kLight[1]);
    double x = i, y = j, z = heights.at(i, j) + 1e-5;
    const double rise = kLight[2] / across * step;
    while ((z += rise) < highest) {
        x += kLight[0] / across, y += kLight[1] / across;
        const int a = static_cast<int>(std::lround(x)), b = static_cast<int>(std::lround(y));
        if (a < 0 || b < 0 || a >= heights.width || b >= heights.height) return false;
        if (heights.at(a, b) > z) return true;
    }
    return false;
}

// Brightness of one sample, [0, 1]: Lambert with a soft sky.
double brightness(const burin::Image& heights, int i, int j, double step, double highest) {
    const int side = heights.width;
    const int left = std::max(i - 1, 0), right = std::min(i + 1, side - 1);
    const int top = std::max(j - 1, 0), bottom = std::min(j + 1, side - 1);
    const double dx = (heights.at(right, j) - heights.at(left, j)) / ((right - left) * step);
    const double dy = (heights.at(i, bottom) - heights.at(i, top)) / ((bottom - top) * step);
    const double length = std::sqrt(dx * dx + dy * dy + 1.0);
    const double facing = (-dx * kLight[0] - dy * kLight[1] + kLight[2]) / length;
    const double sky = 0.18 + 0.12 / length;
    const double sun = in_shadow(heights, i, j, step, highest) ? 0.0 : std::max(facing, 0.0);
    return std::min(sky + 0.85 * sun, 1.0);
}

// All but a rim of `rim` samples, which only casts shadows.
burin::RgbaImage shade(const burin::Image& heights, double step, int rim) {
    const double highest = *std::max_element(heights.texels.begin(), heights.texels.end());
    burin::RgbaImage picture{heights.width / 2 - rim, heights.height / 2 - rim, {}};
    const double tint[3] = {0.93, 0.86, 0.74};
    for (int j = 0; j < picture.height; ++j)
        for (int i = 0; i < picture.width; ++i) {
            double light = 0.0;
            for (int k = 0; k < 4; ++k)
                light += brightness(heights, rim + 2 * i + k % 2, rim + 2 * j + k / 2, step, highest) / 4.0;
            for (double channel : tint)
                picture.texels.push_back(
                    static_cast<std::uint8_t>(std::lround(255.0 * std::pow(light * channel, 1.0 / 2.2))));
            picture.texels.push_back(255);
        }
    return picture;
}

int report(const std::string& message) {
    std::fprintf(stderr, "shade_heights: error: %s\n", message.c_str());
    return 1;
}

}  // namespace

int main(int argc, char** argv) {
    double u = 0.0, v = 0.0, width = 0.0;
    if (argc != 6 || std::sscanf(argv[2], "%lf,%lf,%lf", &u, &v, &width) != 3)
        return report("usage: shade_heights MAP U,V,WIDTH PIXELS RELIEF OUT.png");
    const int pixels = std::atoi(argv[3]);
    const double relief = std::atof(argv[4]);
    if (pixels < 1 || pixels > 4096 || !(relief > 0.0) || !(width > 0.0))
        return report("PIXELS is 1 to 4096, RELIEF and WIDTH are above 0");
    const auto map = burin::read_height_map(argv[1]);
    if (!map) return report(map.error().message);
    // Two samples per pixel side, and half as much again around, from where shadows fall in.
    const int rim = pixels / 2, side = 2 * pixels + 2 * rim;
    const double step = width / (2 * pixels);
    const burin::Image heights = magnify(map->image, u, v, step * side, side, relief);
    const auto written = burin::write_png(argv[5], shade(heights, step, rim));
    return written ? 0 : report(written.error().message);
}
