// What must hold for the resolved form of any pattern: invariants of its elements, and that the surface does
// not hang on how the same pattern is written down. Patterns at random; a failure names the seed.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <burin/evaluate.hpp>
#include <burin/resolve.hpp>

#include "random_pattern.hpp"

namespace burin {
namespace {

using testing::Random;

Pattern pattern_of(std::uint64_t seed, bool degenerate) {
    testing::RandomPatternOptions options;
    options.near_degenerate = degenerate;
    if (seed % 3 == 0) options.size = {1.0, 1.5};
    if (seed % 5 == 4) options.wrap = Wrap::clamp;
    options.motifs = 10;
    return testing::random_pattern(seed, options);
}

Vec2 arc_point(const Element& e, double s) {
    return e.kind == ElementKind::line ? lerp(e.p0, e.p2, s)
                                       : lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s);
}

// ---- invariants

void check_end(const ElementEnd& end) {
    EXPECT_TRUE(end.clip_angle >= 0.0 && end.clip_angle < std::numbers::pi);
    EXPECT_LE(end.shape, end.priority == Priority::both ? 3 : 2);
    EXPECT_TRUE(end.priority != Priority::none || end.shape == 0);
}

void check_element(const ResolvedPattern& pattern, const ResolvedElement& e) {
    const Element& c = e.element;
    const Vec2 size = pattern.size;
    ASSERT_LT(e.style, pattern.styles.size());
    EXPECT_GT(length(c.p2 - c.p0), 0.0);
    const bool inside = c.p0.x >= 0.0 && c.p0.x < size.x && c.p0.y >= 0.0 && c.p0.y < size.y;
    EXPECT_TRUE(inside || pattern.wrap == Wrap::clamp);
    for (const Vec2 p : {c.p0, c.kind == ElementKind::line ? c.p0 : c.p1, c.p2})
        EXPECT_TRUE(p.x >= -0.5 * size.x && p.x < 1.5 * size.x && p.y >= -0.5 * size.y && p.y < 1.5 * size.y);
    const double bend = c.kind == ElementKind::line ? 1.0 : dot(unit(c.p1 - c.p0), unit(c.p2 - c.p1));
    EXPECT_GE(bend, -1e-3);
    check_end(e.start);
    check_end(e.end);
}

TEST(ResolveProperty, ElementsKeepTheirPromises) {
    for (std::uint64_t seed = 1; seed <= 150; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Result<ResolvedPattern> resolved = resolve_pattern(pattern_of(seed, true), {.lenient = true});
        ASSERT_TRUE(resolved.ok()) << resolved.error().message;
        for (const ResolvedElement& e : resolved->elements) check_element(*resolved, e);
        for (const Junction& j : resolved->junctions) {
            if (resolved->wrap == Wrap::clamp) continue;
            EXPECT_TRUE(j.position.x >= 0.0 && j.position.x < resolved->size.x && j.position.y >= 0.0 &&
                        j.position.y < resolved->size.y);
        }
        for (std::size_t i = 1; i < resolved->elements.size(); ++i)
            EXPECT_GE(resolved->elements[i].path, resolved->elements[i - 1].path);
        if (HasFailure()) return;
    }
}

// Whether the ground is one all around p; points just beside a step may lie on either side of it.
bool is_clear(const Truth& truth, Vec2 p) {
    const double ground = truth.ground_at(p);
    for (int i = 0; i < 8; ++i)
        if (truth.ground_at(p + Vec2{std::cos(0.785 * i), std::sin(0.785 * i)} * 1e-3) != ground)
            return false;
    return true;
}

double distance_to(const ResolvedPattern& pattern, const Element& e, Vec2 p) {
    double least = 1e300;
    constexpr int kPoints = 64;
    Vec2 tile{0.0, 0.0};
    if (pattern.wrap == Wrap::repeat) {
        const Vec2 gap = p - arc_point(e, 0.5);
        tile = {std::round(gap.x / pattern.size.x) * pattern.size.x,
                std::round(gap.y / pattern.size.y) * pattern.size.y};
    }
    for (int i = 0; i < kPoints; ++i) {
        const Vec2 a = arc_point(e, static_cast<double>(i) / kPoints) + tile,
                   d = arc_point(e, (i + 1.0) / kPoints) + tile - a;
        const double along = std::clamp(dot(p - a, d) / std::max(dot(d, d), 1e-300), 0.0, 1.0);
        least = std::min(least, length(p - a - d * along));
    }
    return least;
}

// Wherever a groove runs, an element of it stands on the ground of that place.
TEST(ResolveProperty, GroovesStandOnTheGroundTheyLieIn) {
    int checked = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Pattern pattern = pattern_of(seed, true);
        const Result<ResolvedPattern> resolved = resolve_pattern(pattern, {.lenient = true});
        ASSERT_TRUE(resolved.ok());
        const Truth truth(*resolved);
        for (std::uint32_t k = 0; k < pattern.paths.size(); ++k)
            for (const Element& part : pattern.paths[k].elements)
                for (const double s : {0.1, 0.5, 0.9}) {
                    const Vec2 p = arc_point(part, s);
                    const auto& points = pattern.profiles[pattern.paths[k].profile].points;
                    if (points.back().h != points.front().h || !is_clear(truth, p)) continue;
                    ++checked;
                    const double ground = truth.ground_at(p);
                    bool stands = false;
                    for (const ResolvedElement& e : resolved->elements)
                        stands = stands || (e.path == k &&
                                            std::abs(resolved->styles[e.style].level - ground) <=
                                                1e-9 * resolved->depth &&
                                            distance_to(*resolved, e.element, p) <
                                                2e-4 * std::max(resolved->size.x, resolved->size.y));
                    EXPECT_TRUE(stands) << "path " << k << " at (" << p.x << ", " << p.y << ")";
                }
        if (HasFailure()) return;
    }
    EXPECT_GT(checked, 500);
}

// ---- crossings of lines against all pairs

struct Segment {
    Vec2 a, b;
};

int brute_crossings(const std::vector<Segment>& segments) {
    int n = 0;
    for (std::size_t i = 0; i < segments.size(); ++i)
        for (std::size_t k = i + 1; k < segments.size(); ++k)
            for (int x = -1; x <= 1; ++x)
                for (int y = -1; y <= 1; ++y) {
                    const Vec2 by{static_cast<double>(x), static_cast<double>(y)};
                    const Segment s = segments[i], t{segments[k].a + by, segments[k].b + by};
                    const double d0 = cross(s.b - s.a, t.a - s.a), d1 = cross(s.b - s.a, t.b - s.a);
                    const double e0 = cross(t.b - t.a, s.a - t.a), e1 = cross(t.b - t.a, s.b - t.a);
                    if ((d0 > 0.0) != (d1 > 0.0) && (e0 > 0.0) != (e1 > 0.0)) ++n;
                }
    return n;
}

TEST(ResolveProperty, EveryCrossingIsFoundOnce) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Random random(seed);
        Pattern pattern;
        pattern.profiles = {{{{-0.002, 0}, {0, -0.001}, {0.002, 0}}, {}}};
        std::vector<Segment> segments;
        for (int i = 0; i < 60; ++i) {
            const Vec2 a{random.uniform(), random.uniform()};
            segments.push_back({a, a + random.direction() * random.between(0.01, 0.7)});
            Path path;
            Element e;
            e.p0 = segments.back().a;
            e.p2 = segments.back().b;
            path.elements = {e};
            pattern.paths.push_back(path);
        }
        const Result<ResolvedPattern> resolved = resolve_pattern(pattern, {.snap = 0.0});
        ASSERT_TRUE(resolved.ok());
        const auto found = std::count_if(resolved->junctions.begin(), resolved->junctions.end(),
                                         [](const Junction& j) { return j.kind == JunctionKind::crossing; });
        EXPECT_EQ(found, brute_crossings(segments)) << "seed " << seed;
    }
}

// ---- the same pattern written down otherwise

Pattern translated(Pattern pattern, Vec2 by) {
    for (Path& path : pattern.paths)
        for (Element& e : path.elements) e.p0 = e.p0 + by, e.p1 = e.p1 + by, e.p2 = e.p2 + by;
    return pattern;
}

// Each path from its other end, each profile mirrored.
Pattern reversed(Pattern pattern) {
    for (Profile& profile : pattern.profiles) {
        const double rise = profile.points.back().h;
        std::reverse(profile.points.begin(), profile.points.end());
        for (ProfilePoint& p : profile.points) p.b = -p.b, p.h -= rise;
    }
    for (std::size_t i = 0; i < pattern.paths.size(); ++i) {
        Path& path = pattern.paths[i];
        path.level -= pattern.profiles[path.profile].points.back().h * path.elements.front().height0;
        std::reverse(path.elements.begin(), path.elements.end());
        for (Element& e : path.elements) {
            std::swap(e.p0, e.p2);
            std::swap(e.width0, e.width1);
            std::swap(e.height0, e.height1);
        }
        std::swap(path.start_cap, path.end_cap);
    }
    return pattern;
}

// Each element in two.
Pattern halved(Pattern pattern) {
    for (Path& path : pattern.paths) {
        std::vector<Element> halves;
        for (const Element& e : path.elements) {
            Element a = e, b = e;
            a.p2 = b.p0 = arc_point(e, 0.5);
            a.p1 = lerp(e.p0, e.p1, 0.5);
            b.p1 = lerp(e.p1, e.p2, 0.5);
            a.width1 = b.width0 = 0.5 * (e.width0 + e.width1);
            a.height1 = b.height0 = 0.5 * (e.height0 + e.height1);
            halves.push_back(a);
            halves.push_back(b);
        }
        path.elements = std::move(halves);
    }
    return pattern;
}

// Surfaces may differ in a hair's breadth along walls; points at which they differ are counted.
void expect_same_surface(const Pattern& a, const Pattern& b, Vec2 by, std::uint64_t seed) {
    // Snapping moves whole elements, so that halves move otherwise.
    const ResolveOptions options{.snap = 1e-9, .lenient = true};
    const Result<ResolvedPattern> one = resolve_pattern(a, options), other = resolve_pattern(b, options);
    ASSERT_TRUE(one.ok() && other.ok());
    EXPECT_EQ(one->stats.dropped_paths, other->stats.dropped_paths);
    const Truth first(*one), second(*other);
    Random random(seed);
    int different = 0, asked = 0;
    Vec2 last;
    for (const ResolvedElement& e : one->elements)
        for (int i = 0; i < 25; ++i) {
            const Vec2 p = arc_point(e.element, random.between(-0.1, 1.1)) +
                           random.direction() * random.between(0.0, 0.03);
            if (a.wrap == Wrap::clamp && (p.x <= 0.0 || p.y <= 0.0 || p.x >= a.size.x || p.y >= a.size.y))
                continue;
            ++asked;
            if (std::abs(first.surface_at(p).height - second.surface_at(p + by).height) <= 1e-6 * a.depth)
                continue;
            ++different;
            last = p;
        }
    EXPECT_LE(different, asked / 2000)
        << "of " << asked << ", the last at (" << last.x << ", " << last.y << ")";
}

TEST(ResolveProperty, MovingThePatternMovesTheSurface) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Pattern pattern = pattern_of(seed, false);
        if (pattern.wrap == Wrap::clamp) continue;
        Random random(seed);
        const Vec2 by{random.between(-2.0, 2.0), random.between(-2.0, 2.0)};
        expect_same_surface(pattern, translated(pattern, by), by, seed);
    }
}

TEST(ResolveProperty, TurningPathsRoundChangesNothing) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Pattern pattern = pattern_of(seed, false);
        expect_same_surface(pattern, reversed(pattern), {0.0, 0.0}, seed);
    }
}

TEST(ResolveProperty, HalvingElementsChangesNothing) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Pattern pattern = pattern_of(seed, false);
        expect_same_surface(pattern, halved(pattern), {0.0, 0.0}, seed);
    }
}

}  // namespace
}  // namespace burin
