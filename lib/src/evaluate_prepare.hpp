// Internal to lib: a ResolvedPattern made ready for many questions, and the few functions that say where an
// element acts. evaluate*.cpp and rasterize.cpp include it; nothing else does.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <burin/evaluate.hpp>

namespace burin {

struct PreparedEnd {
    Vec2 vertex;
    Vec2 outward;      // unit tangent pointing away from the element: a = (p - vertex) . outward
    Vec2 clip_inward;  // unit normal of the clip line towards the element: p is on its side when (p - vertex)
                       // . it >= 0
    Vec2 bevel;        // m / (m.n): b' = (p - vertex) . bevel
    Priority priority = Priority::none;
    CornerShape corner = CornerShape::mitre;
    EndShape end = EndShape::clip;
};

struct PreparedProfile {
    std::vector<ProfilePoint> points;
    std::vector<double> slope;  // per facet, dh/db; 0 for a vertical one
    std::uint32_t internal_mask = 0;
    double low = 0.0, high = 0.0;  // least and greatest b
    bool height_field = true;      // b never decreases
};

struct PreparedElement {
    ElementKind kind = ElementKind::line;
    Vec2 p0, p2;
    Vec2 tangent;       // line: unit tangent
    double length = 0;  // line: p0 to p2
    Vec2 edge, bend;    // quadratic: B(u) = p0 + 2 u edge + u^2 bend
    PreparedEnd ends[2];
    double width0 = 1, width_rise = 0, height0 = 1, height_rise = 0;
    bool scaled = false;  // a scale varies along the element
    // Function along the path, if any, and what its argument is made of.
    const ScaleFunction* function = nullptr;
    double argument0 = 0, argument_rise = 0;
    double run = 1;  // quadratic: L(1) of resolve.hpp
    double width_bound = 1, height_bound = 1;  // greatest factors
    bool step = false;
    std::uint32_t profile = 0;
    double level = 0, left_level = 0, right_level = 0;
    double reach = 0;  // greatest |b'| at which it can act
    Box box;           // everything it can change
};

struct Truth::Prepared {
    Vec2 size{1, 1};
    bool repeat = true;
    double outer_level = 0, depth = 1, level_tolerance = 0, max_tiles = 0;
    double lowest = 0, highest = 0;  // bounds of the whole surface
    std::vector<double> levels;      // every level of ground that occurs
    std::vector<PreparedElement> elements;
    std::vector<PreparedProfile> profiles;
    std::vector<ScaleFunction> functions;
    std::vector<std::uint32_t> steps;  // elements that change the ground
    std::vector<std::uint32_t> all;    // 0, 1, 2, ...
};

namespace truth {

// Which of the rules of resolve.hpp gives b' at a point.
enum class FormKind : std::uint8_t {
    none,     // the element does not act
    plain,    // b' = b
    across,   // hip: b' = sign * a
    radial,   // round: b' = sign * |p - vertex|
    slanted,  // bevel: b' = (p - vertex) . bevel
};
struct Form {
    FormKind kind = FormKind::none;
    std::uint8_t end = 0;  // index of the end that rules, for all but plain
    double sign = 1.0;
};

// What the function of an element makes of its scales at u, and the rates of that per u.
struct Factors {
    double width = 1, height = 1, width_rate = 0, height_rate = 0;
};
Factors factors_on(const PreparedElement& e, double u);
// Of a quadratic: L of resolve.hpp, the integral of |B'| / 2, and its rate.
struct Run {
    double length = 0, rate = 0;
};
Run run_to(const PreparedElement& e, double u);
// Bounds of both factors over all arguments of an element, by what a function of its kind can give.
void bound_factors(PreparedElement& e);

// Nearest point of the carrier.
struct Foot {
    double offset = 0;     // b
    double parameter = 0;  // of the curve, clamped to [0, 1] beyond the ends
};
Foot find_foot(const PreparedElement& e, Vec2 p);

// b' and scales at a point for a form that was found there or nearby.
struct Local {
    double offset = 0;  // b'
    double width = 1, height = 1;
};
Form find_form(const PreparedElement& e, Vec2 p, const Foot& foot);
Local evaluate_form(const PreparedElement& e, const Form& form, Vec2 p, const Foot& foot);

// The rates of b', width and height in the plane, for normals.
struct LocalGradient {
    Vec2 offset, width, height;
};
LocalGradient gradient_of(const PreparedElement& e, const Form& form, Vec2 p, const Foot& foot);

// Whether the element acts at p on the ground `ground`, and how. With a null `form` nobody asks for it.
bool acts_at(const Truth::Prepared& truth, const PreparedElement& e, Vec2 p, double ground, Local& local,
             Form* form = nullptr);
// The same where the foot is known.
bool acts_at(const Truth::Prepared& truth, const PreparedElement& e, Vec2 p, const Foot& foot, double ground, Local& local,
             Form* form = nullptr);

// Calls visit(shift) for each tile image of e whose box holds p or meets the box [low, high]; the image is e
// moved by shift. Exactly one image, (0, 0), when the pattern does not repeat.
template <typename Visit>
void for_each_image(const Truth::Prepared& truth, const Box& box, Vec2 low, Vec2 high, Visit&& visit) {
    if (!truth.repeat) {
        if (box.low.x <= high.x && box.high.x >= low.x && box.low.y <= high.y && box.high.y >= low.y)
            visit(Vec2{0, 0});
        return;
    }
    const double x0 = std::ceil((low.x - box.high.x) / truth.size.x),
                 x1 = std::floor((high.x - box.low.x) / truth.size.x);
    const double y0 = std::ceil((low.y - box.high.y) / truth.size.y),
                 y1 = std::floor((high.y - box.low.y) / truth.size.y);
    for (double i = x0; i <= x1; ++i)
        for (double j = y0; j <= y1; ++j) visit(Vec2{i * truth.size.x, j * truth.size.y});
}

// Real roots of a x^2 + b x + c = 0 in ascending order; returns how many. With a = b = 0: none.
int solve_quadratic(double a, double b, double c, double roots[2]);

inline Vec2 point_on(const PreparedElement& e, double u) {
    return e.kind == ElementKind::line ? lerp(e.p0, e.p2, u) : e.p0 + e.edge * (2.0 * u) + e.bend * (u * u);
}
Vec2 tangent_on(const PreparedElement& e, double u);  // unit

// Places u in [0, 1] where the path line of e meets the line p + s d; returns how many (0 to 2).
int meet_line(const PreparedElement& e, Vec2 p, Vec2 d, double u[2]);

// Offset b is b' / width scale; rise is z above the element's level; facets stand at height_scale * h.
bool in_add(const PreparedProfile& profile, double b, double rise,
            double height_scale);  // above ground: caller asks
bool in_cut(const PreparedProfile& profile, double b, double rise, double height_scale);

bool inside_map(const Truth::Prepared& truth, Vec2 p);
Vec2 into_tile(const Truth::Prepared& truth, Vec2 p);
bool solid_at(const Truth::Prepared& truth, Vec2 p, double z, double ground);

}  // namespace truth
}  // namespace burin
