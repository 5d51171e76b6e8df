// Connected parts by union and find over runs.
#include "vectorize_parts.hpp"

#include <algorithm>
#include <numeric>

namespace burin::vectorizing {
namespace {

class Connector {
  public:
    Connector(Parts& parts, const Lattice& lattice, bool corners)
        : parts_(parts), lattice_(lattice), slack_(corners ? 1 : 0), parent_(parts.runs.size()) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    void run() {
        for (int y = 0; y < lattice_.height; ++y) {
            if (lattice_.wrap) join_ends(y, y);
            if (y > 0) join_rows(y - 1, y);
        }
        if (lattice_.wrap && lattice_.height > 1) join_rows(lattice_.height - 1, 0);
        number();
    }

  private:
    std::uint32_t root_of(std::uint32_t r) {
        while (parent_[r] != r) r = parent_[r] = parent_[parent_[r]];
        return r;
    }
    // The earlier run stays the root, so that a root is where its part begins.
    void join(std::size_t a, std::size_t b) {
        if (parts_.runs[a].kind != parts_.runs[b].kind) return;
        const std::uint32_t p = root_of(static_cast<std::uint32_t>(a)), q = root_of(static_cast<std::uint32_t>(b));
        parent_[std::max(p, q)] = std::min(p, q);
    }
    void join_rows(int above, int below) {
        std::size_t a = parts_.row_start[above], b = parts_.row_start[below];
        const std::size_t a_end = parts_.row_start[above + 1], b_end = parts_.row_start[below + 1];
        while (a < a_end && b < b_end) {
            const Run& p = parts_.runs[a];
            const Run& q = parts_.runs[b];
            if (p.begin < q.end + slack_ && q.begin < p.end + slack_) join(a, b);
            // Where both end together, what follows the upper one may touch the lower one with a corner.
            if (p.end == q.end && slack_ > 0 && a + 1 < a_end && parts_.runs[a + 1].begin == q.end) join(a + 1, b);
            (p.end < q.end ? a : b) += 1;
        }
        if (lattice_.wrap && slack_ > 0) join_ends(above, below), join_ends(below, above);
    }
    // Over the left and right border of a map that tiles.
    void join_ends(int left, int right) {
        const std::size_t first = parts_.row_start[left], end = parts_.row_start[right + 1];
        if (first == parts_.row_start[left + 1] || end == parts_.row_start[right]) return;
        if (parts_.runs[first].begin == 0 && parts_.runs[end - 1].end == lattice_.width) join(first, end - 1);
    }
    void number() {
        std::vector<std::uint32_t> number(parent_.size());
        for (std::uint32_t r = 0; r < parent_.size(); ++r) {
            const std::uint32_t root = root_of(r);
            if (root == r) number[r] = parts_.count++;
            parts_.runs[r].part = number[root];
        }
    }

    Parts& parts_;
    const Lattice& lattice_;
    int slack_;
    std::vector<std::uint32_t> parent_;
};

}  // namespace

std::size_t Parts::find(int x, int y) const {
    const auto begin = runs.begin() + static_cast<std::ptrdiff_t>(row_start[y]);
    const auto end = runs.begin() + static_cast<std::ptrdiff_t>(row_start[y + 1]);
    const auto after = std::upper_bound(begin, end, x, [](int value, const Run& run) { return value < run.begin; });
    return static_cast<std::size_t>((after != begin && x < (after - 1)->end ? after - 1 : end) - runs.begin());
}

void connect_runs(Parts& parts, const Lattice& lattice, bool corners) { Connector(parts, lattice, corners).run(); }

}  // namespace burin::vectorizing
