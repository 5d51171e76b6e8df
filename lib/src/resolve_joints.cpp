// Priorities: joints, corners, stars, T-junctions and isolated ends. [2010] 5.4, DESIGN 2.
#include <algorithm>
#include <cmath>

#include "resolve_curve.hpp"
#include "resolve_internal.hpp"

namespace burin::resolving {
namespace {

// An element end seen from its vertex.
struct Arm {
    ElementEnd* end = nullptr;
    Vec2 outgoing;         // unit, from the vertex into the element
    bool at_start = true;  // the vertex is the element's start
    JoinKind join = JoinKind::mitre;
    double angle() const { return std::atan2(outgoing.y, outgoing.x); }
};

ElementEnd both(EndShape shape, double clip_angle = 0.0) {
    return {Priority::both, static_cast<std::uint8_t>(shape), clip_angle};
}

// Two arms that go on into each other without a corner share the line across them.
void join_smoothly(Arm& a, Arm& b) {
    const double angle = line_angle(normal_of(a.outgoing - b.outgoing));
    *a.end = *b.end = both(EndShape::clip, angle);
}

// Two arms with a free sector of more than 180 degrees between them, whose middle direction is `middle`: each
// gets back the side that faces it, up to that direction.
void join_corner(const ResolveOptions& options, Arm& a, Arm& b, Vec2 middle) {
    // Half the turn of the path: 0 straight on, 90 degrees a hairpin.
    const double cosine = 0.5 * length(a.outgoing - b.outgoing);
    // A hairpin's mitre is a butt end.
    if (cosine < 0.05) return;
    CornerShape shape = CornerShape::mitre;
    if (a.join == JoinKind::round) shape = CornerShape::round;
    if (a.join == JoinKind::bevel || (a.join == JoinKind::mitre && 1.0 / cosine > options.mitre_limit))
        shape = CornerShape::bevel;
    for (Arm* arm : {&a, &b}) {
        const Vec2 tangent = arm->at_start ? arm->outgoing : -arm->outgoing;
        const Priority side = dot(normal_of(tangent), middle) > 0.0 ? Priority::right : Priority::left;
        *arm->end = {side, static_cast<std::uint8_t>(shape), line_angle(middle)};
    }
}

// Arms around one vertex: the widest gap, when above 180 degrees, is a corner's outer sector; all others are
// inner.
void join_arms(const ResolveOptions& options, std::vector<Arm>& arms) {
    if (arms.size() == 2 &&
        std::abs(std::atan2(cross(arms[0].outgoing, -arms[1].outgoing),
                            dot(arms[0].outgoing, -arms[1].outgoing))) < options.smooth_angle) {
        join_smoothly(arms[0], arms[1]);
        return;
    }
    std::stable_sort(arms.begin(), arms.end(),
                     [](const Arm& a, const Arm& b) { return a.angle() < b.angle(); });
    for (std::size_t i = 0; i < arms.size(); ++i) {
        const std::size_t k = (i + 1) % arms.size();
        double gap = arms[k].angle() - arms[i].angle();
        if (gap <= 0.0) gap += 2.0 * kPi;
        if (gap <= kPi || i == k) continue;
        const double middle = arms[i].angle() + 0.5 * gap;
        join_corner(options, arms[i], arms[k], {std::cos(middle), std::sin(middle)});
    }
}

Arm arm_of(WorkPath& path, std::size_t element, bool at_start) {
    const Element& e = path.elements[element];
    return {at_start ? &path.starts[element] : &path.ends[element],
            at_start ? curve::tangent(e, 0.0) : -curve::tangent(e, 1.0), at_start, path.join};
}

void join_inside(Work& work, WorkPath& path) {
    const std::size_t count = path.elements.size();
    for (std::size_t i = path.closed ? 0 : 1; i < count; ++i) {
        if (path.region_starts[i]) continue;
        std::vector<Arm> arms = {arm_of(path, (i + count - 1) % count, false), arm_of(path, i, true)};
        join_arms(work.options, arms);
        if (path.starts[i].priority != Priority::both)
            work.junctions.push_back({JunctionKind::corner, wrapped(work, path.elements[i].p0)});
    }
}

void cap_end(Work& work, WorkPath& path, int which) {
    ElementEnd& end = which == 0 ? path.starts.front() : path.ends.back();
    const Element& e = which == 0 ? path.elements.front() : path.elements.back();
    const Vec2 at = which == 0 ? e.p0 : e.p2;
    if (path.end[which].outside) return;
    work.junctions.push_back({JunctionKind::isolated_end, wrapped(work, at)});
    // An end that has faded out already needs no cap.
    if ((which == 0 ? e.width0 : e.width1) == 0.0 || (which == 0 ? e.height0 : e.height1) == 0.0) return;
    switch (path.cap[which]) {
        case CapKind::butt:
            break;
        case CapKind::hip:
            end = both(EndShape::hip);
            break;
        case CapKind::round:
            end = both(EndShape::round);
            break;
        case CapKind::taper:
            break;  // has faded out
    }
}

struct EndRef {
    std::size_t path;
    int which;
};

void join_cluster(Work& work, const std::vector<EndRef>& ends) {
    std::vector<Arm> arms;
    for (const EndRef& ref : ends) {
        WorkPath& path = work.paths[ref.path];
        const PathEnd& end = path.end[ref.which];
        Arm arm = arm_of(path, ref.which == 0 ? 0 : path.elements.size() - 1, ref.which == 0);
        if (end.extended) continue;
        if (end.on_path || end.on_border)
            *arm.end = clip_or_hip(arm.outgoing, end.clip);
        else
            arms.push_back(arm);
    }
    if (arms.empty()) return;
    if (arms.size() == 1) {
        if (ends.size() == 1) cap_end(work, work.paths[ends[0].path], ends[0].which);
        return;
    }
    const WorkPath& first = work.paths[ends[0].path];
    const Vec2 at = ends[0].which == 0 ? first.elements.front().p0 : first.elements.back().p2;
    join_arms(work.options, arms);
    if (arms.size() > 2)
        work.junctions.push_back({JunctionKind::star, wrapped(work, at)});
    else if (arms[0].end->priority != Priority::both)
        work.junctions.push_back({JunctionKind::corner, wrapped(work, at)});
}

}  // namespace

ElementEnd clip_or_hip(Vec2 tangent, Vec2 clip) {
    constexpr double kSmallest = 0.12;  // sine of about 7 degrees
    if (std::abs(cross(tangent, clip)) < kSmallest) return both(EndShape::hip);
    return both(EndShape::tee, line_angle(clip));
}

void find_priorities(Work& work) {
    for (WorkPath& path : work.paths) join_inside(work, path);
    std::vector<std::vector<EndRef>> clusters;
    for (std::size_t p = 0; p < work.paths.size(); ++p)
        for (int which = 0; which < 2; ++which) {
            const int cluster = work.paths[p].end[which].cluster;
            if (cluster < 0) continue;
            if (static_cast<std::size_t>(cluster) >= clusters.size()) clusters.resize(cluster + 1);
            clusters[cluster].push_back({p, which});
        }
    for (const auto& cluster : clusters)
        if (!cluster.empty()) join_cluster(work, cluster);
}

}  // namespace burin::resolving
