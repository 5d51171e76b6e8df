// Finds the structure of a curve: which lines and quadratics, and whether they meet smoothly or in a corner.
//
// Candidate breakpoints are the vertices of a fine polyline; between every two of them that one element can span, a
// line and a quadratic are fitted by least squares. The dynamic programme runs over these pieces, not over the
// breakpoints, since what a joint costs depends on the directions of both its pieces.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fit_chain.hpp"

namespace burin::fit {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// What the programme minimises, in elements. A quadratic takes two texels in the data texture and a slower search in
// the shader, so a line is preferred where it does as well; a corner makes a special cell.
constexpr double kLineCost = 1.0;
constexpr double kQuadraticCost = 1.25;
constexpr double kCornerCost = 0.2;
constexpr double kErrorCost = 0.2;  // at an error of the tolerance

constexpr long kMostSamples = 48;  // points that judge one piece: more would tell the same
constexpr long kNear = 6;          // candidate ends tried next to the start, and next to the furthest end

struct Piece {
    long a = 0, b = 0;  // candidate numbers
    bool quadratic = false;
    double cost = 0.0;
    double length = 0.0;
    Vec2 start, control, end;
    Vec2 direction_in, direction_out;  // at its start, at its end
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

struct Judged {
    double largest = 0.0;
    double mean_square = 0.0;
};

class PieceFitter {
  public:
    PieceFitter(const Points& points, const FitOptions& options) : points_(points), options_(options) {}

    // Fits the points from `first` to `last`; false when an error exceeds the tolerance by more than `slack`.
    bool line(long first, long last, Piece& piece) const;
    bool quadratic(long first, long last, Piece& piece) const;

  private:
    Judged judge_line(PointRange core, long stride, Vec2 centre, Vec2 t) const;
    bool fit_by_arc(PointRange core, long stride, Vec2 out[3], double low, double high) const;
    Judged improve(PointRange core, long stride, Vec2 c[3], bool change) const;
    double piece_cost(double base, Judged error) const {
        return base + kErrorCost * error.mean_square / (options_.tolerance * options_.tolerance);
    }
    long stride_of(PointRange core) const { return std::max(1L, (core.end - core.begin) / kMostSamples); }

    const Points& points_;
    const FitOptions& options_;
};

Judged PieceFitter::judge_line(PointRange core, long stride, Vec2 centre, Vec2 t) const {
    Judged error;
    long n = 0;
    for (long i = core.begin; i < core.end; i += stride) {
        if (points_.weight(i) == 0.0) continue;
        const double e = std::abs(cross(t, points_[i] - centre));
        error.largest = std::max(error.largest, e);
        error.mean_square += e * e;
        ++n;
    }
    error.mean_square /= std::max(1.0, static_cast<double>(n));
    return error;
}

bool PieceFitter::line(long first, long last, Piece& piece) const {
    const PointRange core = core_of(points_, first, last, options_.corner_reach);
    const long stride = stride_of(core);
    // Total least squares: the axis of least inertia through the centroid.
    double w = 0.0;
    Vec2 centre;
    for (long i = core.begin; i < core.end; i += stride) w += points_.weight(i), centre = centre + points_[i] * points_.weight(i);
    if (w > 0.0) centre = centre * (1.0 / w);
    double xx = 0.0, xy = 0.0, yy = 0.0;
    for (long i = core.begin; i < core.end; i += stride) {
        const Vec2 d = points_[i] - centre;
        const double v = points_.weight(i);
        xx += v * d.x * d.x, xy += v * d.x * d.y, yy += v * d.y * d.y;
    }
    const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
    Vec2 t{std::cos(angle), std::sin(angle)};
    if (w == 0.0 || !(xx + yy > 0.0)) t = unit(points_[last] - points_[first]), centre = points_[first];
    if (dot(t, points_[last] - points_[first]) < 0.0) t = -t;
    const Judged error = judge_line(core, stride, centre, t);
    piece.quadratic = false;
    piece.start = centre + t * dot(t, points_[first] - centre);
    piece.end = centre + t * dot(t, points_[last] - centre);
    piece.control = (piece.start + piece.end) * 0.5;
    piece.direction_in = piece.direction_out = t;
    piece.cost = piece_cost(kLineCost, error);
    return error.largest <= options_.tolerance;
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

// Control points c of the quadratic whose parameter is the length along the polyline.
bool PieceFitter::fit_by_arc(PointRange core, long stride, Vec2 c[3], double low, double high) const {
    std::array<std::array<double, 3>, 3> m{}, m2;
    std::array<double, 3> x{}, y{};
    for (long i = core.begin; i < core.end; i += stride) {
        const double t = (points_.arc(i) - low) / (high - low);
        const std::array<double, 3> basis{(1 - t) * (1 - t), 2 * t * (1 - t), t * t};
        const double w = points_.weight(i);
        for (std::size_t a = 0; a < 3; ++a) {
            x[a] += w * basis[a] * points_[i].x;
            y[a] += w * basis[a] * points_[i].y;
            for (std::size_t b = 0; b <= a; ++b) m[a][b] += w * basis[a] * basis[b];
        }
    }
    for (std::size_t a = 0; a < 3; ++a) m[a][a] += 1e-10;
    m2 = m;
    if (!solve_small(m, x) || !solve_small(m2, y)) return false;
    for (std::size_t a = 0; a < 3; ++a) c[a] = {x[a], y[a]};
    return true;
}

// One Gauss-Newton step on the distances to the curve, and the errors before it.
Judged PieceFitter::improve(PointRange core, long stride, Vec2 c[3], bool change) const {
    std::array<std::array<double, 6>, 6> m{};
    std::array<double, 6> x{};
    Judged error;
    double t = 0.0, n = 0.0;
    for (long i = core.begin; i < core.end; i += stride) {
        if (points_.weight(i) == 0.0) continue;
        t = closest_parameter(c[0], c[1], c[2], points_[i], t);
        const double w0 = (1 - t) * (1 - t), w1 = 2 * t * (1 - t), w2 = t * t;
        const Vec2 normal = normal_of(unit(lerp(c[1] - c[0], c[2] - c[1], t)));
        const double e = dot(normal, points_[i] - c[0] * w0 - c[1] * w1 - c[2] * w2);
        error.largest = std::max(error.largest, std::abs(e));
        error.mean_square += e * e;
        n += 1.0;
        if (!change) continue;
        const std::array<double, 6> slope{w0 * normal.x, w0 * normal.y, w1 * normal.x,
                                          w1 * normal.y, w2 * normal.x, w2 * normal.y};
        for (std::size_t a = 0; a < 6; ++a) {
            x[a] += slope[a] * e;
            for (std::size_t b = 0; b <= a; ++b) m[a][b] += slope[a] * slope[b];
        }
    }
    error.mean_square /= std::max(1.0, n);
    if (!change) return error;
    // Sliding along the curve changes no distance: a little damping decides it.
    for (std::size_t a = 0; a < 6; ++a) m[a][a] += 1e-3 * n / 6.0;
    if (solve_small(m, x))
        for (std::size_t a = 0; a < 3; ++a) c[a] = c[a] + Vec2{x[2 * a], x[2 * a + 1]};
    return error;
}

bool PieceFitter::quadratic(long first, long last, Piece& piece) const {
    const PointRange core = core_of(points_, first, last, options_.corner_reach);
    if (core.end - core.begin < 4) return false;
    const long stride = stride_of(core);
    Vec2 c[3];
    if (!fit_by_arc(core, stride, c, points_.arc(first), points_.arc(last))) return false;
    Judged error = improve(core, stride, c, true);
    if (error.largest > 6.0 * options_.tolerance) return false;
    error = improve(core, stride, c, true);
    error = improve(core, stride, c, false);
    // A control polygon that turns by more than a right angle and a half has left the arc that the points show.
    const Vec2 in = unit(c[1] - c[0]), out = unit(c[2] - c[1]);
    if (error.largest > options_.tolerance || dot(in, out) < -0.5) return false;
    piece.quadratic = true;
    piece.start = c[0], piece.control = c[1], piece.end = c[2];
    piece.direction_in = in, piece.direction_out = out;
    piece.cost = piece_cost(kQuadraticCost, error);
    return true;
}

// --- the programme ---------------------------------------------------------------------------------------------

class Segmenter {
  public:
    Segmenter(const Points& points, const FitOptions& options)
        : points_(points), options_(options), fitter_(points, options) {}

    std::vector<Piece> run();

  private:
    void add_pieces(long a);
    bool add(long a, long b, bool quadratic);
    long furthest(long a, long guess, bool quadratic) const;
    bool fits(long a, long b, bool quadratic, Piece& piece) const {
        const long i = candidates_[static_cast<std::size_t>(a)], j = candidates_[static_cast<std::size_t>(b)];
        return quadratic ? fitter_.quadratic(i, j, piece) : fitter_.line(i, j, piece);
    }
    double joint_cost(const Piece& before, const Piece& after, bool& corner) const;
    void relax(Piece& after);

    const Points& points_;
    const FitOptions& options_;
    PieceFitter fitter_;
    std::vector<long> candidates_;
    std::vector<Piece> pieces_;
    std::vector<std::vector<long>> ending_;  // pieces by their last candidate
    long reach_line_ = 0, reach_quadratic_ = 0;
};

// Furthest candidate that one element starting at a spans. A piece that fails may be followed by one that does not, so
// the search looks two candidates past a failure.
long Segmenter::furthest(long a, long guess, bool quadratic) const {
    const long last = static_cast<long>(candidates_.size()) - 1;
    long best = a;
    Piece piece;
    long b = std::clamp(guess, a + 1, last);
    while (b > a + 1 && !fits(a, b, quadratic, piece)) --b;
    for (int failures = 0; b <= last && failures < 3; ++b) {
        if (fits(a, b, quadratic, piece)) {
            best = b;
            failures = 0;
        } else {
            ++failures;
        }
    }
    return best;
}

bool Segmenter::add(long a, long b, bool quadratic) {
    Piece piece;
    const bool good = fits(a, b, quadratic, piece);
    // A span of the polyline itself is always allowed as a line: the programme then always finds a way through.
    if (!good && (quadratic || b != a + 1)) return false;
    if (!good) piece.cost += 2.0;
    piece.a = a;
    piece.b = b;
    piece.length = length(piece.end - piece.start);
    pieces_.push_back(piece);
    return true;
}

void Segmenter::add_pieces(long a) {
    const std::size_t first = pieces_.size();
    for (const bool quadratic : {false, true}) {
        long& guess = quadratic ? reach_quadratic_ : reach_line_;
        const long reach = furthest(a, guess, quadratic);
        guess = std::max(reach, a + 1);
        const long last = std::max(reach, a + 1);
        for (long b = a + 1; b <= last; ++b) {
            if (b > a + kNear && b < last - kNear) b = last - kNear;
            add(a, b, quadratic);
        }
    }
    for (std::size_t i = first; i < pieces_.size(); ++i) {
        relax(pieces_[i]);
        ending_[static_cast<std::size_t>(pieces_[i].b)].push_back(static_cast<long>(i));
    }
}

// What it costs to join two pieces, and whether as a corner. A smooth joint must close the gap between the two ends
// and turn both tangents into one, which the shorter piece has to give in to.
double Segmenter::joint_cost(const Piece& before, const Piece& after, bool& corner) const {
    const Vec2 in = before.direction_out, out = after.direction_in;
    const double turn = std::abs(std::atan2(cross(in, out), dot(in, out)));
    const Vec2 n = normal_of(unit(in + out));
    const double gap = std::abs(dot(n, after.start - before.end)) / options_.tolerance;
    const double bend = 0.15 * turn * std::min(before.length, after.length) / options_.tolerance;
    double smooth = 0.15 * (gap * gap + bend * bend);
    if (!before.quadratic && !after.quadratic) smooth += kQuadraticCost;
    if (turn > 1.2 || smooth > 4.0) smooth = kNever;
    corner = false;
    if (turn < options_.corner_angle) return smooth == kNever ? 6.0 : smooth;
    // The corner is where the tangents meet; that must be near the samples that show it.
    const double sine = cross(in, out);
    const Vec2 at = before.end + in * (cross(after.start - before.end, out) / (std::abs(sine) > 1e-6 ? sine : 1e-6));
    const double off = length(at - points_[candidates_[static_cast<std::size_t>(after.a)]]);
    const double allowed = corner_radius(in, out, options_.corner_reach) + 1.5 * options_.tolerance;
    const double over = std::max(0.0, off / std::max(allowed, 1e-9) - 1.0);
    const double sharp = kCornerCost + over * over;
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
        bool corner = false;
        const double total = before.best + joint_cost(before, after, corner) + after.cost;
        if (total < after.best) after.best = total, after.previous = i, after.corner = corner;
    }
}

std::vector<Piece> Segmenter::run() {
    candidates_ = candidates_of(points_, 0.6 * options_.tolerance);
    const long last = static_cast<long>(candidates_.size()) - 1;
    ending_.resize(candidates_.size());
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
    if (points_.closed) joint_cost(path.back(), path.front(), path.front().corner);
    return path;
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
    if (chain_.vertices.empty()) push(pieces_[0].start, true, pieces_[0].a, pieces_[0].a, true);
    if (!points_.closed && options_.pin_start) chain_.vertices.front().v = points_[0];
    if (!points_.closed && options_.pin_end) chain_.vertices.back().v = points_[points_.count - 1];
    set_joints();
    return std::move(chain_);
}

}  // namespace

Chain segment_points(const Points& points, const FitOptions& options) {
    return ChainBuilder(points, options, Segmenter(points, options).run()).run();
}

}  // namespace burin::fit
