// Rays at the places where a decoder that takes bent stretches for straight ones goes wrong: along the surface, through it and
// back within a stretch; over the path line where the height scale changes; through the walls where elements end.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include <cpp/decode.hpp>

#include <scenes/scenes_2010.hpp>

#include "../property/random_pattern.hpp"
#include "patterns.hpp"
#include "rays.hpp"

namespace burin::testing {
namespace {

constexpr std::uint64_t kSeed = 20100705;
constexpr int kRays = 20000;

// Bends of every tightness, half of them with scales that change from end to end.
Pattern bends_pattern(Random& random) {
    Pattern p = base(kRise);
    p.profiles = {groove(0.03, 0.010), undercut(0.03, 0.008), ridge(0.03, 0.007), vee(0.03, 0.011), rail(0.03, 0.007)};
    for (int i = 0; i < 9; ++i) {
        const Vec2 centre{(i % 3 + 0.5) / 3.0, (i / 3 + 0.5) / 3.0};
        Path path = circle(centre, random.between(0.05, 0.12), std::uint32_t(i % 5), random.chance(0.5));
        if (i % 2 == 1) {
            path.closed = false;
            double scale = random.between(0.4, 0.8);
            for (Element& e : path.elements) {
                e.width0 = e.height0 = scale;
                scale = random.between(0.4, 0.8);
                e.width1 = e.height1 = scale;
            }
        }
        p.paths.push_back(path);
    }
    return p;
}

// Through a place of a feature's surface, nearly in its plane there.
PatternRay grazing_ray(const PreparedPattern& p, const Truth& truth, Random& random) {
    while (true) {
        Ray down;
        const ResolvedElement& e = p.resolved.elements[std::size_t(random.below(int(p.resolved.elements.size())))];
        const Vec2 on = lerp(e.element.p0, e.element.p2, random.uniform());
        const Vec2 at = on + random.direction() * random.between(0.0, 0.03);
        down.origin[0] = at.x, down.origin[1] = at.y, down.origin[2] = p.detail.base_offset;
        down.direction[2] = -1.0;
        const RayHit hit = truth.trace_ray(down);
        if (hit.element == kGround) continue;
        const double* n = hit.normal;
        const Vec2 side = random.direction();
        const double tilt = random.between(-0.05, 0.05);
        // In the facet's plane a way of this side falls by so much.
        const double fall = (side.x * n[0] + side.y * n[1]) / std::max(n[2], 1e-3) + tilt;
        if (fall < 0.05) continue;
        const Vec2 slope = side * (1.0 / fall);
        const Vec2 origin = at - slope * hit.t;
        return {{float(origin.x), float(origin.y)}, {float(slope.x), float(slope.y)}};
    }
}

TEST(Graze, BentRaysThatPassAFacetTwiceMeetIt) {
    Random random(kSeed);
    const PreparedPattern pattern = prepare(bends_pattern(random));
    const Truth truth = truth_of_stored(pattern);
    std::vector<AimedRay> rays;
    for (int i = 0; i < kRays; ++i) rays.push_back({grazing_ray(pattern, truth, random), RayKind::feature});
    const Agreement agreement = judge(pattern, rays, decode_rays(pattern, rays));
    std::cout << agreement.report("grazes");
    EXPECT_GE(agreement.facet_share(RayKind::feature), 0.999) << "seed " << kSeed << "\n" << agreement.worst;
    EXPECT_LE(agreement.borders[0], kRays / 50);
}

// A letter's side: the ray comes to the plateau's ground at once, passes over the round side, and goes through it and back
// within one cell. Of the two segments that the bend asks for, one was once spent above the ground.
TEST(Graze, SideOfALetterIsMet) {
    const PreparedPattern pattern = prepare(scenes::make_letters().parts[0].pattern);
    const Truth truth = truth_of_stored(pattern);
    std::vector<AimedRay> rays;
    for (int k = -50; k <= 50; ++k) {
        PatternRay ray{{0.0472373217f, 0.140546292f}, {1.21287191f, -5.35954332f}};
        ray.origin[0] += float(k) * 1e-6f;
        rays.push_back({ray, RayKind::feature});
    }
    const auto hits = decode_rays(pattern, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Verdict verdict = compare_hit(truth, pattern, rays[i].ray, hits[i], 1e-6);
        EXPECT_TRUE(verdict.border || !verdict.facet_differs) << "ray " << i << " falls " << hits[i].drop << ", should " << verdict.truth.t;
    }
}

// The distance of two answers along the ray, in widths of the feature; nothing where they are no answers to compare.
double widths_apart(const PatternRay& ray, const Verdict& verdict, double width) {
    if (verdict.border || verdict.facet_differs) return 0.0;
    return verdict.height * kDepth * std::hypot(1.0, double(ray.slope[0]), double(ray.slope[1])) / width;
}

TEST(Graze, ChangingHeightsBendNoRayAtThePathLine) {
    Random random(kSeed);
    const PreparedPattern pattern = prepare(bends_pattern(random));
    const Truth truth = truth_of_stored(pattern);
    const std::vector<AimedRay> rays = aim_rays(pattern, kRays, kSeed);
    const std::vector<ShadedHit> hits = decode_rays(pattern, rays);
    std::vector<double> apart(rays.size());
    in_parallel(rays.size(), [&](std::size_t i) {
        apart[i] = widths_apart(rays[i].ray, compare_hit(truth, pattern, rays[i].ray, hits[i], 2e-5), 0.06 * 0.4);
    });
    for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_LE(apart[i], 2e-4) << "ray " << i << ", seed " << kSeed;
}

// Features a three-hundredth of the tile wide that end as butts and on each other's lines.
Pattern small_ends_pattern() {
    Pattern p = base();
    p.profiles = {groove(0.0015, 0.003)};
    for (int i = 0; i < 24; ++i) {
        const double x = 0.1 + 0.13 * (i % 6), y = 0.1 + 0.21 * (i / 6), a = 0.4 * i;
        const Vec2 t{std::cos(a), std::sin(a)}, n{-t.y, t.x}, at{x, y};
        p.paths.push_back(with_caps(polyline({at - t * 0.03, at + t * 0.03}, 0), CapKind::butt));
        Path other = polyline({at, at + (n + t * (0.05 * i - 0.6)) * 0.04}, 0);
        other.end_cap = CapKind::butt;
        p.paths.push_back(other);
    }
    return p;
}

TEST(Graze, WallsStandWhereElementsEnd) {
    const PreparedPattern pattern = prepare(small_ends_pattern());
    const Truth truth = truth_of_stored(pattern);
    Random random(kSeed);
    int walls = 0;
    for (int i = 0; i < kRays; ++i) {
        const Element& e = pattern.resolved.elements[std::size_t(random.below(int(pattern.resolved.elements.size())))].element;
        const Vec2 at = (random.chance(0.5) ? e.p0 : e.p2) + random.direction() * random.between(0.0, 0.0015);
        const Vec2 slope = random.direction() * random.between(0.2, 3.0);
        const Vec2 origin = at - slope * random.between(0.0, 0.003);
        const AimedRay ray{{{float(origin.x), float(origin.y)}, {float(slope.x), float(slope.y)}}, RayKind::junction};
        const Verdict verdict = compare_hit(truth, pattern, ray.ray, decode_rays(pattern, {ray})[0], 1e-6);
        if (verdict.truth.facet != kWall || verdict.border) continue;
        ++walls;
        EXPECT_FALSE(verdict.facet_differs) << "ray " << i << ", seed " << kSeed;
        EXPECT_LE(widths_apart(ray.ray, verdict, 0.003), 1e-3) << "ray " << i << ", seed " << kSeed;
    }
    EXPECT_GE(walls, kRays / 100);
}

// Through the last part of an element that tapers to a point. Seen in widths of the feature a point is any distance away, so a decoder
// that takes the way there for a parabola loses the whole tip, which is too small a part of a pattern for rays aimed anywhere to tell.
PatternRay tip_ray(const std::vector<Element>& tapers, double half_width, Random& random) {
    const Element& e = tapers[std::size_t(random.below(int(tapers.size())))];
    const bool ends = e.width1 < e.width0;
    const Vec2 tip = ends ? e.p2 : e.p0, foot = ends ? e.p0 : e.p2;
    const double left = random.between(0.01, 0.3);
    const Vec2 at = lerp(tip, foot, left) + normal_of(unit(foot - tip)) * (random.between(-1.0, 1.0) * half_width * left);
    const Vec2 slope = random.direction() * random.between(0.2, 3.0);
    const Vec2 origin = at - slope * random.between(0.0, 0.003);
    return {{float(origin.x), float(origin.y)}, {float(slope.x), float(slope.y)}};
}

TEST(Graze, TipsOfTapersAreMet) {
    const PreparedPattern pattern = prepare(scenes::make_isolated_end().parts[0].pattern);
    std::vector<Element> tapers;
    for (const ResolvedElement& e : pattern.stored.elements)
        if (std::min(e.element.width0, e.element.width1) == 0.0) tapers.push_back(e.element);
    ASSERT_FALSE(tapers.empty());
    Random random(kSeed);
    std::vector<AimedRay> rays;
    for (int i = 0; i < kRays; ++i) rays.push_back({tip_ray(tapers, 0.0026, random), RayKind::feature});
    const Agreement agreement = judge(pattern, rays, decode_rays(pattern, rays));
    std::cout << agreement.report("tips");
    EXPECT_GE(agreement.facet_share(RayKind::feature), 0.999) << "seed " << kSeed << "\n" << agreement.worst;
    EXPECT_LE(agreement.height_differs[0], kRays / 1000) << agreement.worst;
    EXPECT_LE(agreement.borders[0], kRays / 50);
}

}  // namespace
}  // namespace burin::testing
