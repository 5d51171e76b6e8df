// Internal to the fit stage: breakpoints that are worth trying, and one element fitted between two of them.
#pragma once

#include <limits>
#include <vector>

#include "fit_chain.hpp"

namespace burin::fit {

constexpr long kFewestPoints = 4;  // spacings that a quadratic spans at least

// A quadratic between the frames of two candidates, which fits its neighbours, or one that fits the points
// alone, which is what stands beside a line or a corner.
enum class Kind { line, between, alone };

// How far the points left out at a piece's ends lie off it, at most: what a raster rounds off, or a bend that
// a corner would hide.
struct Ends {
    double first = 0.0, last = 0.0;
};

struct Piece {
    long a = 0, b = 0;  // candidate numbers
    bool quadratic = false;
    double cost = 0.0;
    double length = 0.0;
    Vec2 start, control, end;
    Vec2 direction_in, direction_out;  // at its start, at its end
    Ends ends;
    // Dynamic programme.
    double best = std::numeric_limits<double>::infinity();
    long previous = -1;
    bool corner = false;  // the joint at its start
};

// Position and tangent of the curve at a candidate, from the points on both sides.
struct Frame {
    bool known = false;
    Vec2 p;
    Vec2 t;
};

// Candidate breakpoints (fit_candidates.cpp): the vertices of a polyline within `tolerance`; the same with
// more of them where pieces may have to end.
std::vector<long> candidates_of(const Points& points, double tolerance);
std::vector<long> breakpoints_of(const Points& points, double tolerance);

// The frame of the curve at point i.
Frame frame_at(const Points& points, const FitOptions& options, long i);

// Least squares line through the points from `first` to `last`; false when it misses the tolerance.
bool fit_line(const Points& points, const FitOptions& options, long first, long last, Piece& piece);

// Least squares quadratic, likewise; `reach` is the length left out at either end.
bool fit_quadratic(const Points& points, const FitOptions& options, double reach, long first, long last,
                   Piece& piece);

// The quadratic between two frames: it leaves no kink at a joint with the next such piece.
bool fit_between(const Points& points, const FitOptions& options, const Frame& a, const Frame& b, long first,
                 long last, Piece& piece);

// Whether an arc of a circle follows the points from `first` to `last` (least squares on x^2 + y^2 + a x + b
// y + c).
bool arc_fits(const Points& points, const FitOptions& options, long first, long last);

// Distance of a place to the polyline of the points near index i.
double distance_to_row(const Points& points, Vec2 p, long i);

}  // namespace burin::fit
