// Curve fitting: turns an ordered row of sub-pixel points into the fewest lines and quadratics within a
// tolerance.
//
//     trace_contours, centre lines --[fit_curve]--> chain of Element --> Path
//
// The points are measurements, about one texel apart, each wrong by 0.01 to 0.5 texel across the curve. A fit
// that follows them too closely turns a straight wall into a staircase and costs an element every few texels;
// one that follows too loosely rounds corners. What is wanted, in this order: within the tolerance, few
// elements, tangents continuous wherever the curve does not turn sharply, straight runs exactly straight,
// corners exactly sharp.
//
// Units: the caller's; `tolerance`, `corner_reach` and `period` have the unit of the points (texels in the
// vectorizer). Angles in radians. Words: a joint is the point where two elements meet; it is a corner, where
// the direction turns by at least `corner_angle`, or smooth, where both elements have the same tangent up to
// rounding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <burin/geometry.hpp>
#include <burin/pattern.hpp>
#include <burin/result.hpp>

namespace burin {

struct FitOptions {
    // Bound on the distance of the points to the curve, > 0. Three times the points' noise is a good value:
    // less makes the curve follow noise, and the number of elements grows quickly. A single point whose
    // neighbours are within the bound is noise and not shape: it may err by half as much again.
    double tolerance = 0.15;

    // Least turn of a corner, in (0, pi). A kink that turns less is bent into the neighbouring curves where
    // the tolerance bears it. A turn that an arc within the tolerance explains as well is no corner, however
    // sharp.
    double corner_angle = 0.45;

    // What a corner that hardly turns costs beside a curve, in elements, 0 or more; less the more it turns. The
    // rim of a plateau bends more often than it has such a corner; a centre line that cuts its corners may have
    // it.
    double blunt_cost = 0.0;

    // Points closer than this to a corner are not looked at, 0 or more: a raster rounds a right-angled corner
    // within about one texel of its tip. For a sharper corner of inner angle a the distance grows by the
    // factor 1 / tan(a / 2), up to 5, since the tip of a spike narrower than a texel is lost in the raster. 0
    // for points that are exact up to the corner.
    double corner_reach = 1.0;

    // The curve returns to its start: after the last point comes first point + `period`.
    bool closed = false;

    // For a closed curve, what lies between its end and its start; (0, 0) for a loop, a tile's size along u
    // or v for a curve that crosses the border of a repeating map and meets itself there. Ignored for open
    // curves.
    Vec2 period{0.0, 0.0};

    // Open curves: the chain starts (ends) exactly at the first (last) point, which is then taken as exact.
    // Without, the ends lie beside the first and last point, on the curve that fits best.
    bool pin_start = false;
    bool pin_end = false;

    // Empty, or one weight per point, 0 or more: the confidence in a point. A point of weight 0 is not looked
    // at, and its error not counted.
    std::span<const double> weights = {};
};

struct FitResult {
    // Consecutive elements meet bit by bit (p2 == next p0); in a closed chain the last p2 is the first p0 +
    // period. Width and height scales are 1.
    std::vector<Element> elements;

    // Joint i is the start of element i: 0 when smooth, 1 when its tangents differ: a corner, or a smaller
    // kink that the tolerance did not allow to be rounded. Entry 0 is 1 for an open curve.
    std::vector<std::uint8_t> corner;

    // Element i was fitted to points[first_point[i]] up to, not including, points[first_point[i + 1]]; has
    // one entry more than `elements`. Never decreases. In a closed curve the chain may start at any point:
    // indices count on past the end of the row, so index j means points[j % n] + period * (j / n).
    std::vector<std::size_t> first_point;

    // Distance of points to the curve, largest and root mean square, over the points that count (see
    // corner_reach and weights).
    double max_error = 0.0;
    double rms_error = 0.0;
};

// Fits a chain of lines and quadratics.
//
// Requires (asserted): options in their ranges, weights empty or as many as points.
//
// Ensures:
//   within_tolerance  no two neighbouring points err by more than the tolerance and none by more than 1.5
//   times that,
//                     unless detail is so fine that elements would get shorter than about five points (a
//                     zigzag of two texels); then max_error says by how much
//   few               a dynamic programme over the breakpoints that a fine polyline offers, then removal of
//   every joint
//                     that can go. A straight run is one line, whatever its direction; an arc of angle a and
//                     radius r takes about a / (256 tolerance / r)^(1/4) quadratics
//   smooth            at smooth joints the tangents agree within 1e-6 radian
//   sharp             a corner lies where its two neighbours meet, not at a sample
//   deterministic     equal input gives equal bytes
//
// Degenerate input: repeated points are merged. A loop of fewer than 8 points becomes an oval of four
// quadratics; a loop always keeps an inside (two curves or three lines at least).
//
// Fails with invalid_input when a coordinate is not finite or fewer than two different points remain.
//
// Time grows with points, 1 microsecond each on polygons to 20 on wavy outlines; memory with points. Safe to
// call from many threads, one curve each.
Result<FitResult> fit_curve(std::span<const Vec2> points, const FitOptions& options = {});

// The point of an element at curve parameter t in [0, 1], and the derivative there.
Vec2 point_at(const Element& element, double t);
Vec2 derivative_at(const Element& element, double t);

}  // namespace burin
