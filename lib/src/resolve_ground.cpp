// The ground: which level each piece of a groove lies in, and levels of steps brought together.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "resolve_curve.hpp"
#include "resolve_internal.hpp"

namespace burin::resolving {
namespace {

// Side of a chord on which p lies: cross > 0 is the right.
double side_level(const WorkPath& path, const Chord& chord, Vec2 by, Vec2 p) {
    return cross(chord.b - chord.a, p - (chord.a + by)) < 0.0 ? path.level : path.right_level;
}

struct Ground {
    double level = 0.0;
    double distance = 1e300;  // to the nearest step
};

Ground ground_at(const Work& work, const ChordIndex& steps, Vec2 p) {
    Ground ground{work.pattern.outer_level, 1e300};
    if (steps.chords().empty()) return ground;
    double perpendicular = -1.0;
    steps.visit_rings(p, [&](std::uint32_t k, Shift shift) {
        const Chord& chord = steps.chords()[k];
        const Vec2 by = shift * work.pattern.size;
        double along = 0.0;
        const double distance = segment_distance(chord.a + by, chord.b + by, p, along);
        const double across = std::abs(cross(unit(chord.b - chord.a), p - (chord.a + by)));
        // Two chords that share the nearest vertex: the one seen more from the side knows on which side p is.
        const double slack = 1e-9 * distance;
        if (distance < ground.distance - slack ||
            (distance <= ground.distance + slack && across > perpendicular)) {
            ground = {side_level(work.paths[chord.path], chord, by, p), distance};
            perpendicular = across;
        }
        return ground.distance;
    });
    return ground;
}

// First chord that a ray from `origin` meets, other than `own`; chords.size() when it meets none.
std::uint32_t first_hit(const Work& work, const ChordIndex& steps, Vec2 origin, Vec2 direction,
                        std::uint32_t own, bool& from_left) {
    const double far = 1.5 * std::max(work.pattern.size.x, work.pattern.size.y);
    const double stride = far / 64.0;
    double best = 1e300;
    std::uint32_t hit = static_cast<std::uint32_t>(steps.chords().size());
    for (double t = 0.0; t < far && best > t; t += stride) {
        const Vec2 a = origin + direction * t, b = origin + direction * (t + stride);
        steps.visit_box({{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}},
                        [&](std::uint32_t k, Shift shift) {
                            const Chord& chord = steps.chords()[k];
                            const Vec2 start = chord.a + shift * work.pattern.size, along = chord.b - chord.a;
                            const double det = cross(direction, along);
                            if ((k == own && shift == Shift{}) || det == 0.0) return;
                            const double at = cross(start - origin, along) / det,
                                         u = cross(start - origin, direction) / det;
                            if (at <= 1e-12 * far || at >= best || u < 0.0 || u > 1.0) return;
                            best = at, hit = k, from_left = cross(along, origin - start) < 0.0;
                        });
    }
    return hit;
}

// Sides of step paths that face each other bound one region and get one level; heights are scaled to fit.
// What cannot be scaled to fit is left and counted.
class LevelHarmony {
  public:
    LevelHarmony(Work& work, const ChordIndex& steps)
        : work_(work), steps_(steps), leader_(2 * work.paths.size()), uneven_(work.paths.size(), 0) {
        std::iota(leader_.begin(), leader_.end(), std::size_t{0});
    }

    void run() {
        for (std::uint32_t k = 0; k < steps_.chords().size(); ++k)
            if (is_sample(k)) face(k);
        settle();
    }

  private:
    std::size_t find(std::size_t i) {
        while (leader_[i] != i) i = leader_[i] = leader_[leader_[i]];
        return i;
    }

    // A few chords of every path: the first, and about every 32nd.
    bool is_sample(std::uint32_t k) const {
        const auto& chords = steps_.chords();
        return k == 0 || chords[k].path != chords[k - 1].path || k % 32 == 0;
    }

    void face(std::uint32_t k) {
        const Chord& chord = steps_.chords()[k];
        // Off the middle, so that symmetric patterns do not send rays through vertices.
        const Vec2 origin = lerp(chord.a, chord.b, 0.4871), normal = normal_of(unit(chord.b - chord.a));
        for (int right = 0; right < 2; ++right) {
            bool from_left = false;
            const Vec2 direction = unit((right ? normal : -normal) + 0.0137 * unit(chord.b - chord.a));
            const std::uint32_t hit = first_hit(work_, steps_, origin, direction, k, from_left);
            if (hit == steps_.chords().size()) continue;
            const std::size_t one = 2 * chord.path + static_cast<std::size_t>(right);
            const std::size_t other = 2 * steps_.chords()[hit].path + (from_left ? 0 : 1);
            // Far apart, one of them is wrong as a whole, or the ray slipped through: neither should follow.
            if (std::abs(level(one) - level(other)) > work_.pattern.depth / 16.0) {
                uneven_[chord.path] = 1;
                continue;
            }
            const std::size_t a = find(one), b = find(other);
            leader_[std::max(a, b)] = std::min(a, b);
        }
    }

    double& level(std::size_t side) {
        WorkPath& path = work_.paths[side / 2];
        return side % 2 == 0 ? path.level : path.right_level;
    }

    void settle() {
        const double equal = 1e-12 * work_.pattern.depth, alike = kLevelTolerance * work_.pattern.depth;
        std::vector<double> target(leader_.size(), 0.0);
        for (std::size_t i = 0; i < leader_.size(); ++i)
            if (find(i) == i)
                target[i] = std::abs(level(i) - work_.pattern.outer_level) <= alike
                                ? work_.pattern.outer_level
                                : level(i);
        for (std::size_t p = 0; p < work_.paths.size(); ++p) {
            WorkPath& path = work_.paths[p];
            if (!path.step) continue;
            const double left = target[find(2 * p)], right = target[find(2 * p + 1)];
            const double off = std::max(std::abs(left - path.level), std::abs(right - path.right_level));
            if (off > alike) uneven_[p] = 1;
            if (off > equal) fit(path, left, right);
            work_.stats.uneven_levels += uneven_[p];
        }
    }

    void fit(WorkPath& path, double left, double right) {
        const double scale = (right - left) / work_.rise[path.profile];
        const double before = path.elements.front().height0;
        if (!(scale > 0.5 * before && scale < std::min(2.0 * before, 4.0))) return;
        for (Element& e : path.elements) e.height0 = e.height1 = scale;
        path.level = left;
        path.right_level = left + work_.rise[path.profile] * scale;
    }

    Work& work_;
    const ChordIndex& steps_;
    std::vector<std::size_t> leader_;
    std::vector<char> uneven_;  // parallel to paths
};

// The ground of a run, asked where it is farthest from any step.
double run_level(const Work& work, const ChordIndex& steps, const std::vector<Vec2>& samples) {
    Ground best{work.pattern.outer_level, -1.0};
    for (const Vec2 p : samples) {
        const Ground ground = ground_at(work, steps, p);
        if (ground.distance > best.distance) best = ground;
    }
    return best.level;
}

}  // namespace

void find_levels(Work& work) {
    const ChordIndex steps(flatten(work, true), work.pattern.size, work.repeats());
    if (!steps.chords().empty()) LevelHarmony(work, steps).run();
    const double alike = kLevelTolerance * work.pattern.depth;
    for (WorkPath& path : work.paths) {
        path.levels.assign(path.elements.size(), path.level);
        if (path.step) continue;
        bool own_level = false;
        std::size_t run = 0;
        double level = run_level(work, steps, path.samples[0]);
        for (std::size_t i = 0; i < path.elements.size(); ++i) {
            if (i > 0 && path.region_starts[i]) level = run_level(work, steps, path.samples[++run]);
            own_level = own_level || std::abs(level - path.level) <= alike;
            path.levels[i] = level;
        }
        if (!own_level) ++work.stats.releveled;
    }
}

}  // namespace burin::resolving
