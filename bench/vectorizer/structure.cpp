#include "structure.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "../resolution/drawing.hpp"
#include "skeleton.hpp"

namespace burin::bench {
namespace {

constexpr double kNear = 0.5, kShare = 0.95;
constexpr double kEndNear = 1.0, kNodeNear = 2.0;

using Overlap = std::map<std::pair<std::size_t, std::size_t>, double>;

// For each strand of `from`, what share of it lies near which strand of the same class of `to`.
Overlap overlap_of(const std::vector<Strand>& from, const SampleIndex& to) {
    Overlap overlap;
    for (std::size_t s = 0; s < from.size(); ++s) {
        const double weight = 1.0 / static_cast<double>(from[s].points.size());
        for (const Vec2 p : from[s].points) {
            std::set<std::size_t> strands;
            for (const auto& sample : to.near(p, kNear))
                if (to.strands()[sample.strand].step == from[s].step) strands.insert(sample.strand);
            for (const std::size_t other : strands) overlap[{s, other}] += weight;
        }
    }
    return overlap;
}

// Pairs taken one to one; what is left over becomes misses.
class Matching {
  public:
    Matching(std::size_t authored, std::size_t recovered) : authored_(authored, false), recovered_(recovered, false) {}

    void take(std::size_t authored, std::size_t recovered) {
        if (authored_[authored] || recovered_[recovered]) return;
        authored_[authored] = recovered_[recovered] = true;
        ++matched_;
    }
    template <typename ToMiss>
    Tally finish(ToMiss to_miss, std::vector<Miss>& misses) const {
        for (std::size_t i = 0; i < authored_.size(); ++i)
            if (!authored_[i]) misses.push_back(to_miss(true, i));
        for (std::size_t i = 0; i < recovered_.size(); ++i)
            if (!recovered_[i]) misses.push_back(to_miss(false, i));
        return {static_cast<int>(authored_.size()), static_cast<int>(recovered_.size()), matched_};
    }

  private:
    std::vector<bool> authored_, recovered_;
    int matched_ = 0;
};

Tally match_strands(const std::vector<Strand>& authored, const std::vector<Strand>& recovered, const Sheet& sheet,
                    std::vector<Miss>& misses) {
    const Overlap there = overlap_of(authored, SampleIndex(recovered, sheet));
    const Overlap back = overlap_of(recovered, SampleIndex(authored, sheet));
    Matching matching(authored.size(), recovered.size());
    for (const auto& [pair, share] : there) {
        const auto reverse = back.find({pair.second, pair.first});
        if (share >= kShare && reverse != back.end() && reverse->second >= kShare) matching.take(pair.first, pair.second);
    }
    const auto to_miss = [&](bool from_authored, std::size_t i) {
        const std::vector<Vec2>& points = (from_authored ? authored : recovered)[i].points;
        return Miss{from_authored, true, NodeKind::end, points[points.size() / 2]};
    };
    return matching.finish(to_miss, misses);
}

std::vector<Vec2> places_of(const std::vector<Node>& nodes, NodeKind kind) {
    std::vector<Vec2> places;
    for (const Node& node : nodes)
        if (node.kind == kind) places.push_back(node.place);
    return places;
}

Tally match_nodes(const Skeleton& authored, const Skeleton& recovered, NodeKind kind, const Sheet& sheet,
                  std::vector<Miss>& misses) {
    struct Pair {
        double distance;
        std::size_t authored, recovered;
    };
    const std::vector<Vec2> a = places_of(authored.nodes, kind), r = places_of(recovered.nodes, kind);
    const double near = kind == NodeKind::end ? kEndNear : kNodeNear;
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < r.size(); ++j)
            if (const double distance = sheet.distance(a[i], r[j]); distance <= near) pairs.push_back({distance, i, j});
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) { return p.distance < q.distance; });
    Matching matching(a.size(), r.size());
    for (const Pair& pair : pairs) matching.take(pair.authored, pair.recovered);
    const auto to_miss = [&](bool from_authored, std::size_t i) { return Miss{from_authored, false, kind, (from_authored ? a : r)[i]}; };
    return matching.finish(to_miss, misses);
}

// Straight strokes of 10 texels and more that were missed and meet nothing, as the outlines of pits and plateaus: a hip
// end makes them the same surface.
class Outlining {
  public:
    Outlining(const Pattern& pattern, const Skeleton& skeleton, const std::vector<Miss>& misses, const Sheet& sheet)
        : out_(pattern), skeleton_(skeleton), misses_(misses), texel_(pattern.size.x / sheet.side) {}

    Pattern run() {
        for (Path& path : out_.paths)
            if (may_be_outline(path)) outline(path);
        return std::move(out_);
    }

  private:
    static constexpr double kBroad = 10.0, kMeets = 1.0;  // texels

    // Half its width at half its height.
    double half_width(const Path& path) const {
        const std::vector<ProfilePoint>& points = out_.profiles[path.profile].points;
        return 0.25 * (points.back().b - points.front().b + points[points.size() - 2].b - points[1].b);
    }

    bool may_be_outline(const Path& path) const {
        const std::vector<ProfilePoint>& points = out_.profiles[path.profile].points;
        const bool straight = path.elements.size() == 1 && path.elements[0].kind == ElementKind::line;
        if (!straight || points.front().h != points.back().h || 2.0 * half_width(path) < kBroad * texel_) return false;
        const Vec2 a = path.elements[0].p0, b = path.elements[0].p2;
        const auto distance = [&](Vec2 place) {
            const Vec2 p = place * texel_;
            return length(p - lerp(a, b, std::clamp(dot(p - a, b - a) / dot(b - a, b - a), 0.0, 1.0)));
        };
        const auto meets = [&](const Node& n) { return n.kind != NodeKind::end && distance(n.place) < kMeets * texel_; };
        const auto is_miss = [&](const Miss& m) { return m.authored && m.path && distance(m.place) < 0.1 * texel_; };
        return std::none_of(skeleton_.nodes.begin(), skeleton_.nodes.end(), meets) &&
               std::any_of(misses_.begin(), misses_.end(), is_miss);
    }

    void outline(Path& path) {
        const Vec2 a = path.elements[0].p0, b = path.elements[0].p2;
        const Vec2 along = unit(b - a) * half_width(path), across = normal_of(along);
        const Vec2 corners[] = {a - along - across, b + along - across, b + along + across, a - along + across};
        const double height = out_.profiles[path.profile].points[1].h;
        path.closed = true;
        path.elements.assign(4, Element{});
        for (int i = 0; i < 4; ++i) path.elements[i].p0 = corners[i], path.elements[i].p2 = corners[(i + 1) % 4];
        path.profile = static_cast<std::uint32_t>(out_.profiles.size());
        out_.profiles.push_back({{{-texel_, 0.0}, {texel_, height}}, {}});
    }

    Pattern out_;
    const Skeleton& skeleton_;
    const std::vector<Miss>& misses_;
    double texel_;
};

// Width at half its height of a groove or ridge.
double width_of(const Profile& profile) {
    const std::vector<ProfilePoint>& points = profile.points;
    double half = 0.0;
    for (const ProfilePoint& p : points) half = std::abs(p.h) > std::abs(half) ? p.h : half;
    half *= 0.5;
    double first = points.back().b, last = points.front().b;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const ProfilePoint &a = points[i], &b = points[i + 1];
        if ((a.h < half) == (b.h < half)) continue;
        const double at = a.b + (b.b - a.b) * (half - a.h) / (b.h - a.h);
        first = std::min(first, at), last = std::max(last, at);
    }
    return std::max(0.0, last - first);
}

// Dots and slots, straight strokes with round ends, as the outlines of their walls: the surface is the same.
Pattern with_outlined_slots(Pattern pattern) {
    constexpr double kHalfTexel = 0.5 / 512.0;
    pattern.profiles.push_back({{{-kHalfTexel, 0.0}, {kHalfTexel, 1e-3 * pattern.depth}}, {}});
    for (Path& path : pattern.paths) {
        const bool round = path.start_cap == CapKind::round && path.end_cap == CapKind::round;
        const bool straight = path.elements.size() == 1 && path.elements[0].kind == ElementKind::line;
        const double radius = 0.5 * width_of(pattern.profiles[path.profile]);
        if (path.closed || !round || !straight || radius == 0.0) continue;
        const Vec2 middle = lerp(path.elements[0].p0, path.elements[0].p2, 0.5), way = path.elements[0].p2 - path.elements[0].p0;
        const double scale = pattern.size.x / kSheet, r = radius / scale, reach = 0.5 * length(way) / scale;
        const Stroke outline = reach < 0.25 ? circle({}, r) : slab({}, {reach + r, r}, r, std::atan2(way.y, way.x));
        path.elements = outline.placed(scale, 0.0, middle).elements();
        path.closed = true;
        path.profile = static_cast<std::uint32_t>(pattern.profiles.size() - 1);
    }
    return pattern;
}

StructureScore compare_skeletons(const Skeleton& authored, const Skeleton& recovered, const Sheet& sheet) {
    StructureScore score;
    score.paths = match_strands(authored.strands, recovered.strands, sheet, score.misses);
    for (int k = 0; k < kNodeKinds; ++k)
        score.nodes[k] = match_nodes(authored, recovered, static_cast<NodeKind>(k), sheet, score.misses);
    return score;
}

Tally sum(Tally a, Tally b) {
    return {a.authored + b.authored, a.recovered + b.recovered, a.matched + b.matched};
}

}  // namespace

Tally StructureScore::junctions() const {
    Tally all;
    for (int k = 1; k < kNodeKinds; ++k) all = sum(all, nodes[k]);
    return all;
}

double StructureScore::percent() const {
    const Tally all = sum(sum(paths, ends()), junctions());
    if (all.authored == 0) return all.recovered == 0 ? 100.0 : 0.0;
    return std::max(0.0, 100.0 * (2 * all.matched - all.recovered) / all.authored);
}

StructureScore compare_structure(const Pattern& authored, const Pattern& recovered, int texels) {
    const Sheet sheet{static_cast<double>(texels), authored.wrap == Wrap::repeat};
    const Skeleton drawn = skeleton_of(authored, sheet);
    StructureScore best;
    bool any = false;
    for (const Pattern& found : {recovered, with_outlined_slots(recovered)}) {
        const Skeleton r = skeleton_of(found, sheet);
        const StructureScore as_drawn = compare_skeletons(drawn, r, sheet);
        const Pattern outlined = Outlining(authored, drawn, as_drawn.misses, sheet).run();
        for (const StructureScore& score : {as_drawn, compare_skeletons(skeleton_of(outlined, sheet), r, sheet)})
            if (!any || score.percent() > best.percent()) best = score, any = true;
    }
    return best;
}

}  // namespace burin::bench
