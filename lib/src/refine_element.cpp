#include "refine_element.hpp"

#include <algorithm>
#include <cmath>

namespace burin::refinement {
namespace {

// Texels neither overflow nor vanish: the care of std::hypot is not needed where every texel is looked at.
double norm(Vec2 a) { return std::sqrt(dot(a, a)); }

Vec2 direction(Vec2 a) {
    const double l = norm(a);
    return l > 0.0 ? a * (1.0 / l) : Vec2{1.0, 0.0};
}

Vec2 curve_point(const ElementFrame& f, double s) {
    return lerp(lerp(f.p0, f.p1, s), lerp(f.p1, f.p2, s), s);
}

EndFrame end_frame(const ElementEnd& end, Vec2 vertex, Vec2 outward) {
    EndFrame out{end, vertex, outward, {}, {}};
    const Vec2 clip{std::cos(end.clip_angle), std::sin(end.clip_angle)};
    const Vec2 across = normal_of(clip);
    out.clip_normal = dot(across, outward) <= 0.0 ? across : -across;
    const Vec2 normal = normal_of(outward);
    const double cosine = dot(clip, normal);
    if (std::abs(cosine) > 1e-6) out.bevel_normal = clip * (1.0 / cosine);
    return out;
}

// The cross product of first and second derivative is constant along a quadratic: it bends most where it is slowest.
double greatest_curvature(const ElementFrame& f) {
    const Vec2 first = 2.0 * (f.p1 - f.p0), second = 2.0 * (f.p0 - 2.0 * f.p1 + f.p2);
    const double square = dot(second, second);
    if (square <= 0.0) return 0.0;
    const double slowest = std::clamp(-dot(first, second) / square, 0.0, 1.0);
    const double speed = std::max(1e-9, norm(first + second * slowest));
    return cross(first, second) / (speed * speed * speed);
}

// Derivative of half the squared distance to the point, and its derivative, by the curve parameter.
double nearest_parameter(const ElementFrame& f, Vec2 p, double guess) {
    const Vec2 second = f.p0 - 2.0 * f.p1 + f.p2;
    double s = guess;
    if (guess < 0.0) {
        double best = 1e300;
        for (int i = 0; i <= 4; ++i) {
            const Vec2 d = curve_point(f, 0.25 * i) - p;
            if (dot(d, d) < best) best = dot(d, d), s = 0.25 * i;
        }
    }
    const Vec2 leg = f.p1 - f.p0, from = f.p0 - p;
    for (int i = 0; i < 12; ++i) {
        const Vec2 half = leg + second * s;  // of the first derivative
        const Vec2 d = from + (leg + half) * s;
        const double square = dot(half, half);
        const double curvature = std::max(2.0 * square + dot(d, second), 0.2 * square);
        const double next = std::clamp(s - dot(d, half) / std::max(curvature, 1e-300), 0.0, 1.0);
        // The next step would be the square of this one.
        const bool settled = std::abs(next - s) < 1e-5;
        s = next;
        if (settled) break;
    }
    return s;
}

Foot foot_on_line(const ElementFrame& f, Vec2 p) {
    Foot foot;
    const Vec2 r = p - f.p0;
    const double along = dot(r, f.tangent0);
    foot.tangent = f.tangent0;
    foot.offset = dot(r, normal_of(f.tangent0));
    foot.parameter = along / f.size;
    foot.weight[0] = 1.0 - foot.parameter;
    foot.weight[2] = foot.parameter;
    const double beyond = std::max({0.0, -along, along - f.size});
    foot.distance = std::sqrt(foot.offset * foot.offset + beyond * beyond);
    return foot;
}

// The straight continuation of a quadratic beyond its start or its end.
void continue_straight(const ElementFrame& f, Vec2 p, bool at_start, Foot& foot) {
    const Vec2 vertex = at_start ? f.p0 : f.p2;
    const double leg = std::max(1e-9, norm(at_start ? f.p1 - f.p0 : f.p2 - f.p1));
    const double along = dot(p - vertex, foot.tangent);
    foot.offset = dot(p - vertex, normal_of(foot.tangent));
    foot.bend = 0.0;
    const double ratio = along / leg;
    foot.weight[0] = at_start ? 1.0 - ratio : 0.0;
    foot.weight[1] = at_start ? ratio : -ratio;
    foot.weight[2] = at_start ? 0.0 : 1.0 + ratio;
    foot.parameter = at_start ? 0.5 * ratio : 1.0 + 0.5 * ratio;
}

Foot foot_on_quadratic(const ElementFrame& f, Vec2 p, double guess) {
    Foot foot;
    const double s = nearest_parameter(f, p, guess);
    const Vec2 d = p - curve_point(f, s);
    foot.distance = norm(d);
    foot.parameter = s;
    const Vec2 first = lerp(f.p1 - f.p0, f.p2 - f.p1, s) * 2.0;
    const double speed = std::max(1e-9, norm(first));
    foot.tangent = s <= 0.0 ? f.tangent0 : s >= 1.0 ? f.tangent1 : first * (1.0 / speed);
    const double along = dot(d, foot.tangent);
    if (s <= 0.0 && along < 0.0) return continue_straight(f, p, true, foot), foot;
    if (s >= 1.0 && along > 0.0) return continue_straight(f, p, false, foot), foot;
    foot.offset = dot(d, normal_of(foot.tangent));
    const double curvature = cross(first, 2.0 * (f.p0 - 2.0 * f.p1 + f.p2)) / (speed * speed * speed);
    foot.bend = -curvature / std::max(0.2, 1.0 - curvature * foot.offset);
    foot.weight[0] = (1.0 - s) * (1.0 - s);
    foot.weight[1] = 2.0 * s * (1.0 - s);
    foot.weight[2] = s * s;
    return foot;
}

double sign_of(double b) { return b < 0.0 ? -1.0 : 1.0; }

void set_at_vertex(Placement& placement, bool at_start, double offset, Vec2 gradient) {
    placement.offset = offset;
    placement.gradient = gradient;
    placement.bend = 0.0;
    placement.weight[0] = at_start ? 1.0 : 0.0;
    placement.weight[1] = 0.0;
    placement.weight[2] = at_start ? 0.0 : 1.0;
}

bool is_outer(const EndFrame& end, double b) {
    return (b < 0.0) == (end.end.priority == Priority::left);
}

// One end's say: false where the element does not act; changes the offset where the end's shape rules.
bool allow(const EndFrame& end, bool at_start, Vec2 p, double b, Placement& placement) {
    const Vec2 r = p - end.vertex;
    const double beyond = dot(r, end.outward);
    if (end.end.priority == Priority::none) return beyond <= 0.0;
    if (end.end.priority == Priority::both) {
        const EndShape shape = static_cast<EndShape>(end.end.shape);
        if (end.end.clips_both()) return dot(r, end.clip_normal) >= 0.0;
        if (beyond <= 0.0) return true;
        if (shape == EndShape::round) {
            set_at_vertex(placement, at_start, sign_of(b) * norm(r), direction(r) * sign_of(b));
        } else if (beyond > std::abs(b)) {
            set_at_vertex(placement, at_start, sign_of(b) * beyond, end.outward * sign_of(b));
        }
        return true;
    }
    if (!is_outer(end, b)) return beyond <= 0.0;
    if (dot(r, end.clip_normal) < 0.0) return false;
    if (beyond <= 0.0) return true;
    const CornerShape shape = static_cast<CornerShape>(end.end.shape);
    if (shape == CornerShape::round) {
        const double side = end.end.priority == Priority::left ? -1.0 : 1.0;
        set_at_vertex(placement, at_start, side * norm(r), direction(r) * side);
    } else if (shape == CornerShape::bevel) {
        // The outward tangent at the start runs against the path, so its normal does too.
        const Vec2 m = at_start ? -end.bevel_normal : end.bevel_normal;
        set_at_vertex(placement, at_start, dot(r, m), m);
    }
    return true;
}

void judge_end(const EndFrame& end, Vec2 p, double b, double widest, double margin, Reach& reach) {
    const Vec2 r = p - end.vertex;
    const double beyond = dot(r, end.outward);
    const double inside = dot(r, end.clip_normal);
    const bool within = beyond <= -margin;
    switch (end.end.priority) {
        case Priority::none:
            reach.possible &= beyond <= margin;
            reach.plain &= within;
            return;
        case Priority::both:
            if (end.end.clips_both()) {
                reach.possible &= inside >= -margin;
                reach.plain &= inside >= margin;
            } else {
                reach.possible &= beyond <= widest + margin;
                reach.plain &= within;
                reach.shaped |= !within;
            }
            return;
        default: {
            const bool clear = std::abs(b) >= margin, outer = is_outer(end, b);
            const bool plain_inner = within, possible_inner = beyond <= margin;
            const bool plain_outer = inside >= margin &&
                                     (within || (clear && end.end.shape == 0 && beyond <= 4.0 * widest));
            const bool possible_outer = inside >= -margin;
            reach.possible &= clear ? (outer ? possible_outer : possible_inner) : possible_inner || possible_outer;
            reach.plain &= clear ? (outer ? plain_outer : plain_inner) : plain_inner && plain_outer;
            reach.shaped |= end.end.shape != 0 && !within && (outer || !clear);
        }
    }
}

}  // namespace

ElementFrame frame_of(const ResolvedElement& resolved) {
    const Element& e = resolved.element;
    ElementFrame f;
    f.kind = e.kind;
    f.p0 = e.p0;
    f.p2 = e.p2;
    f.p1 = e.kind == ElementKind::line ? lerp(e.p0, e.p2, 0.5) : e.p1;
    f.tangent0 = direction(f.p1 == f.p0 ? f.p2 - f.p0 : f.p1 - f.p0);
    f.tangent1 = direction(f.p1 == f.p2 ? f.p2 - f.p0 : f.p2 - f.p1);
    if (e.kind == ElementKind::line) f.tangent0 = f.tangent1 = direction(e.p2 - e.p0);
    f.size = std::max(1e-9, norm(f.p1 - f.p0) + norm(f.p2 - f.p1));
    f.bow = greatest_curvature(f);
    f.start = end_frame(resolved.start, f.p0, -f.tangent0);
    f.end = end_frame(resolved.end, f.p2, f.tangent1);
    f.width0 = e.width0, f.width1 = e.width1;
    f.height0 = e.height0, f.height1 = e.height1;
    return f;
}

Foot foot_of(const ElementFrame& frame, Vec2 p, double guess) {
    return frame.kind == ElementKind::line ? foot_on_line(frame, p) : foot_on_quadratic(frame, p, guess);
}

bool is_tame(const ElementFrame& frame, const Foot& foot, double radius) {
    constexpr double kTame = 0.8;  // of the way to the centre of curvature
    return frame.bow * foot.offset + std::abs(frame.bow) * radius < kTame;
}

Placement place(const ElementFrame& frame, Vec2 p, const Foot& foot, bool plain) {
    Placement placement;
    placement.offset = foot.offset;
    placement.gradient = normal_of(foot.tangent);
    placement.bend = foot.bend;
    for (int k = 0; k < 3; ++k) placement.weight[k] = foot.weight[k];
    placement.along = std::clamp(foot.parameter, 0.0, 1.0);
    placement.acts = plain || (allow(frame.start, true, p, foot.offset, placement) &&
                               allow(frame.end, false, p, foot.offset, placement));
    return placement;
}

Reach reach_at(const ElementFrame& frame, Vec2 p, const Foot& foot, double left, double right, double margin) {
    Reach reach;
    const double widest = std::max(-left, right);
    reach.possible = reach.plain = foot.offset >= left - margin && foot.offset <= right + margin;
    if (!reach.possible) return reach;
    judge_end(frame.start, p, foot.offset, widest, margin, reach);
    judge_end(frame.end, p, foot.offset, widest, margin, reach);
    reach.plain &= reach.possible;
    return reach;
}

}  // namespace burin::refinement
