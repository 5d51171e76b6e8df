// Columns over a plan as one closed surface.
#pragma once

#include <optional>

#include "walls.hpp"

namespace burin::mesh {

struct SurfaceOptions {
    double fine = 0.0;    // metres: heights nearer than this over one corner are one
    bool closed = false;  // with sides on the border and a bottom
    // Height of the solid around the map, where it is not closed: walls stand on the border. Nothing: it goes on beyond.
    std::optional<double> outside;
};

// Takes the plan, whose edges are divided where surfaces of neighbouring columns cross above them. Cost: linear in the columns.
TriangleMesh close_surface(Plan plan, const Columns& columns, const Walls& walls, const SurfaceOptions& options);

}  // namespace burin::mesh
