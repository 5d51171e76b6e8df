// Lines and quadratic Béziers of the stages from vectorize to grid: points, tangents, parts, nearest points,
// flattening. Private to lib. The truth has its own formulas on purpose: it judges what is computed here.
#pragma once

#include <vector>

#include <burin/pattern.hpp>

namespace burin::curve {

Vec2 point(const Element& element, double s);
// Derivative by the parameter; not of unit length.
Vec2 derivative(const Element& element, double s);
// Unit tangent along the element, also where the derivative vanishes (control point on an end).
Vec2 tangent(const Element& element, double s);
// The piece between two parameters, s0 < s1; scales are interpolated. Ends at 0 and 1 are kept bit by bit.
Element part(const Element& element, double s0, double s1);
Element translated(const Element& element, Vec2 by);
// Parameter in [0, 1] of a point of the arc nearest to p.
double nearest(const Element& element, Vec2 p);
// Box of the control points: contains the arc.
Box control_box(const Element& element);
// Length of the arc, within about 1e-6 of it.
double arc_length(const Element& element);
// Argument of the path's perturbation at s, as resolve.hpp defines it.
double argument(const Element& element, double s);
// Number of equal parameter steps whose chords stay within `tolerance` of the arc.
int chord_count(const Element& element, double tolerance);
// Angle by which the tangent turns, radians [0, pi].
double turning(const Element& element);

}  // namespace burin::curve
