// Rays that leave the chart they entered: the decoder against a march through the body in small steps.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include <burin/charts.hpp>
#include <cpp/decode.hpp>

#include "patterns.hpp"
#include "rays.hpp"
#include "volumes.hpp"

namespace burin::testing {
namespace {

constexpr double kWidth = 0.05;  // of the grooves, metres: the unit of all errors
constexpr double kTile = 0.25;
constexpr double kStep = 1.5e-4;
constexpr double kFar = 0.6;  // metres followed

// The ground lies below the mesh, so that every ray has a way to go.
Pattern crossed() {
    Pattern p = base(kRise);
    p.size = {kTile, kTile};
    p.profiles = {vee(kWidth / 2, 0.011), groove(kWidth / 2, 0.010), ridge(kWidth / 2, kRise)};
    p.paths = {polyline({{0.0, 0.06}, {kTile, 0.06}}, 0), polyline({{0.05, 0.0}, {0.05, kTile}}, 1), polyline({{0.12, 0.12}, {0.22, 0.2}}, 2)};
    return p;
}

struct Crossing {
    double distance;
    std::size_t triangle;
    double b, c;
};

// The nearest triangle whose front the ray meets.
Crossing meet(const BaseMesh& mesh, const Vec3& origin, const Vec3& direction) {
    Crossing best{HUGE_VAL, 0, 0, 0};
    const auto at = [&](std::uint32_t i) {
        return Vec3{double(mesh.positions[3 * i]), double(mesh.positions[3 * i + 1]), double(mesh.positions[3 * i + 2])};
    };
    for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        const Vec3 a = at(mesh.indices[t]), e = at(mesh.indices[t + 1]) - a, f = at(mesh.indices[t + 2]) - a;
        const Vec3 n = cross(e, f), o = origin - a;
        const double rate = dot(direction, n);
        if (rate >= 0) continue;
        const double way = -dot(o, n) / rate;
        if (way < 0 || way >= best.distance) continue;
        const Vec3 p = o + direction * way;
        const double area = dot(n, n), b = dot(cross(p, f), n) / area, c = dot(cross(e, p), n) / area;
        if (b >= 0 && c >= 0 && b + c <= 1) best = {way, t, b, c};
    }
    return best;
}

struct Setting {
    Body body;
    CutMesh mesh;
    ChartTable table;
    PreparedPattern pattern;
    PathDetail detail;
    std::vector<std::array<std::uint32_t, 2>> seam;  // triangles with an edge on a border: first corner, and that opposite of it
};

Setting prepare_setting(const Body& body) {
    Setting s{body, mesh_of(body, {{kTile, kTile}, true, 0.8}), {}, prepare(crossed()), {}, {}};
    s.table = pack_charts(s.mesh.set.borders, s.pattern.detail.depth);
    s.detail = s.pattern.detail;
    s.detail.charts = s.table.layout;
    const BaseMesh& base = s.mesh.base;
    const auto uv = [&](std::uint32_t i) { return Vec2{double(base.uvs[2 * i]) * kTile, double(base.uvs[2 * i + 1]) * kTile}; };
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

SurfacePlace interpolate(const CutMesh& mesh, const Crossing& at) {
    const BaseMesh& base = mesh.base;
    SurfacePlace place;
    place.normal = {0, 0, 0};
    const double weights[3] = {1.0 - at.b - at.c, at.b, at.c};
    Vec2 uv[3];
    Vec3 p[3];
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t i = base.indices[at.triangle + k];
        uv[k] = {double(base.uvs[2 * i]), double(base.uvs[2 * i + 1])};
        p[k] = {double(base.positions[3 * i]), double(base.positions[3 * i + 1]), double(base.positions[3 * i + 2])};
        place.uv = place.uv + uv[k] * weights[k];
        place.spread = place.spread + Vec3{uv[k].x * uv[k].x, uv[k].x * uv[k].y, uv[k].y * uv[k].y} * weights[k];
        for (std::size_t axis = 0; axis < 3; ++axis) place.normal[axis] += weights[k] * double(base.normals[3 * i + axis]);
        if (base.frames.empty()) continue;
        const SurfaceFrame& f = base.frames[i];
        const auto add = [&](Vec3& sum, const std::array<float, 3>& v) { sum = sum + Vec3{double(v[0]), double(v[1]), double(v[2])} * weights[k]; };
        add(place.du, f.du), add(place.dv, f.dv), add(place.duu, f.duu), add(place.duv, f.duv), add(place.dvv, f.dvv);
    }
    place.spread = place.spread - Vec3{place.uv.x * place.uv.x, place.uv.x * place.uv.y, place.uv.y * place.uv.y};
    place.normal = normalized(place.normal);
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    const double area = a.x * b.y - a.y * b.x;
    if (base.frames.empty()) {
        place.du = ((p[1] - p[0]) * b.y - (p[2] - p[0]) * a.y) * (1 / area);
        place.dv = ((p[2] - p[0]) * a.x - (p[1] - p[0]) * b.x) * (1 / area);
    }
    place.du = place.du - place.normal * dot(place.du, place.normal);
    place.dv = place.dv - place.normal * dot(place.dv, place.normal);
    place.chart = 2 * mesh.charts[base.indices[at.triangle]] + (area < 0 ? 1 : 0);
    return place;
}

// Way to the first solid point; infinity where the ray leaves the body.
double march(const Setting& s, const Truth& truth, const Vec3& entry, const Vec3& direction) {
    const auto below = [&](double way, bool& outside) {
        const BodyPlace place = s.body.locate(entry + direction * way);
        const Vec2 uv = s.body.patches[place.patch].uv(place.st);
        outside = place.drop < -1e-6 && way > 4 * kStep;
        return place.drop >= s.detail.base_offset - truth.surface_at({uv.x * kTile, uv.y * kTile}).height - 1e-9;
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

struct Errors {
    std::vector<double> widths;
    int rays = 0, lost = 0;
    double at(double share) const { return widths.empty() ? HUGE_VAL : widths[std::size_t(share * double(widths.size() - 1))]; }
    double lost_share() const { return rays > 0 ? double(lost) / rays : 1.0; }
};

// Of a triangle, over the edge opposite of corner k.
double height_over(const BaseMesh& base, std::uint32_t t, std::uint32_t k) {
    const auto at = [&](std::uint32_t i) {
        const std::uint32_t v = base.indices[t + i % 3];
        return Vec3{double(base.positions[3 * v]), double(base.positions[3 * v + 1]), double(base.positions[3 * v + 2])};
    };
    const Vec3 edge = at(k + 2) - at(k + 1), n = cross(edge, at(k) - at(k + 1));
    return std::sqrt(dot(n, n) / dot(edge, edge));
}

// Rays through triangles at the borders, 0 to 70 degrees from their normals.
Errors measure(const Setting& s, bool charted, int rays) {
    std::mt19937_64 random(20104);
    const auto uniform = [&](double low, double high) { return low + (high - low) * std::uniform_real_distribution<double>()(random); };
    const Truth truth(s.pattern.resolved);
    const Decoder decoder(s.pattern.textures, s.detail, charted ? &s.table.words : nullptr);
    Errors errors;
    for (int i = 0; i < rays; ++i) {
        const auto [t, k0] = s.seam[std::size_t(uniform(0, double(s.seam.size()) - 1e-9))];
        // Within some 2 cm of the edge.
        const BaseMesh& base = s.mesh.base;
        const double inward = std::min(uniform(0, 0.02) / height_over(base, t, k0), 1.0), share = uniform(0, 1 - inward);
        double weights[3];
        weights[k0] = inward, weights[(k0 + 1) % 3] = share, weights[(k0 + 2) % 3] = 1 - inward - share;
        const Crossing at{0, t, weights[1], weights[2]};
        Vec3 p{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = base.indices[t + k];
            const double weight = k == 0 ? 1 - at.b - at.c : (k == 1 ? at.b : at.c);
            p = p + Vec3{double(base.positions[3 * v]), double(base.positions[3 * v + 1]), double(base.positions[3 * v + 2])} * weight;
        }
        const Vec3 n = interpolate(s.mesh, at).normal, x = normalized(cross(std::abs(n[1]) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, n));
        const double tilt = uniform(0, 1.2217), turn = uniform(0, 6.283185307);
        const Vec3 out = n * std::cos(tilt) + (x * std::cos(turn) + cross(n, x) * std::sin(turn)) * std::sin(tilt);
        const Crossing entry = meet(base, p + out * 0.3, out * -1.0);
        if (!(entry.distance < HUGE_VAL)) continue;
        const SurfacePlace place = interpolate(s.mesh, entry);
        if (dot(place.normal, out) < 0.17) continue;
        const Vec3 from = p + out * (0.3 - entry.distance);
        const SurfaceHit hit = decoder.trace_surface(place, out * -1.0);
        const double right = march(s, truth, from, out * -1.0);
        ++errors.rays;
        if ((right < HUGE_VAL) != hit.met) ++errors.lost;
        else if (hit.met) errors.widths.push_back(std::abs(hit.way - right) / kWidth);
    }
    std::sort(errors.widths.begin(), errors.widths.end());
    return errors;
}

// The direct way over an edge: a groove's floor behind it looks the way that the face behind it does.
TEST(Charts, NormalsBeyondAnEdgeAreThoseOfItsFace) {
    for (const double degrees : {50.0, -50.0}) {
        const Body body = cut_bodies(kTile)[degrees > 0 ? 1 : 2];
        const Setting s = prepare_setting(body);
        const Decoder decoder(s.pattern.textures, s.detail, &s.table.words);
        const double c = std::cos(degrees * 3.14159265358979 / 180), t = std::sin(degrees * 3.14159265358979 / 180);
        int found = 0;
        for (int i = 0; i < 400; ++i) {
            // Down in the plane across the edge, towards the second face.
            const Vec3 direction = normalized({degrees > 0 ? 0.5 : 0.9, -1.0, 0.0});
            const Vec3 from{-0.002 - 1e-5 * (i % 40), 0.0, -0.45 + 0.0022 * i};
            const Crossing at = meet(s.mesh.base, from - direction * 0.1, direction);
            if (!(at.distance < 0.2)) continue;
            const SurfaceHit hit = decoder.trace_surface(interpolate(s.mesh, at), direction);
            const BodyPlace place = s.body.locate(from + direction * hit.way);
            if (!hit.met || place.patch != 1 || hit.element != kDecodedGround || hit.facet != kDecodedGroundFacet) continue;
            ++found;
            // In the first face's space x is across the edge and z up; uv has u along x there.
            EXPECT_NEAR(hit.normal[0], t, 1e-4);
            EXPECT_NEAR(hit.normal[2], c, 1e-4);
        }
        EXPECT_GT(found, 5) << degrees;
    }
}

class CutBodies : public ::testing::TestWithParam<int> {};

TEST_P(CutBodies, RaysGoOnBeyondBorders) {
    const Body body = cut_bodies(kTile)[std::size_t(GetParam())];
    const Setting setting = prepare_setting(body);
    ASSERT_TRUE(setting.mesh.set.needed);
    ASSERT_FALSE(setting.seam.empty());
    const int rays = std::getenv("BURIN_RAYS") != nullptr ? std::atoi(std::getenv("BURIN_RAYS")) : 600;
    const Errors with = measure(setting, true, rays);
    const Errors without = measure(setting, false, rays);
    for (const auto& [name, e] : {std::pair{"borders", with}, std::pair{"without", without}})
        std::printf("%-22s %s: median %.5f  95%% %.5f  99%% %.5f widths, lost %.2f %% of %d\n", body.name.c_str(), name, e.at(0.5), e.at(0.95), e.at(0.99),
                    100 * e.lost_share(), e.rays);
    EXPECT_LT(with.at(0.5), 0.002);
    EXPECT_LT(with.at(0.95), 0.02);
    EXPECT_LT(with.lost_share(), 0.01);
    EXPECT_GT(without.at(0.99) + without.lost_share(), 3 * (with.at(0.99) + with.lost_share()));
}

INSTANTIATE_TEST_SUITE_P(All, CutBodies, ::testing::Range(0, 6));

}  // namespace
}  // namespace burin::testing
