// Skeleton graph: strands and nodes of a thinned mask, spurs pruned, split crossings joined.
#include "vectorize_skeleton.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace burin::vectorizing {
namespace {

constexpr int kAroundX[8] = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr int kAroundY[8] = {-1, -1, 0, 1, 1, 1, 0, -1};

struct Walker {
    std::vector<std::uint8_t>& mask;  // see Mask
    const Lattice& lattice;
    std::vector<int> texels;               // with the bit `thin`, row by row
    std::unordered_map<int, int> node_at;  // number of the node per texel that has the bit `node`

    int at(int i, int k) const {
        const int j = lattice.index(i % lattice.width + kAroundX[k], i / lattice.width + kAroundY[k]);
        return j >= 0 && (mask[j] & Mask::thin) ? j : -1;
    }
    int degree(int i) const {
        int n = 0;
        for (int k = 0; k < 8; ++k) n += at(i, k) >= 0;
        return n;
    }
    bool is_node(int i) const { return mask[i] & Mask::node; }
    bool is_visited(int i) const { return mask[i] & Mask::visited; }
};

std::vector<int> thin_texels(const std::vector<std::uint8_t>& mask, const Parts& parts, const Lattice& lattice) {
    std::vector<int> texels;
    for_each_run(parts, [&](int y, const Run& run) {
        for (int i = y * lattice.width + run.begin, end = y * lattice.width + run.end; i < end; ++i)
            if (mask[i] & Mask::thin) texels.push_back(i);
    });
    return texels;
}

// Texels with three or more neighbours, joined where they touch, become nodes.
void find_nodes(Walker& walker, const Parts& parts, Skeleton& skeleton) {
    const int width = walker.lattice.width;
    for (const int i : walker.texels)
        if (walker.degree(i) >= 3) walker.mask[i] |= Mask::node;
    std::vector<std::pair<int, Vec2>> stack;
    for (const int i : walker.texels) {
        if (!walker.is_node(i) || walker.node_at.contains(i)) continue;
        SkeletonNode node;
        const int id = static_cast<int>(skeleton.nodes.size());
        int texels = 0;
        stack.assign(1, {i, {i % width + 0.5, i / width + 0.5}});
        walker.node_at.emplace(i, id);
        while (!stack.empty()) {
            const auto [j, p] = stack.back();
            stack.pop_back();
            node.position = node.position + p;
            node.radius = std::max(node.radius, distance_inside(parts, walker.lattice, j % width, j / width));
            ++texels;
            for (int k = 0; k < 8; ++k) {
                const int m = walker.at(j, k);
                if (m < 0 || !walker.is_node(m) || !walker.node_at.emplace(m, id).second) continue;
                stack.push_back({m, p + Vec2{double(kAroundX[k]), double(kAroundY[k])}});
            }
        }
        node.position = node.position * (1.0 / texels);
        skeleton.nodes.push_back(node);
    }
}

// Walks from texel `first` away from node `from` (or from a free end, -1) to the next node or end.
Strand walk_strand(Walker& walker, int first, Vec2 start, int from) {
    Strand strand;
    strand.node[0] = from;
    int current = first;
    Vec2 p = start;
    for (;;) {
        walker.mask[current] |= Mask::visited;
        strand.texels.push_back(p);
        int next = -1, next_k = 0, node = -1;
        for (int k = 0; k < 8; ++k) {
            const int j = walker.at(current, k);
            if (j < 0) continue;
            if (walker.is_node(j)) {
                // The first texels touch the node they came from; returning to it later closes a loop on it.
                const int id = walker.node_at.at(j);
                if (id != from || strand.texels.size() > 3) node = id;
            } else if (!walker.is_visited(j) && (next < 0 || k % 2 == 0)) {
                next = j;
                next_k = k;
            }
        }
        if (node >= 0) {
            strand.node[1] = node;
            return strand;
        }
        if (next < 0) return strand;
        p = p + Vec2{double(kAroundX[next_k]), double(kAroundY[next_k])};
        current = next;
    }
}

void trace_strands(Walker& walker, Skeleton& skeleton) {
    const Lattice& lattice = walker.lattice;
    for (const int i : walker.texels) {
        if (!walker.is_node(i)) continue;
        for (int k = 0; k < 8; ++k) {
            const int j = walker.at(i, k);
            if (j < 0 || walker.is_node(j) || walker.is_visited(j)) continue;
            const Vec2 start = lattice.centre(i) + Vec2{double(kAroundX[k]), double(kAroundY[k])};
            skeleton.strands.push_back(walk_strand(walker, j, start, walker.node_at.at(i)));
        }
    }
    for (const int i : walker.texels) {
        if (walker.is_node(i) || walker.is_visited(i) || walker.degree(i) > 1) continue;
        skeleton.strands.push_back(walk_strand(walker, i, lattice.centre(i), -1));
    }
    for (const int i : walker.texels) {
        if (walker.is_node(i) || walker.is_visited(i)) continue;
        Strand strand = walk_strand(walker, i, lattice.centre(i), -1);
        strand.loop = strand.texels.size() > 4;
        skeleton.strands.push_back(std::move(strand));
    }
}

double texel_length(const Strand& strand) {
    double sum = 0.0;
    for (std::size_t i = 1; i < strand.texels.size(); ++i) sum += length(strand.texels[i] - strand.texels[i - 1]);
    return sum;
}

Vec2 nearest_image(Vec2 p, Vec2 target, const Lattice& lattice) { return p + lattice.shift_to(p, target); }

// A thinned mask grows a branch into every corner of a wide line; such branches are no longer than the line is wide.
bool prune_spurs(Skeleton& skeleton) {
    bool changed = false;
    for (Strand& strand : skeleton.strands) {
        if (strand.gone || strand.loop) continue;
        const bool free_front = strand.node[0] < 0, free_back = strand.node[1] < 0;
        if (free_front == free_back) continue;
        const SkeletonNode& node = skeleton.nodes[free_front ? strand.node[1] : strand.node[0]];
        if (texel_length(strand) < 1.2 * node.radius + 0.5) {
            strand.gone = true;
            changed = true;
        }
    }
    return changed;
}

// A wide crossing thins to two nodes with a short strand between; it is one node.
void contract_short(Skeleton& skeleton, const Lattice& lattice) {
    std::vector<int> same_as(skeleton.nodes.size());
    std::iota(same_as.begin(), same_as.end(), 0);
    const auto find = [&](int n) {
        while (same_as[n] != n) n = same_as[n] = same_as[same_as[n]];
        return n;
    };
    for (Strand& strand : skeleton.strands) {
        if (strand.gone || strand.node[0] < 0 || strand.node[1] < 0) continue;
        const int a = find(strand.node[0]), b = find(strand.node[1]);
        const double radius = std::max(skeleton.nodes[a].radius, skeleton.nodes[b].radius);
        if (texel_length(strand) > 1.4 * radius + 1.0) continue;
        strand.gone = true;
        if (a == b) continue;
        const Vec2 pb = nearest_image(skeleton.nodes[b].position, skeleton.nodes[a].position, lattice);
        skeleton.nodes[a].position = (skeleton.nodes[a].position + pb) * 0.5;
        skeleton.nodes[a].radius = radius;
        same_as[b] = a;
    }
    for (Strand& strand : skeleton.strands)
        for (int& n : strand.node)
            if (n >= 0) n = find(n);
}

void reverse_strand(Strand& strand) {
    std::reverse(strand.texels.begin(), strand.texels.end());
    std::swap(strand.node[0], strand.node[1]);
}

// After pruning, two strands may meet at a node that nothing else touches: they are one strand.
void merge_through(Skeleton& skeleton, const Lattice& lattice) {
    std::vector<std::vector<int>> touching(skeleton.nodes.size());
    for (std::size_t s = 0; s < skeleton.strands.size(); ++s)
        for (const int n : skeleton.strands[s].node)
            if (n >= 0 && !skeleton.strands[s].gone) touching[n].push_back(static_cast<int>(s));
    for (std::size_t n = 0; n < skeleton.nodes.size(); ++n) {
        if (touching[n].size() != 2) continue;
        const int a = touching[n][0], b = touching[n][1];
        touching[n].clear();
        if (a == b) {  // a loop that starts and ends here
            Strand& strand = skeleton.strands[a];
            strand.loop = true;
            strand.node[0] = strand.node[1] = -1;
            continue;
        }
        Strand& first = skeleton.strands[a];
        Strand& second = skeleton.strands[b];
        const int here = static_cast<int>(n);
        if (first.node[1] != here) reverse_strand(first);
        if (second.node[0] != here) reverse_strand(second);
        const Vec2 shift = nearest_image(second.texels.front(), first.texels.back(), lattice) - second.texels.front();
        for (const Vec2 p : second.texels) first.texels.push_back(p + shift);
        first.node[1] = second.node[1];
        second.gone = true;
        if (first.node[1] >= 0) std::replace(touching[first.node[1]].begin(), touching[first.node[1]].end(), b, a);
    }
}

}  // namespace

Skeleton trace_skeleton(std::vector<std::uint8_t>& mask, const Parts& parts, const Lattice& lattice) {
    Skeleton skeleton;
    Walker walker{mask, lattice, thin_texels(mask, parts, lattice), {}};
    find_nodes(walker, parts, skeleton);
    trace_strands(walker, skeleton);
    for (int round = 0; round < 3 && prune_spurs(skeleton); ++round) merge_through(skeleton, lattice);
    contract_short(skeleton, lattice);
    merge_through(skeleton, lattice);
    return skeleton;
}

}  // namespace burin::vectorizing
