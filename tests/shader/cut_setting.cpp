#include "cut_setting.hpp"

#include <algorithm>
#include <cmath>

#include "patterns.hpp"

namespace burin::testing {
namespace {

constexpr double kStep = 1.5e-4;
constexpr double kFar = 0.6;  // metres followed

}  // namespace

Pattern crossed_pattern() {
    Pattern p = base(kRise);
    p.size = {kCutTile, kCutTile};
    p.profiles = {vee(kCutWidth / 2, 0.011), groove(kCutWidth / 2, 0.010), ridge(kCutWidth / 2, kRise)};
    p.paths = {polyline({{0.0, 0.06}, {kCutTile, 0.06}}, 0), polyline({{0.05, 0.0}, {0.05, kCutTile}}, 1), polyline({{0.12, 0.12}, {0.22, 0.2}}, 2)};
    return p;
}

CutSetting prepare_cut(const Body& body, const Pattern& pattern) {
    CutSetting s{body, mesh_of(body, {{kCutTile, kCutTile}, true, 0.8}), {}, prepare(pattern), {}, nullptr, {}};
    s.table = pack_charts(s.mesh.set.borders, s.pattern.detail.depth);
    s.detail = s.pattern.detail;
    s.detail.charts = s.table.layout;
    const BaseMesh& base = s.mesh.base;
    s.base = std::make_unique<EmbreeScene>(base.positions, base.indices);
    const auto uv = [&](std::uint32_t i) { return Vec2{double(base.uvs[2 * i]) * kCutTile, double(base.uvs[2 * i + 1]) * kCutTile}; };
    std::vector<std::array<double, 2>> middles;
    for (const ChartBorder& b : s.mesh.set.borders) middles.push_back({(b.begin.x + b.end.x) / 2, (b.begin.y + b.end.y) / 2});
    std::sort(middles.begin(), middles.end());
    for (std::uint32_t t = 0; t + 2 < base.indices.size(); t += 3)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const Vec2 a = uv(base.indices[t + (k + 1) % 3]), b = uv(base.indices[t + (k + 2) % 3]);
            if (std::binary_search(middles.begin(), middles.end(), std::array{(a.x + b.x) / 2, (a.y + b.y) / 2})) s.seam.push_back({t, k});
        }
    return s;
}

SurfacePlace place_of(const CutSetting& s, const EmbreeHit& hit) { return place_on(s.mesh.base, hit.triangle, hit.u, hit.v, &s.mesh.charts); }

double march(const CutSetting& s, const Truth& truth, const Vec3& entry, const Vec3& direction) {
    const auto below = [&](double way, bool& outside) {
        const BodyPlace place = s.body.locate(entry + direction * way);
        const Vec2 uv = s.body.patches[place.patch].uv(place.st);
        outside = place.drop < -1e-6 && way > 4 * kStep;
        return place.drop >= s.detail.base_offset - truth.surface_at({uv.x * kCutTile, uv.y * kCutTile}).height - 1e-9;
    };
    bool outside = false;
    for (double way = 0; way < kFar; way += kStep) {
        if (below(way, outside)) {
            double low = std::max(way - kStep, 0.0), high = way;
            for (int i = 0; i < 12; ++i) {
                const double middle = 0.5 * (low + high);
                (below(middle, outside) ? high : low) = middle;
            }
            return high;
        }
        if (outside) return HUGE_VAL;
    }
    return HUGE_VAL;
}

}  // namespace burin::testing
