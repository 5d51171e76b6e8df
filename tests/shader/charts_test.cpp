// Rays that leave the chart they entered: the decoder against a march through the body in small steps.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include <cpp/decode.hpp>

#include "cut_setting.hpp"

namespace burin::testing {
namespace {

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
Errors measure(const CutSetting& s, bool charted, int rays) {
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
        const EmbreeHit at{0, t / 3, weights[1], weights[2]};
        Vec3 p{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = base.indices[t + k];
            const double weight = k == 0 ? 1 - at.u - at.v : (k == 1 ? at.u : at.v);
            p = p + Vec3{double(base.positions[3 * v]), double(base.positions[3 * v + 1]), double(base.positions[3 * v + 2])} * weight;
        }
        const Vec3 n = place_of(s, at).normal, x = normalized(cross(std::abs(n[1]) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}, n));
        const double tilt = uniform(0, 1.2217), turn = uniform(0, 6.283185307);
        const Vec3 out = n * std::cos(tilt) + (x * std::cos(turn) + cross(n, x) * std::sin(turn)) * std::sin(tilt);
        const EmbreeHit entry = s.base->trace(p + out * 0.3, out * -1.0, 0.0);
        if (!(entry.distance < HUGE_VAL)) continue;
        const SurfacePlace place = place_of(s, entry);
        if (dot(place.normal, out) < 0.17) continue;
        const Vec3 from = p + out * (0.3 - entry.distance);
        const SurfaceHit hit = decoder.trace_surface(place, out * -1.0);
        const double right = march(s, truth, from, out * -1.0);
        ++errors.rays;
        if ((right < HUGE_VAL) != hit.met) ++errors.lost;
        else if (hit.met) errors.widths.push_back(std::abs(hit.way - right) / kCutWidth);
    }
    std::sort(errors.widths.begin(), errors.widths.end());
    return errors;
}

// The direct way over an edge: a groove's floor behind it looks the way that the face behind it does.
TEST(Charts, NormalsBeyondAnEdgeAreThoseOfItsFace) {
    for (const double degrees : {50.0, -50.0}) {
        const Body body = cut_bodies(kCutTile)[degrees > 0 ? 1 : 2];
        const CutSetting s = prepare_cut(body);
        const Decoder decoder(s.pattern.textures, s.detail, &s.table.words);
        const double c = std::cos(degrees * 3.14159265358979 / 180), t = std::sin(degrees * 3.14159265358979 / 180);
        int found = 0;
        for (int i = 0; i < 400; ++i) {
            // Down in the plane across the edge, towards the second face.
            const Vec3 direction = normalized({degrees > 0 ? 0.5 : 0.9, -1.0, 0.0});
            const Vec3 from{-0.002 - 1e-5 * (i % 40), 0.0, -0.45 + 0.0022 * i};
            const EmbreeHit at = s.base->trace(from - direction * 0.1, direction, 0.0);
            if (!(at.distance < 0.2)) continue;
            const SurfaceHit hit = decoder.trace_surface(place_of(s, at), direction);
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
    const Body body = cut_bodies(kCutTile)[std::size_t(GetParam())];
    const CutSetting setting = prepare_cut(body);
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

INSTANTIATE_TEST_SUITE_P(All, CutBodies, ::testing::Range(0, int(cut_bodies(kCutTile).size())));

}  // namespace
}  // namespace burin::testing
