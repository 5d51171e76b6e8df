// The truth against itself by other ways: rays against heights, hits against dense sampling, maps against
// averages.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include <burin/evaluate.hpp>
#include <burin/rasterize.hpp>

#include "resolved_builder.hpp"

namespace burin {
namespace {

using testing::Random;

constexpr std::uint64_t kSeed = 20260517;

Ray ray_through(Vec2 p, double z, double x, double y, double down) {
    Ray ray;
    ray.origin[0] = p.x, ray.origin[1] = p.y, ray.origin[2] = z;
    ray.direction[0] = x, ray.direction[1] = y, ray.direction[2] = down;
    return ray;
}

Vec2 any_point(Random& random) { return {random.between(-0.2, 1.2), random.between(-0.2, 1.2)}; }

class EveryPattern : public ::testing::TestWithParam<int> {
  protected:
    std::uint64_t seed() const { return kSeed + static_cast<std::uint64_t>(GetParam()); }
    Wrap wrap() const { return GetParam() % 4 == 3 ? Wrap::clamp : Wrap::repeat; }
    bool overhangs() const { return GetParam() % 2 == 1; }
    ResolvedPattern pattern() const { return testing::random_resolved(seed(), overhangs(), wrap()); }
    void SetUp() override { RecordProperty("seed", std::to_string(seed())); }
};

TEST_P(EveryPattern, RayStraightDownMeetsTheSurface) {
    const Truth truth(pattern());
    Random random(seed());
    int same = 0;
    constexpr int kRays = 3000;
    for (int i = 0; i < kRays; ++i) {
        const Vec2 p = any_point(random);
        const RayHit hit = truth.trace_ray(ray_through(p, 0.01, 0, 0, -2));
        const SurfacePoint surface = truth.surface_at(p);
        ASSERT_TRUE(hit.hit && !hit.inside) << "seed " << seed() << " at " << p.x << ' ' << p.y;
        ASSERT_NEAR(hit.position[2], surface.height, 1e-12)
            << "seed " << seed() << " at " << p.x << ' ' << p.y;
        if (hit.element != surface.element || hit.facet != surface.facet) continue;
        ++same;
        for (int k = 0; k < 3; ++k)
            ASSERT_NEAR(hit.normal[k], surface.normal[k], 1e-6)
                << "seed " << seed() << " at " << p.x << ' ' << p.y;
    }
    // Where two surfaces coincide either may be named.
    EXPECT_GE(same, kRays * 98 / 100) << "seed " << seed();
}

TEST_P(EveryPattern, SlantedRayStopsAtTheFirstSolid) {
    const Truth truth(pattern());
    Random random(seed() + 1);
    for (int i = 0; i < 400; ++i) {
        const Vec2 p = any_point(random), d = random.direction();
        const double run = std::pow(10.0, random.between(-2.0, 1.5)) * 0.01;
        const Ray ray = ray_through(p, 0.004, d.x * run, d.y * run, -0.01);
        const RayHit hit = truth.trace_ray(ray);
        ASSERT_TRUE(hit.hit && !hit.inside) << "seed " << seed() << " ray " << i;
        const auto at = [&](double t) { return p + d * (run * t); };
        const auto z_at = [&](double t) { return 0.004 - 0.01 * t; };
        constexpr int kSteps = 150;
        for (int k = 0; k < kSteps; ++k) {
            const double t = hit.t * (k + 0.5) / kSteps;
            ASSERT_FALSE(truth.is_solid(at(t), z_at(t)))
                << "seed " << seed() << " ray " << i << " at " << t << " of " << hit.t;
        }
        EXPECT_FALSE(truth.is_solid(at(hit.t - 1e-9), z_at(hit.t - 1e-9)))
            << "seed " << seed() << " ray " << i;
        EXPECT_TRUE(truth.is_solid(at(hit.t + 1e-9), z_at(hit.t + 1e-9)))
            << "seed " << seed() << " ray " << i;
        const double against = hit.normal[0] * ray.direction[0] + hit.normal[1] * ray.direction[1] +
                               hit.normal[2] * ray.direction[2];
        EXPECT_LE(against, 1e-12) << "seed " << seed() << " ray " << i;
    }
}

TEST_P(EveryPattern, RaysUpAndLevelStopAtTheFirstSolid) {
    const Truth truth(pattern(), {.max_tiles = 8});
    Random random(seed() + 2);
    for (int i = 0; i < 200; ++i) {
        const Vec2 p = any_point(random), d = random.direction();
        const double z = random.between(-0.003, 0.002), climb = i % 2 ? 0.0 : random.between(0.0, 0.05);
        const RayHit hit = truth.trace_ray(ray_through(p, z, d.x, d.y, climb));
        ASSERT_EQ(hit.hit && hit.inside, truth.is_solid(p, z)) << "seed " << seed() << " ray " << i;
        if (hit.inside) {
            EXPECT_EQ(hit.t, 0.0);
            continue;
        }
        const double end = hit.hit ? std::min(hit.t, 3.0) : 3.0;
        for (int k = 0; k < 300; ++k) {
            const double t = end * (k + 0.5) / 300;
            ASSERT_FALSE(truth.is_solid(p + d * t, z + climb * t))
                << "seed " << seed() << " ray " << i << " at " << t;
        }
        if (!hit.hit) continue;
        EXPECT_TRUE(truth.is_solid(p + d * (hit.t + 1e-9), z + climb * (hit.t + 1e-9)))
            << "seed " << seed() << " ray " << i << " hit at " << hit.t;
    }
}

TEST_P(EveryPattern, SurfaceIsTheTopOfTheSolid) {
    const Truth truth(pattern());
    Random random(seed() + 3);
    for (int i = 0; i < 1000; ++i) {
        const Vec2 p = any_point(random);
        const SurfacePoint surface = truth.surface_at(p);
        EXPECT_TRUE(truth.is_solid(p, surface.height - 1e-10))
            << "seed " << seed() << " at " << p.x << ' ' << p.y;
        for (int k = 0; k < 20; ++k) {
            const double z = surface.height + 1e-10 + 0.006 * k / 20;
            ASSERT_FALSE(truth.is_solid(p, z))
                << "seed " << seed() << " at " << p.x << ' ' << p.y << " z " << z;
        }
        if (wrap() == Wrap::clamp) continue;
        const SurfacePoint moved = truth.surface_at(p + Vec2{3.0, -2.0});
        EXPECT_NEAR(moved.height, surface.height, 1e-11) << "seed " << seed() << " at " << p.x << ' ' << p.y;
    }
}

// H = min(max(ground, adds), cuts), written here once more from each element asked alone.
TEST_P(EveryPattern, HeightsCombineByMinAndMax) {
    const ResolvedPattern whole =
        testing::random_resolved(seed(), false, wrap());  // a formula for height fields
    const Truth truth(whole);
    Random random(seed() + 4);
    for (int i = 0; i < 500; ++i) {
        const Vec2 p = any_point(random);
        double base = truth.ground_at(p), cut = 1e300;
        for (std::uint32_t e = 0; e < whole.elements.size(); ++e) {
            const SurfacePoint alone = truth.surface_at(p, std::span(&e, 1));
            if (alone.element == kGround) continue;
            const std::uint32_t mask =
                whole.profiles[whole.styles[whole.elements[e].style].profile].internal_mask;
            base = std::max(base, alone.height);
            if ((mask >> alone.facet) & 1u) cut = std::min(cut, alone.height);
        }
        // An element alone whose cut lies above its add is named with its add, which then is the lower of the
        // two.
        EXPECT_NEAR(truth.surface_at(p).height, std::min(base, cut), 1e-12)
            << "seed " << seed() << " at " << p.x << ' ' << p.y;
    }
}

TEST_P(EveryPattern, MapIsTheMeanOfTheSurface) {
    const ResolvedPattern whole = pattern();
    const Truth truth(whole);
    const int width = 200, height = 160, n = 3;
    const Image map = rasterize_height(whole, width, height, {.samples = n, .threads = 2});
    Random random(seed() + 5);
    for (int i = 0; i < 3000; ++i) {
        const int x = random.below(width), y = random.below(height);
        double sum = 0;
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n; ++b)
                sum += truth.surface_at({(x + (a + 0.5) / n) / width, (y + (b + 0.5) / n) / height}).height;
        const double expected = 1.0 + (sum / (n * n) - whole.base_offset) / whole.depth;
        ASSERT_NEAR(map.at(x, y), expected, 1e-5) << "seed " << seed() << " texel " << x << ' ' << y;
    }
}

TEST_P(EveryPattern, MapDependsOnNeitherThreadsNorRegion) {
    const ResolvedPattern whole = pattern();
    const Image one = rasterize_height(whole, 150, 131, {.threads = 1});
    const Image four = rasterize_height(whole, 150, 131, {.threads = 4});
    EXPECT_EQ(one.texels, four.texels) << "seed " << seed();
    Random random(seed() + 6);
    for (int i = 0; i < 10; ++i) {
        TexelRegion region{random.below(140), random.below(120), 0, 0};
        region.width = 1 + random.below(150 - region.x);
        region.height = 1 + random.below(131 - region.y);
        const Image part = rasterize_height(whole, 150, 131, {.region = region});
        for (int y = 0; y < region.height; ++y)
            for (int x = 0; x < region.width; ++x)
                ASSERT_EQ(part.at(x, y), one.at(region.x + x, region.y + y))
                    << "seed " << seed() << " texel " << x << ' ' << y;
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EveryPattern, ::testing::Range(0, 16));

}  // namespace
}  // namespace burin
