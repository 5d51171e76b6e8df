#include "level_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <burin/rasterize.hpp>

namespace burin::bench {
namespace {

constexpr int kMapSamples = 40;   // per side of a map texel
constexpr int kFineSamples = 6;   // per side of a texel of the zoomed surface

void quantize(Image& map, int bits) {
    const double steps = std::pow(2.0, bits) - 1.0;
    for (float& v : map.texels) v = static_cast<float>(std::round(std::min(1.0, std::max(0.0, double(v))) * steps) / steps);
}

}  // namespace

ResolvedPattern resolved_or_exit(const Pattern& pattern, bool lenient) {
    ResolveOptions options;
    options.lenient = lenient;
    Result<ResolvedPattern> resolved = resolve_pattern(pattern, options);
    if (!resolved) {
        std::fprintf(stderr, "bench: %s\n", resolved.error().message.c_str());
        std::exit(3);
    }
    return std::move(*resolved);
}

Image sampled(const ResolvedPattern& pattern, int side, int samples, int threads) {
    RasterizeOptions options;
    options.samples = samples;
    options.threads = threads;
    options.level_tolerance = 4e-5;  // levels of stored patterns come from 16-bit codes
    return rasterize_height(pattern, side, side, options);
}

Image map_of(const Pattern& pattern, int texels, int bits) {
    Image map = sampled(resolved_or_exit(pattern, false), texels, kMapSamples);
    quantize(map, bits);
    return map;
}

Image zoomed(const Image& map, int zoom, Wrap wrap) {
    const double scale = static_cast<double>(map.width) / zoom;
    const auto inside = [&](int v) {
        return wrap == Wrap::repeat ? (v + map.width) % map.width : std::clamp(v, 0, map.width - 1);
    };
    Image surface(zoom, zoom);
    for (int y = 0; y < zoom; ++y) {
        for (int x = 0; x < zoom; ++x) {
            const double u = (x + 0.5) * scale - 0.5, v = (y + 0.5) * scale - 0.5;
            const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
            const double s = u - i, t = v - j;
            const auto at = [&](int a, int b) { return double(map.at(inside(a), inside(b))); };
            surface.at(x, y) = static_cast<float>((1 - t) * ((1 - s) * at(i, j) + s * at(i + 1, j)) +
                                                  t * ((1 - s) * at(i, j + 1) + s * at(i + 1, j + 1)));
        }
    }
    return surface;
}

std::vector<Segment> lines_of(const Image& surface, const std::vector<double>& heights, int texels) {
    std::vector<Segment> lines;
    for (const double height : heights)
        add_level_lines(surface, height, static_cast<double>(surface.width) / texels, lines);
    return lines;
}

std::vector<Segment> lines_of(const Pattern& pattern, const std::vector<double>& heights, int zoom, int texels) {
    return lines_of(sampled(resolved_or_exit(pattern, true), zoom, kFineSamples), heights, texels);
}

}  // namespace burin::bench
