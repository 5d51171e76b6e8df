// One element fitted to a stretch of points by least squares.
#include "fit_piece.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace burin::fit {

namespace {

constexpr std::size_t kMostSamples = 24;  // points that judge one piece: more would tell the same

// Points of a piece that may lie on a rounded corner at either end are left out, at most a quarter at each
// end.
PointRange core_of(const Points& points, long first, long last, double reach) {
    const double whole = points.arc(last) - points.arc(first);
    const double cut = std::min(reach, 0.25 * whole);
    PointRange r{first, last};
    while (r.begin < r.end && points.arc(r.begin) - points.arc(first) < cut) ++r.begin;
    while (r.end > r.begin && points.arc(last) - points.arc(r.end) < cut) --r.end;
    if (r.end - r.begin < 1) r = {first, last};
    return {r.begin, r.end + 1};
}

// The points that judge one piece, copied out once: every n-th of its core.
struct Samples {
    std::array<Vec2, kMostSamples> p;
    std::array<double, kMostSamples> weight;
    std::array<double, kMostSamples> t;  // curve parameter
    std::size_t count = 0;
    double total_weight = 0.0;

    Samples(const Points& points, long first, long last, double reach) {
        const PointRange core = core_of(points, first, last, reach);
        const double low = points.arc(first), scale = 1.0 / (points.arc(last) - low);
        const long n = core.end - core.begin;
        const long wanted = std::min(n, static_cast<long>(kMostSamples));
        for (long k = 0; k < wanted; ++k) {
            const long i = core.begin + (wanted > 1 ? k * (n - 1) / (wanted - 1) : 0);
            if (points.weight(i) == 0.0) continue;
            p[count] = points[i];
            weight[count] = points.weight(i);
            t[count] = (points.arc(i) - low) * scale;
            total_weight += weight[count];
            ++count;
        }
    }
};

template <typename Distance>
Ends ends_of(const Points& points, const FitOptions& options, long first, long last,
             const Distance& distance) {
    Ends ends;
    const PointRange core = core_of(points, first, last, options.corner_reach);
    // The end points themselves are shared with the neighbours: at a corner they may lie on either side.
    for (long i = first + 1; i < core.begin; ++i) ends.first = std::max(ends.first, distance(points[i]));
    for (long i = core.end; i < last; ++i) ends.last = std::max(ends.last, distance(points[i]));
    return ends;
}

// Solves the symmetric system of N unknowns in place; false when it is singular.
template <std::size_t N>
bool solve_small(std::array<std::array<double, N>, N>& m, std::array<double, N>& x) {
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = m[i][j];
            for (std::size_t k = 0; k < j; ++k) sum -= m[i][k] * m[j][k];
            if (i == j) {
                if (!(sum > 1e-12)) return false;
                m[i][i] = std::sqrt(sum);
            } else {
                m[i][j] = sum / m[j][j];
            }
        }
    }
    for (std::size_t i = 0; i < N; ++i) {
        for (std::size_t k = 0; k < i; ++k) x[i] -= m[i][k] * x[k];
        x[i] /= m[i][i];
    }
    for (std::size_t i = N; i-- > 0;) {
        for (std::size_t k = i + 1; k < N; ++k) x[i] -= m[k][i] * x[k];
        x[i] /= m[i][i];
    }
    return true;
}

struct Judged {
    double largest = 0.0;  // see ErrorTally
    double mean_square = 0.0;
};

using Controls = std::array<Vec2, 3>;

// The quadratic whose parameter is the length along the polyline.
bool fit_by_arc(const Samples& s, Controls& c) {
    std::array<std::array<double, 3>, 3> m{};
    std::array<double, 3> x{}, y{};
    for (std::size_t i = 0; i < s.count; ++i) {
        const double t = s.t[i], w = s.weight[i];
        const std::array<double, 3> basis{(1 - t) * (1 - t), 2 * t * (1 - t), t * t};
        for (std::size_t a = 0; a < 3; ++a) {
            x[a] += w * basis[a] * s.p[i].x;
            y[a] += w * basis[a] * s.p[i].y;
            for (std::size_t b = 0; b <= a; ++b) m[a][b] += w * basis[a] * basis[b];
        }
    }
    for (std::size_t a = 0; a < 3; ++a) m[a][a] += 1e-10;
    std::array<std::array<double, 3>, 3> again = m;
    if (!solve_small(m, x) || !solve_small(again, y)) return false;
    for (std::size_t a = 0; a < 3; ++a) c[a] = {x[a], y[a]};
    return true;
}

// Moves the samples' parameters to their feet (one Newton step), and takes one Gauss-Newton step on the
// distances where `change` is set. Gives the distances before it.
Judged improve(Samples& s, Controls& c, bool change) {
    std::array<std::array<double, 6>, 6> m{};
    std::array<double, 6> x{};
    ErrorTally tally;
    const Vec2 d = c[1] - c[0], a2 = c[2] - c[1] - d;
    for (std::size_t i = 0; i < s.count; ++i) {
        double t = s.t[i];
        const Vec2 offset = c[0] + d * (2.0 * t) + a2 * (t * t) - s.p[i];
        const Vec2 slope = (d + a2 * t) * 2.0;
        const double g = std::max(dot(slope, slope) + 2.0 * dot(offset, a2), 0.25 * dot(slope, slope));
        if (g > 0.0) t = std::clamp(t - dot(offset, slope) / g, -0.1, 1.1);
        s.t[i] = t;
        const Vec2 along = d + a2 * t;
        const Vec2 normal = normal_of(along) * (1.0 / std::sqrt(std::max(dot(along, along), 1e-24)));
        const double e = dot(normal, s.p[i] - (c[0] + d * (2.0 * t) + a2 * (t * t)));
        tally.add(std::abs(e));
        if (!change) continue;
        const double w0 = (1 - t) * (1 - t), w1 = 2 * t * (1 - t), w2 = t * t;
        const std::array<double, 6> slopes{w0 * normal.x, w0 * normal.y, w1 * normal.x,
                                           w1 * normal.y, w2 * normal.x, w2 * normal.y};
        for (std::size_t a = 0; a < 6; ++a) {
            const double v = slopes[a] * s.weight[i];
            x[a] += v * e;
            for (std::size_t b = 0; b <= a; ++b) m[a][b] += v * slopes[b];
        }
    }
    const Judged judged{tally.finish(),
                        tally.sum_of_squares / std::max<double>(1.0, static_cast<double>(s.count))};
    if (!change) return judged;
    // Sliding along the curve changes no distance: a little damping decides it.
    for (std::size_t a = 0; a < 6; ++a) m[a][a] += 1e-3 * s.total_weight / 6.0;
    if (solve_small(m, x))
        for (std::size_t a = 0; a < 3; ++a) c[a] = c[a] + Vec2{x[2 * a], x[2 * a + 1]};
    return judged;
}

}  // namespace

bool fit_line(const Points& points, const FitOptions& options, long first, long last, Piece& piece) {
    const Samples s(points, first, last, options.corner_reach);
    // Total least squares: the axis of least inertia through the centroid.
    Vec2 centre;
    for (std::size_t i = 0; i < s.count; ++i) centre = centre + s.p[i] * s.weight[i];
    centre = s.count > 0 ? centre * (1.0 / s.total_weight) : points[first];
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < s.count; ++i) {
        const Vec2 d = s.p[i] - centre;
        xx += s.weight[i] * d.x * d.x, xy += s.weight[i] * d.x * d.y, yy += s.weight[i] * d.y * d.y;
    }
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    Vec2 t{std::cos(angle), std::sin(angle)};
    if (!(xx + yy > 0.0)) t = unit(points[last] - points[first]);
    if (dot(t, points[last] - points[first]) < 0.0) t = -t;
    ErrorTally tally;
    for (std::size_t i = 0; i < s.count; ++i) tally.add(std::abs(cross(t, s.p[i] - centre)));
    piece.quadratic = false;
    piece.start = centre + t * dot(t, points[first] - centre);
    piece.end = centre + t * dot(t, points[last] - centre);
    piece.control = (piece.start + piece.end) * 0.5;
    piece.direction_in = piece.direction_out = t;
    const double mean_square = tally.sum_of_squares / std::max<double>(1.0, static_cast<double>(s.count));
    piece.cost = piece_cost(kLineCost, mean_square, options.tolerance);
    piece.ends =
        ends_of(points, options, first, last, [&](Vec2 p) { return std::abs(cross(t, p - centre)); });
    return tally.finish() <= options.tolerance;
}

bool fit_quadratic(const Points& points, const FitOptions& options, double reach, long first, long last,
                   Piece& piece) {
    piece.quadratic = true;
    Samples s(points, first, last, reach);
    Controls c;
    if (s.count < 4 || !fit_by_arc(s, c)) return false;
    Judged error = improve(s, c, true);
    if (error.largest > 6.0 * options.tolerance) return false;
    if (error.largest > 0.5 * options.tolerance) {
        improve(s, c, true);
        error = improve(s, c, false);
    }
    // A control polygon that turns by more than 120 degrees or is far off balance has left the arc that the
    // points show.
    const Vec2 in = unit(c[1] - c[0]), out = unit(c[2] - c[1]), chord = c[2] - c[0];
    const double along = dot(c[1] - c[0], chord) / std::max(dot(chord, chord), 1e-12);
    if (error.largest > options.tolerance || dot(in, out) < -0.5 || along < 0.1 || along > 0.9) return false;
    piece.start = c[0], piece.control = c[1], piece.end = c[2];
    piece.direction_in = in, piece.direction_out = out;
    piece.cost = piece_cost(kQuadraticCost, error.mean_square, options.tolerance);
    if (reach > 0.0)
        piece.ends = ends_of(points, options, first, last, [&](Vec2 p) {
            const double t = closest_parameter(c[0], c[1], c[2], p,
                                               dot(p - c[0], chord) > 0.5 * dot(chord, chord) ? 1.0 : 0.0);
            return length(p - lerp(lerp(c[0], c[1], t), lerp(c[1], c[2], t), t));
        });
    return true;
}

// The widest window in which one parabola follows the points gives the steadiest tangent.
Frame frame_at(const Points& points, const FitOptions& options, long i) {
    Frame frame;
    for (const long half : {2L, 3L, 5L, 8L, 12L}) {
        const long first = points.closed ? i - half : std::max(0L, i - half);
        const long last = points.closed ? i + half : std::min(points.count - 1, i + half);
        if (points.closed && 2 * half >= points.count) break;
        Samples s(points, first, last, 0.0);
        Controls c;
        if (s.count < 5 || !fit_by_arc(s, c)) continue;
        if (improve(s, c, false).largest > (half == 2 ? 1.0 : 0.6) * options.tolerance) break;
        const double t = (points.arc(i) - points.arc(first)) / (points.arc(last) - points.arc(first));
        frame.known = true;
        frame.p = lerp(lerp(c[0], c[1], t), lerp(c[1], c[2], t), t);
        frame.t = unit(lerp(c[1] - c[0], c[2] - c[1], t));
    }
    return frame;
}

namespace {

// Shifts both ends of a quadratic along their normals, each by its own amount, as the mean of the errors
// asks. Gives the errors after that.
Judged shift_ends(Samples& s, Controls& c, Vec2 n0, Vec2 n1) {
    std::array<double, kMostSamples> error;
    std::array<std::array<double, 2>, 2> m{};
    std::array<double, 2> x{};
    const Vec2 d = c[1] - c[0], a2 = c[2] - c[1] - d;
    for (std::size_t i = 0; i < s.count; ++i) {
        s.t[i] = closest_parameter(c[0], c[1], c[2], s.p[i], s.t[i]);
        const double t = s.t[i], w = s.weight[i];
        error[i] = dot(normal_of(unit(d + a2 * t)), s.p[i] - (c[0] + d * (2.0 * t) + a2 * (t * t)));
        const double u = 1.0 - t;
        m[0][0] += w * u * u, m[1][0] += w * u * t, m[1][1] += w * t * t;
        x[0] += w * u * error[i], x[1] += w * t * error[i];
    }
    m[0][0] += 1e-9, m[1][1] += 1e-9;
    if (!solve_small(m, x)) x = {0.0, 0.0};
    ErrorTally tally;
    for (std::size_t i = 0; i < s.count; ++i)
        tally.add(std::abs(error[i] - x[0] * (1.0 - s.t[i]) - x[1] * s.t[i]));
    c[0] = c[0] + n0 * x[0];
    c[2] = c[2] + n1 * x[1];
    c[1] = c[1] + (n0 * x[0] + n1 * x[1]) * 0.5;
    return {tally.finish(), tally.sum_of_squares / std::max<double>(1.0, static_cast<double>(s.count))};
}

}  // namespace

bool fit_between(const Points& points, const FitOptions& options, const Frame& a, const Frame& b, long first,
                 long last, Piece& piece) {
    piece.quadratic = true;
    if (!a.known || !b.known || last - first < kFewestPoints) return false;
    const double sine = cross(a.t, b.t);
    const Vec2 chord = b.p - a.p;
    if (std::abs(sine) < 1e-4 || dot(a.t, b.t) < -0.3) return false;
    const double arm0 = cross(chord, b.t) / sine, arm1 = cross(a.t, chord) / sine;
    const double whole = arm0 + arm1;
    if (arm0 < 0.1 * whole || arm1 < 0.1 * whole || !(whole > 0.0)) return false;
    Controls c{a.p, a.p + a.t * arm0, b.p};
    Samples s(points, first, last, 0.0);
    const Judged error = shift_ends(s, c, normal_of(a.t), normal_of(b.t));
    if (error.largest > options.tolerance) return false;
    piece.quadratic = true;
    piece.start = c[0], piece.control = c[1], piece.end = c[2];
    piece.direction_in = a.t, piece.direction_out = b.t;
    piece.cost = piece_cost(kQuadraticCost, error.mean_square, options.tolerance);
    return true;
}

bool arc_fits(const Points& points, const FitOptions& options, long first, long last) {
    const Samples s(points, first, last, 0.0);
    if (s.count < 4) return true;
    Vec2 centre;
    for (std::size_t i = 0; i < s.count; ++i) centre = centre + s.p[i] * (1.0 / static_cast<double>(s.count));
    std::array<std::array<double, 3>, 3> m{};
    std::array<double, 3> x{};
    for (std::size_t i = 0; i < s.count; ++i) {
        const Vec2 p = s.p[i] - centre;
        const std::array<double, 3> row{p.x, p.y, 1.0};
        for (std::size_t a = 0; a < 3; ++a) {
            x[a] += row[a] * dot(p, p);
            for (std::size_t b = 0; b <= a; ++b) m[a][b] += row[a] * row[b];
        }
    }
    if (!solve_small(m, x)) return false;
    const Vec2 c = centre + Vec2{x[0], x[1]} * 0.5;
    const double radius = std::sqrt(std::max(0.0, x[2] + 0.25 * (x[0] * x[0] + x[1] * x[1])));
    ErrorTally tally;
    for (std::size_t i = 0; i < s.count; ++i) tally.add(std::abs(length(s.p[i] - c) - radius));
    return tally.finish() <= options.tolerance;
}

double distance_to_row(const Points& points, Vec2 p, long i) {
    const long first = points.closed ? i - 3 : std::max(0L, i - 3);
    const long last = points.closed ? i + 3 : std::min(points.count - 1, i + 3);
    double least = length(points[first] - p);
    for (long k = first; k < last; ++k) {
        const Vec2 side = points[k + 1] - points[k];
        const double t = std::clamp(dot(p - points[k], side) / std::max(dot(side, side), 1e-12), 0.0, 1.0);
        least = std::min(least, length(points[k] + side * t - p));
    }
    return least;
}

}  // namespace burin::fit
