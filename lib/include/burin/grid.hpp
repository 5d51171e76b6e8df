// Stage grid: decides which elements each cell of the grid texture lists, and what a ray may skip.
//
//     ResolvedPattern --[build_grid]--> CellGrid --[pack_textures]--> bytes
//
// Cell (i, j) is the rectangle [i, i+1) / cols x [j, j+1) / rows of uv, row-major, (0,0) at uv (0,0). Its MARGIN
// RECTANGLE is the cell grown by `margin` cell sides on each side: a decoder may ask for points a little outside
// a cell (antialiasing) and still read one cell only. Source: [2010] 4.2, 4.3; DESIGN 3 and 4.
//
// WHICH IMAGE. When the pattern repeats, a reference to element e in cell (i, j) means exactly one translated copy of e:
// the one whose chord midpoint m = (p0 + p2) / 2 is nearest to the cell's centre c along each axis,
//     offset = size * floor((c - m) / size + 0.5)      (per axis, size = pattern size; floor of the double value)
// No cell lists an element that would have to act in it through two copies: `resolve_pattern` cuts elements short
// enough, and `build_grid` uses enough cells, so that a copy that reaches a cell is the nearest one by a margin (never
// near the rounding tie). With clamp the offset is 0.
//
// COMPLETE. For every point p of the margin rectangle (inside [0, size] when clamped) the listed elements contain
//   - every element that acts at p (resolve.hpp), and
//   - every step element whose arc passes through the margin rectangle; then the cell has BURIN_CELL_FLAG_STEP.
// So the ground at p follows from the cell alone: on the straight way from the cell's start to p, the arc of a listed step
// that is crossed last gives the level of the side walked to; none crossed: `level`. Without the flag the ground is
// `level` everywhere. The start is the first of 16 points, the centre after all others, that no listed step comes near.
// TIGHT. An element is listed only where its path line, widened by its reach there (profile, width scale, mitre
// tip, cap), comes nearer to the margin rectangle than a thousandth of a cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <burin/resolve.hpp>
#include <burin/result.hpp>

namespace burin {

struct GridOptions {
    double cell_size = 0.0;     // metres, side of a cell at most; 0: chosen by the cost model below
    std::size_t max_bytes = 0;  // grid_bytes at most, as below, when the cell size is not given; 0: no limit
    double margin = 0.0625;     // in cell sides, [0, 1]
    int threads = 0;            // 0: as many as the machine has; the result does not depend on it
};

struct CellGrid {
    int cols = 0;  // [1, BURIN_MAX_TEXTURE_SIDE]
    int rows = 0;  // [1, BURIN_MAX_TEXTURE_SIDE]
    std::vector<std::uint32_t> first_ref;  // cols * rows + 1 entries: cell k lists refs[first_ref[k] .. first_ref[k + 1])
    std::vector<std::uint32_t> refs;       // indices into ResolvedPattern::elements, ascending within a cell
    std::vector<std::uint8_t> start;       // index of the start, [0, 15]; 0 without BURIN_CELL_FLAG_STEP
    std::vector<double> level;             // ground at the cell's start, metres
    std::vector<double> highest, lowest;   // bounds of the surface in the margin rectangle, metres; conservative
    // Every cell of the square of (2 skip + 1)^2 cells around this one lists nothing and has the same level, so a ray
    // may go on where it leaves that square. 0 for a cell that lists something. The square never passes the border
    // of a clamped map; in a repeating one it wraps and is smaller than the map. [0, 15]
    std::vector<std::uint8_t> skip;
    // BURIN_CELL_FLAG_STEP: a step's path line meets the margin rectangle.
    // BURIN_CELL_FLAG_ISOLATED: the listed elements follow each other in one path, are joined smoothly (both, clip on
    // one line), and no other kind of end acts in the margin rectangle. Set for an empty cell without step, too.
    std::vector<std::uint8_t> flags;
};

// Start `index` of a cell, in cell sides from its centre.
Vec2 cell_start(std::uint32_t index);

// Bytes of the cells and lists as packed, before equal lists are merged. `wide`: its references take 32 bits, as those of a pattern
// with more than 65536 texels of elements do.
std::size_t grid_bytes(const CellGrid& grid, bool wide = false);

// Cost model: the expected work of a pixel, drawn by rays and as areas, is cells asked, elements listed in them, and
// elements near what it spans; beyond 12 KiB, half the bytes of elements, cells and lists count as much as an eighth of
// the work. Of sizes from 0.7 to 45 mean feature widths the cheapest is taken that keeps to the budget and to 63 references
// per cell; beyond those KiB it does not depend on how large a part of a pattern is at hand. The cost is foretold from
// lengths and widths; bytes and references are counted, and cells made larger or smaller as they ask.
// Requires: the result of resolve_pattern (or of unpack_textures).
// Ensures: as above; the same bytes for any thread count. Without cell_size, grid_bytes(result) <= max_bytes, and the different
// lists of a wide pattern (format/SPECIFICATION.md) take at most BURIN_MAX_LIST_TEXELS, unless no such size keeps to 63 references
// per cell: then cells are as large as these allow, and grid_bytes tells by how much the budget is missed.
// Fails: invalid_argument for an option out of range; limit_exceeded when a cell needs more than
// BURIN_MAX_REFS_PER_CELL references at any allowed size, naming cell, count and the size that would fit, and when an
// element reaches around the tile.
// Cost: about n log n in elements plus the number of references; two passes, threaded. Where the counts do not keep to
// the limits, one more pass per size tried, a few as a rule.
Result<CellGrid> build_grid(const ResolvedPattern& pattern, const GridOptions& options = {});

}  // namespace burin
