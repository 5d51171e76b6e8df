// Where texture coordinates are cut: what a ray needs to go on when it leaves the chart that it entered.
//
//     positions, normals, uvs, triangles --[find_charts]--> ChartSet --[pack_charts]--> ChartTable (SPECIFICATION.md, 14.1)
//
// A CHART is a part of a mesh whose texture coordinates hang together: triangles that share vertices of equal position and uv, and that
// are wound alike in uv. A BORDER is an edge whose two triangles lie in different charts, or in one that is cut there, or
// that meet in a crease. It says where the plane of pattern space goes on: unfold the other triangle about the edge into
// the plane of this one; `map` then leads from this one's pattern space to the other's. A border has one record per side.
//
// Under a crease the object is divided by the plane through the edge that halves the angle of its faces, so that every
// point below the surface belongs to one chart only: grooves that meet over an edge are mitred.
// Source: [2010] 4.1, which continues rays over borders as geometry with texture atlases does.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <burin/format/extension.hpp>
#include <burin/frames.hpp>
#include <burin/geometry.hpp>

namespace burin {

// Lengths in metres of the pattern of this side or the other, as said.
struct ChartBorder {
    std::uint32_t from = 0, to = 0;   // 2 * chart, + 1 where the triangle is wound clockwise in uv
    Vec2 begin, end;                  // this side; outside lies where (-t_y, t_x) points, t = end - begin
    Vec2 there;                       // the other side's place of `begin`
    std::array<double, 4> map{};      // row-major 2 x 2: a step of this side's pattern as a step of the other's
    Vec2 across;                      // the other side's step per metre that leads away from the edge
    double scale = 1.0;               // metres of the mesh per metre of this side's pattern, straight away from the edge
    double angle = 0.0;               // radians by which the surface turns there: > 0 convex; 0 where it is smooth
};

struct ChartSet {
    // Per mesh and vertex; 0 to the number of charts - 1.
    std::vector<std::vector<std::uint32_t>> charts;
    std::vector<ChartBorder> borders;
    std::uint32_t count = 0;
    // Whether any border is more than a whole number of tiles of a pattern that repeats: if not, rays need no borders.
    bool needed = false;
};

struct ChartOptions {
    Vec2 size{1.0, 1.0};   // metres per uv unit
    bool repeat = true;    // the pattern tiles: a border that moves uv by whole tiles changes nothing
    double crease_cosine = 0.8;  // normals that differ by more make a crease, range (-1, 1); as in FrameOptions
};

// The meshes share one space; their charts and borders are numbered together, starting at `first_chart`. Edges of one triangle, or of more
// than two, edges without length in uv, triangles without area in uv and edges folded by more than 166 degrees make no border: rays go on as if the chart did.
// Requires: sizes that belong together, indices in range, finite values. Cost: n log n of the edges.
ChartSet find_charts(std::span<const SurfaceMesh> meshes, const ChartOptions& options, std::uint32_t first_chart = 0);

struct ChartTable {
    ChartLayout layout;                // what the extension says of it, but for its buffer view
    std::vector<std::uint32_t> words;  // four per texel
};

// Borders in a grid over their bounding box, about as many cells as borders. `depth`: metres, how far below the surface a border
// is asked for, in metres of the mesh. Requires: at least one border, finite. The table may be too large for a texture; see layout.
// Cost: linear in borders times cells that they pass. Equal input gives equal bytes.
ChartTable pack_charts(std::span<const ChartBorder> borders, double depth);

}  // namespace burin
