// Fit: from points to elements. The steps are in fit_segment.cpp (structure), fit_refine.cpp (least squares)
// and fit_simplify.cpp (repair and removal).
#include <burin/fit.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "fit_chain.hpp"

namespace burin {

namespace {

using fit::Chain;
using fit::Points;

// The points without repeats, and where each came from.
struct Distinct {
    std::vector<Vec2> points;
    std::vector<double> weights;
    std::vector<std::size_t> source;
};

Distinct distinct_points(std::span<const Vec2> points, const FitOptions& options) {
    Distinct out;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!out.points.empty() && points[i] == out.points.back()) continue;
        out.points.push_back(points[i]);
        if (!options.weights.empty()) out.weights.push_back(options.weights[i]);
        out.source.push_back(i);
    }
    while (options.closed && out.points.size() > 1 &&
           out.points.back() == out.points.front() + options.period) {
        out.points.pop_back();
        if (!out.weights.empty()) out.weights.pop_back();
        out.source.pop_back();
    }
    return out;
}

// The row from `start` on, once around.
Distinct rotated(const Distinct& row, std::size_t start, Vec2 period) {
    Distinct out = row;
    const std::size_t n = row.points.size();
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = i + start;
        out.points[i] = j < n ? row.points[j] : row.points[j - n] + period;
        if (!row.weights.empty()) out.weights[i] = row.weights[j % n];
    }
    return out;
}

Element line_element(Vec2 a, Vec2 b) {
    Element e;
    e.kind = ElementKind::line;
    e.p0 = a;
    e.p1 = (a + b) * 0.5;
    e.p2 = b;
    return e;
}

Element quadratic_element(Vec2 a, Vec2 control, Vec2 b) {
    Element e;
    e.kind = ElementKind::quadratic;
    e.p0 = a;
    e.p1 = control;
    e.p2 = b;
    return e;
}

// Errors of one piece join those of the chain.
struct Errors {
    double largest = 0.0, sum = 0.0;
    long counted = 0;
    void add(const fit::PieceError& e) {
        largest = std::max(largest, e.largest);
        sum += e.sum_of_squares;
        counted += e.counted;
    }
};

// Where a point of the chain's row was in the caller's.
struct Numbering {
    const std::vector<std::size_t>& source;
    std::size_t start;  // of the chain's row
    std::size_t given;  // points of one turn as the caller counts
    std::size_t operator()(long i, bool closed) const {
        const long n = static_cast<long>(source.size());
        if (!closed) return i >= n ? given : source[static_cast<std::size_t>(i)];
        const long j = i + static_cast<long>(start);
        const long lap = j >= 0 ? j / n : -((-j + n - 1) / n);
        return static_cast<std::size_t>(static_cast<long>(source[static_cast<std::size_t>(j - lap * n)]) +
                                        (lap + 1) * static_cast<long>(given));
    }
};

FitResult result_of(const Chain& chain, const Points& points, const FitOptions& options,
                    const Numbering& numbering) {
    FitResult result;
    Errors errors;
    const double reach = options.corner_reach;
    const auto push = [&](const Element& e, long first, bool corner) {
        result.elements.push_back(e);
        result.corner.push_back(corner ? 1 : 0);
        result.first_point.push_back(numbering(first, chain.closed));
    };
    for (long k = 0; k < chain.size(); ++k) {
        const fit::Vertex& vertex = chain.at(k);
        if (!vertex.corner) {
            push(quadratic_element(chain.joint_in(k), vertex.v, chain.joint_out(k)), chain.begin(k),
                 !chain.at(k - 1).line && chain.at(k - 1).corner);
            errors.add(quadratic_error(chain, points, k, reach));
        }
        if (k < chain.sides() && vertex.line) {
            push(line_element(chain.joint_out(k), chain.joint_in(k + 1)), chain.end(k), vertex.corner);
            errors.add(line_error(chain, points, k, reach));
        }
    }
    result.first_point.push_back(
        numbering(chain.closed ? chain.begin(chain.size()) : points.count, chain.closed));
    if (chain.closed && result.elements.size() > 0) {
        // The chain may begin with a quadratic whose points start before the row does.
        const long turn = static_cast<long>(numbering.given);
        while (static_cast<long>(result.first_point.front()) >= turn)
            for (std::size_t& i : result.first_point) i -= numbering.given;
    }
    result.max_error = errors.largest;
    result.rms_error = std::sqrt(errors.sum / std::max(1.0, static_cast<double>(errors.counted)));
    return result;
}

// Makes consecutive ends equal bit by bit: a joint on a side is computed once per neighbour, from the same
// numbers, but across the seam of a closed chain rounding may differ.
void weld(FitResult& result, const FitOptions& options) {
    std::vector<Element>& e = result.elements;
    for (std::size_t i = 1; i < e.size(); ++i) e[i].p0 = e[i - 1].p2;
    if (options.closed && !e.empty()) e.back().p2 = e.front().p0 + options.period;
}

// A joint that turns less than corner_angle is no corner, whatever the structure says, where its tangents
// agree.
void mark_corners(FitResult& result, const FitOptions& options) {
    const std::vector<Element>& e = result.elements;
    for (std::size_t i = 0; i < e.size(); ++i) {
        if (i == 0 && !options.closed) {
            result.corner[i] = 1;
            continue;
        }
        const Vec2 in = unit(derivative_at(e[i == 0 ? e.size() - 1 : i - 1], 1.0));
        const Vec2 out = unit(derivative_at(e[i], 0.0));
        result.corner[i] = std::abs(cross(in, out)) > 1e-6 || dot(in, out) < 0.0 ? 1 : 0;
    }
}

double area_of(const Points& points) {
    double twice = 0.0;
    for (long i = 0; i < points.count; ++i) twice += cross(points[i] - points[0], points[i + 1] - points[0]);
    return 0.5 * twice;
}

// The oval of a loop of so few points that they have no shape to speak of: quadratics in the rectangle about
// them.
Chain oval_of(const Points& points) {
    Vec2 centre;
    for (long i = 0; i < points.count; ++i)
        centre = centre + points[i] * (1.0 / static_cast<double>(points.count));
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (long i = 0; i < points.count; ++i) {
        const Vec2 d = points[i] - centre;
        xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
    }
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    const Vec2 t{std::cos(angle), std::sin(angle)}, n = normal_of(t);
    Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
    for (long i = 0; i < points.count; ++i) {
        const Vec2 d = points[i] - centre;
        const Vec2 p{dot(d, t), dot(d, n)};
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    const double area = area_of(points);
    // Never flatter than a tenth of its length, so that it stays a loop.
    const double half = std::max(0.5 * (high.y - low.y), 0.05 * (high.x - low.x));
    const Vec2 middle{0.5 * (low.x + high.x), 0.5 * (low.y + high.y)}, size{0.5 * (high.x - low.x), half};
    Chain chain;
    chain.closed = true;
    chain.turn = points.count;
    const auto corner_of = [&](int i) {
        const int turned = (area >= 0.0 ? i : 7 - i) % 4;
        const double x = turned == 0 || turned == 3 ? size.x : -size.x, y = turned < 2 ? size.y : -size.y;
        return centre + t * (middle.x + x) + n * (middle.y + y);
    };
    // The first quadratic is the one that the row's first eighth turns around.
    const Vec2 lead =
        lerp(points[0], points[1], points.count >= 8 ? 1.0 : static_cast<double>(points.count) / 8.0);
    int first = 0;
    for (const int i : {1, 2, 3})
        if (length(corner_of(i) - lead) < length(corner_of(first) - lead) - 1e-9) first = i;
    for (const int i : {0, 1, 2, 3}) {
        fit::Vertex v;
        v.v = corner_of(first + i);
        v.begin = points.count * i / 4;
        v.end = points.count * (i + 1) / 4;
        v.s0 = v.s1 = 0.5;
        chain.vertices.push_back(v);
    }
    return chain;
}

bool is_loop(const Points& points) { return points.closed && points.period == Vec2{}; }

double area_of(const Chain& chain, Vec2 origin) {
    double twice = 0.0;
    for (long k = 0; k < chain.size(); ++k) {
        const Vec2 a = chain.joint_in(k) - origin, v = chain.position(k) - origin,
                   b = chain.joint_out(k) - origin;
        // A quadratic covers two thirds of the triangle of its control points; a corner's three points
        // coincide.
        twice += cross(a, b) + (cross(a, v) + cross(v, b) - cross(a, b)) * (2.0 / 3.0);
        if (chain.at(k).line) twice += cross(b, chain.joint_in(k + 1) - origin);
    }
    return 0.5 * twice;
}

// A loop narrower than the tolerance may be fitted by a line there and back: it must keep an inside.
bool has_inside(const Chain& chain, const Points& points) {
    const double given = area_of(points);
    return chain.elements() >= 2 && area_of(chain, points[0]) * given >= 0.3 * given * given;
}

Chain fit_points(const Points& points, const FitOptions& options) {
    constexpr long kFewestOfLoop = 8;
    if (is_loop(points) && points.count < kFewestOfLoop) return oval_of(points);
    Chain best;
    double least = 1e300;
    // The structure is looked for with a little less slack, since smooth joints will take some. Where it does
    // not lead to a chain within the tolerance, or to one that crosses itself, a finer one may.
    for (const double share : {0.85, 0.6, 0.35}) {
        FitOptions finer = options;
        finer.tolerance *= share;
        Chain chain = fit::segment_points(points, finer);
        fit::repair_chain(chain, points, options);
        fit::simplify_chain(chain, points, options);
        if (is_loop(points) && !has_inside(chain, points)) continue;
        double error = fit::judged_error(chain, points, options);
        if (is_loop(points) && fit::crosses_itself(chain)) error = std::max(error, 2.5 * options.tolerance);
        if (error < least) least = error, best = std::move(chain);
        if (least <= 1.5 * options.tolerance) break;
    }
    if (best.vertices.empty()) return oval_of(points);
    return least > 2.0 * options.tolerance ? fit::polyline_chain(points, options) : best;
}

void check_options(std::span<const Vec2> points, const FitOptions& options) {
    assert(options.tolerance > 0.0);
    assert(options.corner_angle > 0.0 && options.corner_angle < std::numbers::pi);
    assert(options.corner_reach >= 0.0);
    assert(options.blunt_cost >= 0.0);
    assert(options.weights.empty() || options.weights.size() == points.size());
    static_cast<void>(points);
    static_cast<void>(options);
}

}  // namespace

Vec2 point_at(const Element& e, double t) {
    if (e.kind == ElementKind::line) return lerp(e.p0, e.p2, t);
    return lerp(lerp(e.p0, e.p1, t), lerp(e.p1, e.p2, t), t);
}

Vec2 derivative_at(const Element& e, double t) {
    if (e.kind == ElementKind::line) return e.p2 - e.p0;
    return lerp(e.p1 - e.p0, e.p2 - e.p1, t) * 2.0;
}

Result<FitResult> fit_curve(std::span<const Vec2> points, const FitOptions& options) {
    check_options(points, options);
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y))
            return Error{ErrorCode::invalid_input,
                         "point " + std::to_string(i) + " of a curve is not finite"};
    Distinct row = distinct_points(points, options);
    const bool returns = options.closed && (options.period.x != 0.0 || options.period.y != 0.0);
    if (row.points.size() < 2 && !(returns && row.points.size() == 1))
        return Error{ErrorCode::invalid_input, "a curve of " + std::to_string(row.points.size()) +
                                                   " different points, at least 2 are needed"};
    std::size_t start = 0;
    if (options.closed) {
        start = static_cast<std::size_t>(
            fit::seam_of(Points(row.points, row.weights, true, options.period), options));
        start %= row.points.size();
        std::vector<std::size_t> source = std::move(row.source);
        row = rotated(row, start, options.period);
        row.source = std::move(source);
    }
    const Points all(std::move(row.points), std::move(row.weights), options.closed, options.period);
    const Chain chain = fit_points(all, options);
    FitResult result = result_of(chain, all, options, {row.source, start, points.size()});
    weld(result, options);
    mark_corners(result, options);
    return result;
}

}  // namespace burin
