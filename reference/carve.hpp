// What of the faces is the surface: all additions before any subtraction. [2008] 6.2, DESIGN 2
//
//     LocalGeometry --[carve_faces]--> pieces of faces
//
// A face of the ground or of an addition is lost where it lies inside an addition of another element, or in any cut; a
// face of a cut is lost in another element's cut, and where there was nothing to cut. Of faces that coincide the one of the
// element that comes first stays, and the ground's before all, as the truth has it.
#pragma once

#include "sweep.hpp"

namespace burin::reference {

struct Piece {
    std::uint32_t face = 0;  // index into LocalGeometry::faces
    Polygon polygon;         // in LocalGeometry::points
};

// Memory of one thread, used again and again.
struct Carving {
    std::vector<Piece> pieces;
    std::vector<HalfSpace> halves;          // of all brushes
    std::vector<std::uint32_t> first_half;  // of each brush, and one past the last
    std::vector<Polygon> kept, next, solid;
};

// Fills out.pieces. Cost: faces times brushes whose boxes meet.
void carve_faces(LocalGeometry& geometry, const GroovedSurface& surface, const Gathered& gathered, Carving& out);

}  // namespace burin::reference
