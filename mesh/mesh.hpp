// The surface of a pattern as triangles: what sculpting, printing and ray tracing of geometry need, and a judge of everything else.
//
//     ResolvedPattern --[sweep_brushes]--> brushes --[divide_plan]--> plan --[stack_columns]--> columns --[close_surface]--> TriangleMesh
//
// Profiles are swept along their elements as upright prisms ("brushes", reference/sweep.hpp) that add to the solid or cut it. The plan is
// cut into triangles along all edges of brushes and all lines where two of their surfaces meet (CGAL, constrained Delaunay), so that
// over one triangle every surface keeps its order; a column is what is solid over a triangle. Horizontal and slanted faces are the
// ends of columns' solid stretches, upright faces stand where neighbouring columns differ. Since both take their corners from the same
// columns, the surface has no hole, whatever rounding did. The rules are DESIGN 2: all additions before any subtraction, each
// over ground of its own level.
//
// Units: metres in pattern space; z up, the object surface at base_offset, as everywhere (resolve.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <burin/grid.hpp>
#include <burin/resolve.hpp>
#include <burin/result.hpp>
#include <reference/polygon.hpp>

namespace burin::mesh {

// What a mesh may hold at most; named in the message when it is exceeded.
inline constexpr std::size_t kMaxTriangles = 1u << 26;

struct MeshOptions {
    // How far bent paths may lie from the straight pieces that stand for them, metres. Lines without perturbation are exact. 0: a
    // thousandth of the mean width of what is swept. Range [1e-7, 0.1] times the longer side of the map.
    double tolerance = 0.0;
    // Adds sides on the borders of the map and a bottom, so that the mesh bounds a solid.
    bool closed = false;
    // Of a closed mesh: how far below the lowest point the bottom lies, metres. 0: half of the pattern's depth.
    double base = 0.0;
    int threads = 0;  // 0: all. The result is the same.
};

// Which facet of which element a triangle lies on: as evaluate.hpp has it, kGround and kWall included.
struct Origin {
    std::uint32_t element = 0;  // of ResolvedPattern::elements
    std::uint32_t facet = 0;
};

// One tile of the pattern: [0, size] in plan. Corners shared by triangles are stored once; front faces are counter-clockwise seen
// from outside the solid, in axes x right, y down, z towards the viewer: their normal is (q - p) x (r - p) there.
struct TriangleMesh {
    std::vector<reference::Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Origin> origins;  // of each triangle
    double tolerance = 0.0;       // as used
    double lowest = 0.0;          // of the surface, metres
};

// Of a map that ends, not closed, walls on the border reach to outer_level.
// Ensures: every edge inside the map is shared by as many triangles that run along it one way as the other; with `closed` all are. Corners
// nearer to each other than a 32nd of the tolerance are one. Equal input gives equal output.
// Fails with invalid_argument: an option out of its range; limit_exceeded: more than kMaxTriangles.
// Cost: some 20 us a triangle, most of it the triangulation, which runs on one core.
Result<TriangleMesh> mesh_pattern(const ResolvedPattern& pattern, const CellGrid& grid, const MeshOptions& options = {});

// Edges that are not matched by one that runs the other way: 0 for a surface without holes or borders.
std::size_t count_open_edges(const TriangleMesh& mesh);

}  // namespace burin::mesh
