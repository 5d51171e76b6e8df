#include "structure.hpp"

#include <algorithm>
#include <map>
#include <set>

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

Tally match_strands(const std::vector<Strand>& authored, const std::vector<Strand>& recovered, const Sheet& sheet) {
    Tally tally{static_cast<int>(authored.size()), static_cast<int>(recovered.size()), 0};
    const Overlap there = overlap_of(authored, SampleIndex(recovered, sheet));
    const Overlap back = overlap_of(recovered, SampleIndex(authored, sheet));
    std::set<std::size_t> used_authored, used_recovered;
    for (const auto& [pair, share] : there) {
        const auto reverse = back.find({pair.second, pair.first});
        if (share < kShare || reverse == back.end() || reverse->second < kShare) continue;
        if (used_authored.contains(pair.first) || used_recovered.contains(pair.second)) continue;
        used_authored.insert(pair.first), used_recovered.insert(pair.second);
        ++tally.matched;
    }
    return tally;
}

Tally match_nodes(const std::vector<Node>& authored, const std::vector<Node>& recovered, NodeKind kind, const Sheet& sheet) {
    Tally tally;
    struct Pair {
        double distance;
        std::size_t authored, recovered;
    };
    std::vector<Pair> pairs;
    const double near = kind == NodeKind::end ? kEndNear : kNodeNear;
    for (std::size_t i = 0; i < authored.size(); ++i)
        for (std::size_t j = 0; j < recovered.size(); ++j) {
            const double distance = sheet.distance(authored[i].place, recovered[j].place);
            if (authored[i].kind == kind && recovered[j].kind == kind && distance <= near) pairs.push_back({distance, i, j});
        }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
    std::set<std::size_t> used_authored, used_recovered;
    for (const Pair& pair : pairs) {
        if (used_authored.contains(pair.authored) || used_recovered.contains(pair.recovered)) continue;
        used_authored.insert(pair.authored), used_recovered.insert(pair.recovered);
        ++tally.matched;
    }
    const auto of_kind = [kind](const Node& node) { return node.kind == kind; };
    tally.authored = static_cast<int>(std::count_if(authored.begin(), authored.end(), of_kind));
    tally.recovered = static_cast<int>(std::count_if(recovered.begin(), recovered.end(), of_kind));
    return tally;
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
    const Skeleton a = skeleton_of(authored, sheet), r = skeleton_of(recovered, sheet);
    StructureScore score;
    score.paths = match_strands(a.strands, r.strands, sheet);
    for (int k = 0; k < kNodeKinds; ++k) score.nodes[k] = match_nodes(a.nodes, r.nodes, static_cast<NodeKind>(k), sheet);
    return score;
}

}  // namespace burin::bench
