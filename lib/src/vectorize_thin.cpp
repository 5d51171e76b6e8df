// Thinning of a mask (Guo and Hall 1989), and its width at a texel.
#include "vectorize_skeleton.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "parallel.hpp"

namespace burin::vectorizing {
namespace {

// The eight neighbours in order around the texel, starting above.
constexpr int kAroundX[8] = {0, 1, 1, 1, 0, -1, -1, -1};
constexpr int kAroundY[8] = {-1, -1, 0, 1, 1, 1, 0, -1};

// Bits of a mask's texel besides those of Mask: the texel is to be looked at in the even or in the odd sub-iterations.
constexpr std::uint8_t kListed[2] = {16, 32};

// Whether a texel whose neighbours are the bits of `around` can go without breaking or shortening a line.
constexpr bool can_remove(unsigned around, bool even) {
    bool n[8] = {};
    for (int k = 0; k < 8; ++k) n[k] = (around >> k & 1) != 0;
    const int crossings = (!n[0] && (n[1] || n[2])) + (!n[2] && (n[3] || n[4])) + (!n[4] && (n[5] || n[6])) +
                          (!n[6] && (n[7] || n[0]));
    const int n1 = (n[7] || n[0]) + (n[1] || n[2]) + (n[3] || n[4]) + (n[5] || n[6]);
    const int n2 = (n[0] || n[1]) + (n[2] || n[3]) + (n[4] || n[5]) + (n[6] || n[7]);
    const int least = n1 < n2 ? n1 : n2;
    const bool guard = even ? ((n[0] || n[1] || !n[3]) && n[2]) : ((n[4] || n[5] || !n[7]) && n[6]);
    return crossings == 1 && least >= 2 && least <= 3 && !guard;
}

constexpr std::array<std::array<bool, 256>, 2> make_table() {
    std::array<std::array<bool, 256>, 2> table{};
    for (unsigned around = 0; around < 256; ++around)
        for (int odd = 0; odd < 2; ++odd) table[odd][around] = can_remove(around, odd == 0);
    return table;
}
constexpr auto kCanRemove = make_table();

// Removes, in turns, what can go from one side and from the other. Only a texel with a neighbour that went since it was
// last looked at can have come to be removable.
class Thinner {
  public:
    Thinner(std::vector<std::uint8_t>& mask, const Lattice& lattice) : mask_(mask), lattice_(lattice) {
        for (int k = 0; k < 8; ++k) step_[k] = kAroundY[k] * lattice.width + kAroundX[k];
    }

    void run(const Parts& parts) {
        for_each_run(parts, [&](int y, const Run& run) {
            for (int x = run.begin; x < run.end; ++x) {
                const int i = y * lattice_.width + x;
                if ((mask_[i] & Mask::thin) && neighbours(i) != 255u) list(i);
            }
        });
        for (int turn = 0; !listed_[0].empty() || !listed_[1].empty(); turn = 1 - turn) take_turn(turn);
    }

  private:
    template <typename Visit>
    void for_each_neighbour(int i, const Visit& visit) const {
        const int x = i % lattice_.width, y = i / lattice_.width;
        const bool inside = x > 0 && y > 0 && x + 1 < lattice_.width && y + 1 < lattice_.height;
        for (int k = 0; k < 8; ++k) visit(k, inside ? i + step_[k] : lattice_.index(x + kAroundX[k], y + kAroundY[k]));
    }
    unsigned neighbours(int i) const {
        unsigned around = 0;
        for_each_neighbour(i, [&](int k, int j) { around |= j >= 0 && (mask_[j] & Mask::thin) ? 1u << k : 0u; });
        return around;
    }
    void list(int i) {
        for (int turn = 0; turn < 2; ++turn) {
            if (mask_[i] & kListed[turn]) continue;
            mask_[i] |= kListed[turn];
            listed_[turn].push_back(i);
        }
    }
    // All are looked at before any goes.
    void take_turn(int turn) {
        constexpr std::size_t kPiece = 16384;
        const std::vector<int> looked_at = std::exchange(listed_[turn], {});
        std::vector<std::vector<int>> gone((looked_at.size() + kPiece - 1) / kPiece);
        for_each_piece(gone.size(), lattice_.threads, [&](std::size_t piece) {
            for (std::size_t k = piece * kPiece, end = std::min(looked_at.size(), k + kPiece); k < end; ++k)
                if ((mask_[looked_at[k]] & Mask::thin) && kCanRemove[turn][neighbours(looked_at[k])])
                    gone[piece].push_back(looked_at[k]);
        });
        for (const int i : looked_at) mask_[i] &= static_cast<std::uint8_t>(~kListed[turn]);
        for (const std::vector<int>& some : gone)
            for (const int i : some) mask_[i] &= static_cast<std::uint8_t>(~Mask::thin);
        for (const std::vector<int>& some : gone)
            for (const int i : some)
                for_each_neighbour(i, [&](int, int j) {
                    if (j >= 0 && (mask_[j] & Mask::thin)) list(j);
                });
    }

    std::vector<std::uint8_t>& mask_;
    const Lattice& lattice_;
    int step_[8] = {};
    std::vector<int> listed_[2];
};

// Texels from x to the end of its run and beyond, to both sides; 0 outside of all runs.
struct Room {
    double left = 0.0, right = 0.0;
};

Room room_around(const Parts& parts, const Lattice& lattice, int x, int y) {
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    const std::size_t first = parts.row_start[y], end = parts.row_start[y + 1];
    const std::size_t r = parts.find(x, y);
    if (r == end) return {};
    const Run& run = parts.runs[r];
    Room room{x - run.begin + 1.0, static_cast<double>(run.end - x)};
    const bool at_left = run.begin == 0, at_right = run.end == lattice.width;
    if (at_left && at_right) return {kEndless, kEndless};
    if (at_left && !lattice.wrap) room.left = kEndless;
    if (at_right && !lattice.wrap) room.right = kEndless;
    const Run& last = parts.runs[end - 1];
    if (at_left && lattice.wrap && last.end == lattice.width) room.left += last.end - last.begin;
    if (at_right && lattice.wrap && parts.runs[first].begin == 0) room.right += parts.runs[first].end;
    return room;
}

}  // namespace

void thin_mask(std::vector<std::uint8_t>& mask, const Parts& parts, const Lattice& lattice) {
    Thinner(mask, lattice).run(parts);
}

double distance_inside(const Parts& parts, const Lattice& lattice, int x, int y) {
    const int furthest = std::max(lattice.width, lattice.height);
    double square = static_cast<double>(furthest) * furthest;
    for (int dy = 0; dy < furthest && static_cast<double>(dy) * dy < square; ++dy)
        for (const int row : {y - dy, y + dy}) {
            if (!lattice.wrap && (row < 0 || row >= lattice.height)) continue;
            const Room room = room_around(parts, lattice, x, Lattice::modulo(row, lattice.height));
            const double across = std::min(room.left, room.right);
            square = std::min(square, across * across + static_cast<double>(dy) * dy);
        }
    return std::sqrt(square);
}

}  // namespace burin::vectorizing
