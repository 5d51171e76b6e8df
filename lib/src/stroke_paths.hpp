// Pieces of strokes as paths of few elements. For the sources of this library only.
#pragma once

#include "stroke_pieces.hpp"

namespace burin::stroking {

struct PathOptions {
    double width = 0.0;      // of the stroke, metres in space
    double spacing = 0.0;    // of points along the trace, metres in space
    double tolerance = 0.0;  // of positions, metres in space
    double base = 0.0;       // of the profile, metres of the pattern: what scales multiply
};

// Elements alone; the scales of heights are 1.
Result<Path> path_of(const Piece& piece, const PathOptions& options);

}  // namespace burin::stroking
