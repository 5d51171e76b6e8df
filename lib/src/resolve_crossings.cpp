// Crossings: of which paths, at which parameters, and whether they cross or only touch.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "resolve_curve.hpp"
#include "resolve_internal.hpp"

namespace burin::resolving {
namespace {

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

// Paths that were joined at an end meet there; what the chords do within the snap distance of it is no
// crossing.
bool near_attached_end(const Work& work, const WorkPath& path, const std::vector<int>& cluster_size, Vec2 p) {
    if (path.closed) return false;
    for (int which = 0; which < 2; ++which) {
        const PathEnd& end = path.end[which];
        const bool attached =
            end.on_path || end.on_border || (end.cluster >= 0 && cluster_size[end.cluster] > 1);
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
        return std::pair(crossings[a].path[0], crossings[a].path[1]) <
               std::pair(crossings[b].path[0], crossings[b].path[1]);
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (used[order[i]]) continue;
        const ArcCrossing& first = crossings[order[i]];
        int count = 0;
        for (std::size_t k = i; k < order.size(); ++k) {
            const ArcCrossing& other = crossings[order[k]];
            if (other.path[0] != first.path[0] || other.path[1] != first.path[1]) break;
            if (used[order[k]] || length(copy_near(work, other.position, first.position) - first.position) >
                                      0.5 * work.snap + 1e-12)
                continue;
            used[order[k]] = 1;
            ++count;
        }
        if (count % 2 == 1) kept.push_back(first);
    }
    return kept;
}

}  // namespace

std::vector<ArcCrossing> find_arc_crossings(const Work& work) {
    return without_touches(work, all_crossings(work));
}

}  // namespace burin::resolving
