#include "level_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <burin/rasterize.hpp>
#include <burin/resolve.hpp>

#include "authored.hpp"

namespace burin::bench {
namespace {

constexpr int kMapSamples = 40;   // per side of a map texel
constexpr int kFineSamples = 6;   // per side of a texel of the zoomed surface
constexpr int kPart = 512;        // texels of the zoomed surface worked on at a time

void quantize(Image& map, int bits) {
    const double steps = std::pow(2.0, bits) - 1.0;
    for (float& v : map.texels) v = static_cast<float>(std::round(std::min(1.0, std::max(0.0, double(v))) * steps) / steps);
}

ResolvedPattern resolved_or_exit(const Pattern& pattern) {
    ResolveOptions options;
    options.lenient = true;
    Result<ResolvedPattern> resolved = resolve_pattern(pattern, options);
    if (!resolved) {
        std::fprintf(stderr, "resolution: %s\n", resolved.error().message.c_str());
        std::exit(3);
    }
    return std::move(*resolved);
}

// Calls make(x0, y0, side) for overlapping parts of the zoomed surface and gathers the level lines in map texels.
template <typename Make>
std::vector<Segment> level_lines(int zoom, int texels, Make make) {
    std::vector<Segment> lines;
    for (int y = 0; y < zoom - 1; y += kPart) {
        for (int x = 0; x < zoom - 1; x += kPart) {
            const int width = std::min(kPart + 1, zoom - x), height = std::min(kPart + 1, zoom - y);
            const Image part = make(x, y, width, height);
            for (const double level : kHalfHeights)
                add_level_lines(part, x, y, level, static_cast<double>(zoom) / texels, lines);
        }
    }
    return lines;
}

}  // namespace

std::vector<Segment> lines_of(const Pattern& pattern, int zoom, int texels) {
    const ResolvedPattern resolved = resolved_or_exit(pattern);
    return level_lines(zoom, texels, [&](int x, int y, int width, int height) {
        RasterizeOptions options;
        options.samples = kFineSamples;
        options.region = {x, y, width, height};
        return rasterize_height(resolved, zoom, zoom, options);
    });
}

std::vector<Segment> lines_of(const Image& map, int zoom) {
    const double scale = static_cast<double>(map.width) / zoom;
    return level_lines(zoom, map.width, [&](int x0, int y0, int width, int height) {
        Image part(width, height);
        const auto clamped = [&](int v) { return std::min(std::max(v, 0), map.width - 1); };
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const double u = (x0 + x + 0.5) * scale - 0.5, v = (y0 + y + 0.5) * scale - 0.5;
                const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
                const double s = u - i, t = v - j;
                const auto at = [&](int a, int b) { return double(map.at(clamped(a), clamped(b))); };
                part.at(x, y) = static_cast<float>((1 - t) * ((1 - s) * at(i, j) + s * at(i + 1, j)) +
                                                   t * ((1 - s) * at(i, j + 1) + s * at(i + 1, j + 1)));
            }
        }
        return part;
    });
}

Image map_of(const Pattern& pattern, int texels, int bits) {
    RasterizeOptions options;
    options.samples = kMapSamples;
    Image map = rasterize_height(resolved_or_exit(pattern), texels, texels, options);
    quantize(map, bits);
    return map;
}

}  // namespace burin::bench
