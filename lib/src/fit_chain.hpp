// Internal to the fit stage: the points as the fit sees them, and the curve as a control polygon.
//
// A chain of lines and quadratics that is tangent-continuous has a control polygon: each quadratic
// contributes its control point, each corner itself, and every joint lies on a side of the polygon. Written
// that way the curve is smooth by construction, whatever the optimiser does to the vertices.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <burin/fit.hpp>

namespace burin::fit {

// The points, indexed from -2 count to 3 count - 1 when closed (five turns, so that elements may straddle the
// start and their neighbours still be looked up), else from 0 to count - 1.
class Points {
  public:
    Points(std::vector<Vec2> once, std::vector<double> weight_once, bool is_closed, Vec2 turn);

    Vec2 operator[](long i) const { return p_[static_cast<std::size_t>(i + shift_)]; }
    double weight(long i) const {
        return weight_.empty() ? 1.0 : weight_[static_cast<std::size_t>(i + shift_)];
    }
    double arc(long i) const { return arc_[static_cast<std::size_t>(i + shift_)]; }
    bool weighted() const { return !weight_.empty(); }

    long count = 0;  // of one turn
    bool closed = false;
    Vec2 period;
    // Index just past what the chain covers when it starts at 0: an open chain ends with its last point, a
    // closed one with the first point of the next turn.
    long end() const { return closed ? count : count - 1; }
    long first() const { return closed ? -2 * count : 0; }            // smallest index
    long last() const { return closed ? 3 * count - 1 : count - 1; }  // largest index

  private:
    std::vector<Vec2> p_;
    std::vector<double> weight_;
    std::vector<double> arc_;  // length along the polyline
    long shift_ = 0;
};

// Vertex k and side k (from vertex k to vertex k + 1) of the control polygon.
struct Vertex {
    Vec2 v;
    bool corner = false;  // the curve passes through v; otherwise v is the control point of a quadratic
    long begin = 0;       // points [begin, end) belong to the quadratic; begin == end for a corner
    long end = 0;
    // The side: the joints at its start and end as fractions of it. They coincide when the side carries no
    // line.
    bool line = false;
    double s0 = 0.0;
    double s1 = 0.0;
    unsigned tried = 0;  // moves of simplify_chain that have failed here, by bit
};

struct Chain {
    std::vector<Vertex> vertices;  // open: the first and the last are corners
    bool closed = false;
    Vec2 period;
    long turn = 0;  // points of one turn (closed)

    long size() const { return static_cast<long>(vertices.size()); }
    long sides() const { return closed ? size() : size() - 1; }
    long wrap(long k) const { return closed ? ((k % size()) + size()) % size() : k; }
    long turns(long k) const { return closed ? (k - wrap(k)) / size() : 0; }
    Vertex& at(long k) { return vertices[static_cast<std::size_t>(wrap(k))]; }
    const Vertex& at(long k) const { return vertices[static_cast<std::size_t>(wrap(k))]; }
    Vec2 position(long k) const { return at(k).v + period * static_cast<double>(turns(k)); }
    long begin(long k) const { return at(k).begin + turn * turns(k); }
    long end(long k) const { return at(k).end + turn * turns(k); }
    Vec2 joint_out(long k) const {
        return lerp(position(k), position(k + 1), at(k).s0);
    }  // first joint on side k
    Vec2 joint_in(long k) const {
        return lerp(position(k - 1), position(k), at(k - 1).s1);
    }  // last on side k - 1
    // Points of the piece that ends (begins) at corner k.
    long line_or_quadratic_before(long k) const { return at(k - 1).line ? end(k - 1) : begin(k - 1); }
    long line_or_quadratic_after(long k) const { return at(k).line ? begin(k + 1) : end(k + 1); }
    long elements() const;
};

// What the fit minimises, about in elements. A quadratic takes two texels in the data texture where a line
// takes one, and a slower search in the shader; besides, a straight run should be a line even where a curve's
// slack would cover it.
constexpr double kLineCost = 0.65;
constexpr double kQuadraticCost = 1.25;

// At a mean square error of the tolerance squared. High enough that straight lines and a corner win over a
// bow that just keeps within the tolerance; the price is a seventh more quadratics on an arc than the
// tolerance asks for.
constexpr double kErrorCost = 1.5;

inline double piece_cost(double base, double mean_square, double tolerance) {
    return base + kErrorCost * mean_square / (tolerance * tolerance);
}

// A run of vertices [first, first + count) that may move; the rest stays.
struct Window {
    long first = 0;
    long count = 0;
};

// Errors of points in a row. A single point that strays, with neighbours that do not, is noise and not shape:
// it may err half as much again as the tolerance. So what is held against the tolerance is the larger of e
// / 1.5 and min(e, the larger of its neighbours' errors). In a row of fewer than 12 points every point counts
// as it is: there a bow's middle and its ends look like single points.
struct ErrorTally {
    double judged = 0.0;
    double largest = 0.0;
    long where = 0;  // count of points before the one of the largest error
    double sum_of_squares = 0.0;
    long counted = 0;

    void add(double e) {
        // Here the neighbours of the point before are known.
        judged = std::max(judged, std::max(std::min(last_, std::max(before_, e)), e * (1.0 / 1.5)));
        before_ = last_;
        last_ = e;
        if (e > largest) largest = e, where = counted;
        sum_of_squares += e * e;
        ++counted;
    }
    double finish() const { return counted < 12 ? largest : std::max(judged, std::min(last_, before_)); }

  private:
    double before_ = 0.0, last_ = 0.0;
};

struct PieceError {
    double judged = 0.0;  // to be held against the tolerance
    double largest = 0.0;
    long where = 0;  // point of the largest error
    double sum_of_squares = 0.0;
    long counted = 0;
};

// Which points count for a piece between two joints: those not within reach of a corner.
struct PointRange {
    long begin = 0;
    long end = 0;
};

PointRange ignored_range(const Chain& chain, const Points& points, long k, double corner_reach);
PointRange quadratic_range(const Chain& chain, const Points& points, long k, double corner_reach);
PointRange line_range(const Chain& chain, const Points& points, long k, double corner_reach);
PieceError quadratic_error(const Chain& chain, const Points& points, long k, double corner_reach);
PieceError line_error(const Chain& chain, const Points& points, long k, double corner_reach);

// How far the points about corner k lie off its sides, beyond what a raster takes off a corner (half its
// reach).
double excess_at_corner(const Chain& chain, const Points& points, long k, double corner_reach);

// The distance within which a raster rounds a corner between directions `in` and `out` (unit vectors).
double corner_radius(Vec2 in, Vec2 out, double corner_reach);

// Foot of p on the quadratic: parameter in [0, 1], starting the search at `guess`.
double closest_parameter(Vec2 p0, Vec2 p1, Vec2 p2, Vec2 p, double guess);

// Moves the borders between the pieces' points to where the joints now are.
void assign_points(Chain& chain, const Points& points, Window window);

// Where a closed row is best cut: in the middle of its longest straight span, away from anything that
// matters.
long seam_of(const Points& points, const FitOptions& options);

// The curve as nothing but lines and corners, through some of its points: within the tolerance whatever they
// are.
Chain polyline_chain(const Points& points, const FitOptions& options);

// Dynamic programme: the cheapest chain over the candidate breakpoints (fit_segment.cpp).
Chain segment_points(const Points& points, const FitOptions& options);

// One element alone, unconstrained, for the points from `first` to `last`: cheap, and a bound for any chain
// that spans them with one.
struct OnePiece {
    bool fits = false;  // within the tolerance
    double cost = 0.0;
    Vec2 direction;  // at its start
};
OnePiece one_line(const Points& points, const FitOptions& options, long first, long last);
OnePiece one_quadratic(const Points& points, const FitOptions& options, long first, long last);

// What refine_chain makes small: the mean square, best against noise, or something near the largest error,
// for a chain that just misses the tolerance.
enum class Aim { mean_square, largest };

// Least squares over the polygon's vertices and joints (fit_refine.cpp). Returns the weighted sum of squares.
double refine_chain(Chain& chain, const Points& points, const FitOptions& options, Window window, Aim aim,
                    int iterations);

// Largest error of a chain, as it is held against the tolerance.
double judged_error(const Chain& chain, const Points& points, const FitOptions& options);

// Whether a loop meets itself, by exact predicates on a polyline of four points per quadratic
// (fit_simple.cpp).
bool crosses_itself(const Chain& chain);

// Splits pieces until all are within tolerance, then removes what can go (fit_simplify.cpp).
void repair_chain(Chain& chain, const Points& points, const FitOptions& options);
void simplify_chain(Chain& chain, const Points& points, const FitOptions& options);

}  // namespace burin::fit
