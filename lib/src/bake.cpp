#include <burin/bake.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace burin {
namespace {

// Slopes dh/du and dh/dv, or one height, per texel; row-major.
struct Slopes {
    int width = 0, height = 0;
    std::vector<float> u, v;
    Slopes(int w, int h)
        : width(w), height(h), u(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)), v(u.size()) {}
};

int wrapped(int i, int n, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(i, 0, n - 1);
    const int r = i % n;
    return r < 0 ? r + n : r;
}

// Part of the source's texel range [0, n) that texel `i` of `m` covers, as weights on whole source texels:
// the box filter, exact for every ratio of sizes.
struct Cover {
    int first = 0;
    std::vector<float> weights;
};

std::vector<Cover> box_covers(int source, int target) {
    std::vector<Cover> covers(static_cast<std::size_t>(target));
    const double ratio = static_cast<double>(source) / target;
    for (int i = 0; i < target; ++i) {
        const double begin = i * ratio, end = std::min<double>((i + 1) * ratio, source);
        Cover& cover = covers[static_cast<std::size_t>(i)];
        cover.first = std::min(static_cast<int>(begin), source - 1);
        for (int s = cover.first; s < source && s < end; ++s) {
            const double part = std::min<double>(s + 1, end) - std::max<double>(s, begin);
            cover.weights.push_back(static_cast<float>(part / (end - begin)));
        }
    }
    return covers;
}

// Shrinks one channel, row by row: first along x, then into the target rows.
std::vector<float> shrink(const std::vector<float>& source, int w, int h, int tw, int th) {
    const std::vector<Cover> across = box_covers(w, tw), down = box_covers(h, th);
    std::vector<float> target(static_cast<std::size_t>(tw) * static_cast<std::size_t>(th), 0.0f);
    std::vector<float> row(static_cast<std::size_t>(tw));
    for (int y = 0; y < th; ++y) {
        const Cover& rows = down[static_cast<std::size_t>(y)];
        float* out = target.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(tw);
        for (std::size_t k = 0; k < rows.weights.size(); ++k) {
            const float* in =
                source.data() + (static_cast<std::size_t>(rows.first) + k) * static_cast<std::size_t>(w);
            for (int x = 0; x < tw; ++x) {
                const Cover& c = across[static_cast<std::size_t>(x)];
                float sum = 0.0f;
                for (std::size_t i = 0; i < c.weights.size(); ++i)
                    sum += c.weights[i] * in[static_cast<std::size_t>(c.first) + i];
                out[x] += rows.weights[k] * sum;
            }
        }
    }
    return target;
}

// Metres of height per metre of surface, by central differences.
Slopes slopes_of(const Image& heights, int w, int h, Vec2 size, double depth, Wrap wrap) {
    Slopes slopes(w, h);
    const auto du = static_cast<float>(depth * w / (2.0 * size.x)),
               dv = static_cast<float>(depth * h / (2.0 * size.y));
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
            const int left = wrapped(x - 1, w, wrap), right = wrapped(x + 1, w, wrap);
            const int above = wrapped(y - 1, h, wrap), below = wrapped(y + 1, h, wrap);
            slopes.u[i] = (heights.at(right, y) - heights.at(left, y)) * du;
            slopes.v[i] = (heights.at(x, below) - heights.at(x, above)) * dv;
        }
    return slopes;
}

std::array<float, 3> normal_of_slopes(float u, float v) {
    // Tangent along +u, bitangent against v, as glTF has it.
    const float scale = 1.0f / std::sqrt(u * u + v * v + 1.0f);
    return {-u * scale, v * scale, scale};
}

float bilinear(const std::vector<float>& values, int w, int h, float x, float y, Wrap wrap) {
    const float fx = std::floor(x - 0.5f), fy = std::floor(y - 0.5f);
    const float ax = x - 0.5f - fx, ay = y - 0.5f - fy;
    const int x0 = wrapped(static_cast<int>(fx), w, wrap), x1 = wrapped(static_cast<int>(fx) + 1, w, wrap);
    const int y0 = wrapped(static_cast<int>(fy), h, wrap), y1 = wrapped(static_cast<int>(fy) + 1, h, wrap);
    const auto at = [&](int i, int j) {
        return values[static_cast<std::size_t>(j) * static_cast<std::size_t>(w) +
                      static_cast<std::size_t>(i)];
    };
    return (at(x0, y0) * (1 - ax) + at(x1, y0) * ax) * (1 - ay) +
           (at(x0, y1) * (1 - ax) + at(x1, y1) * ax) * ay;
}

// RMS angle in degrees between the normals of a small map, interpolated, and those of the large one.
double normal_error(const Slopes& small, const Slopes& large, Wrap wrap) {
    double sum = 0.0;
    for (int y = 0; y < large.height; ++y)
        for (int x = 0; x < large.width; ++x) {
            const float sx = (static_cast<float>(x) + 0.5f) * static_cast<float>(small.width) /
                             static_cast<float>(large.width);
            const float sy = (static_cast<float>(y) + 0.5f) * static_cast<float>(small.height) /
                             static_cast<float>(large.height);
            const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(large.width) +
                                  static_cast<std::size_t>(x);
            const auto a = normal_of_slopes(large.u[i], large.v[i]);
            const auto b = normal_of_slopes(bilinear(small.u, small.width, small.height, sx, sy, wrap),
                                            bilinear(small.v, small.width, small.height, sx, sy, wrap));
            double difference = 0.0;
            for (std::size_t k = 0; k < 3; ++k) difference += (a[k] - b[k]) * (a[k] - b[k]);
            const double angle = 2.0 * std::asin(std::min(1.0, std::sqrt(difference) / 2.0));
            sum += angle * angle;
        }
    return std::sqrt(sum / (static_cast<double>(large.width) * large.height)) * 180.0 /
           3.14159265358979323846;
}

RgbaImage normal_image(const Slopes& slopes) {
    RgbaImage image{slopes.width, slopes.height, {}};
    image.texels.reserve(slopes.u.size() * 4);
    for (std::size_t i = 0; i < slopes.u.size(); ++i) {
        for (const float n : normal_of_slopes(slopes.u[i], slopes.v[i]))
            image.texels.push_back(static_cast<std::uint8_t>(std::lround((n + 1.0f) * 127.5f)));
        image.texels.push_back(255);
    }
    return image;
}

// Sine of the horizon's elevation from texel (x, y) in one direction: the steepest rise within the reach.
double horizon(const Image& heights, int x, int y, int dx, int dy, int reach, double step_metres,
               double depth, Wrap wrap) {
    const double here = heights.at(x, y);
    double steepest = 0.0;
    for (int k = 1; k <= reach; ++k) {
        const float there =
            heights.at(wrapped(x + k * dx, heights.width, wrap), wrapped(y + k * dy, heights.height, wrap));
        steepest = std::max(steepest, (there - here) * depth / (k * step_metres));
    }
    return steepest / std::sqrt(1.0 + steepest * steepest);
}

// Share of a uniform sky that is seen above the horizon in eight directions: the mean of 1 -
// sin^2(elevation), weighted by the cosine to the surface's own normal taken as straight up.
RgbaImage occlusion_image(const Image& heights, Vec2 size, double depth, Wrap wrap) {
    constexpr int kReach = 12;
    static constexpr int kDirections[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                              {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    const double px = size.x / heights.width, py = size.y / heights.height;
    RgbaImage image{heights.width, heights.height, {}};
    image.texels.reserve(heights.texels.size() * 4);
    for (int y = 0; y < heights.height; ++y)
        for (int x = 0; x < heights.width; ++x) {
            double open = 0.0;
            for (const auto& d : kDirections) {
                const double sine =
                    horizon(heights, x, y, d[0], d[1], kReach, std::hypot(d[0] * px, d[1] * py), depth, wrap);
                open += (1.0 - sine * sine) / 8.0;
            }
            const auto code = static_cast<std::uint8_t>(std::lround(open * 255.0));
            image.texels.insert(image.texels.end(), {code, code, code, 255});
        }
    return image;
}

struct Size {
    int width, height;
};

// The longer side gets `side` texels, but never more than the map has.
Size size_for(const Image& map, int side) {
    const int longer = std::max(map.width, map.height);
    const double scale = std::min(1.0, static_cast<double>(side) / longer);
    const auto scaled = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * scale))); };
    return {scaled(map.width), scaled(map.height)};
}

Image shrunk(const Image& map, Size size) {
    Image result(size.width, size.height);
    result.texels = shrink(map.texels, map.width, map.height, size.width, size.height);
    return result;
}

// Sizes fall by halves; the smallest that is good enough wins.
Slopes smallest_good(const Slopes& largest, const FallbackOptions& options, Wrap wrap, double& error) {
    constexpr int kLeastSide = 16;
    Slopes best = largest;
    error = 0.0;
    for (int divisor = 2; std::max(largest.width, largest.height) / divisor >= kLeastSide; divisor *= 2) {
        Slopes small(std::max(1, largest.width / divisor), std::max(1, largest.height / divisor));
        small.u = shrink(largest.u, largest.width, largest.height, small.width, small.height);
        small.v = shrink(largest.v, largest.width, largest.height, small.width, small.height);
        const double trial = normal_error(small, largest, wrap);
        if (trial > options.normal_tolerance) break;
        best = std::move(small);
        error = trial;
    }
    return best;
}

}  // namespace

Fallback bake_fallback(const Image& height01, Vec2 size, double depth, Wrap wrap,
                       const FallbackOptions& options) {
    assert(!height01.texels.empty() && size.x > 0.0 && size.y > 0.0 && depth > 0.0);
    assert(options.max_side >= 1 && options.max_side <= 4096 && options.normal_tolerance >= 0.0);
    Fallback fallback;
    const auto [low, high] = std::minmax_element(height01.texels.begin(), height01.texels.end());
    if (*low == *high) return fallback;
    const Size largest_size = size_for(height01, options.max_side);
    const Image heights = shrunk(height01, largest_size);
    const Slopes largest = slopes_of(heights, heights.width, heights.height, size, depth, wrap);
    const Slopes chosen = smallest_good(largest, options, wrap, fallback.normal_error);
    fallback.normal = normal_image(chosen);
    if (!options.occlusion) return fallback;
    const Image coarse = shrunk(heights, {std::max(1, chosen.width / 2), std::max(1, chosen.height / 2)});
    fallback.occlusion = occlusion_image(coarse, size, depth, wrap);
    const auto& texels = fallback.occlusion.texels;
    if (std::all_of(texels.begin(), texels.end(), [](std::uint8_t v) { return v >= 253; }))
        fallback.occlusion = {};
    return fallback;
}

}  // namespace burin
