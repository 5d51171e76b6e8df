// Crossings, splits of grooves at steps, and the ground: which level each piece of a groove lies in.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "resolve_curve.hpp"
#include "resolve_internal.hpp"

namespace burin::resolving {
namespace {

// A crossing of two arcs; parameters on the elements, position near the first path.
struct ArcCrossing {
    std::uint32_t path[2], element[2];
    double s[2];
    Vec2 position;
};

// Newton on first(s) = second(u) + by from the chords' crossing; kept only where it stays near the chords.
ArcCrossing refine(const Work& work, const ChordIndex& index, const ChordCrossing& found) {
    const Chord* chord[2] = {&index.chords()[found.first], &index.chords()[found.second]};
    const Vec2 by = found.shift * index.size();
    ArcCrossing crossing{};
    const Element* element[2];
    for (int k = 0; k < 2; ++k) {
        crossing.path[k] = chord[k]->path;
        crossing.element[k] = chord[k]->element;
        element[k] = &work.paths[chord[k]->path].elements[chord[k]->element];
        double along = 0.0;
        segment_distance(chord[k]->a, chord[k]->b, k == 0 ? found.position : found.position - by, along);
        crossing.s[k] = chord[k]->s0 + along * (chord[k]->s1 - chord[k]->s0);
    }
    crossing.position = found.position;
    double s = crossing.s[0], u = crossing.s[1];
    for (int round = 0; round < 8; ++round) {
        const Vec2 gap = curve::point(*element[0], s) - curve::point(*element[1], u) - by;
        const Vec2 a = curve::derivative(*element[0], s), b = curve::derivative(*element[1], u);
        const double det = cross(b, a);
        if (std::abs(det) <= 1e-9 * length(a) * length(b)) break;
        s -= cross(b, gap) / det;
        u -= cross(a, gap) / det;
    }
    const Vec2 meeting = curve::point(*element[0], s);
    const bool inside = s >= -1e-9 && s <= 1.0 + 1e-9 && u >= -1e-9 && u <= 1.0 + 1e-9;
    if (inside && length(meeting - found.position) <= 8.0 * work.tolerance) {
        crossing.s[0] = std::clamp(s, 0.0, 1.0);
        crossing.s[1] = std::clamp(u, 0.0, 1.0);
        crossing.position = curve::point(*element[0], crossing.s[0]);
    }
    return crossing;
}

Vec2 copy_near(const Work& work, Vec2 target, Vec2 p) {
    if (!work.repeats()) return target;
    const Vec2 size = work.pattern.size;
    return {target.x + std::round((p.x - target.x) / size.x) * size.x,
            target.y + std::round((p.y - target.y) / size.y) * size.y};
}

// Paths that were joined at an end meet there; what the chords do within the snap distance of it is no crossing.
bool near_attached_end(const Work& work, const WorkPath& path, const std::vector<int>& cluster_size, Vec2 p) {
    if (path.closed) return false;
    for (int which = 0; which < 2; ++which) {
        const PathEnd& end = path.end[which];
        const bool attached = end.on_path || end.on_border || (end.cluster >= 0 && cluster_size[end.cluster] > 1);
        const Vec2 at = which == 0 ? path.elements.front().p0 : path.elements.back().p2;
        if (attached && length(copy_near(work, at, p) - p) <= 2.0 * (work.snap + work.tolerance)) return true;
    }
    return false;
}

std::vector<int> cluster_sizes(const Work& work) {
    std::vector<int> sizes;
    for (const WorkPath& path : work.paths)
        for (const PathEnd& end : path.end) {
            if (end.cluster < 0) continue;
            if (static_cast<std::size_t>(end.cluster) >= sizes.size()) sizes.resize(end.cluster + 1, 0);
            ++sizes[end.cluster];
        }
    return sizes;
}

// Chords that share a vertex of one path.
bool are_neighbours(const ChordIndex& index, const std::vector<std::size_t>& first_chord, const Work& work,
                    const Chord& a, const Chord& b, Shift shift) {
    if (a.path != b.path) return false;
    const std::size_t ia = static_cast<std::size_t>(&a - index.chords().data());
    const std::size_t ib = static_cast<std::size_t>(&b - index.chords().data());
    if (ib == ia + 1 && shift == Shift{}) return true;
    const bool ends = ia == first_chord[a.path] && ib + 1 == first_chord[a.path + 1];
    const Vec2 gap = b.b + shift * index.size() - a.a;
    return work.paths[a.path].closed && ends && length(gap) <= 1e-9 * length(index.size());
}

std::vector<ArcCrossing> all_crossings(const Work& work) {
    const ChordIndex index(flatten(work, false), work.pattern.size, work.repeats());
    std::vector<std::size_t> first_chord(work.paths.size() + 1, index.chords().size());
    for (std::size_t i = index.chords().size(); i-- > 0;) first_chord[index.chords()[i].path] = i;
    const std::vector<int> sizes = cluster_sizes(work);
    const auto found = find_crossings(index, [&](const Chord& a, const Chord& b, Shift shift) {
        return !are_neighbours(index, first_chord, work, a, b, shift);
    });
    std::vector<ArcCrossing> crossings;
    for (const ChordCrossing& chord_crossing : found) {
        const ArcCrossing crossing = refine(work, index, chord_crossing);
        if (near_attached_end(work, work.paths[crossing.path[0]], sizes, crossing.position) ||
            near_attached_end(work, work.paths[crossing.path[1]], sizes, crossing.position))
            continue;
        crossings.push_back(crossing);
    }
    return crossings;
}

// Crossings of the same two paths at one place: an odd number is a crossing, an even one a touch.
std::vector<ArcCrossing> without_touches(const Work& work, const std::vector<ArcCrossing>& crossings) {
    std::vector<char> used(crossings.size(), 0);
    std::vector<ArcCrossing> kept;
    std::vector<std::size_t> order(crossings.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(crossings[a].path[0], crossings[a].path[1]) < std::pair(crossings[b].path[0], crossings[b].path[1]);
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (used[order[i]]) continue;
        const ArcCrossing& first = crossings[order[i]];
        int count = 0;
        for (std::size_t k = i; k < order.size(); ++k) {
            const ArcCrossing& other = crossings[order[k]];
            if (other.path[0] != first.path[0] || other.path[1] != first.path[1]) break;
            if (used[order[k]] || length(copy_near(work, other.position, first.position) - first.position) > 0.5 * work.snap + 1e-12)
                continue;
            used[order[k]] = 1;
            ++count;
        }
        if (count % 2 == 1) kept.push_back(first);
    }
    return kept;
}

struct Split {
    std::uint32_t element;
    double s;
    ElementEnd end;  // both pieces end like this
};

// Tangent of a path at a parameter; at a vertex inside the path the mean of both sides.
Vec2 tangent_at(const Work& work, const WorkPath& path, std::size_t element, double s) {
    const Element& e = path.elements[element];
    const std::size_t count = path.elements.size();
    const Vec2 p = curve::point(e, s);
    const double near = std::max(work.snap, 1e-12);
    if (length(p - e.p0) <= near && (element > 0 || path.closed))
        return unit(curve::tangent(e, 0.0) + curve::tangent(path.elements[(element + count - 1) % count], 1.0));
    if (length(p - e.p2) <= near && (element + 1 < count || path.closed))
        return unit(curve::tangent(e, 1.0) + curve::tangent(path.elements[(element + 1) % count], 0.0));
    return curve::tangent(e, s);
}

// Cuts one groove at its crossings with steps. `splits` in order along the path.
void split_path(Work& work, WorkPath& path, const std::vector<Split>& splits) {
    const std::vector<Element> old = std::move(path.elements);
    const double shortest = std::max(work.snap, 1e-9 * work.pattern.size.x);
    path.elements.clear();
    path.starts.clear(), path.ends.clear(), path.region_starts.clear();
    const auto push = [&](const Element& e) {
        path.elements.push_back(e);
        path.starts.emplace_back();
        path.ends.emplace_back();
        path.region_starts.push_back(0);
    };
    std::optional<ElementEnd> pending;  // for the start of the next element
    std::size_t next = 0;
    for (std::size_t k = 0; k < old.size(); ++k) {
        double from = 0.0;
        const double extent = std::max(curve::arc_length(old[k]), 1e-300);
        for (; next < splits.size() && splits[next].element == k; ++next) {
            const double s = splits[next].s;
            ++work.stats.step_crossings;
            if ((s - from) * extent > shortest && (1.0 - s) * extent > shortest) {
                push(curve::part(old[k], from, s));
                if (pending) path.starts.back() = *pending, path.region_starts.back() = 1;
                path.ends.back() = splits[next].end;
                pending = splits[next].end;
                from = s;
            } else if ((1.0 - s) * extent <= shortest) {
                break;  // at the element's end: handled below, once the rest is pushed
            } else if (!path.elements.empty()) {
                path.ends.back() = splits[next].end;
                pending = splits[next].end;
            } else if (path.closed) {
                pending = splits[next].end;
            }
        }
        push(curve::part(old[k], from, 1.0));
        if (pending) path.starts.back() = *pending, path.region_starts.back() = 1;
        pending.reset();
        for (; next < splits.size() && splits[next].element == k; ++next) {
            if (k + 1 == old.size() && !path.closed) continue;  // within the snap distance of an end: no piece beyond
            path.ends.back() = splits[next].end;
            pending = splits[next].end;
        }
    }
    // A closed path's last end and first start are one vertex.
    if (path.closed && pending) path.starts.front() = *pending, path.region_starts.front() = 1;
    if (path.closed && path.region_starts.front() && !pending) path.ends.back() = path.starts.front();
}

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
        if (distance < ground.distance - slack || (distance <= ground.distance + slack && across > perpendicular)) {
            ground = {side_level(work.paths[chord.path], chord, by, p), distance};
            perpendicular = across;
        }
        return ground.distance;
    });
    return ground;
}

// First chord that a ray from `origin` meets, other than `own`; chords.size() when it meets none.
std::uint32_t first_hit(const Work& work, const ChordIndex& steps, Vec2 origin, Vec2 direction, std::uint32_t own, bool& from_left) {
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
            const double at = cross(start - origin, along) / det, u = cross(start - origin, direction) / det;
            if (at <= 1e-12 * far || at >= best || u < 0.0 || u > 1.0) return;
            best = at, hit = k, from_left = cross(along, origin - start) < 0.0;
        });
    }
    return hit;
}

// Sides of step paths that face each other bound one region and get one level; heights are scaled to fit. What cannot
// be scaled to fit is left and counted.
class LevelHarmony {
  public:
    LevelHarmony(Work& work, const ChordIndex& steps) : work_(work), steps_(steps), leader_(2 * work.paths.size()) {
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
            const std::size_t a = find(2 * chord.path + right), b = find(2 * steps_.chords()[hit].path + (from_left ? 0 : 1));
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
            if (find(i) == i) target[i] = std::abs(level(i) - work_.pattern.outer_level) <= alike ? work_.pattern.outer_level : level(i);
        for (std::size_t p = 0; p < work_.paths.size(); ++p) {
            WorkPath& path = work_.paths[p];
            if (!path.step) continue;
            const double left = target[find(2 * p)], right = target[find(2 * p + 1)];
            if (std::abs(left - path.level) <= equal && std::abs(right - path.right_level) <= equal) continue;
            if (std::abs(left - path.level) > alike || std::abs(right - path.right_level) > alike) ++work_.stats.uneven_levels;
            fit(path, left, right);
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
};

// The ground of elements [first, last) of a run, asked where it is farthest from any step.
double run_level(const Work& work, const ChordIndex& steps, const WorkPath& path, const std::vector<std::size_t>& run) {
    Ground best{work.pattern.outer_level, -1.0};
    const std::size_t stride = std::max<std::size_t>(1, run.size() / 8);
    for (std::size_t i = 0; i < run.size(); i += stride)
        for (const double s : {0.25, 0.5, 0.75}) {
            const Ground ground = ground_at(work, steps, curve::point(path.elements[run[i]], s));
            if (ground.distance > best.distance) best = ground;
        }
    return best.level;
}

// Elements between two crossings with steps, in order; on a closed path the last run goes on into the first.
std::vector<std::vector<std::size_t>> runs_of(const WorkPath& path) {
    std::vector<std::vector<std::size_t>> runs;
    for (std::size_t i = 0; i < path.elements.size(); ++i) {
        if (i == 0 || path.region_starts[i]) runs.emplace_back();
        runs.back().push_back(i);
    }
    if (path.closed && runs.size() > 1 && !path.region_starts.front()) {
        runs.front().insert(runs.front().end(), runs.back().begin(), runs.back().end());
        runs.pop_back();
    }
    return runs;
}

}  // namespace

std::vector<PathError> split_at_steps(Work& work) {
    std::vector<PathError> errors;
    std::vector<std::vector<Split>> splits(work.paths.size());
    for (const ArcCrossing& crossing : without_touches(work, all_crossings(work))) {
        const WorkPath &a = work.paths[crossing.path[0]], &b = work.paths[crossing.path[1]];
        if (a.step && b.step) {
            const std::size_t loser = a.elements.size() < b.elements.size() ? crossing.path[0] : crossing.path[1];
            errors.push_back({loser, "step path " + std::to_string(a.source) + " crosses step path " + std::to_string(b.source) +
                                         " at " + position_text(wrapped(work, crossing.position)) +
                                         "; step paths may only end on each other"});
            continue;
        }
        work.junctions.push_back({JunctionKind::crossing, wrapped(work, crossing.position)});
        if (!a.step && !b.step) continue;
        const int groove = a.step ? 1 : 0, step = 1 - groove;
        const Vec2 tangent = tangent_at(work, work.paths[crossing.path[step]], crossing.element[step], crossing.s[step]);
        const Vec2 along = curve::tangent(work.paths[crossing.path[groove]].elements[crossing.element[groove]], crossing.s[groove]);
        splits[crossing.path[groove]].push_back({crossing.element[groove], crossing.s[groove], clip_or_hip(along, tangent)});
    }
    for (std::size_t p = 0; p < work.paths.size(); ++p) {
        std::sort(splits[p].begin(), splits[p].end(), [](const Split& a, const Split& b) {
            return std::tuple(a.element, a.s, a.end.clip_angle) < std::tuple(b.element, b.s, b.end.clip_angle);
        });
        split_path(work, work.paths[p], splits[p]);
    }
    return errors;
}

void find_levels(Work& work) {
    const ChordIndex steps(flatten(work, true), work.pattern.size, work.repeats());
    if (!steps.chords().empty()) LevelHarmony(work, steps).run();
    const double alike = kLevelTolerance * work.pattern.depth;
    for (WorkPath& path : work.paths) {
        path.levels.assign(path.elements.size(), path.level);
        if (path.step) continue;
        bool own_level = false;
        for (const auto& run : runs_of(path)) {
            const double level = run_level(work, steps, path, run);
            own_level = own_level || std::abs(level - path.level) <= alike;
            for (const std::size_t i : run) path.levels[i] = level;
        }
        if (!own_level) ++work.stats.releveled;
    }
}

}  // namespace burin::resolving
