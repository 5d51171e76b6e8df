#include "stroke_paths.hpp"

#include <algorithm>

#include <burin/fit.hpp>

#include "resolve_curve.hpp"

namespace burin::stroking {
namespace {

// Of what linear widths may differ from those that are needed.
constexpr double kWidthError = 0.005;

// Width needed at a parameter of an element.
struct WidthAt {
    double t = 0.0, width = 0.0;
};

// A line through widths: least squares, at t = 0 and 1.
struct WidthLine {
    double at0 = 0.0, at1 = 0.0;
    double value(double t) const { return at0 + (at1 - at0) * t; }
};

WidthLine line_through(std::span<const WidthAt> widths) {
    double n = 0, t = 0, w = 0, tt = 0, tw = 0;
    for (const WidthAt& at : widths) n += 1, t += at.t, w += at.width, tt += at.t * at.t, tw += at.t * at.width;
    const double spread = tt * n - t * t;
    const double slope = spread > 1e-9 * tt * n ? (tw * n - t * w) / spread : 0.0;
    const double at0 = (w - slope * t) / n;
    return {at0, at0 + slope};
}

// Where to part widths that no line follows: at the greatest jump.
std::size_t greatest_jump(std::span<const WidthAt> widths) {
    std::size_t best = widths.size() / 2;
    double most = 4.0 * std::abs(widths.back().width - widths.front().width) / static_cast<double>(widths.size());
    for (std::size_t i = 2; i + 1 < widths.size(); ++i)
        if (const double jump = std::abs(widths[i].width - widths[i - 1].width); jump > most) most = jump, best = i;
    return best;
}

// Appends the part of the element between two parameters, in as many pieces as its widths need.
void append_parts(const Element& element, double t0, double t1, std::span<const WidthAt> widths, double base, std::vector<Element>& out) {
    const WidthLine line = line_through(widths);
    const bool follows = std::all_of(widths.begin(), widths.end(), [&](const WidthAt& at) {
        return std::abs(line.value(at.t) - at.width) <= kWidthError * at.width;
    });
    if (follows || widths.size() < 4) {
        Element part = curve::part(element, t0, t1);
        // Few points make a steep line; beyond them it says nothing.
        const auto [least, most] = std::minmax_element(widths.begin(), widths.end(), [](const WidthAt& a, const WidthAt& b) { return a.width < b.width; });
        const auto within = [&](double t) { return std::clamp(line.value(t), least->width, most->width) / base; };
        part.width0 = within(t0), part.width1 = within(t1);
        out.push_back(part);
        return;
    }
    const std::size_t at = greatest_jump(widths);
    const double middle = 0.5 * (widths[at - 1].t + widths[at].t);
    if (!(middle > t0 + 1e-6) || !(middle < t1 - 1e-6)) return append_parts(element, t0, t1, widths.subspan(0, 3), base, out);
    append_parts(element, t0, middle, widths.subspan(0, at), base, out);
    append_parts(element, middle, t1, widths.subspan(at), base, out);
}

// A step of the width between neighbours would be a wall across the groove. A small one is shared by both; for a greater one the
// last and first bit of them, `reach` long, becomes a ramp.
void join_widths(std::vector<Element>& elements, bool closed, double reach) {
    std::vector<Element> out;
    const auto bend = [&](Element e, double from, double to) {
        // Share of the element that a ramp takes at each end, and the widths between the ramps.
        const double share = std::min(0.4, reach / length(e.p2 - e.p0));
        const auto small = [&](double a, double b) { return std::abs(a - b) <= 1.5 * kWidthError * b; };
        const double first = small(from, e.width0) ? 0.0 : share, last = small(to, e.width1) ? 1.0 : 1.0 - share;
        if (first > 0.0) out.push_back(curve::part(e, 0.0, first)), out.back().width0 = from;
        out.push_back(curve::part(e, first, last));
        if (first == 0.0) out.back().width0 = from;
        if (last == 1.0) out.back().width1 = to;
        if (last < 1.0) out.push_back(curve::part(e, last, 1.0)), out.back().width1 = to;
    };
    const std::size_t count = elements.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Element &e = elements[i], &before = elements[(i + count - 1) % count], &after = elements[(i + 1) % count];
        bend(e, i > 0 || closed ? 0.5 * (before.width1 + e.width0) : e.width0, i + 1 < count || closed ? 0.5 * (e.width1 + after.width0) : e.width1);
    }
    elements = std::move(out);
}

// An element and the points that it was fitted to: [first, last).
struct Fitted {
    Element element;
    std::size_t first = 0, last = 0;
};

std::vector<Fitted> fitted_elements(const FitResult& fit) {
    std::vector<Fitted> out;
    for (std::size_t i = 0; i < fit.elements.size(); ++i) out.push_back({fit.elements[i], fit.first_point[i], fit.first_point[i + 1]});
    return out;
}

// Where two fitted lines miss each other, the fit may link them by a jog shorter than the points lie apart, which may lead
// sideways and would turn the cross-section with it. Its neighbours meet in its middle instead; ends that are pinned stay.
void drop_jogs(std::vector<Fitted>& row, double shortest, const Piece& piece) {
    for (std::size_t i = 0; i < row.size() && row.size() > 2;) {
        const Element& jog = row[i].element;
        if (length(jog.p2 - jog.p0) >= shortest) {
            ++i;
            continue;
        }
        const bool first = i == 0, last = i + 1 == row.size();
        const Vec2 meet = first && !piece.closed ? jog.p0 : last && !piece.closed ? jog.p2 : lerp(jog.p0, jog.p2, 0.5);
        if (!first || piece.closed) row[first ? row.size() - 1 : i - 1].element.p2 = first ? meet + piece.period : meet;
        if (!last || piece.closed) row[last ? 0 : i + 1].element.p0 = last ? meet - piece.period : meet;
        row.erase(row.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

// A quadratic that turns much, or nearly all at one end, where a line says the same, is a hook that the fit made of a kink; a
// cross-section would swing round in it.
void straighten_hooks(std::vector<Fitted>& row, double tolerance) {
    constexpr double kSharp = 0.35;  // radians
    for (Fitted& fitted : row) {
        Element& e = fitted.element;
        if (e.kind != ElementKind::quadratic) continue;
        const Vec2 chord = e.p2 - e.p0, arm = e.p1 - e.p0;
        const double share = dot(arm, chord) / dot(chord, chord);
        if (share > 0.1 && share < 0.9 && curve::turning(e) < kSharp) continue;
        // The farthest that the arc lies from its chord.
        if (0.5 * std::abs(cross(unit(chord), arm)) <= 2.0 * tolerance) e.kind = ElementKind::line, e.p1 = lerp(e.p0, e.p2, 0.5);
    }
}

}  // namespace

Result<Path> path_of(const Piece& piece, const PathOptions& options) {
    std::vector<Vec2> points;
    double stretch = 1e300;  // least metres of the pattern per metre in space
    for (const PiecePoint& point : piece.points) {
        points.push_back(point.p);
        stretch = std::min({stretch, length(point.along), point.width / options.width});
    }
    FitOptions fit;
    fit.tolerance = options.tolerance * stretch;
    fit.corner_reach = 0.0;
    fit.closed = piece.closed;
    fit.period = piece.period;
    fit.pin_start = fit.pin_end = true;
    const auto fitted = fit_curve(points, fit);
    if (!fitted) return fitted.error();
    Path path;
    path.closed = piece.closed;
    std::vector<Fitted> row = fitted_elements(*fitted);
    drop_jogs(row, 0.5 * options.spacing * stretch, piece);
    straighten_hooks(row, fit.tolerance);
    for (const auto& [element, first, last] : row) {
        std::vector<WidthAt> widths;
        for (std::size_t k = first; k < last; ++k) {
            const double rounds = static_cast<double>(k / points.size());
            widths.push_back({curve::nearest(element, points[k % points.size()] + piece.period * rounds), piece.points[k % points.size()].width});
        }
        if (widths.empty()) widths.push_back({0.0, piece.points[first % points.size()].width});
        append_parts(element, 0.0, 1.0, widths, options.base, path.elements);
    }
    join_widths(path.elements, path.closed, 0.5 * options.spacing * stretch);
    return path;
}

}  // namespace burin::stroking
