// Finds the structure of a curve: which lines and quadratics, and whether they meet smoothly or in a corner.
//
// Candidate breakpoints are the vertices of a fine polyline; between every two of them that one element can
// span, a line and a quadratic are fitted by least squares. The dynamic programme runs over these pieces, not
// over the breakpoints, since what a joint costs depends on the directions of both its pieces.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "fit_piece.hpp"

namespace burin::fit {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kCornerCost = 0.2;  // a corner makes a special cell
constexpr double kBlunt = 1.3;       // radians; corners that turn more are sharp
constexpr long kNear = 3;            // candidate ends tried next to the start, and next to the furthest end

class Segmenter {
  public:
    Segmenter(const Points& points, const FitOptions& options) : points_(points), options_(options) {}

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
    std::vector<Trial> trials_;                       // from the current candidate, of one kind
    std::vector<std::vector<long>> ending_;           // pieces by their last candidate
    std::vector<std::array<signed char, 4>> smooth_;  // smooth_about, remembered: -1 not yet known
    double unit_ = 1.0;                               // the points' scale: what a raster blurs
    std::array<long, 3> reach_{};                     // furthest end from the last start, by kind
};

// Fits one piece, or gives it from memory.
const Segmenter::Trial& Segmenter::trial(long a, long b, Kind kind) {
    for (const Trial& t : trials_)
        if (t.piece.b == b) return t;
    Trial t;
    const long i = candidates_[static_cast<std::size_t>(a)], j = candidates_[static_cast<std::size_t>(b)];
    switch (kind) {
        case Kind::line:
            t.good = fit_line(points_, options_, i, j, t.piece);
            break;
        case Kind::between:
            t.good = fit_between(points_, options_, frames_[static_cast<std::size_t>(a)],
                                 frames_[static_cast<std::size_t>(b)], i, j, t.piece);
            break;
        case Kind::alone:
            t.good = fit_quadratic(points_, options_, options_.corner_reach, i, j, t.piece);
            break;
    }
    t.piece.a = a;
    t.piece.b = b;
    trials_.push_back(t);
    return trials_.back();
}

// Furthest candidate that one element starting at a spans. A piece that fails may be followed by one that
// does not, so the search looks two candidates past a failure.
long Segmenter::furthest(long a, long guess, Kind kind) {
    const long last = static_cast<long>(candidates_.size()) - 1;
    long best = a;
    // Too few points for any quadratic say nothing about longer spans.
    long least = a + 1;
    while (kind != Kind::line && least < last &&
           candidates_[static_cast<std::size_t>(least)] - candidates_[static_cast<std::size_t>(a)] <
               kFewestPoints)
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
    // A span of the polyline itself is always allowed as a line: the programme then always finds a way
    // through.
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

// Whether one smooth curve, an arc or a parabola, explains the points about a candidate as well as a corner
// of this turn does. A corner is seen only from far enough away: over w texels on either side the best arc
// misses a turn a by about w a / 16. That has to exceed the tolerance, and what a raster rounds off the tip,
// a fifth of a texel for a right angle.
bool Segmenter::smooth_about(long candidate, double turn) {
    constexpr std::array<double, 4> turns{0.45, 0.75, 1.1, 1.6};  // radians
    std::size_t level = 3;
    while (level > 0 && turn < turns[level]) --level;
    signed char& known = smooth_[static_cast<std::size_t>(candidate)][level];
    if (known >= 0) return known > 0;
    const double a = turns[level];
    const double reach = (level == 0   ? 8.0
                          : level == 1 ? 10.0
                                       : 12.0) /
                         a * (1.2 * options_.tolerance + unit_ * (0.1 + 0.1 * a));
    const long middle = candidates_[static_cast<std::size_t>(candidate)];
    const long low = points_.closed ? middle - points_.count / 2 : 0;
    const long high = points_.closed ? middle + points_.count / 2 : points_.count - 1;
    long first = middle, last = middle;
    while (first > low && points_.arc(middle) - points_.arc(first) < reach) --first;
    while (last < high && points_.arc(last) - points_.arc(middle) < reach) ++last;
    FitOptions strict = options_;
    strict.tolerance *= 0.8;
    Piece piece;
    known = arc_fits(points_, strict, first, last) || fit_quadratic(points_, strict, 0.0, first, last, piece)
                ? 1
                : 0;
    return known > 0;
}

// What it costs to join two pieces, and whether as a corner. A smooth joint must close the gap between the
// two ends and turn both tangents into one, which the shorter piece has to give in to.
double Segmenter::joint_cost(const Piece& before, const Piece& after, bool& corner) {
    const Vec2 in = before.direction_out, out = after.direction_in;
    const double turn = std::abs(std::atan2(cross(in, out), dot(in, out)));
    const Vec2 n = normal_of(unit(in + out));
    // A quadratic of length l turned by a at one end moves by about 0.15 l a; a line cannot bend, two
    // quadratics share.
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
    const Vec2 at =
        before.end + in * (cross(after.start - before.end, out) / (std::abs(sine) > 1e-6 ? sine : 1e-6));
    const double off = length(at - points_[candidates_[static_cast<std::size_t>(after.a)]]);
    const double allowed = corner_radius(in, out, options_.corner_reach) + 1.5 * options_.tolerance;
    const double far = std::max(0.0, off / std::max(allowed, 1e-9) - 1.0);
    // The tip of a corner of inner angle a loses up to 0.5 cos(a / 2) texels on either side.
    const double lost = 0.35 * options_.corner_reach * std::cos(0.5 * (std::numbers::pi - turn));
    // A raster leaves about a / 8 texels between a corner that turns a and the contour, an arc of radius r
    // leaves r (1 / cos(a / 2) - 1).
    const double gap_at_tip = distance_to_row(points_, at, candidates_[static_cast<std::size_t>(after.a)]) -
                              0.15 * turn * options_.corner_reach - 0.5 * options_.tolerance;
    const double hairpin = turn > 2.8 ? kQuadraticCost : 0.0;
    // A blunt corner beside a curve is more often a piece of the curve that bends more.
    const bool curved = before.quadratic || after.quadratic;
    const double blunt = curved ? options_.blunt_cost * std::max(0.0, 1.0 - turn / kBlunt) : 0.0;
    const double sharp = kCornerCost + hairpin + blunt + far * far +
                         cost_of_left_out(std::max(left_out - lost, turn < 1.0 ? gap_at_tip : 0.0)) +
                         (smooth_about(after.a, turn) ? 2.0 * kQuadraticCost : 0.0);
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
    candidates_ = breakpoints_of(points_, options_.tolerance);
    const long last = static_cast<long>(candidates_.size()) - 1;
    ending_.resize(candidates_.size());
    smooth_.assign(candidates_.size(), {-1, -1, -1, -1});
    const double spacing = points_.arc(points_.end()) - points_.arc(0);
    unit_ = std::max(options_.corner_reach, spacing / static_cast<double>(std::max(1L, points_.end())));
    for (const long i : candidates_) frames_.push_back(frame_at(points_, options_, i));
    for (long a = 0; a < last; ++a) add_pieces(a);
    long best = -1;
    for (const long i : ending_[static_cast<std::size_t>(last)])
        if (best < 0 ||
            pieces_[static_cast<std::size_t>(i)].best < pieces_[static_cast<std::size_t>(best)].best)
            best = i;
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
        const bool good = first.quadratic
                              ? fit_quadratic(points_, options_, options_.corner_reach, a, b, whole)
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

// --- from pieces to the control polygon
// ------------------------------------------------------------------------

Vec2 meeting_point(const Piece& before, const Piece& after, Vec2 fallback, double reach) {
    const Vec2 in = before.direction_out, out = after.direction_in;
    const double sine = cross(in, out);
    if (std::abs(sine) < 1e-3) return fallback;
    const Vec2 at = before.end + in * (cross(after.start - before.end, out) / sine);
    return length(at - fallback) < 3.0 * corner_radius(in, out, reach) + 2.0 ? at : fallback;
}

Vec2 project(Vec2 p, const Piece& line) {
    return line.start + line.direction_in * dot(p - line.start, line.direction_in);
}

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
        const Vec2 at =
            a.end + a.direction_out * (cross(b.start - a.end, b.direction_in) / (sine == 0.0 ? 1.0 : sine));
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
        const auto fraction = [&](long i) {
            return std::clamp(dot(points_[i] - a, side) * scale, 0.05, 0.95);
        };
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
