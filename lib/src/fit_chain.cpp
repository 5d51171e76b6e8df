// The control polygon and its points: distances, and which point belongs to which piece.
#include "fit_chain.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace burin::fit {

Points::Points(std::vector<Vec2> once, std::vector<double> weight_once, bool is_closed, Vec2 turn)
    : count(static_cast<long>(once.size())),
      closed(is_closed),
      period(turn),
      p_(std::move(once)),
      weight_(std::move(weight_once)) {
    if (closed) {
        shift_ = 2 * count;
        std::vector<Vec2> all;
        all.reserve(5 * p_.size());
        for (const double lap : {-2.0, -1.0, 0.0, 1.0, 2.0})
            for (const Vec2 p : p_) all.push_back(p + period * lap);
        p_ = std::move(all);
        const std::size_t n = weight_.size();
        weight_.resize(5 * n);
        for (std::size_t i = n; i < 5 * n; ++i) weight_[i] = weight_[i - n];
    }
    arc_.resize(p_.size());
    for (std::size_t i = 1; i < p_.size(); ++i) arc_[i] = arc_[i - 1] + length(p_[i] - p_[i - 1]);
}

long Chain::elements() const {
    long n = 0;
    for (long k = 0; k < size(); ++k) n += (at(k).corner ? 0 : 1) + (k < sides() && at(k).line ? 1 : 0);
    return n;
}

double corner_radius(Vec2 in, Vec2 out, double corner_reach) {
    // Half the inner angle a: the turn is pi - a, and tan(a / 2) = sin / (1 + cos) with cos = -dot.
    const double sine = std::abs(cross(in, out));
    const double tangent_of_half = sine / std::max(1e-6, 1.0 - dot(in, out));
    // 5: beyond that the spike is narrower than a fifth of its length, and its tip is a guess anyway.
    return corner_reach * std::clamp(1.0 / std::max(tangent_of_half, 1e-6), 1.0, 5.0);
}

namespace {

// Directions in which the curve reaches and leaves vertex k.
Vec2 direction_in(const Chain& chain, long k) { return unit(chain.position(k) - chain.position(k - 1)); }
Vec2 direction_out(const Chain& chain, long k) { return unit(chain.position(k + 1) - chain.position(k)); }

// Radius about vertex k within which points do not count: 0 unless it is a corner inside the curve.
double ignored_radius(const Chain& chain, long k, double corner_reach) {
    if (!chain.at(k).corner) return 0.0;
    if (!chain.closed && (k == 0 || k == chain.size() - 1)) return 0.0;
    return corner_radius(direction_in(chain, k), direction_out(chain, k), corner_reach);
}

}  // namespace

PointRange ignored_range(const Chain& chain, const Points& points, long k, double corner_reach) {
    const double radius = ignored_radius(chain, k, corner_reach);
    PointRange r{chain.begin(k), chain.begin(k)};
    if (radius == 0.0) return r;
    const Vec2 tip = chain.position(k);
    const long low = chain.line_or_quadratic_before(k), high = chain.line_or_quadratic_after(k);
    while (r.begin > std::max(low, points.first()) && length(points[r.begin - 1] - tip) < radius) --r.begin;
    while (r.end < std::min(high, points.last()) && length(points[r.end] - tip) < radius) ++r.end;
    return r;
}

PointRange quadratic_range(const Chain& chain, const Points& points, long k, double corner_reach) {
    PointRange r{chain.begin(k), chain.end(k)};
    // A quadratic touches a corner only where the side between carries no line.
    if (!chain.at(k - 1).line && chain.at(k - 1).corner)
        r.begin = std::max(r.begin, ignored_range(chain, points, k - 1, corner_reach).end);
    if (!chain.at(k).line && chain.at(k + 1).corner)
        r.end = std::min(r.end, ignored_range(chain, points, k + 1, corner_reach).begin);
    return r;
}

PointRange line_range(const Chain& chain, const Points& points, long k, double corner_reach) {
    PointRange r{chain.end(k), chain.begin(k + 1)};
    if (chain.at(k).corner) r.begin = std::max(r.begin, ignored_range(chain, points, k, corner_reach).end);
    if (chain.at(k + 1).corner)
        r.end = std::min(r.end, ignored_range(chain, points, k + 1, corner_reach).begin);
    return r;
}

double closest_parameter(Vec2 p0, Vec2 p1, Vec2 p2, Vec2 p, double guess) {
    // B(t) = p0 + 2 t d + t^2 a; Newton on (B - p) . B', which has one root near the guess for points within
    // a radius of curvature. Where that is not convex, the step is bounded by leaving out the second
    // derivative (Gauss-Newton).
    const Vec2 d = p1 - p0;
    const Vec2 a = p2 - p1 - d;
    double t = guess;
    for (int i = 0; i < 12; ++i) {
        const Vec2 offset = p0 + d * (2.0 * t) + a * (t * t) - p;
        const Vec2 slope = (d + a * t) * 2.0;
        const double speed = dot(slope, slope);
        const double g = std::max(speed + 2.0 * dot(offset, a), 0.5 * speed);
        if (!(g > 0.0)) break;
        const double next = std::clamp(t - dot(offset, slope) / g, 0.0, 1.0);
        const double moved = std::abs(next - t);
        t = next;
        if (moved < 1e-3) break;  // the foot is then right to second order, far below any tolerance
    }
    return t;
}

namespace {

PieceError error_of(const ErrorTally& tally, long first) {
    // Points of weight 0 are rare: `where` may then be a few points early.
    return {tally.finish(), tally.largest, first + tally.where, tally.sum_of_squares, tally.counted};
}

double distance_to_quadratic(Vec2 p0, Vec2 p1, Vec2 p2, Vec2 p, double guess) {
    const double t = closest_parameter(p0, p1, p2, p, guess);
    return length(p - lerp(lerp(p0, p1, t), lerp(p1, p2, t), t));
}

double distance_to_line(Vec2 a, Vec2 b, Vec2 p) {
    const Vec2 side = b - a;
    const double t = std::clamp(dot(p - a, side) / std::max(dot(side, side), 1e-300), 0.0, 1.0);
    return length(p - a - side * t);
}

}  // namespace

double excess_at_corner(const Chain& chain, const Points& points, long k, double corner_reach) {
    const PointRange range = ignored_range(chain, points, k, corner_reach);
    const Vec2 tip = chain.position(k);
    double most = 0.0;
    for (long i = range.begin; i < range.end; ++i) {
        if (points.weight(i) == 0.0) continue;
        const Vec2 p = points[i];
        const double before =
            chain.at(k - 1).line
                ? distance_to_line(chain.joint_out(k - 1), tip, p)
                : distance_to_quadratic(chain.joint_in(k - 1), chain.position(k - 1), tip, p, 1.0);
        const double after = chain.at(k).line ? distance_to_line(tip, chain.joint_in(k + 1), p)
                                              : distance_to_quadratic(tip, chain.position(k + 1),
                                                                      chain.joint_out(k + 1), p, 0.0);
        most = std::max(most, std::min(before, after));
    }
    return most - 0.5 * corner_reach;
}

PieceError quadratic_error(const Chain& chain, const Points& points, long k, double corner_reach) {
    const Vec2 p0 = chain.joint_in(k);
    const Vec2 p1 = chain.position(k);
    const Vec2 p2 = chain.joint_out(k);
    const PointRange range = quadratic_range(chain, points, k, corner_reach);
    ErrorTally tally;
    double t = 0.0;
    for (long i = range.begin; i < range.end; ++i) {
        if (points.weight(i) == 0.0) continue;
        t = closest_parameter(p0, p1, p2, points[i], t);
        const Vec2 foot = lerp(lerp(p0, p1, t), lerp(p1, p2, t), t);
        const double e = length(points[i] - foot);
        tally.add(e);
    }
    return error_of(tally, range.begin);
}

PieceError line_error(const Chain& chain, const Points& points, long k, double corner_reach) {
    const Vec2 a = chain.joint_out(k);
    const Vec2 b = chain.joint_in(k + 1);
    const Vec2 t = unit(b - a);
    const double extent = dot(b - a, t);
    const PointRange range = line_range(chain, points, k, corner_reach);
    ErrorTally tally;
    for (long i = range.begin; i < range.end; ++i) {
        if (points.weight(i) == 0.0) continue;
        const Vec2 p = points[i] - a;
        const double along = dot(p, t);
        const double beyond = std::max({0.0, -along, along - extent});
        const double e = std::hypot(cross(t, p), beyond);
        tally.add(e);
    }
    return error_of(tally, range.begin);
}

namespace {

// First index in [low, high] whose point lies past the joint, seen along t; the search starts at `guess`.
long border_index(const Points& points, Vec2 joint, Vec2 t, long guess, long low, long high) {
    // A joint moves by a few points at a time; a border that runs far has lost its joint.
    constexpr long kMost = 16;
    long i = std::clamp(guess, low, high);
    low = std::max(low, i - kMost);
    high = std::min(high, i + kMost);
    while (i > low && dot(points[i - 1] - joint, t) >= 0.0) --i;
    while (i < high && dot(points[i] - joint, t) < 0.0) ++i;
    return i;
}

// Index in [low, high], not far from `guess`, of the point nearest to a corner.
long nearest_index(const Points& points, Vec2 corner, long guess, long low, long high) {
    constexpr long kWindow = 12;
    long best = std::clamp(guess, low, high);
    for (long i = std::max(low, guess - kWindow); i < std::min(high, guess + kWindow); ++i)
        if (length(points[i] - corner) < length(points[best] - corner)) best = i;
    return best;
}

// Next fixed border after vertex k's own two, as far as the points of the pieces reach.
struct Limits {
    long low;
    long high;
};

void assign_vertex(Chain& chain, const Points& points, long k, Limits limits) {
    const long lap = chain.turn * chain.turns(k);
    Vertex& vertex = chain.at(k);
    if (vertex.corner) {
        const Vec2 in = direction_in(chain, k), out = direction_out(chain, k);
        // In a hairpin the bisector says nothing: there the nearest point is the border. 0.85: turns above
        // 150 degrees.
        const long i = dot(in, out) > -0.85 ? border_index(points, chain.position(k), unit(in + out),
                                                           chain.begin(k), limits.low, limits.high)
                                            : nearest_index(points, chain.position(k), chain.begin(k),
                                                            limits.low, limits.high);
        vertex.begin = vertex.end = i - lap;
        return;
    }
    const long b = border_index(points, chain.joint_in(k), direction_in(chain, k), chain.begin(k), limits.low,
                                limits.high);
    const long e =
        border_index(points, chain.joint_out(k), direction_out(chain, k), chain.end(k), b, limits.high);
    vertex.begin = b - lap;
    vertex.end = e - lap;
}

}  // namespace

void assign_points(Chain& chain, const Points& points, Window window) {
    // The neighbours' borders move in the same pass, so a border between two quadratics, which belongs to
    // both, is set from the earlier one and handed on.
    const bool whole = window.count >= chain.size();
    const long first = whole ? 0 : window.first - 1;
    const long last = whole ? chain.size() - 1 : window.first + window.count;
    for (long k = first; k <= last; ++k) {
        if (!chain.closed && (k <= 0 || k >= chain.size() - 1)) continue;
        long low = chain.end(k - 1);
        long high = chain.begin(k + 1);
        // No line between: the border is shared, so it may move within the neighbour's range.
        if (!chain.at(k - 1).line) low = std::max(chain.begin(k - 1), chain.end(k) - points.count);
        if (!chain.at(k).line) high = std::min(chain.end(k + 1), chain.begin(k) + points.count);
        if (chain.closed) low = std::max(low, -points.count), high = std::min(high, 2 * points.count);
        if (low <= high) assign_vertex(chain, points, k, {low, high});
        Vertex& before = chain.at(k - 1);
        Vertex& after = chain.at(k + 1);
        if (!chain.at(k - 1).line) {
            before.end = chain.begin(k) - chain.turn * chain.turns(k - 1);
            if (before.corner) before.begin = before.end;
        }
        if (!chain.at(k).line) {
            after.begin = chain.end(k) - chain.turn * chain.turns(k + 1);
            if (after.corner) after.end = after.begin;
        }
    }
}

}  // namespace burin::fit
