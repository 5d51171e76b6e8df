// Step contours: the borders between regions as sub-texel chains, closed or from node to node.
#include "vectorize_internal.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace burin::vectorizing {
namespace {

// Borders run on the lattice of texel corners. Directions: 0 right, 1 down, 2 left, 3 up.
constexpr int kDirX[4] = {1, 0, -1, 0};
constexpr int kDirY[4] = {0, 1, 0, -1};

struct Corner {
    int x = 0, y = 0;
};

class BorderTracer {
  public:
    BorderTracer(const Image& map, const Lattice& lattice, const Regions& regions)
        : map_(map), lattice_(lattice), regions_(regions),
          columns_(lattice.wrap ? lattice.width : lattice.width + 1),
          rows_(lattice.wrap ? lattice.height : lattice.height + 1),
          taken_(static_cast<std::size_t>(columns_) * rows_, 0) {}

    std::vector<Chain> trace() {
        std::vector<Chain> chains;
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x)
                if (is_node({x, y}))
                    for (int dir = 0; dir < 4; ++dir)
                        if (is_border({x, y}, dir) && !is_taken({x, y}, dir)) chains.push_back(follow({x, y}, dir));
        for (int y = 0; y < rows_; ++y)
            for (int x = 0; x < columns_; ++x)
                for (int dir = 0; dir < 4; ++dir)
                    if (is_border({x, y}, dir) && !is_taken({x, y}, dir)) chains.push_back(follow({x, y}, dir));
        settle_nodes(chains);
        return chains;
    }

  private:
    std::uint32_t label(int x, int y) const {
        const int i = lattice_.index(x, y);
        return i < 0 ? 0xffffffffu : regions_.at(i);
    }
    // Texels left and right of the lattice edge that leaves the corner in a direction.
    std::pair<Corner, Corner> sides(Corner c, int dir) const {
        switch (dir) {
            case 0: return {{c.x, c.y - 1}, {c.x, c.y}};
            case 1: return {{c.x, c.y}, {c.x - 1, c.y}};
            case 2: return {{c.x - 1, c.y}, {c.x - 1, c.y - 1}};
            default: return {{c.x - 1, c.y - 1}, {c.x, c.y - 1}};
        }
    }
    bool is_border(Corner c, int dir) const {
        const auto [left, right] = sides(c, dir);
        const std::uint32_t a = label(left.x, left.y), b = label(right.x, right.y);
        return a != b && a != 0xffffffffu && b != 0xffffffffu;
    }
    int degree(Corner c) const {
        int n = 0;
        for (int dir = 0; dir < 4; ++dir) n += is_border(c, dir);
        return n;
    }
    // Two texels of one region that touch at a corner of two others of one region: two borders that only touch.
    bool is_saddle(Corner c) const {
        return degree(c) == 4 && label(c.x, c.y) == label(c.x - 1, c.y - 1) &&
               label(c.x - 1, c.y) == label(c.x, c.y - 1);
    }
    bool is_node(Corner c) const {
        const int n = degree(c);
        return n != 0 && n != 2 && !is_saddle(c);
    }
    std::size_t slot(Corner c) const {
        const int x = lattice_.wrap ? Lattice::modulo(c.x, columns_) : c.x;
        const int y = lattice_.wrap ? Lattice::modulo(c.y, rows_) : c.y;
        return static_cast<std::size_t>(y) * columns_ + x;
    }
    bool is_taken(Corner c, int dir) const { return taken_[slot(c)] >> dir & 1; }
    void take(Corner c, int dir) {
        taken_[slot(c)] |= static_cast<std::uint8_t>(1 << dir);
        const Corner next{c.x + kDirX[dir], c.y + kDirY[dir]};
        taken_[slot(next)] |= static_cast<std::uint8_t>(1 << ((dir + 2) % 4));
    }

    // Where the map passes half height between the texels beside an edge; where it does not, because a speck or a third
    // level disturbs it, near the texel that is nearer to half height. A point never leaves its own edge, so that
    // contours neither cross themselves nor each other.
    Vec2 crossing(Corner a, Corner b) const {
        const double half = 0.5 * (regions_.level[label(a.x, a.y)] + regions_.level[label(b.x, b.y)]);
        const double va = map_.texels[lattice_.nearest(a.x, a.y)] - half;
        const double vb = map_.texels[lattice_.nearest(b.x, b.y)] - half;
        double t = std::fabs(va) < std::fabs(vb) ? 0.02 : 0.98;
        if (va * vb < 0.0) t = std::clamp(va / (va - vb), 0.02, 0.98);
        return {a.x + 0.5 + t * (b.x - a.x), a.y + 0.5 + t * (b.y - a.y)};
    }

    // The next edge of the same border; at a saddle the lower label is cut apart.
    int next_direction(Corner c, int dir, std::uint32_t left, std::uint32_t right) const {
        const int turn_left = (dir + 3) % 4, turn_right = (dir + 1) % 4;
        if (is_saddle(c)) return left < right ? turn_left : turn_right;
        for (const int d : {dir, turn_left, turn_right})
            if (is_border(c, d)) return d;
        return -1;
    }

    Chain follow(Corner start, int dir) {
        Chain chain;
        chain.kind = ChainKind::step;
        const auto [left, right] = sides(start, dir);
        chain.left_region = label(left.x, left.y);
        chain.right_region = label(right.x, right.y);
        chain.contrast = std::fabs(regions_.level[chain.left_region] - regions_.level[chain.right_region]);
        const bool from_node = is_node(start);
        if (from_node) chain.points.push_back({double(start.x), double(start.y)});
        Corner c = start;
        while (!is_taken(c, dir)) {
            take(c, dir);
            const auto [a, b] = sides(c, dir);
            const Vec2 p = crossing(a, b);
            if (chain.points.empty() || length(p - chain.points.back()) > 1e-6) chain.points.push_back(p);
            c = {c.x + kDirX[dir], c.y + kDirY[dir]};
            if (is_node(c)) {
                chain.points.push_back({double(c.x), double(c.y)});
                chain.start_tie = tie_of(start);
                chain.end_tie = tie_of(c);
                return orient(chain);
            }
            dir = next_direction(c, dir, chain.left_region, chain.right_region);
            if (dir < 0) break;
        }
        chain.closed = true;
        chain.winding = {double(c.x - start.x), double(c.y - start.y)};
        return orient(chain);
    }

    EndTie tie_of(Corner c) const { return degree(c) == 1 ? EndTie::border : EndTie::node; }

    // The higher side comes to lie on the left, so that steps of one height share their profile.
    Chain orient(Chain chain) const {
        if (regions_.level[chain.left_region] >= regions_.level[chain.right_region]) return chain;
        std::reverse(chain.points.begin(), chain.points.end());
        std::swap(chain.left_region, chain.right_region);
        std::swap(chain.start_tie, chain.end_tie);
        chain.winding = -chain.winding;
        return chain;
    }

    // A node was put at a texel's corner; it belongs where the borders that end there point to.
    void settle_nodes(std::vector<Chain>& chains) const {
        struct Sum {
            Vec2 offset;
            int count = 0;
        };
        std::unordered_map<std::size_t, Sum> sums;
        const auto key = [&](Vec2 p) { return slot({int(std::lround(p.x)), int(std::lround(p.y))}); };
        const auto gather = [&](Vec2 end, Vec2 next) {
            Sum& sum = sums[key(end)];
            sum.offset = sum.offset + (next - end);
            ++sum.count;
        };
        for (const Chain& chain : chains) {
            if (chain.closed || chain.points.size() < 2) continue;
            gather(chain.points.front(), chain.points[1]);
            gather(chain.points.back(), chain.points[chain.points.size() - 2]);
        }
        for (Chain& chain : chains) {
            if (chain.closed || chain.points.size() < 2) continue;
            Vec2 targets[2];
            for (const int k : {0, 1}) {
                const Vec2 end = k == 0 ? chain.points.front() : chain.points.back();
                const Sum& sum = sums[key(end)];
                targets[k] = end + sum.offset * (1.0 / sum.count);
            }
            if (chain.start_tie == EndTie::node) chain.points.front() = targets[0];
            if (chain.end_tie == EndTie::node) chain.points.back() = targets[1];
        }
    }

    const Image& map_;
    const Lattice& lattice_;
    const Regions& regions_;
    int columns_, rows_;
    std::vector<std::uint8_t> taken_;
};

}  // namespace

std::vector<Chain> trace_steps(const Image& map, const Lattice& lattice, const Regions& regions) {
    return BorderTracer(map, lattice, regions).trace();
}

}  // namespace burin::vectorizing
