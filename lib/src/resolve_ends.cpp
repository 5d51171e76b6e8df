// Ends of open paths: which meet each other, which lie on another path, which on the border of a clamped map.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "resolve_curve.hpp"
#include "resolve_internal.hpp"

namespace burin::resolving {
namespace {

struct EndKey {
    std::size_t path = 0;
    int which = 0;  // 0 start, 1 end
};

Vec2 position_of(const Work& work, EndKey key) {
    const WorkPath& path = work.paths[key.path];
    return key.which == 0 ? path.elements.front().p0 : path.elements.back().p2;
}

void move_end(Work& work, EndKey key, Vec2 to) {
    WorkPath& path = work.paths[key.path];
    if (length(to - position_of(work, key)) > 1e-9 * work.pattern.size.x) ++work.stats.snapped_ends;
    (key.which == 0 ? path.elements.front().p0 : path.elements.back().p2) = to;
}

PathEnd& end_of(Work& work, EndKey key) { return work.paths[key.path].end[key.which]; }

double path_length(const WorkPath& path) {
    double sum = 0.0;
    for (const Element& e : path.elements) sum += curve::arc_length(e);
    return sum;
}

// Moving an end must not turn its element around: elements at ends are at least a few snap distances long. What is shorter
// as a whole is a dot, or no step.
void lengthen_end_elements(Work& work) {
    std::erase_if(work.paths, [&](WorkPath& path) {
        path.dot = !path.closed && work.snap > 0.0 && path_length(path) <= 2.0 * work.snap;
        if (path.dot && path.step) work.stats.dropped_elements += static_cast<int>(path.elements.size());
        return path.dot && path.step;
    });
    for (WorkPath& path : work.paths) {
        if (path.closed || path.dot || work.snap == 0.0) continue;
        auto& elements = path.elements;
        while (elements.size() > 1 && curve::arc_length(elements.front()) < 2.0 * work.snap) {
            elements[1].p0 = elements[0].p0;
            elements[1].width0 = elements[0].width0, elements[1].height0 = elements[0].height0;
            elements[1].argument0 = elements[0].argument0;
            elements.erase(elements.begin());
            ++work.stats.dropped_elements;
        }
        while (elements.size() > 1 && curve::arc_length(elements.back()) < 2.0 * work.snap) {
            Element& before = elements[elements.size() - 2];
            before.p2 = elements.back().p2;
            before.width1 = elements.back().width1, before.height1 = elements.back().height1;
            before.argument1 = elements.back().argument1;
            elements.pop_back();
            ++work.stats.dropped_elements;
        }
    }
}

// Clamped maps: an end on the border is moved exactly onto it and runs along it; one beyond it needs no
// treatment.
void attach_to_border(Work& work, const std::vector<EndKey>& ends) {
    if (work.repeats()) return;
    const Vec2 size = work.pattern.size;
    for (const EndKey& key : ends) {
        if (work.paths[key.path].dot) continue;
        PathEnd& end = end_of(work, key);
        Vec2 p = position_of(work, key);
        const double to_x = std::min(std::abs(p.x), std::abs(p.x - size.x)),
                     to_y = std::min(std::abs(p.y), std::abs(p.y - size.y));
        const bool within =
            p.x > -work.snap && p.y > -work.snap && p.x < size.x + work.snap && p.y < size.y + work.snap;
        if (within && std::min(to_x, to_y) <= work.snap) {
            if (to_x <= to_y)
                p.x = std::abs(p.x) < std::abs(p.x - size.x) ? 0.0 : size.x, end.clip = {0.0, 1.0};
            else
                p.y = std::abs(p.y) < std::abs(p.y - size.y) ? 0.0 : size.y, end.clip = {1.0, 0.0};
            end.on_border = true;
            move_end(work, key, p);
        } else if (p.x < 0.0 || p.y < 0.0 || p.x > size.x || p.y > size.y) {
            end.outside = true;
        }
    }
}

// Ends within the snap distance of each other become one point: that of the first of them.
std::vector<std::vector<EndKey>> cluster_ends(Work& work, const std::vector<EndKey>& ends) {
    std::vector<Chord> points;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const Vec2 p = position_of(work, ends[i]);
        points.push_back({p, p, 0.0, 1.0, static_cast<std::uint32_t>(i), 0});
    }
    const ChordIndex index(points, work.pattern.size, work.repeats());
    std::vector<std::size_t> leader(ends.size());
    std::iota(leader.begin(), leader.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
        while (leader[i] != i) i = leader[i] = leader[leader[i]];
        return i;
    };
    const double reach = std::max(work.snap, 1e-9 * std::max(work.pattern.size.x, work.pattern.size.y));
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const Vec2 p = points[i].a;
        index.visit_box({p - Vec2{reach, reach}, p + Vec2{reach, reach}}, [&](std::uint32_t k, Shift shift) {
            if (length(points[k].a + shift * work.pattern.size - p) > reach) return;
            if (work.paths[ends[i].path].dot || work.paths[ends[k].path].dot) return;
            const std::size_t a = find(i), b = find(k);
            leader[std::max(a, b)] = std::min(a, b);
        });
    }
    std::vector<std::vector<EndKey>> clusters;
    std::vector<int> number(ends.size(), -1);
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const std::size_t first = find(i);
        if (number[first] < 0) {
            number[first] = static_cast<int>(clusters.size());
            clusters.emplace_back();
        }
        clusters[number[first]].push_back(ends[i]);
        end_of(work, ends[i]).cluster = number[first];
        move_end(work, ends[i], copy_near(work, position_of(work, ends[first]), position_of(work, ends[i])));
    }
    return clusters;
}

// A point of a path's interior.
struct Foot {
    bool found = false;
    bool step = false;
    double distance = 1e300;
    Vec2 position, tangent;
    std::size_t path = 0, element = 0;
    double s = 0.0;
};

// Point and tangent of the path at parameter s of an element; near a vertex inside the path the vertex
// itself.
void settle_foot(const Work& work, const WorkPath& path, std::size_t element, double s, Vec2 by, Foot& foot) {
    const Element& e = path.elements[element];
    const std::size_t count = path.elements.size();
    foot.position = curve::point(e, s) + by;
    foot.tangent = curve::tangent(e, s);
    const double near = std::max(work.snap, 1e-12);
    if (length(foot.position - (e.p0 + by)) <= near && (element > 0 || path.closed)) {
        foot.position = e.p0 + by;
        foot.tangent =
            unit(curve::tangent(e, 0.0) + curve::tangent(path.elements[(element + count - 1) % count], 1.0));
    } else if (length(foot.position - (e.p2 + by)) <= near && (element + 1 < count || path.closed)) {
        foot.position = e.p2 + by;
        foot.tangent =
            unit(curve::tangent(e, 1.0) + curve::tangent(path.elements[(element + 1) % count], 0.0));
    }
}

// Whether p, on an element of `path`, lies where an end of that path belongs to this cluster: then it is that
// end, not the interior. Elsewhere on the path it is interior, also when the path comes back to its own end.
bool is_own_end(const Work& work, const WorkPath& path, int cluster, std::size_t element, Vec2 p) {
    if (path.closed) return false;
    const std::size_t last = path.elements.size() - 1;
    for (int which = 0; which < 2; ++which) {
        if (path.end[which].cluster != cluster) continue;
        const Element& e = path.elements[which == 0 ? 0 : last];
        const std::size_t from_end = which == 0 ? element : last - element;
        const Vec2 end = which == 0 ? e.p0 : e.p2;
        if (length(copy_near(work, end, p) - p) > 2.0 * work.snap + 1e-12) continue;
        if (from_end == 0 || (from_end == 1 && curve::arc_length(e) < 4.0 * work.snap)) return true;
    }
    return false;
}

Foot foot_of_cluster(const Work& work, const ChordIndex& index, const std::vector<EndKey>& cluster) {
    bool has_step = false;
    for (const EndKey& key : cluster) has_step = has_step || work.paths[key.path].step;
    const Vec2 p = position_of(work, cluster.front());
    const int number = work.paths[cluster.front().path].end[cluster.front().which].cluster;
    const double reach = std::max(work.snap, 1e-9 * work.pattern.size.x);
    const double look = reach + work.tolerance;
    Foot best;
    index.visit_box({p - Vec2{look, look}, p + Vec2{look, look}}, [&](std::uint32_t k, Shift shift) {
        const Chord& chord = index.chords()[k];
        const WorkPath& path = work.paths[chord.path];
        double along = 0.0;
        const Vec2 by = shift * work.pattern.size;
        if (path.dot || (has_step && !path.step) || segment_distance(chord.a + by, chord.b + by, p, along) > look) return;
        const double s = curve::nearest(path.elements[chord.element], p - by);
        Foot foot;
        settle_foot(work, path, chord.element, s, by, foot);
        foot.distance = length(curve::point(path.elements[chord.element], s) + by - p);
        foot.step = path.step;
        foot.found = true;
        foot.path = chord.path, foot.element = chord.element, foot.s = s;
        if (foot.distance > reach || is_own_end(work, path, number, chord.element, foot.position)) return;
        // A step's line bounds what acts; it goes before a groove that passes here too.
        if (!best.found || std::pair(!foot.step, foot.distance) < std::pair(!best.step, best.distance))
            best = foot;
    });
    return best;
}

void attach_to_paths(Work& work, const std::vector<std::vector<EndKey>>& clusters, bool record) {
    const ChordIndex index(flatten(work, false), work.pattern.size, work.repeats());
    for (const auto& cluster : clusters) {
        if (work.paths[cluster.front().path].dot) continue;
        const Foot foot = foot_of_cluster(work, index, cluster);
        if (!foot.found) continue;
        for (const EndKey& key : cluster) {
            PathEnd& end = end_of(work, key);
            end.on_path = true;
            end.clip = foot.tangent;
            end.target = foot.path, end.target_element = foot.element, end.target_s = foot.s;
            move_end(work, key, copy_near(work, foot.position, position_of(work, key)));
        }
        if (record) work.junctions.push_back({JunctionKind::tee, wrapped(work, foot.position)});
    }
}

// Direction from the end into the path.
Vec2 outgoing(const Work& work, EndKey key) {
    const WorkPath& path = work.paths[key.path];
    return key.which == 0 ? curve::tangent(path.elements.front(), 0.0)
                          : -curve::tangent(path.elements.back(), 1.0);
}

// Grooves that end where steps meet run up to the line the steps make there.
void attach_grooves_to_step_ends(Work& work, const std::vector<EndKey>& cluster) {
    std::vector<EndKey> steps;
    for (const EndKey& key : cluster)
        if (work.paths[key.path].step) steps.push_back(key);
    if (steps.empty() || steps.size() == cluster.size()) return;
    const WorkPath& target = work.paths[steps[0].path];
    const Vec2 first = outgoing(work, steps[0]);
    for (const EndKey& key : cluster) {
        PathEnd& end = end_of(work, key);
        if (work.paths[key.path].step || end.on_path) continue;
        end.on_path = true;
        end.clip = steps.size() > 1 ? unit(first - outgoing(work, steps[1])) : first;
        end.target = steps[0].path;
        end.target_element = steps[0].which == 0 ? 0 : target.elements.size() - 1;
        end.target_s = steps[0].which;
    }
}

void find_loose_steps(const Work& work, const std::vector<EndKey>& cluster, std::vector<PathError>& errors) {
    int steps = 0;
    for (const EndKey& key : cluster) steps += work.paths[key.path].step ? 1 : 0;
    for (const EndKey& key : cluster) {
        const WorkPath& path = work.paths[key.path];
        const PathEnd& end = path.end[key.which];
        if (!path.step || steps > 1 || end.on_path || end.on_border || end.outside) continue;
        errors.push_back(
            {key.path, path_text(path.source, position_of(work, key)) +
                           " is a step path that ends nowhere; close it, or end it on a step path" +
                           (work.repeats() ? "" : " or on the map's border")});
    }
}

// The element that lets a path fade out: twice as long as the profile is wide.
Element taper_element(const WorkPath& path, int which) {
    const Element& e = which == 0 ? path.elements.front() : path.elements.back();
    const Vec2 at = which == 0 ? e.p0 : e.p2;
    const Vec2 away = which == 0 ? -curve::tangent(e, 0.0) : curve::tangent(e, 1.0);
    const double width = which == 0 ? e.width0 : e.width1, height = which == 0 ? e.height0 : e.height1;
    const Vec2 tip = at + away * (4.0 * path.reach * width);
    Element taper;
    taper.p0 = which == 0 ? tip : at;
    taper.p2 = which == 0 ? at : tip;
    taper.p1 = lerp(taper.p0, taper.p2, 0.5);
    taper.width0 = which == 0 ? 0.0 : width;
    taper.width1 = which == 0 ? width : 0.0;
    taper.height0 = which == 0 ? 0.0 : height;
    taper.height1 = which == 0 ? height : 0.0;
    taper.argument0 = taper.argument1 = which == 0 ? e.argument0 : e.argument1;
    return taper;
}

// Before steps are looked for, since the taper may cross one.
void append_tapers(Work& work, const std::vector<std::vector<EndKey>>& clusters) {
    for (const auto& cluster : clusters) {
        if (cluster.size() != 1) continue;
        const EndKey key = cluster.front();
        WorkPath& path = work.paths[key.path];
        const PathEnd& end = path.end[key.which];
        const Element& e = key.which == 0 ? path.elements.front() : path.elements.back();
        const bool faded = (key.which == 0 ? e.width0 : e.width1) == 0.0;
        if (path.cap[key.which] != CapKind::taper || path.step || faded || end.on_path || end.on_border ||
            end.outside)
            continue;
        path.elements.insert(key.which == 0 ? path.elements.begin() : path.elements.end(),
                             taper_element(path, key.which));
    }
}

}  // namespace

std::vector<Chord> flatten(const Work& work, bool steps_only) {
    std::vector<Chord> chords;
    for (std::size_t p = 0; p < work.paths.size(); ++p) {
        const WorkPath& path = work.paths[p];
        if (steps_only && !path.step) continue;
        for (std::size_t k = 0; k < path.elements.size(); ++k) {
            const Element& e = path.elements[k];
            const int count = curve::chord_count(e, work.tolerance);
            for (int i = 0; i < count; ++i) {
                const double s0 = static_cast<double>(i) / count, s1 = static_cast<double>(i + 1) / count;
                // Ends are taken as they are, so that chords of neighbours share them bit by bit.
                chords.push_back({i == 0 ? e.p0 : curve::point(e, s0),
                                  i + 1 == count ? e.p2 : curve::point(e, s1), s0, s1,
                                  static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(k)});
            }
        }
    }
    return chords;
}

std::vector<PathError> connect_ends(Work& work) {
    lengthen_end_elements(work);
    std::vector<EndKey> ends;
    for (std::size_t p = 0; p < work.paths.size(); ++p)
        if (!work.paths[p].closed)
            for (int which = 0; which < 2; ++which) ends.push_back({p, which});
    attach_to_border(work, ends);
    const auto clusters = cluster_ends(work, ends);
    // The second round follows targets that the first one moved.
    attach_to_paths(work, clusters, false);
    attach_to_paths(work, clusters, true);
    std::vector<PathError> errors;
    for (const auto& cluster : clusters) {
        attach_grooves_to_step_ends(work, cluster);
        find_loose_steps(work, cluster, errors);
    }
    append_tapers(work, clusters);
    return errors;
}

}  // namespace burin::resolving
