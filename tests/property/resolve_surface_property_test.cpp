// What resolve makes of a pattern, judged from the pattern itself: away from ends and corners the surface
// follows from DESIGN 2 without any priority. Grooves: the lower wins; ridges: the higher; a groove cuts a
// ridge; features stand on the ground of their region, wherever resolve had to split them. The oracle here
// knows paths only: dense points on the curves, no ends, no clip lines, no resolved element.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <burin/evaluate.hpp>

#include "random_pattern.hpp"

namespace burin {
namespace {

using testing::Random;

constexpr std::uint64_t kSeed = 77001;
constexpr int kDense = 256;

Vec2 on_curve(const Element& e, double u) {
    return e.kind == ElementKind::line ? lerp(e.p0, e.p2, u)
                                       : lerp(lerp(e.p0, e.p1, u), lerp(e.p1, e.p2, u), u);
}
Vec2 tangent_of(const Element& e, double u) {
    return unit(e.kind == ElementKind::line ? e.p2 - e.p0 : lerp(e.p1 - e.p0, e.p2 - e.p1, u));
}

struct Nearest {
    double distance = 1e300, u = 0, offset = 0;
};

// Nearest point of the arc: the best of dense places, then golden section around it.
Nearest nearest_on(const Element& e, Vec2 p) {
    int best = 0;
    double least = 1e300;
    for (int i = 0; i <= kDense; ++i) {
        const double d = length(p - on_curve(e, i / static_cast<double>(kDense)));
        if (d < least) least = d, best = i;
    }
    double low = std::max(0, best - 1) / static_cast<double>(kDense),
           high = std::min(kDense, best + 1) / static_cast<double>(kDense);
    for (int i = 0; i < 80; ++i) {
        const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
        (length(p - on_curve(e, a)) < length(p - on_curve(e, b)) ? high : low) =
            length(p - on_curve(e, a)) < length(p - on_curve(e, b)) ? b : a;
    }
    const double u = 0.5 * (low + high);
    return {length(p - on_curve(e, u)), u, dot(p - on_curve(e, u), normal_of(tangent_of(e, u)))};
}

double height_of(const Profile& profile, double b) {
    for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
        const ProfilePoint p = profile.points[i], q = profile.points[i + 1];
        if (p.b <= b && b < q.b) return p.h + (q.h - p.h) * (b - p.b) / (q.b - p.b);
    }
    return 0.0;
}

enum class Nature { groove, ridge, other };
// A ridge rises and falls once.
Nature nature_of(const Profile& profile) {
    bool up = false, down = false, falls = false, rises_again = false;
    for (std::size_t i = 0; i < profile.points.size(); ++i) {
        up = up || profile.points[i].h > 0;
        down = down || profile.points[i].h < 0;
        if (i == 0) continue;
        falls = falls || profile.points[i].h < profile.points[i - 1].h;
        rises_again = rises_again || (falls && profile.points[i].h > profile.points[i - 1].h);
    }
    if (up == down) return Nature::other;
    return down ? Nature::groove : rises_again ? Nature::other : Nature::ridge;
}

// Distance of p from the box of the control polygon: never more than from the curve.
double box_distance(const Element& e, Vec2 p) {
    const Vec2 control = e.kind == ElementKind::line ? e.p0 : e.p1;
    const double dx = std::max(
        {std::min({e.p0.x, control.x, e.p2.x}) - p.x, p.x - std::max({e.p0.x, control.x, e.p2.x}), 0.0});
    const double dy = std::max(
        {std::min({e.p0.y, control.y, e.p2.y}) - p.y, p.y - std::max({e.p0.y, control.y, e.p2.y}), 0.0});
    return std::hypot(dx, dy);
}

class Oracle {
  public:
    explicit Oracle(const Pattern& pattern) : pattern_(pattern) {
        for (std::uint32_t i = 0; i < pattern.paths.size(); ++i)
            for (std::uint32_t k = 0; k < pattern.paths[i].elements.size(); ++k) pieces_.push_back({i, k});
        for (const Path& path : pattern.paths) widest_ = std::max(widest_, reach_of(path));
    }

    bool is_step(const Path& path) const {
        const Profile& profile = pattern_.profiles[path.profile];
        return profile.points.front().h != profile.points.back().h;
    }
    double reach_of(const Path& path) const {
        double reach = 0, scale = 1;
        for (const ProfilePoint& p : pattern_.profiles[path.profile].points)
            reach = std::max(reach, std::abs(p.b));
        for (const Element& e : path.elements) scale = std::max({scale, e.width0, e.width1});
        return reach * scale;
    }

    // Height at p, or nothing where an end, a corner or a step is too near for a plain answer.
    std::optional<double> height_at(Vec2 p, double& ground) const {
        const std::optional<double> level = ground_at(p);
        if (!level) return std::nullopt;
        ground = *level;
        double base = ground, cut = 1e300;
        int others = 0, features = 0;
        std::vector<Vec2> steps, ways;  // directions of what is near
        for (const auto& [path_index, index] : pieces_) {
            const Path& path = pattern_.paths[path_index];
            const double reach = reach_of(path);
            for (int i = -1; i <= 1; ++i)
                for (int j = -1; j <= 1; ++j) {
                    const Vec2 q = p + Vec2{i * pattern_.size.x, j * pattern_.size.y};
                    const Element& e = path.elements[index];
                    const double far = 4.5 * (is_step(path) ? widest_ : reach);
                    if (box_distance(e, q) > far) continue;
                    const Nearest near = nearest_on(e, q);
                    if (near.distance > far) continue;
                    if (is_step(path)) {
                        if (!straight_step(e, near, reach)) return std::nullopt;
                        steps.push_back(tangent_of(e, near.u));
                        continue;
                    }
                    if (!plain(path, index, near, reach)) return std::nullopt;
                    ways.push_back(tangent_of(e, near.u));
                    if (near.u <= 1e-6 || near.u >= 1 - 1e-6) continue;  // a smooth neighbour holds the foot
                    const double width = e.width0 + (e.width1 - e.width0) * near.u;
                    const double height = e.height0 + (e.height1 - e.height0) * near.u;
                    const Profile& profile = pattern_.profiles[path.profile];
                    const double b = near.offset / width;
                    if (std::abs(near.offset) > reach || b < profile.points.front().b ||
                        b > profile.points.back().b)
                        continue;
                    const double z = ground + height * height_of(profile, b);
                    const Nature nature = nature_of(profile);
                    ++features;
                    others += nature == Nature::other;
                    if (nature == Nature::ridge || nature == Nature::other) base = std::max(base, z);
                    if (nature == Nature::groove || (nature == Nature::other && z < ground))
                        cut = std::min(cut, z);
                }
        }
        // Very slanting crossings with a step end in a hip.
        for (const Vec2 step : steps)
            for (const Vec2 way : ways)
                if (std::abs(cross(step, way)) < 0.25) return std::nullopt;
        if (others > 0 && features > 1) return std::nullopt;
        if (features == 0) return std::nullopt;
        return std::min(base, cut);
    }

    // Level on p's side of the nearest step path; nothing where that is a corner.
    std::optional<double> ground_at(Vec2 p) const {
        double least = 1e300, level = pattern_.outer_level;
        bool sure = true;
        for (const auto& [path_index, index] : pieces_) {
            const Path& path = pattern_.paths[path_index];
            if (!is_step(path)) continue;
            for (int i = -1; i <= 1; ++i)
                for (int j = -1; j <= 1; ++j) {
                    const Vec2 q = p + Vec2{i * pattern_.size.x, j * pattern_.size.y};
                    if (box_distance(path.elements[index], q) >= least) continue;
                    const Nearest near = nearest_on(path.elements[index], q);
                    if (near.distance >= least) continue;
                    least = near.distance;
                    sure = near.u > 1e-4 && near.u < 1 - 1e-4 && near.distance > 1e-6;
                    const Profile& profile = pattern_.profiles[path.profile];
                    level = path.level +
                            (near.offset > 0 ? profile.points.back().h - profile.points.front().h : 0.0);
                }
        }
        if (!sure) return std::nullopt;
        return level;
    }

  private:
    // A step near p says nothing more than which level p has: p is beyond its profile and away from its
    // corners.
    bool straight_step(const Element& e, const Nearest& near, double reach) const {
        const Vec2 foot = on_curve(e, near.u);
        return e.kind == ElementKind::line && near.distance > reach && length(foot - e.p0) > 4.5 * widest_ &&
               length(foot - e.p2) > 4.5 * widest_;
    }

    // The foot lies well inside the element, or beyond a smooth joint to a neighbour.
    bool plain(const Path& path, std::size_t index, const Nearest& near, double reach) const {
        const Element& e = path.elements[index];
        const Vec2 foot = on_curve(e, near.u);
        const std::size_t n = path.elements.size();
        for (int end = 0; end < 2; ++end) {
            const double away = length(foot - (end == 0 ? e.p0 : e.p2));
            if (away > 4.5 * reach) continue;
            const bool last = end == 0 ? index == 0 : index + 1 == n;
            if (last && !path.closed) return false;
            const Element& next = path.elements[end == 0 ? (index + n - 1) % n : (index + 1) % n];
            const Vec2 a = end == 0 ? tangent_of(next, 1) : tangent_of(e, 1),
                       b = end == 0 ? tangent_of(e, 0) : tangent_of(next, 0);
            const double turn = std::abs(std::atan2(cross(a, b), dot(a, b)));
            if (turn > 1e-6) return false;
        }
        // Inside of a tight bend the nearest point is not alone.
        if (e.kind == ElementKind::quadratic) {
            const Vec2 dd = (e.p0 - e.p1 * 2.0 + e.p2) * 2.0;
            for (double u = 0; u <= 1.0; u += 0.02) {
                const Vec2 du = lerp(e.p1 - e.p0, e.p2 - e.p1, u) * 2.0;
                const double l = length(du);
                if (std::abs(cross(du, dd)) / (l * l * l) * reach > 0.7) return false;
            }
        }
        return true;
    }

    const Pattern& pattern_;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pieces_;
    double widest_ = 0;
};

class ResolvedSurface : public ::testing::TestWithParam<int> {};

TEST_P(ResolvedSurface, FollowsFromThePattern) {
    const std::uint64_t seed = kSeed + static_cast<std::uint64_t>(GetParam());
    RecordProperty("seed", std::to_string(seed));
    const Pattern pattern = testing::random_pattern(
        seed, {.motifs = 6, .step_loops = 2, .width = 0.004, .near_degenerate = false});
    const Result<ResolvedPattern> resolved = resolve_pattern(pattern, {.snap = 1e-9});
    ASSERT_TRUE(resolved.ok()) << "seed " << seed << ": " << resolved.error().message;
    const Truth truth(*resolved);
    const Oracle oracle(pattern);
    Random random(seed);
    int asked = 0;
    for (int i = 0; i < 3000; ++i) {
        const Path& path =
            pattern.paths[static_cast<std::size_t>(random.below(static_cast<int>(pattern.paths.size())))];
        const Element& e =
            path.elements[static_cast<std::size_t>(random.below(static_cast<int>(path.elements.size())))];
        const double u = random.uniform();
        const Vec2 p = on_curve(e, u) +
                       normal_of(tangent_of(e, u)) * (random.between(-1.1, 1.1) * oracle.reach_of(path));
        double ground = 0;
        const std::optional<double> expected = oracle.height_at(p, ground);
        if (!expected) continue;
        ++asked;
        const SurfacePoint surface = truth.surface_at(p);
        EXPECT_NEAR(surface.ground, ground, 1e-12) << "seed " << seed << " at " << p.x << ' ' << p.y;
        // Where a scaled path is split at a step, its scale stands still beyond the split.
        EXPECT_NEAR(surface.height, *expected, 1e-6) << "seed " << seed << " at " << p.x << ' ' << p.y;
    }
    for (int i = 0; i < 50; ++i) {
        const Vec2 p{random.uniform(), random.uniform()};
        const std::optional<double> level = oracle.ground_at(p);
        if (!level) continue;
        EXPECT_NEAR(truth.ground_at(p), *level, 1e-12) << "seed " << seed << " at " << p.x << ' ' << p.y;
    }
    EXPECT_GT(asked, 20) << "seed " << seed << ": too few plain places";
}

INSTANTIATE_TEST_SUITE_P(Seeds, ResolvedSurface, ::testing::Range(0, 24));

}  // namespace
}  // namespace burin
