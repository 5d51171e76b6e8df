// Where one resolved element acts and at which offset, with the derivative of the offset by the element's points.
// The rules are those of `resolve.hpp`. Lengths in texels.
#pragma once

#include <algorithm>

#include <burin/geometry.hpp>
#include <burin/resolve.hpp>

namespace burin::refinement {

// Foot of a point on an element's carrier.
struct Foot {
    double parameter = 0.0;  // of the curve; outside [0, 1] on a line's carrier or a quadratic's tangent continuation
    double offset = 0.0;     // b, signed distance along the normal
    double distance = 0.0;   // to the element itself
    Vec2 tangent;            // unit
    double bend = 0.0;       // second derivative of the offset along the tangent
    double weight[3] = {};   // share of p0, p1, p2 in the foot: d b = -n . sum weight_k d p_k
};

struct EndFrame {
    ElementEnd end;
    Vec2 vertex;
    Vec2 outward;         // unit tangent pointing out of the element
    Vec2 clip_normal;     // unit; the element's side is where (p - vertex) . clip_normal >= 0
    Vec2 bevel_normal;    // m / cos(theta / 2)
};

struct ElementFrame {
    ElementKind kind = ElementKind::line;
    Vec2 p0, p1, p2;
    Vec2 tangent0, tangent1;  // unit, along the path
    double size = 0.0;        // length of the chord (line) or of the control polygon
    double bow = 0.0;         // greatest curvature, > 0 where the centre of curvature lies at b > 0
    EndFrame start, end;
    double width0 = 1.0, width1 = 1.0, height0 = 1.0, height1 = 1.0;
};

// What an element does at a point.
struct Placement {
    bool acts = false;
    double offset = 0.0;    // b'
    Vec2 gradient;          // of b' by the point; d b' = -gradient . sum weight_k d p_k
    double weight[3] = {};
    double along = 0.0;     // curve parameter within [0, 1], for the scales
    double bend = 0.0;      // second derivative of b' along the direction perpendicular to the gradient
};

ElementFrame frame_of(const ResolvedElement& element);

// `guess`: a curve parameter near the foot of a quadratic, or negative when there is none.
Foot foot_of(const ElementFrame& frame, Vec2 p, double guess = -1.0);

// Whether the offset within `radius` of the foot's point differs from the foot's by no more than the radius. It does
// not where the foot may leap: near a quadratic's centre of curvature.
bool is_tame(const ElementFrame& frame, const Foot& foot, double radius);

// A guess for the feet of points within `radius` of the foot's point, where they lie near it.
inline double guess_near(const ElementFrame& frame, const Foot& foot, double radius) {
    return is_tame(frame, foot, radius) ? std::clamp(foot.parameter, 0.0, 1.0) : -1.0;
}

// `plain`: the point is known to be one where the foot alone tells, see Reach.
Placement place(const ElementFrame& frame, Vec2 p, const Foot& foot, bool plain);

// Whether any point within `margin` of p may be acted on by a profile that reaches left..right (scaled), and whether
// all of them are, plainly by the foot alone. Where an end is not shaped, the offset is the foot's wherever it acts.
struct Reach {
    bool possible = false;
    bool plain = false;
    bool shaped = false;  // an end's hip, round or bevel may change the offset somewhere
};
Reach reach_at(const ElementFrame& frame, Vec2 p, const Foot& foot, double left, double right, double margin);

}  // namespace burin::refinement
