// Step contours: the borders between regions as sub-texel chains, closed or from node to node.
#include "vectorize_internal.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "parallel.hpp"

namespace burin::vectorizing {
namespace {

// Borders run on the lattice of texel corners. Directions: 0 right, 1 down, 2 left, 3 up.
constexpr int kDirX[4] = {1, 0, -1, 0};
constexpr int kDirY[4] = {0, 1, 0, -1};
constexpr std::uint32_t kOutside = 0xffffffffu;

struct Corner {
    int x = 0, y = 0;
};

class BorderTracer {
  public:
    BorderTracer(const Image& map, const Lattice& lattice, const Regions& regions)
        : map_(map), lattice_(lattice), regions_(regions),
          columns_(lattice.wrap ? lattice.width : lattice.width + 1),
          rows_(lattice.wrap ? lattice.height : lattice.height + 1),
          corners_(static_cast<std::size_t>(columns_) * rows_, 0) {
        for_each_band(rows_, lattice.threads, [&](const Band& band) {
            std::vector<std::uint32_t> above = region_row(band.begin - 1);
            for (int y = band.begin; y < band.end; ++y) {
                std::vector<std::uint32_t> below = region_row(y);
                find_borders(above, below, &corners_[static_cast<std::size_t>(y) * columns_]);
                above.swap(below);
            }
        });
    }

    std::vector<Chain> trace() {
        std::vector<Chain> chains;
        const auto follow_all = [&](Corner c) {
            for (int dir = 0; dir < 4; ++dir)
                if (is_border(c, dir) && !is_taken(c, dir)) chains.push_back(follow(c, dir));
        };
        for_each_border_corner([&](Corner c) {
            if (is_node(c)) follow_all(c);
        });
        for_each_border_corner(follow_all);
        settle_nodes(chains);
        return chains;
    }

  private:
    std::uint32_t label(int x, int y) const {
        const int i = lattice_.index(x, y);
        return i < 0 ? kOutside : regions_.at(i);
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
    // The regions of a row of texels, from the one left of the first corner to the one right of the last.
    std::vector<std::uint32_t> region_row(int y) const {
        std::vector<std::uint32_t> row(static_cast<std::size_t>(columns_) + 1, kOutside);
        const int start = lattice_.index(0, y);
        if (start < 0) return row;
        for (int x = 0; x < lattice_.width; ++x) row[x + 1] = regions_.at(static_cast<std::size_t>(start) + x);
        if (lattice_.wrap) row.front() = row.back();
        return row;
    }
    // The directions in which a border leaves each corner of a row, as bits 0 to 3.
    void find_borders(const std::vector<std::uint32_t>& above, const std::vector<std::uint32_t>& below, std::uint8_t* row) const {
        const auto differ = [](std::uint32_t a, std::uint32_t b) { return a != b && a != kOutside && b != kOutside; };
        for (int x = 0; x < columns_; ++x)
            row[x] = static_cast<std::uint8_t>(differ(above[x + 1], below[x + 1]) | differ(below[x + 1], below[x]) << 1 |
                                               differ(below[x], above[x]) << 2 | differ(above[x], above[x + 1]) << 3);
    }
    template <typename Visit>
    void for_each_border_corner(const Visit& visit) const {
        for (int y = 0; y < rows_; ++y) {
            const std::uint8_t* row = &corners_[static_cast<std::size_t>(y) * columns_];
            for (int x = 0; x < columns_; ++x)
                if (row[x] != 0) visit(Corner{x, y});
        }
    }
    bool is_border(Corner c, int dir) const { return corners_[slot(c)] >> dir & 1; }
    int degree(Corner c) const { return std::popcount(static_cast<unsigned>(corners_[slot(c)] & 15u)); }
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
        const bool inside = c.x >= 0 && c.y >= 0 && c.x < columns_ && c.y < rows_;
        const int x = inside ? c.x : Lattice::modulo(c.x, columns_), y = inside ? c.y : Lattice::modulo(c.y, rows_);
        return static_cast<std::size_t>(y) * columns_ + x;
    }
    bool is_taken(Corner c, int dir) const { return corners_[slot(c)] >> (4 + dir) & 1; }
    void take(Corner c, int dir) {
        corners_[slot(c)] |= static_cast<std::uint8_t>(16 << dir);
        const Corner next{c.x + kDirX[dir], c.y + kDirY[dir]};
        corners_[slot(next)] |= static_cast<std::uint8_t>(16 << ((dir + 2) % 4));
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
    std::vector<std::uint8_t> corners_;  // bits 0-3: a border leaves in that direction, 4-7: it was followed
};

}  // namespace

std::vector<Chain> trace_steps(const Image& map, const Lattice& lattice, const Regions& regions) {
    return BorderTracer(map, lattice, regions).trace();
}

}  // namespace burin::vectorizing
