// What the parts of the grid stage share. Private to lib.
//   grid_shape.*    where an element acts            grid_hits.cpp   which cells each element touches
//   grid_cells.cpp  level, bounds, flags, skip        grid.cpp        cost model, limits, driver
#pragma once

#include <functional>
#include <vector>

#include <burin/grid.hpp>

#include "grid_shape.hpp"

namespace burin::gridding {

// What one element does in one cell.
struct Hit {
    std::uint32_t cell = 0;
    bool path_line = false;  // a step's arc passes the margin rectangle
    bool end_zone = false;   // an end that is no smooth joint acts there
    HeightRange heights;     // above the element's level
};

struct Frame {
    const ResolvedPattern& pattern;
    int cols = 1, rows = 1;
    double margin = 0.0;  // in cell sides
    Vec2 cell;            // metres
    bool repeats() const { return pattern.wrap == Wrap::repeat; }
    // Rectangle of an unwrapped cell, grown by the margin.
    Box margin_rectangle(int col, int row) const {
        return {{(col - margin) * cell.x, (row - margin) * cell.y},
                {(col + 1 + margin) * cell.x, (row + 1 + margin) * cell.y}};
    }
    Vec2 centre(int col, int row) const { return {(col + 0.5) * cell.x, (row + 0.5) * cell.y}; }
    // Start `index` of cell k.
    Vec2 start(std::size_t k, std::uint32_t index) const {
        const Vec2 away = cell_start(index);
        return centre(static_cast<int>(k) % cols, static_cast<int>(k) / cols) +
               Vec2{away.x * cell.x, away.y * cell.y};
    }
};

// next[e]: the element that e's end joins smoothly, or kNoElement; the same for starts.
inline constexpr std::uint32_t kNoElement = 0xffffffffu;
struct Chain {
    std::vector<std::uint32_t> next;
    std::vector<char> joined_start;  // some element's next
    Joints joints(std::uint32_t e) const { return {joined_start[e] != 0, next[e] != kNoElement}; }
};
Chain find_chain(const ResolvedPattern& pattern);

// Farthest point, along each axis, at which an element acts, from its chord's midpoint; the largest of all
// elements.
Vec2 farthest_extent(const ResolvedPattern& pattern, const Chain& chain);

// Cells per element, sorted by cell, each once. Threads share the elements; the result does not depend on
// them.
std::vector<std::vector<Hit>> find_hits(const Frame& frame, const Chain& chain, int threads);

// Lists, levels, bounds, flags and skip from the hits.
CellGrid fill_cells(const Frame& frame, const Chain& chain, const std::vector<std::vector<Hit>>& hits);

void for_each_index(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace burin::gridding
