// Lines on the surface as lines in the charts that their width touches. For the sources of this library only.
#pragma once

#include <vector>

#include "stroke_trace.hpp"

namespace burin::stroking {

// The middle of a stroke as one chart sees it: unfolded into the chart's plane where it runs outside of it.
struct PiecePoint {
    double s = 0.0;      // metres along the trace
    Vec2 p;              // metres of the pattern
    Vec2 along;          // the pattern's step per metre of the trace
    double width = 0.0;  // of the stroke, metres of the pattern
    Point3 place;        // of the middle, on the surface
    // Metres along the trace by which an end that is square in the pattern falls short of what lies across in space.
    double ahead = 0.0, behind = 0.0;
};

// What of a trace shows in one chart.
struct Piece {
    std::uint32_t chart = 0;
    std::vector<PiecePoint> points;  // two or more, along the trace
    bool starts = false, ends = false;  // with the trace itself, whose cap it has, rather than at a border
    bool closed = false;
    Vec2 period;  // of a closed piece: from its start to its end, whole tiles
};

struct PieceOptions {
    double width = 0.0;    // metres in space
    double spacing = 0.0;  // of points along the trace, metres
    bool open_caps = true; // the ends' caps reach half a width beyond them
};

struct Pieces {
    std::vector<Piece> pieces;
    int borders = 0;       // times that the middle passed into another chart
    double length = 0.0;   // of the trace, metres
    double lost = 0.0;     // metres of it on triangles without area in uv
};

Pieces pieces_of(const Surface& surface, const Trace& trace, const PieceOptions& options);

}  // namespace burin::stroking
