#include "timing.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

namespace burin::bench {
namespace {

double seconds_of(const Asset& asset, const RenderOptions& options) {
    const std::clock_t before = std::clock();
    const auto picture = render_asset(asset, options);
    return picture ? double(std::clock() - before) / CLOCKS_PER_SEC : 1e9;
}

}  // namespace

void PassTimer::try_once() {
    options_.samples = 1;
    one_ = std::min(one_, seconds_of(asset_, options_));
    options_.samples = 4;
    four_ = std::min(four_, seconds_of(asset_, options_));
}

PixelWork work_of(const Subject& subject, const PlaneView& view) {
    const ResolvedPattern& pattern = subject.prepared.resolved;
    const PlaneCamera camera = camera_of(view, pattern.size);
    const Extent extent = extent_of(view, pattern);
    const double a = view.light.azimuth * std::numbers::pi / 180.0, e = view.light.elevation * std::numbers::pi / 180.0;
    const Vec2 from_light = Vec2{-std::sin(a), -std::cos(a)} * (std::cos(e) / std::sin(e));
    const Decoder decoder(subject.prepared.textures, subject.prepared.detail);
    DecodeCounts counts;
    double pixels = 0.0;
    for (int y = 0; y < view.height; y += 2)
        for (int x = 0; x < view.width; x += 2) {
            const double across = (2.0 * (x + 0.5) / view.width - 1.0) * camera.tangent * camera.aspect,
                         up = (1.0 - 2.0 * (y + 0.5) / view.height) * camera.tangent;
            std::array<double, 3> way;
            for (std::size_t i = 0; i < 3; ++i) way[i] = camera.forward[i] + across * camera.right[i] + up * camera.up[i];
            if (way[1] >= 0.0) continue;
            const double t = camera.eye[1] / -way[1];
            const Vec2 at{camera.eye[0] + way[0] * t + pattern.size.x * 0.5, camera.eye[2] + way[2] * t + pattern.size.y * 0.5};
            const double u = at.x / pattern.size.x, v = at.y / pattern.size.y;
            if (u < extent.low.x || u > extent.high.x || v < extent.low.y || v > extent.high.y) continue;
            const DecodedHit hit = decoder.trace(at, {way[0] / -way[1], way[2] / -way[1]}, &counts);
            decoder.trace(hit.position - from_light * hit.drop, from_light, &counts);
            pixels += 1.0;
        }
    const auto mean = [&](std::uint64_t count) { return double(count) / std::max(pixels, 1.0); };
    return {mean(counts.cells), mean(counts.elements), mean(counts.styles), mean(counts.profiles), mean(counts.lists)};
}

}  // namespace burin::bench
