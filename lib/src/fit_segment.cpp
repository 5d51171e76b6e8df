// Finds the structure of a curve: which lines and quadratics, and whether they meet smoothly or in a corner.
//
// Candidate breakpoints are the vertices of a fine polyline; between every two of them that one element can span, a
// line and a quadratic are fitted by least squares. The dynamic programme runs over these pieces, not over the
// breakpoints, since what a joint costs depends on the directions of both its pieces.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "fit_chain.hpp"

namespace burin::fit {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

constexpr double kCornerCost = 0.2;  // a corner makes a special cell

constexpr std::size_t kMostSamples = 24;  // points that judge one piece: more would tell the same
constexpr long kFewestPoints = 4;    // spacings that a quadratic spans at least
constexpr long kNear = 3;            // candidate ends tried next to the start, and next to the furthest end

// A quadratic between the frames of two candidates, which fits its neighbours, or one that fits the points alone, which
// is what stands beside a line or a corner.
enum class Kind { line, between, alone };

// How far the points left out at a piece's ends lie off it, at most: what a raster rounds off, or a bend that a corner
// would hide.
struct Ends {
    double first = 0.0, last = 0.0;
};

struct Piece {
    long a = 0, b = 0;  // candidate numbers
    bool quadratic = false;
    double cost = 0.0;
    double length = 0.0;
    Vec2 start, control, end;
    Vec2 direction_in, direction_out;  // at its start, at its end
    Ends ends;
    // Dynamic programme.
    double best = kNever;
    long previous = -1;
    bool corner = false;  // the joint at its start
};

// --- candidates ------------------------------------------------------------------------------------------------

void split_span(const Points& points, long first, long last, double tolerance, std::vector<long>& out) {
    // Own stack: a contour of a million points would otherwise recurse as deep.
    std::vector<std::array<long, 2>> open{{first, last}};
    while (!open.empty()) {
        const auto [a, b] = open.back();
        open.pop_back();
        const Vec2 t = unit(points[b] - points[a]);
        const bool loop = length(points[b] - points[a]) == 0.0;
        double most = tolerance;
        long where = -1;
        for (long i = a + 1; i < b; ++i) {
            const Vec2 p = points[i] - points[a];
            const double e = loop ? length(p) : std::abs(cross(t, p));
            if (e > most) most = e, where = i;
        }
        if (where < 0) {
            out.push_back(b);
            continue;
        }
        open.push_back({where, b});
        open.push_back({a, where});
    }
}

std::vector<long> candidates_of(const Points& points, double tolerance) {
    std::vector<long> out{0};
    if (!points.closed) {
        split_span(points, 0, points.end(), tolerance, out);
        return out;
    }
    // A loop is halved first at its furthest point: its chord has no direction of its own.
    long far = points.count / 2;
    for (long i = 1; i < points.count; ++i)
        if (length(points[i] - points[0]) > length(points[far] - points[0])) far = i;
    split_span(points, 0, far, tolerance, out);
    split_span(points, far, points.end(), tolerance, out);
    return out;
}

// Adds the neighbours of sharp vertices: the polyline's vertex is the point furthest out, and a corner's sides may part
// one point before or after it.
std::vector<long> with_more_at_corners(const Points& points, const std::vector<long>& vertices) {
    std::vector<long> out{vertices[0]};
    for (std::size_t i = 1; i + 1 < vertices.size(); ++i) {
        const Vec2 here = points[vertices[i]];
        const Vec2 in = unit(here - points[vertices[i - 1]]), out_of = unit(points[vertices[i + 1]] - here);
        const bool sharp = dot(in, out_of) < 0.94;  // 20 degrees
        if (sharp && vertices[i] - 1 > out.back()) out.push_back(vertices[i] - 1);
        if (vertices[i] > out.back()) out.push_back(vertices[i]);
        if (sharp && vertices[i] + 1 < vertices[i + 1]) out.push_back(vertices[i] + 1);
    }
    out.push_back(vertices.back());
    return out;
}

// Adds candidates in bends. On an arc of radius r a quadratic spans about (256 tolerance r^3)^(1/4), see fit_curve; with
// six candidates to that length, ending at one of them instead of where it must costs a piece a twelfth of its length.
std::vector<long> with_more_in_bends(const Points& points, const std::vector<long>& vertices, double tolerance) {
    constexpr double kPerQuadratic = 6.0;
    const auto turn = [&](std::size_t i) {
        if (i == 0 || i + 1 >= vertices.size()) return 0.0;
        const Vec2 here = points[vertices[i]];
        const Vec2 in = unit(here - points[vertices[i - 1]]), out = unit(points[vertices[i + 1]] - here);
        const double a = std::abs(std::atan2(cross(in, out), dot(in, out)));
        return a < 1.2 ? a : 0.0;  // more is a corner
    };
    std::vector<long> out{vertices[0]};
    double before = turn(0);
    for (std::size_t i = 1; i < vertices.size(); ++i) {
        const double after = turn(i);
        const long span = vertices[i] - vertices[i - 1];
        const double arc = points.arc(vertices[i]) - points.arc(vertices[i - 1]);
        const double radius = arc / std::max({before, after, 1e-3});
        const double spacing = std::sqrt(std::sqrt(256.0 * tolerance * radius * radius * radius)) / kPerQuadratic;
        const long parts = std::min({1L + static_cast<long>(arc / spacing), 6L, span});
        for (long k = 1; k < parts; ++k) out.push_back(vertices[i - 1] + span * k / parts);
        out.push_back(vertices[i]);
        before = after;
    }
    return out;
}

// --- pieces ----------------------------------------------------------------------------------------------------

// Points of a piece that may lie on a rounded corner at either end are left out, at most a quarter at each end.
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
Ends ends_of(const Points& points, const FitOptions& options, long first, long last, const Distance& distance) {
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

// Moves the samples' parameters to their feet (one Newton step), and takes one Gauss-Newton step on the distances
// where `change` is set. Gives the distances before it.
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
    const Judged judged{tally.finish(), tally.sum_of_squares / std::max<double>(1.0, static_cast<double>(s.count))};
    if (!change) return judged;
    // Sliding along the curve changes no distance: a little damping decides it.
    for (std::size_t a = 0; a < 6; ++a) m[a][a] += 1e-3 * s.total_weight / 6.0;
    if (solve_small(m, x))
        for (std::size_t a = 0; a < 3; ++a) c[a] = c[a] + Vec2{x[2 * a], x[2 * a + 1]};
    return judged;
}

// Least squares line through the points from `first` to `last`; false when it misses the tolerance.
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
    piece.ends = ends_of(points, options, first, last, [&](Vec2 p) { return std::abs(cross(t, p - centre)); });
    return tally.finish() <= options.tolerance;
}

// Least squares quadratic, likewise; `reach` is the length left out at either end.
bool fit_quadratic(const Points& points, const FitOptions& options, double reach, long first, long last, Piece& piece) {
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
    // A control polygon that turns by more than 120 degrees or is far off balance has left the arc that the points show.
    const Vec2 in = unit(c[1] - c[0]), out = unit(c[2] - c[1]), chord = c[2] - c[0];
    const double along = dot(c[1] - c[0], chord) / std::max(dot(chord, chord), 1e-12);
    if (error.largest > options.tolerance || dot(in, out) < -0.5 || along < 0.1 || along > 0.9) return false;
    piece.start = c[0], piece.control = c[1], piece.end = c[2];
    piece.direction_in = in, piece.direction_out = out;
    piece.cost = piece_cost(kQuadraticCost, error.mean_square, options.tolerance);
    if (reach > 0.0)
        piece.ends = ends_of(points, options, first, last, [&](Vec2 p) {
            const double t = closest_parameter(c[0], c[1], c[2], p, dot(p - c[0], chord) > 0.5 * dot(chord, chord) ? 1.0 : 0.0);
            return length(p - lerp(lerp(c[0], c[1], t), lerp(c[1], c[2], t), t));
        });
    return true;
}

// Position and tangent of the curve at a candidate, from the points on both sides.
struct Frame {
    bool known = false;
    Vec2 p;
    Vec2 t;
};

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

// Shifts both ends of a quadratic along their normals, each by its own amount, as the mean of the errors asks. Gives the
// errors after that.
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
    for (std::size_t i = 0; i < s.count; ++i) tally.add(std::abs(error[i] - x[0] * (1.0 - s.t[i]) - x[1] * s.t[i]));
    c[0] = c[0] + n0 * x[0];
    c[2] = c[2] + n1 * x[1];
    c[1] = c[1] + (n0 * x[0] + n1 * x[1]) * 0.5;
    return {tally.finish(), tally.sum_of_squares / std::max<double>(1.0, static_cast<double>(s.count))};
}

// The quadratic between two frames: it leaves no kink at a joint with the next such piece.
bool fit_between(const Points& points, const FitOptions& options, const Frame& a, const Frame& b, long first, long last,
                 Piece& piece) {
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

// Whether an arc of a circle follows the points from `first` to `last` (least squares on x^2 + y^2 + a x + b y + c).
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

// Distance of a place to the polyline of the points near index i.
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

// --- the programme ---------------------------------------------------------------------------------------------

class Segmenter {
  public:
    Segmenter(const Points& points, const FitOptions& options)
        : points_(points), options_(options) {}

    std::vector<Piece> run();

  private:
    // A piece tried from one candidate.
    struct Trial {
        bool good;
        Piece piece;
    };

    void add_pieces(long a);
    void add(const Trial& trial, long a);
    long furthest(long a, long guess, Kind kind);
    const Trial& trial(long a, long b, Kind kind);
    double joint_cost(const Piece& before, const Piece& after, bool& corner);
    bool smooth_about(long candidate, double turn);
    double cost_of_left_out(double excess) const {
        if (!(excess > 0.0) || options_.corner_reach == 0.0) return 0.0;
        const double over = excess / (0.15 * options_.corner_reach);
        return 0.5 * over * over;
    }
    void relax(Piece& after);
    void close(std::vector<Piece>& path);

    const Points& points_;
    const FitOptions& options_;
    std::vector<long> candidates_;
    std::vector<Frame> frames_;  // by candidate
    std::vector<Piece> pieces_;
    std::vector<Trial> trials_;  // from the current candidate, of one kind
    std::vector<std::vector<long>> ending_;  // pieces by their last candidate
    std::vector<std::array<signed char, 4>> smooth_;  // smooth_about, remembered: -1 not yet known
    double unit_ = 1.0;  // the points' scale: what a raster blurs
    std::array<long, 3> reach_{};  // furthest end from the last start, by kind
};

// Fits one piece, or gives it from memory.
const Segmenter::Trial& Segmenter::trial(long a, long b, Kind kind) {
    for (const Trial& t : trials_)
        if (t.piece.b == b) return t;
    Trial t;
    const long i = candidates_[static_cast<std::size_t>(a)], j = candidates_[static_cast<std::size_t>(b)];
    switch (kind) {
        case Kind::line: t.good = fit_line(points_, options_, i, j, t.piece); break;
        case Kind::between:
            t.good = fit_between(points_, options_, frames_[static_cast<std::size_t>(a)],
                                 frames_[static_cast<std::size_t>(b)], i, j, t.piece);
            break;
        case Kind::alone: t.good = fit_quadratic(points_, options_, options_.corner_reach, i, j, t.piece); break;
    }
    t.piece.a = a;
    t.piece.b = b;
    trials_.push_back(t);
    return trials_.back();
}

// Furthest candidate that one element starting at a spans. A piece that fails may be followed by one that does not, so
// the search looks two candidates past a failure.
long Segmenter::furthest(long a, long guess, Kind kind) {
    const long last = static_cast<long>(candidates_.size()) - 1;
    long best = a;
    // Too few points for any quadratic say nothing about longer spans.
    long least = a + 1;
    while (kind != Kind::line && least < last &&
           candidates_[static_cast<std::size_t>(least)] - candidates_[static_cast<std::size_t>(a)] < kFewestPoints)
        ++least;
    long b = std::clamp(guess, least, last);
    while (b > least && !trial(a, b, kind).good) --b;
    for (int failures = 0; b <= last && failures < 3; ++b) {
        const bool good = trial(a, b, kind).good;
        if (good) best = b;
        failures = good ? 0 : failures + 1;
    }
    return best;
}

void Segmenter::add(const Trial& trial, long a) {
    // A span of the polyline itself is always allowed as a line: the programme then always finds a way through.
    if (!trial.good && (trial.piece.quadratic || trial.piece.b != a + 1)) return;
    Piece piece = trial.piece;
    if (!trial.good) piece.cost += 2.0;
    piece.length = length(piece.end - piece.start);
    relax(piece);
    ending_[static_cast<std::size_t>(piece.b)].push_back(static_cast<long>(pieces_.size()));
    pieces_.push_back(piece);
}

void Segmenter::add_pieces(long a) {
    for (const Kind kind : {Kind::line, Kind::between, Kind::alone}) {
        trials_.clear();
        long& guess = reach_[static_cast<std::size_t>(kind)];
        const long last = std::max(furthest(a, guess, kind), a + 1);
        guess = last;
        const long near = a + (kind == Kind::line ? kNear : 2 * kNear);
        for (long b = a + 1; b <= last; ++b) {
            if (b > near && b < last - kNear) b = last - kNear;
            add(trial(a, b, kind), a);
        }
    }
}

// Whether one smooth curve, an arc or a parabola, explains the points about a candidate as well as a corner of this turn
// does. A corner is seen only from far enough away: over w texels on either side the best arc misses a turn a by about
// w a / 16. That has to exceed the tolerance, and what a raster rounds off the tip, a fifth of a texel for a right angle.
bool Segmenter::smooth_about(long candidate, double turn) {
    constexpr std::array<double, 4> turns{0.45, 0.75, 1.1, 1.6};  // radians
    std::size_t level = 3;
    while (level > 0 && turn < turns[level]) --level;
    signed char& known = smooth_[static_cast<std::size_t>(candidate)][level];
    if (known >= 0) return known > 0;
    const double a = turns[level];
    const double reach = (level == 0 ? 8.0 : level == 1 ? 10.0 : 12.0) / a * (1.2 * options_.tolerance + unit_ * (0.1 + 0.1 * a));
    const long middle = candidates_[static_cast<std::size_t>(candidate)];
    const long low = points_.closed ? middle - points_.count / 2 : 0;
    const long high = points_.closed ? middle + points_.count / 2 : points_.count - 1;
    long first = middle, last = middle;
    while (first > low && points_.arc(middle) - points_.arc(first) < reach) --first;
    while (last < high && points_.arc(last) - points_.arc(middle) < reach) ++last;
    FitOptions strict = options_;
    strict.tolerance *= 0.8;
    Piece piece;
    known = arc_fits(points_, strict, first, last) || fit_quadratic(points_, strict, 0.0, first, last, piece) ? 1 : 0;
    return known > 0;
}

// What it costs to join two pieces, and whether as a corner. A smooth joint must close the gap between the two ends
// and turn both tangents into one, which the shorter piece has to give in to.
double Segmenter::joint_cost(const Piece& before, const Piece& after, bool& corner) {
    const Vec2 in = before.direction_out, out = after.direction_in;
    const double turn = std::abs(std::atan2(cross(in, out), dot(in, out)));
    const Vec2 n = normal_of(unit(in + out));
    // A quadratic of length l turned by a at one end moves by about 0.15 l a; a line cannot bend, two quadratics share.
    const double l1 = before.length, l2 = after.length;
    const double bent = before.quadratic && after.quadratic ? l1 * l2 / std::max(l1 + l2, 1e-9)
                        : before.quadratic                  ? l1
                                                            : l2;
    const double gap = 0.5 * std::abs(dot(n, after.start - before.end));
    const double moved = (gap + 0.15 * turn * bent) / options_.tolerance;
    const double over = std::max(0.0, moved - 0.6);
    double smooth = 0.25 * moved * moved + 4.0 * over * over;
    if (!before.quadratic && !after.quadratic) smooth = kQuadraticCost + (gap / options_.tolerance);
    const double left_out = std::max(before.ends.last, after.ends.first) - options_.tolerance;
    smooth += cost_of_left_out(left_out);
    if (turn > 1.2) smooth = kNever;
    corner = false;
    if (turn < options_.corner_angle) return std::min(smooth, 6.0);
    // The corner is where the tangents meet; that must be near the samples that show it.
    const double sine = cross(in, out);
    const Vec2 at = before.end + in * (cross(after.start - before.end, out) / (std::abs(sine) > 1e-6 ? sine : 1e-6));
    const double off = length(at - points_[candidates_[static_cast<std::size_t>(after.a)]]);
    const double allowed = corner_radius(in, out, options_.corner_reach) + 1.5 * options_.tolerance;
    const double far = std::max(0.0, off / std::max(allowed, 1e-9) - 1.0);
    // The tip of a corner of inner angle a loses up to 0.5 cos(a / 2) texels on either side.
    const double lost = 0.35 * options_.corner_reach * std::cos(0.5 * (std::numbers::pi - turn));
    // A raster leaves about a / 8 texels between a corner that turns a and the contour, an arc of radius r leaves
    // r (1 / cos(a / 2) - 1).
    const double gap_at_tip = distance_to_row(points_, at, candidates_[static_cast<std::size_t>(after.a)]) -
                              0.15 * turn * options_.corner_reach - 0.5 * options_.tolerance;
    const double hairpin = turn > 2.8 ? kQuadraticCost : 0.0;
    const double sharp = kCornerCost + hairpin + far * far + cost_of_left_out(std::max(left_out - lost, turn < 1.0 ? gap_at_tip : 0.0)) + (smooth_about(after.a, turn) ? 2.0 * kQuadraticCost : 0.0);
    corner = sharp < smooth;
    return std::min({sharp, smooth, 6.0});
}

void Segmenter::relax(Piece& after) {
    if (after.a == 0) {
        after.best = after.cost;
        return;
    }
    for (const long i : ending_[static_cast<std::size_t>(after.a)]) {
        const Piece& before = pieces_[static_cast<std::size_t>(i)];
        if (before.best + after.cost >= after.best) continue;
        bool corner = false;
        const double total = before.best + joint_cost(before, after, corner) + after.cost;
        if (total < after.best) after.best = total, after.previous = i, after.corner = corner;
    }
}

std::vector<Piece> Segmenter::run() {
    const std::vector<long> vertices = candidates_of(points_, 0.6 * options_.tolerance);
    candidates_ = with_more_in_bends(points_, with_more_at_corners(points_, vertices), options_.tolerance);
    const long last = static_cast<long>(candidates_.size()) - 1;
    ending_.resize(candidates_.size());
    smooth_.assign(candidates_.size(), {-1, -1, -1, -1});
    const double spacing = points_.arc(points_.end()) - points_.arc(0);
    unit_ = std::max(options_.corner_reach, spacing / static_cast<double>(std::max(1L, points_.end())));
    for (const long i : candidates_) frames_.push_back(frame_at(points_, options_, i));
    for (long a = 0; a < last; ++a) add_pieces(a);
    long best = -1;
    for (const long i : ending_[static_cast<std::size_t>(last)])
        if (best < 0 || pieces_[static_cast<std::size_t>(i)].best < pieces_[static_cast<std::size_t>(best)].best) best = i;
    std::vector<Piece> path;
    for (long i = best; i >= 0; i = pieces_[static_cast<std::size_t>(i)].previous)
        path.push_back(pieces_[static_cast<std::size_t>(i)]);
    std::reverse(path.begin(), path.end());
    for (Piece& piece : path) {
        piece.a = candidates_[static_cast<std::size_t>(piece.a)];
        piece.b = candidates_[static_cast<std::size_t>(piece.b)];
    }
    if (points_.closed) close(path);
    return path;
}

// The row of a closed curve begins somewhere within a piece, which the programme has cut in two.
void Segmenter::close(std::vector<Piece>& path) {
    Piece& first = path.front();
    Piece& last = path.back();
    if (path.size() > 2 && first.quadratic == last.quadratic) {
        Piece whole;
        const long a = last.a - points_.count, b = first.b;
        const bool good = first.quadratic ? fit_quadratic(points_, options_, options_.corner_reach, a, b, whole)
                                          : fit_line(points_, options_, a, b, whole);
        if (good) {
            whole.a = a;
            whole.b = b;
            whole.length = length(whole.end - whole.start);
            first = whole;
            path.pop_back();
            candidates_[0] = a;  // where a corner at the seam is looked for
            smooth_[0] = {-1, -1, -1, -1};
        }
    }
    Piece before = path.back();
    before.start = before.start - points_.period;
    before.end = before.end - points_.period;
    path.front().a = 0;  // as a candidate number, for joint_cost
    const long a = candidates_[0];
    joint_cost(before, path.front(), path.front().corner);
    path.front().a = a;
}

// --- from pieces to the control polygon ------------------------------------------------------------------------

Vec2 meeting_point(const Piece& before, const Piece& after, Vec2 fallback, double reach) {
    const Vec2 in = before.direction_out, out = after.direction_in;
    const double sine = cross(in, out);
    if (std::abs(sine) < 1e-3) return fallback;
    const Vec2 at = before.end + in * (cross(after.start - before.end, out) / sine);
    return length(at - fallback) < 3.0 * corner_radius(in, out, reach) + 2.0 ? at : fallback;
}

Vec2 project(Vec2 p, const Piece& line) { return line.start + line.direction_in * dot(p - line.start, line.direction_in); }

class ChainBuilder {
  public:
    ChainBuilder(const Points& points, const FitOptions& options, std::vector<Piece> pieces)
        : points_(points), options_(options), pieces_(std::move(pieces)) {}
    Chain run();

  private:
    void push(Vec2 v, bool corner, long begin, long end, bool line) {
        chain_.vertices.push_back({v, corner, begin, end, line, 0.0, 0.0});
    }
    void push_start(std::size_t i);
    void push_quadratic(std::size_t i);
    void set_joints();
    bool corner_before(std::size_t i) const { return i == 0 && !points_.closed ? true : pieces_[i].corner; }

    const Points& points_;
    const FitOptions& options_;
    std::vector<Piece> pieces_;
    Chain chain_;
};

// The vertex, if any, that stands between piece i - 1 and piece i.
void ChainBuilder::push_start(std::size_t i) {
    const Piece& piece = pieces_[i];
    const Piece& before = pieces_[i == 0 ? pieces_.size() - 1 : i - 1];
    if (i == 0 && !points_.closed) return push(piece.start, true, piece.a, piece.a, !piece.quadratic);
    Piece shifted = before;
    if (i == 0) shifted.end = before.end - points_.period;
    const Vec2 at = meeting_point(shifted, piece, points_[piece.a], options_.corner_reach);
    if (corner_before(i)) return push(at, true, piece.a, piece.a, !piece.quadratic);
    // Two lines that may not meet in a corner: a small quadratic rounds the kink.
    if (!before.quadratic && !piece.quadratic) push(at, false, piece.a, piece.a, true);
}

void ChainBuilder::push_quadratic(std::size_t i) {
    const Piece& piece = pieces_[i];
    const std::size_t n = pieces_.size();
    Vec2 control = piece.control;
    // A neighbouring line that joins smoothly carries the control point.
    const bool has_before = i > 0 && !pieces_[i].corner && !pieces_[i - 1].quadratic;
    const bool has_after = i + 1 < n && !pieces_[i + 1].corner && !pieces_[i + 1].quadratic;
    if (has_before && has_after) {
        const Piece& a = pieces_[i - 1];
        const Piece& b = pieces_[i + 1];
        const double sine = cross(a.direction_out, b.direction_in);
        const Vec2 at = a.end + a.direction_out * (cross(b.start - a.end, b.direction_in) / (sine == 0.0 ? 1.0 : sine));
        const bool good = std::abs(sine) > 0.02 && length(at - control) < length(piece.end - piece.start);
        control = good ? at : (project(control, a) + project(control, b)) * 0.5;
    } else if (has_before) {
        control = project(control, pieces_[i - 1]);
    } else if (has_after) {
        control = project(control, pieces_[i + 1]);
    }
    const bool line_follows = i + 1 < n ? !pieces_[i + 1].quadratic && !pieces_[i + 1].corner
                                        : points_.closed && !pieces_[0].quadratic && !pieces_[0].corner;
    push(control, false, piece.a, piece.b, line_follows);
}

// Places the joints on the sides from the indices of the points there.
void ChainBuilder::set_joints() {
    for (long k = 0; k < chain_.sides(); ++k) {
        Vertex& vertex = chain_.at(k);
        const Vec2 a = chain_.position(k);
        const Vec2 side = chain_.position(k + 1) - a;
        const double scale = 1.0 / std::max(dot(side, side), 1e-12);
        const bool start_corner = vertex.corner, end_corner = chain_.at(k + 1).corner;
        const auto fraction = [&](long i) { return std::clamp(dot(points_[i] - a, side) * scale, 0.05, 0.95); };
        vertex.s0 = start_corner ? 0.0 : fraction(chain_.end(k));
        vertex.s1 = end_corner ? 1.0 : fraction(chain_.begin(k + 1));
        if (vertex.line) {
            if (vertex.s1 < vertex.s0) vertex.s0 = vertex.s1 = 0.5 * (vertex.s0 + vertex.s1);
        } else if (start_corner) {
            vertex.s1 = 0.0;
        } else if (end_corner) {
            vertex.s0 = 1.0;
        } else {
            vertex.s1 = vertex.s0;
        }
    }
}

Chain ChainBuilder::run() {
    chain_.closed = points_.closed;
    chain_.period = points_.period;
    chain_.turn = points_.closed ? points_.count : 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
        push_start(i);
        if (pieces_[i].quadratic) push_quadratic(i);
    }
    if (!points_.closed) push(pieces_.back().end, true, points_.count, points_.count, false);
    // One line around a tile meets itself without a kink: a vertex to begin at is all it needs.
    const bool single_line = pieces_.size() == 1 && !pieces_[0].quadratic && points_.closed;
    if (single_line) chain_.vertices.clear();
    if (chain_.vertices.empty()) push(pieces_[0].start, true, pieces_[0].a, pieces_[0].a, true);
    if (!points_.closed && options_.pin_start) chain_.vertices.front().v = points_[0];
    if (!points_.closed && options_.pin_end) chain_.vertices.back().v = points_[points_.count - 1];
    set_joints();
    return std::move(chain_);
}

}  // namespace

OnePiece one_line(const Points& points, const FitOptions& options, long first, long last) {
    Piece piece;
    if (last - first < 2) return {true, kLineCost, unit(points[std::max(first, last)] - points[first])};
    const bool fits = fit_line(points, options, first, last, piece);
    return {fits, piece.cost, piece.direction_in};
}

OnePiece one_quadratic(const Points& points, const FitOptions& options, long first, long last) {
    Piece piece;
    if (last <= first) return {};
    const bool fits = fit_quadratic(points, options, options.corner_reach, first, last, piece);
    return {fits, piece.cost, piece.direction_in};
}

Chain polyline_chain(const Points& points, const FitOptions& options) {
    Chain chain;
    chain.closed = points.closed;
    chain.period = points.period;
    chain.turn = points.closed ? points.count : 0;
    std::vector<long> vertices = candidates_of(points, 0.8 * options.tolerance);
    if (points.closed) vertices.pop_back();
    for (const long i : vertices) chain.vertices.push_back({points[i], true, i, i, true, 0.0, 1.0});
    if (!points.closed) {
        chain.vertices.back().line = false;
        chain.vertices.back().begin = chain.vertices.back().end = points.count;
    }
    return chain;
}

long seam_of(const Points& points, const FitOptions& options) {
    const std::vector<long> vertices = candidates_of(points, 0.6 * options.tolerance);
    long best = 0;
    double most = -1.0;
    for (std::size_t i = 1; i < vertices.size(); ++i) {
        const double span = points.arc(vertices[i]) - points.arc(vertices[i - 1]);
        if (span > most) most = span, best = (vertices[i] + vertices[i - 1]) / 2;
    }
    return best;
}

Chain segment_points(const Points& points, const FitOptions& options) {
    return ChainBuilder(points, options, Segmenter(points, options).run()).run();
}

}  // namespace burin::fit
