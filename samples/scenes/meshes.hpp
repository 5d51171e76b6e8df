// The surfaces that scenes are on. Tangents are left to the viewer: along u, as uv says.
#pragma once

#include <functional>

#include "scenes.hpp"

namespace burin::scenes {

struct SurfacePoint3 {
    std::array<double, 3> position;
    std::array<double, 3> normal;
};

// A sheet over uv [0,1]² in columns x rows pieces. With u to the right and v down the outside must face the reader,
// so that triangles come out counter-clockwise.
Mesh make_sheet(int columns, int rows, const std::function<SurfacePoint3(double u, double v)>& at);

using Vec3 = std::array<double, 3>;

// A parallelogram with uv (0,0) at `corner`; u runs along `across`, v along `down`, in tiles of that many metres. The outside is
// down x across.
Mesh make_quad(Vec3 corner, Vec3 across, Vec3 down, Vec2 tile);
// Box without top and bottom: four sides of one tile size, their uv (0,0) at the upper left of each.
Mesh make_sides(Vec3 low, Vec3 high, Vec2 tile);

// Rectangle of uv [0,1]², centred: size.x along +x, size.y along +z, facing up; as burin::make_plane.
Mesh make_rectangle(Vec2 size);
// u once around eastwards, v from the north pole to the south pole; the poles are cut off at `cap` radians.
Mesh make_sphere(double radius, double cap = 0.0);
// Upright side of a cylinder or cone, u around, v down; the middle of its axis is the origin. `repeat`: how many tiles
// around and down.
Mesh make_column(double top_radius, double bottom_radius, double height, Vec2 repeat = {1, 1});
// A ring seen from above, u around, v from the inner rim to the outer; both rims bend down by `bend` metres.
Mesh make_ring(double inner, double outer, double bend, double tiles_around);

// The mesh turned about y by `degrees`, then moved.
Mesh placed(Mesh mesh, double degrees, std::array<double, 3> by);
void append(Mesh& to, const Mesh& mesh);

}  // namespace burin::scenes
