// The carved surface by square blocks of the plan, each made when a ray may first meet it, and kept: neighbouring footprints see the same facets.
//
//     Layer (how fine), block (i, j) --[gather, sweep, clip]--> faces, carved when first asked for
//
// What a block holds follows from its layer and place alone, so that pictures are the same whatever was drawn before, and by how many threads.
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>

#include "carve.hpp"
#include "direction.hpp"

namespace burin::reference {

// Squares of the plan.
struct Lattice {
    Vec2 start;  // corner of square (0, 0)
    double side = 1.0;

    std::int64_t column(double x) const { return static_cast<std::int64_t>(std::floor((x - start.x) / side)); }
    std::int64_t row(double y) const { return static_cast<std::int64_t>(std::floor((y - start.y) / side)); }
    // Calls use(row, first column, last column) for the squares over which the rays to the window run between two heights.
    template <typename Use>
    void for_each_row(const Window& window, const Direction& direction, double low, double high, const Use& use) const;
};

struct Extents {
    Box box;  // in plan
    double lowest = 0.0, highest = 0.0;
};

struct Block {
    Box box;
    Gathered gathered;
    LocalGeometry geometry;        // faces end at the block's border
    std::vector<Extents> extents;  // of each face
    Carving carving;
    std::optional<Carver> carver;  // none: the block has not been met
    // Faces by the squares that their boxes meet: a range of `listed` for each.
    Lattice lattice;
    std::int64_t squares = 1;  // along a side
    std::vector<std::uint32_t> first, listed;
    std::vector<std::uint32_t> asked;  // of each face: when it was last met
    std::uint32_t turn = 0;

    template <typename Use>
    void for_each_face(const Window& window, const Direction& direction, double low, double high, const Use& use);
};

// Blocks of one size, and as fine as each other.
struct Layer {
    Lattice lattice;
    double tolerance = 0.0;  // metres
    std::unordered_map<std::uint64_t, std::unique_ptr<Block>> blocks;
};

// Of one thread. Surfaces are told apart by their `id`.
class Blocks {
  public:
    // Serves footprints of that width from now on, whose rays run no farther than `reach` over the plan: says which blocks the next calls ask.
    // What was found before may be gone. The surface must stay where it is for as long as it is asked.
    void choose(const GroovedSurface& surface, double width, double reach, double tolerance);

    // Calls use(block, face) for the faces that may be shown in the window, and lie between two heights. Cost: what the rays pass.
    template <typename Use>
    void for_each_face(const Window& window, const Direction& direction, double low, double high, const Use& use) {
        layer_->lattice.for_each_row(window, direction, low, high, [&](std::int64_t row, std::int64_t first, std::int64_t last) {
            for (std::int64_t column = first; column <= last; ++column) {
                Block& block = block_at(column, row);
                const double lowest = std::max(low, block.gathered.lowest), highest = std::min(high, block.gathered.highest);
                if (lowest > highest || !window.meets(direction.show(block.box, lowest, highest))) continue;
                if (!block.carver) open(block);
                block.for_each_face(window, direction, low, high, [&](std::uint32_t face) { use(block, face); });
            }
        });
    }

  private:
    Block& block_at(std::int64_t column, std::int64_t row);
    void open(Block& block);

    const GroovedSurface* surface_ = nullptr;
    std::map<std::tuple<std::uint64_t, int, int>, Layer> layers_;
    Layer* layer_ = nullptr;
    std::size_t weight_ = 0;  // of all that is kept, in faces
};

template <typename Use>
void Lattice::for_each_row(const Window& window, const Direction& direction, double low, double high, const Use& use) const {
    const Box& shown = window.box;
    const Vec2 from = direction.slope * (direction.top - high), way = direction.slope * (direction.top - low) - from;
    const std::int64_t last_row = row(shown.high.y + from.y + std::max(way.y, 0.0));
    for (std::int64_t j = row(shown.low.y + from.y + std::min(way.y, 0.0)); j <= last_row; ++j) {
        // Parts of the way on which the rays are over this row.
        double enter = 0.0, leave = 1.0;
        if (way.y != 0.0) {
            const double y = start.y + double(j) * side - from.y, a = (y - shown.high.y) / way.y, b = (y + side - shown.low.y) / way.y;
            enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
        }
        if (enter > leave) continue;
        const double left = std::min(way.x * enter, way.x * leave), right = std::max(way.x * enter, way.x * leave);
        use(j, column(shown.low.x + from.x + left), column(shown.high.x + from.x + right));
    }
}

template <typename Use>
void Block::for_each_face(const Window& window, const Direction& direction, double low, double high, const Use& use) {
    ++turn;
    lattice.for_each_row(window, direction, low, high, [&](std::int64_t row, std::int64_t first_column, std::int64_t last_column) {
        if (row < 0 || row >= squares) return;
        const std::int64_t from = row * squares + std::max<std::int64_t>(first_column, 0), to = row * squares + std::min(last_column, squares - 1);
        if (from > to) return;
        for (std::uint32_t k = first[std::size_t(from)]; k < first[std::size_t(to + 1)]; ++k) {
            const std::uint32_t face = listed[k];
            if (asked[face] == turn) continue;
            asked[face] = turn;
            const Extents& at = extents[face];
            if (at.lowest <= high && at.highest >= low && window.meets(direction.show(at.box, at.lowest, at.highest))) use(face);
        }
    });
}

}  // namespace burin::reference
