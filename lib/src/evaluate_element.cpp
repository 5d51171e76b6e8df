// Where one element acts, and with which offset: foot points, end rules, profile membership.
#include <algorithm>

#include "evaluate_prepare.hpp"

namespace burin::truth {
namespace {

// Half the derivative of B, and a tangent that stays defined where it vanishes (p1 on p0 or on p2).
Vec2 direction_at(const PreparedElement& e, double u) {
    const Vec2 d = e.edge + e.bend * u;
    const double scale = std::max(dot(e.edge, e.edge), dot(e.bend, e.bend));
    if (dot(d, d) > 1e-24 * scale) return d;
    // Near the zero of B' the direction is that of +-B''; the one that leads on along the curve.
    return e.bend * (u < 0.5 ? 1.0 : -1.0);
}

// The root of c0 + c1 u + c2 u^2 + c3 u^3 in [low, high], where the polynomial is monotone and changes sign.
// Newton, kept inside the bracket: certain, and at full precision after a few steps.
double polish_root(const double c[4], double low, double high) {
    const auto value = [&](double u) { return ((c[3] * u + c[2]) * u + c[1]) * u + c[0]; };
    const bool rising = value(high) > value(low);
    double u = 0.5 * (low + high);
    for (int i = 0; i < 100; ++i) {
        const double f = value(u);
        if (f == 0.0) return u;
        ((f < 0.0) == rising ? low : high) = u;
        const double slope = (3.0 * c[3] * u + 2.0 * c[2]) * u + c[1];
        double next = slope != 0.0 ? u - f / slope : low;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::abs(next - u) <= 1e-16) return next;
        u = next;
    }
    return u;
}

void offer(Foot& best, double parameter, double offset) {
    if (std::abs(offset) < std::abs(best.offset)) best = {offset, parameter};
}

// Feet on the arc: (B(u) - p) . B'(u) = 0, a cubic. Its derivative's roots split [0, 1] into monotone pieces.
void offer_arc_feet(const PreparedElement& e, Vec2 p, Foot& best) {
    const Vec2 c = e.p0 - p;
    const double k[4] = {dot(c, e.edge), dot(c, e.bend) + 2.0 * dot(e.edge, e.edge),
                         3.0 * dot(e.edge, e.bend), dot(e.bend, e.bend)};
    double roots[2];
    const int n = solve_quadratic(3.0 * k[3], 2.0 * k[2], k[1], roots);
    double cuts[4] = {0.0, 1.0, 1.0, 1.0};
    int pieces = 0;
    for (int i = 0; i < n; ++i)
        if (roots[i] > 0.0 && roots[i] < 1.0) cuts[++pieces] = roots[i];
    cuts[++pieces] = 1.0;
    const auto value = [&](double u) { return ((k[3] * u + k[2]) * u + k[1]) * u + k[0]; };
    for (int i = 0; i < pieces; ++i) {
        // A minimum of the distance is where the cubic rises through zero.
        if (!(value(cuts[i]) <= 0.0 && value(cuts[i + 1]) >= 0.0)) continue;
        const double u = polish_root(k, cuts[i], cuts[i + 1]);
        offer(best, u, dot(p - point_on(e, u), normal_of(tangent_on(e, u))));
    }
}

// True where the profile's vertical line at b crosses facet i; then h is the height there.
bool crosses(const PreparedProfile& profile, std::size_t i, double b, double height_scale, double& h) {
    const ProfilePoint p = profile.points[i], q = profile.points[i + 1];
    if ((p.b <= b) == (q.b <= b)) return false;
    h = height_scale * (p.h + profile.slope[i] * (b - p.b));
    return true;
}

}  // namespace

int solve_quadratic(double a, double b, double c, double roots[2]) {
    if (a == 0.0) {
        if (b == 0.0) return 0;
        roots[0] = -c / b;
        return std::isfinite(roots[0]) ? 1 : 0;
    }
    const double d = b * b - 4.0 * a * c;
    if (!(d >= 0.0)) return 0;
    // The sum without cancellation gives one root, the product of the roots the other.
    const double s = -0.5 * (b + std::copysign(std::sqrt(d), b));
    roots[0] = s / a;
    roots[1] = s != 0.0 ? c / s : roots[0];
    if (!std::isfinite(roots[0])) {  // a is nothing beside b
        roots[0] = roots[1];
        return 1;
    }
    if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
    return 2;
}

Vec2 tangent_on(const PreparedElement& e, double u) {
    if (e.kind == ElementKind::line) return e.tangent;
    const Vec2 d = direction_at(e, u);
    const double l = std::sqrt(dot(d, d));  // std::hypot costs as much as the rest of a foot point
    return l > 0.0 ? d * (1.0 / l) : Vec2{1.0, 0.0};
}

int meet_line(const PreparedElement& e, Vec2 p, Vec2 d, double u[2]) {
    double roots[2];
    int n = 0;
    if (e.kind == ElementKind::line)
        n = solve_quadratic(0.0, cross(e.p2 - e.p0, d), cross(e.p0 - p, d), roots);
    else
        n = solve_quadratic(cross(e.bend, d), 2.0 * cross(e.edge, d), cross(e.p0 - p, d), roots);
    int kept = 0;
    for (int i = 0; i < n; ++i)
        if (roots[i] >= 0.0 && roots[i] <= 1.0) u[kept++] = roots[i];
    return kept;
}

Foot find_foot(const PreparedElement& e, Vec2 p) {
    if (e.kind == ElementKind::line) {
        const double s = e.length > 0.0 ? dot(p - e.p0, e.tangent) / e.length : 0.0;
        return {dot(p - e.p0, normal_of(e.tangent)), std::clamp(s, 0.0, 1.0)};
    }
    Foot best{1e300, 0.0};
    if (dot(p - e.p0, e.ends[0].outward) >= 0.0)
        offer(best, 0.0, dot(p - e.p0, normal_of(-e.ends[0].outward)));
    if (dot(p - e.p2, e.ends[1].outward) >= 0.0)
        offer(best, 1.0, dot(p - e.p2, normal_of(e.ends[1].outward)));
    offer_arc_feet(e, p, best);
    // Rounding may leave a point on the normal of an end to neither side.
    if (best.offset == 1e300) {
        const int near = length(p - e.p0) <= length(p - e.p2) ? 0 : 1;
        const double side = near == 0 ? -1.0 : 1.0;
        best = {dot(p - e.ends[near].vertex, normal_of(e.ends[near].outward * side)),
                static_cast<double>(near)};
    }
    return best;
}

Form find_form(const PreparedElement& e, Vec2 p, const Foot& foot) {
    Form form{FormKind::plain, 0, 1.0};
    const double side = foot.offset < 0.0 ? -1.0 : 1.0;
    double farthest = std::abs(foot.offset);  // of b' by the hips seen so far
    for (std::uint8_t k = 0; k < 2; ++k) {
        const PreparedEnd& end = e.ends[k];
        const Vec2 from = p - end.vertex;
        const double a = dot(from, end.outward);
        const bool beyond = a > 0.0;
        if (end.priority == Priority::none) {
            if (beyond) return {};
        } else if (end.priority == Priority::both) {
            if (end.end == EndShape::clip) {
                if (dot(from, end.clip_inward) < 0.0) return {};
            } else if (end.end == EndShape::hip) {
                if (a > farthest) form = {FormKind::across, k, side}, farthest = a;
            } else if (beyond) {
                form = {FormKind::radial, k, side};
                farthest = length(from);
            }
        } else if ((end.priority == Priority::left) == (side < 0.0)) {
            if (dot(from, end.clip_inward) < 0.0) return {};
            if (beyond && end.corner == CornerShape::round) form = {FormKind::radial, k, side};
            if (beyond && end.corner == CornerShape::bevel) form = {FormKind::slanted, k, side};
        } else if (beyond) {
            return {};
        }
    }
    return form;
}

Local evaluate_form(const PreparedElement& e, const Form& form, Vec2 p, const Foot& foot) {
    Local local;
    const PreparedEnd& end = e.ends[form.end];
    switch (form.kind) {
        case FormKind::across:
            local.offset = form.sign * dot(p - end.vertex, end.outward);
            break;
        case FormKind::radial:
            local.offset = form.sign * length(p - end.vertex);
            break;
        case FormKind::slanted:
            local.offset = dot(p - end.vertex, end.bevel);
            break;
        default:
            local.offset = foot.offset;
            break;
    }
    local.width = e.width0 + e.width_rise * foot.parameter;
    local.height = e.height0 + e.height_rise * foot.parameter;
    if (e.function != nullptr) {
        const Factors factors = factors_on(e, foot.parameter);
        local.width *= factors.width;
        local.height *= factors.height;
    }
    return local;
}

LocalGradient gradient_of(const PreparedElement& e, const Form& form, Vec2 p, const Foot& foot) {
    LocalGradient out;
    const Vec2 t = tangent_on(e, foot.parameter);
    const PreparedEnd& end = e.ends[form.end];
    switch (form.kind) {
        case FormKind::across:
            out.offset = end.outward * form.sign;
            break;
        case FormKind::radial:
            out.offset = unit(p - end.vertex) * form.sign;
            break;
        case FormKind::slanted:
            out.offset = end.bevel;
            break;
        default:
            out.offset = normal_of(t);
            break;
    }
    if (!e.scaled || foot.parameter <= 0.0 || foot.parameter >= 1.0) return out;
    Vec2 rate{0, 0};  // of the curve parameter
    if (e.kind == ElementKind::line) {
        rate = t * (1.0 / e.length);
    } else {
        // From (B - p) . B' = 0: du = B' . dp / (|B'|^2 + (B - p) . B'').
        const Vec2 d = (e.edge + e.bend * foot.parameter) * 2.0;
        const double denominator = dot(d, d) + dot(point_on(e, foot.parameter) - p, e.bend * 2.0);
        if (denominator != 0.0) rate = d * (1.0 / denominator);
    }
    const Factors factors = factors_on(e, foot.parameter);
    const double width = e.width0 + e.width_rise * foot.parameter, height = e.height0 + e.height_rise * foot.parameter;
    out.width = rate * (e.width_rise * factors.width + width * factors.width_rate);
    out.height = rate * (e.height_rise * factors.height + height * factors.height_rate);
    return out;
}

bool acts_at(const Truth::Prepared& truth, const PreparedElement& e, Vec2 p, double ground, Local& local,
             Form* form) {
    return acts_at(truth, e, p, find_foot(e, p), ground, local, form);
}

bool acts_at(const Truth::Prepared& truth, const PreparedElement& e, Vec2 p, const Foot& foot, double ground, Local& local,
             Form* form) {
    const Form found = find_form(e, p, foot);
    if (found.kind == FormKind::none) return false;
    local = evaluate_form(e, found, p, foot);
    const PreparedProfile& profile = truth.profiles[e.profile];
    if (!(local.width > 0.0) || local.offset < profile.low * local.width ||
        local.offset > profile.high * local.width)
        return false;
    if (form) *form = found;
    const bool left = std::abs(ground - e.left_level) <= truth.level_tolerance;
    const bool right = std::abs(ground - e.right_level) <= truth.level_tolerance;
    // On the path line itself the ground of either side will do.
    if (std::abs(local.offset) <= 1e-12 * truth.size.x) return left || right;
    return local.offset < 0.0 ? left : right;
}

bool in_add(const PreparedProfile& profile, double b, double rise, double height_scale) {
    bool inside = false;
    double h = 0.0;
    for (std::size_t i = 0; i + 1 < profile.points.size(); ++i)
        if (crosses(profile, i, b, height_scale, h) && h > rise) inside = !inside;
    return inside;
}

bool in_cut(const PreparedProfile& profile, double b, double rise, double height_scale) {
    bool inside = false;
    double h = 0.0;
    for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
        if (!((profile.internal_mask >> i) & 1u)) {
            if (inside) return true;  // this run's wedge holds the point; the next run is a wedge of its own
            continue;
        }
        if (crosses(profile, i, b, height_scale, h) && h < rise) inside = !inside;
    }
    return inside;
}

bool inside_map(const Truth::Prepared& truth, Vec2 p) {
    return truth.repeat || (p.x >= 0.0 && p.y >= 0.0 && p.x <= truth.size.x && p.y <= truth.size.y);
}

Vec2 into_tile(const Truth::Prepared& truth, Vec2 p) {
    if (!truth.repeat) return p;
    return {p.x - truth.size.x * std::floor(p.x / truth.size.x),
            p.y - truth.size.y * std::floor(p.y / truth.size.y)};
}

bool solid_at(const Truth::Prepared& truth, Vec2 p, double z, double ground) {
    bool solid = z <= ground, cut = false;
    Local local;
    if (!inside_map(truth, p)) return solid;
    for (const PreparedElement& e : truth.elements)
        for_each_image(truth, e.box, p, p, [&](Vec2 shift) {
            if (cut || !acts_at(truth, e, p - shift, ground, local)) return;
            const PreparedProfile& profile = truth.profiles[e.profile];
            const double b = local.offset / local.width, rise = z - e.level;
            solid = solid || (z > ground && in_add(profile, b, rise, local.height));
            cut = in_cut(profile, b, rise, local.height);
        });
    return solid && !cut;
}

}  // namespace burin::truth
