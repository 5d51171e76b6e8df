// Adds joints where the tolerance is missed and removes every joint whose absence it bears.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "fit_chain.hpp"

namespace burin::fit {

namespace {

constexpr int kRefineAll = 12;       // iterations over a whole chain
constexpr int kRefineNear = 8;       // over the few vertices that miss the tolerance
constexpr int kRefineTrial = 4;      // over those about a move
constexpr double kShortLine = 40.0;  // in tolerances: a line that a curve may swallow
constexpr long kFewest = 5;  // points below which a quadratic is not split: it could only follow noise

// Fraction of side k at which a joint lies, for a joint whose side has changed.
double fraction_on(const Chain& chain, long k, Vec2 joint) {
    const Vec2 a = chain.position(k);
    const Vec2 side = chain.position(k + 1) - a;
    return std::clamp(dot(joint - a, side) / std::max(dot(side, side), 1e-12), 0.02, 0.98);
}

// Sets the joints of side k after its ends have moved, where the joints were `first` and `last`.
void place_joints(Chain& chain, long k, Vec2 first, Vec2 last) {
    Vertex& vertex = chain.at(k);
    const bool start_corner = vertex.corner, end_corner = chain.at(k + 1).corner;
    vertex.s0 = start_corner ? 0.0 : fraction_on(chain, k, first);
    vertex.s1 = end_corner ? 1.0 : fraction_on(chain, k, last);
    if (vertex.line && vertex.s1 < vertex.s0) vertex.s0 = vertex.s1 = 0.5 * (vertex.s0 + vertex.s1);
    if (vertex.line) return;
    if (start_corner) {
        vertex.s1 = 0.0;
    } else if (end_corner) {
        vertex.s0 = 1.0;
    } else {
        vertex.s0 = vertex.s1 = 0.5 * (vertex.s0 + vertex.s1);
    }
}

// A line that does not do has a kink at its worst point, or a bend that smooth_corner will make of it.
void split_line(Chain& chain, const Points& points, long k, long where) {
    const Vec2 first = chain.joint_out(k), last = chain.joint_in(k + 1);
    Vertex middle;
    middle.corner = true;
    middle.line = true;
    middle.v = points[where];
    middle.begin = middle.end = where - chain.turn * chain.turns(k);
    chain.vertices.insert(chain.vertices.begin() + k + 1, middle);
    place_joints(chain, k, first, middle.v);
    place_joints(chain, k + 1, middle.v, last);
}

void split_quadratic(Chain& chain, const Points& points, long k) {
    const Vec2 p0 = chain.joint_in(k), p1 = chain.position(k), p2 = chain.joint_out(k);
    const Vec2 first = chain.joint_out(k - 1), last = chain.joint_in(k + 1);
    const long middle = (chain.begin(k) + chain.end(k)) / 2;
    const double t = std::clamp(closest_parameter(p0, p1, p2, points[middle], 0.5), 0.25, 0.75);
    Vertex second = chain.at(k);
    Vertex& vertex = chain.at(k);
    second.v = lerp(p1, p2, t);
    second.begin = middle;
    vertex.v = lerp(p0, p1, t);
    vertex.end = middle;
    vertex.line = false;
    vertex.s0 = vertex.s1 = t;
    chain.vertices.insert(chain.vertices.begin() + k + 1, second);
    place_joints(chain, k - 1, first, p0);
    place_joints(chain, k + 1, p2, last);
}

Window about(const Chain& chain, long first, long count) {
    if (chain.closed)
        return count >= chain.size() - 2 ? Window{0, chain.size()} : Window{chain.wrap(first), count};
    const long low = std::max(0L, first);
    const long high = std::min(chain.size(), first + count);
    return {low, high - low};
}

// The pieces that a window's vertices shape: their largest error, and what they cost.
struct Shaped {
    double judged = 0.0;
    double cost = 0.0;

    void add(const PieceError& e, double base, double tolerance) {
        judged = std::max(judged, e.judged);
        cost += piece_cost(base, e.sum_of_squares / static_cast<double>(std::max(1L, e.counted)), tolerance);
    }
};

Shaped shaped_by(const Chain& chain, const Points& points, const FitOptions& options, Window window) {
    const bool whole = window.count >= chain.size();
    long first = whole ? 0 : window.first - 1;
    long last = whole ? chain.size() - 1 : window.first + window.count;
    if (!chain.closed) first = std::max(first, 0L), last = std::min(last, chain.size() - 1);
    Shaped shaped;
    for (long k = first; k <= last; ++k) {
        if (!chain.at(k).corner)
            shaped.add(quadratic_error(chain, points, k, options.corner_reach), kQuadraticCost,
                       options.tolerance);
        if ((chain.closed || k < chain.sides()) && chain.at(k).line)
            shaped.add(line_error(chain, points, k, options.corner_reach), kLineCost, options.tolerance);
    }
    return shaped;
}

// --- moves that remove an element; each gives the changed chain, or nothing where it does not apply
// --------------

struct Input {
    const Points& points;
    const FitOptions& options;
};

double cost_of_quadratic(const Chain& chain, const Input& input, long k) {
    const PieceError e = quadratic_error(chain, input.points, k, input.options.corner_reach);
    return piece_cost(kQuadraticCost, e.sum_of_squares / static_cast<double>(std::max(1L, e.counted)),
                      input.options.tolerance);
}

double cost_of_line(const Chain& chain, const Input& input, long k) {
    const PieceError e = line_error(chain, input.points, k, input.options.corner_reach);
    return piece_cost(kLineCost, e.sum_of_squares / static_cast<double>(std::max(1L, e.counted)),
                      input.options.tolerance);
}

// How far, in tolerances, the quadratic at vertex k must give when its tangent at one end turns from `now` to
// `line`.
double bent_by(const Chain& chain, const Input& input, long k, Vec2 line, Vec2 now) {
    if (chain.at(k).corner) return 0.0;
    const double extent = length(chain.joint_out(k) - chain.joint_in(k));
    return 0.15 * std::abs(cross(line, now)) * extent / input.options.tolerance;
}

using Move = std::optional<Chain> (*)(const Chain&, const Input&, long k);

// The line on side k goes; the curves beside it meet.
std::optional<Chain> drop_line(const Chain& chain, const Input& input, long k) {
    const bool start_corner = chain.at(k).corner, end_corner = chain.at(k + 1).corner;
    if (!chain.at(k).line || (start_corner && end_corner)) return {};
    // Long lines stay: bending a straight run within the tolerance would save an element and show.
    if (length(chain.joint_in(k + 1) - chain.joint_out(k)) > kShortLine * input.options.tolerance) return {};
    const long middle = start_corner ? chain.end(k)
                        : end_corner ? chain.begin(k + 1)
                                     : (chain.end(k) + chain.begin(k + 1)) / 2;
    if (!start_corner && !one_quadratic(input.points, input.options, chain.begin(k), middle - 1).fits)
        return {};
    if (!end_corner && !one_quadratic(input.points, input.options, middle, chain.end(k + 1) - 1).fits)
        return {};
    Chain next = chain;
    Vertex& vertex = next.at(k);
    vertex.line = false;
    vertex.s0 = vertex.s1 = start_corner ? 0.0 : end_corner ? 1.0 : 0.5 * (vertex.s0 + vertex.s1);
    vertex.end = middle - chain.turn * chain.turns(k);
    next.at(k + 1).begin = middle - chain.turn * chain.turns(k + 1);
    if (start_corner) vertex.begin = vertex.end;
    if (end_corner) next.at(k + 1).end = next.at(k + 1).begin;
    return next;
}

// The two quadratics that meet on side k become one.
std::optional<Chain> join_quadratics(const Chain& chain, const Input& input, long k) {
    if (chain.at(k).corner || chain.at(k + 1).corner || chain.at(k).line) return {};
    if (chain.closed && chain.size() < 4) return {};
    const Vec2 before = chain.position(k - 1), a = chain.position(k), b = chain.position(k + 1),
               after = chain.position(k + 2);
    const Vec2 in = unit(a - before), out = unit(after - b);
    const double sine = cross(in, out);
    // More than about 100 degrees: one parabola would not do.
    if (dot(in, out) < -0.2) return {};
    const OnePiece one = one_quadratic(input.points, input.options, chain.begin(k), chain.end(k + 1) - 1);
    if (!one.fits || one.cost > cost_of_quadratic(chain, input, k) + cost_of_quadratic(chain, input, k + 1))
        return {};
    Vec2 v = (a + b) * 0.5;
    if (std::abs(sine) > 0.02) {
        const double along = cross(b - a, out) / sine;
        if (along > 0.0 && along < 2.0 * length(b - a)) v = a + in * along;
    }
    const Vec2 j0 = chain.joint_out(k - 1), j1 = chain.joint_in(k), j2 = chain.joint_out(k + 1),
               j3 = chain.joint_in(k + 2);
    Chain next = chain;
    Vertex& vertex = next.at(k);
    const Vertex& second = chain.at(k + 1);
    vertex.v = v;
    vertex.end = chain.end(k + 1) - chain.turn * chain.turns(k);
    vertex.line = second.line;
    vertex.s0 = second.s0;
    vertex.s1 = second.s1;
    next.vertices.erase(next.vertices.begin() + chain.wrap(k + 1));
    const long at = chain.wrap(k + 1) == 0 ? k - 1 : k;
    place_joints(next, at - 1, j0, j1);
    place_joints(next, at, j2, j3);
    return next;
}

// Vertex k goes, a corner between two lines or a quadratic, and one line runs from the joint before to the
// joint after.
std::optional<Chain> straighten(const Chain& chain, const Input& input, long k) {
    if (!chain.closed && (k == 0 || k == chain.size() - 1)) return {};
    if (chain.closed && chain.size() < 2) return {};
    const bool line_before = chain.at(k - 1).line, line_after = chain.at(k).line;
    if (chain.at(k).corner && !(line_before && line_after)) return {};
    const Vec2 in = unit(chain.position(k) - chain.position(k - 1));
    const Vec2 out = unit(chain.position(k + 1) - chain.position(k));
    if (dot(in, out) < 0.9) return {};
    const long begin = line_before ? chain.end(k - 1) : chain.begin(k);
    const long end = line_after ? chain.begin(k + 1) : chain.end(k);
    const OnePiece one = one_line(input.points, input.options, begin, end - 1);
    double now = chain.at(k).corner ? 0.0 : cost_of_quadratic(chain, input, k);
    if (line_before) now += cost_of_line(chain, input, k - 1);
    if (line_after) now += cost_of_line(chain, input, k);
    if (!one.fits || one.cost > now) return {};
    // A curve between curves becomes a line only where the points are clearly straight.
    if (!line_before && !line_after && one.cost > kLineCost + 0.1 * kErrorCost) return {};
    if (!line_before && bent_by(chain, input, k - 1, one.direction, in) > 0.6) return {};
    if (!line_after && bent_by(chain, input, k + 1, one.direction, out) > 0.6) return {};
    const Vec2 first = chain.joint_out(k - 1), last = chain.joint_in(k + 1);
    Chain next = chain;
    next.at(k - 1).line = true;
    next.vertices.erase(next.vertices.begin() + chain.wrap(k));
    // Vertex k - 1 keeps its index unless vertex k stood before it in the array.
    place_joints(next, chain.wrap(k) == 0 ? next.size() - 1 : k - 1, first, last);
    return next;
}

// A corner that turns less than a corner must: between two lines a quadratic rounds it; beside a quadratic
// the tangents become one.
std::optional<Chain> smooth_corner(const Chain& chain, const Input& input, long k) {
    if (!chain.at(k).corner || (!chain.closed && (k == 0 || k == chain.size() - 1)) || chain.size() < 3)
        return {};
    const Vec2 in = unit(chain.position(k) - chain.position(k - 1));
    const Vec2 out = unit(chain.position(k + 1) - chain.position(k));
    if (dot(in, out) < std::cos(input.options.corner_angle)) return {};
    const Vec2 first = chain.joint_out(k - 1), last = chain.joint_in(k + 1), here = chain.position(k);
    const bool line_before = chain.at(k - 1).line, line_after = chain.at(k).line;
    Chain next = chain;
    if (line_before && line_after) {
        next.at(k).corner = false;
        place_joints(next, k - 1, first, lerp(first, here, 0.7));
        place_joints(next, k, lerp(here, last, 0.3), last);
        return next;
    }
    next.at(k - 1).line = line_before || line_after;
    const long border = chain.begin(k);
    if (!chain.at(k - 1).corner && !line_before)
        next.at(k - 1).end = border - chain.turn * chain.turns(k - 1);
    if (!chain.at(k + 1).corner && !line_after)
        next.at(k + 1).begin = border - chain.turn * chain.turns(k + 1);
    next.vertices.erase(next.vertices.begin() + chain.wrap(k));
    const long side = chain.wrap(k) == 0 ? next.size() - 1 : k - 1;
    place_joints(next, side, line_before ? first : here, line_after ? last : here);
    return next;
}

// A stretch of a chain as an open chain of its own: a move and its refinement then cost the same however long
// the chain.
struct Stretch {
    long first;  // number of its first vertex in the whole chain
    Chain chain;
};

constexpr long kBefore = 6,
               kAfter = 7;  // vertices about the one that a move is for; the refinement moves five of them

Stretch stretch_about(const Chain& chain, long k) {
    Stretch s;
    s.first = chain.closed ? k - kBefore : std::max(0L, k - kBefore);
    const long last = chain.closed ? k + kAfter : std::min(chain.size() - 1, k + kAfter);
    for (long i = s.first; i <= last; ++i) {
        Vertex v = chain.at(i);
        v.v = chain.position(i);
        v.begin = chain.begin(i);
        v.end = chain.end(i);
        s.chain.vertices.push_back(v);
    }
    return s;
}

// Puts a stretch, which may have lost a vertex, back in its place. What failed near its vertex `at` may be
// tried again.
void put_back(Chain& chain, const Stretch& stretch, long old_size, long at) {
    for (long i = 0; i < stretch.chain.size(); ++i) {
        const long k = stretch.first + i;
        Vertex v = stretch.chain.at(i);
        v.v = v.v - chain.period * static_cast<double>(chain.turns(k));
        v.begin -= chain.turn * chain.turns(k);
        v.end -= chain.turn * chain.turns(k);
        if (i >= at - 2 && i <= at + 3) v.tried = 0;
        chain.at(k) = v;
    }
    for (long i = stretch.chain.size(); i < old_size; ++i)
        chain.vertices.erase(chain.vertices.begin() + chain.wrap(stretch.first + stretch.chain.size()));
}

// The move at vertex k of a chain, followed by a refinement of the vertices about it; false, and the chain as
// it was, where the move does not pay.
bool improve_by(Chain& chain, const Input& input, Move move, long k) {
    const auto& [points, options] = input;
    std::optional<Chain> next = move(chain, input, k);
    if (!next) return false;
    const long gone = chain.size() - next->size();
    const Window window = about(*next, k - 1, 4);
    const bool whole = window.count >= next->size();
    const Shaped before = shaped_by(
        chain, points, options, whole ? Window{0, chain.size()} : Window{window.first, window.count + gone});
    assign_points(*next, points, window);
    // Two iterations show whether there is hope.
    refine_chain(*next, points, options, window, Aim::mean_square, 2);
    Shaped after = shaped_by(*next, points, options, window);
    if (after.judged > 2.5 * options.tolerance) return false;
    refine_chain(*next, points, options, window, Aim::mean_square, kRefineTrial);
    after = shaped_by(*next, points, options, window);
    if (after.judged > options.tolerance && after.judged < 1.6 * options.tolerance) {
        refine_chain(*next, points, options, window, Aim::largest, kRefineTrial);
        after = shaped_by(*next, points, options, window);
    }
    // Rounding a kink that is no corner may cost something; every other move has to pay.
    const double allowed = before.cost + (move == &smooth_corner ? kQuadraticCost : 0.0);
    if (after.judged > options.tolerance || after.cost > allowed) return false;
    chain = std::move(*next);
    return true;
}

bool try_move(Chain& chain, const Input& input, Move move, long k) {
    if (chain.size() <= kBefore + kAfter + 4) {
        if (!improve_by(chain, input, move, k)) return false;
        for (Vertex& v : chain.vertices) v.tried = 0;
        return true;
    }
    Stretch stretch = stretch_about(chain, k);
    const long size = stretch.chain.size();
    if (!improve_by(stretch.chain, input, move, k - stretch.first)) return false;
    put_back(chain, stretch, size, k - stretch.first);
    return true;
}

}  // namespace

namespace {

double judged_line(const Chain& chain, const Points& points, const FitOptions& options, long k) {
    if (k >= chain.sides() || !chain.at(k).line) return 0.0;
    const PieceError e = line_error(chain, points, k, options.corner_reach);
    return e.counted >= kFewest ? e.judged : 0.0;
}

double judged_quadratic(const Chain& chain, const Points& points, const FitOptions& options, long k) {
    if (chain.at(k).corner) return 0.0;
    const PieceError e = quadratic_error(chain, points, k, options.corner_reach);
    return e.counted >= kFewest ? e.judged : 0.0;
}

bool misses(const Chain& chain, const Points& points, const FitOptions& options, long k) {
    return std::max(judged_line(chain, points, options, k), judged_quadratic(chain, points, options, k)) >
           options.tolerance;
}

// Splits pieces that miss the tolerance. The error of a quadratic falls with the fourth power of its length,
// so a run of quadratics that all miss it by the factor e needs e^(1/4) times as many: only that share of
// them is split, and the refinement spreads the joints. Gives the number of splits.
long split_missing(Chain& chain, const Points& points, const FitOptions& options,
                   std::vector<bool>& missing) {
    long splits = 0;
    double owed = 0.5;
    const auto mark = [&](long k) {
        missing.insert(missing.begin() + k + 1, true);
        ++splits;
    };
    // From the back, so that an insertion leaves the numbers before it alone.
    for (long k = chain.size() - 1; k >= 0; --k) {
        if (judged_line(chain, points, options, k) > options.tolerance) {
            split_line(chain, points, k, line_error(chain, points, k, options.corner_reach).where);
            mark(k);
        }
        const double excess = judged_quadratic(chain, points, options, k) / options.tolerance;
        if (excess <= 1.0) {
            owed = 0.5;
            continue;
        }
        owed += std::max(0.1, std::sqrt(std::sqrt(excess)) - 1.0);
        if (owed < 0.6) continue;
        split_quadratic(chain, points, k);
        mark(k);
        owed = std::max(owed - 1.0, -0.5);
    }
    return splits;
}

}  // namespace

namespace {

// Refines every run of vertices near one that misses the tolerance.
void refine_missing(Chain& chain, const Points& points, const FitOptions& options,
                    const std::vector<bool>& missing, Aim aim) {
    constexpr long kMargin = 3;
    const long n = chain.size();
    long since = kMargin + 1;  // vertices since the last that misses
    long first = -1;
    const auto close_run = [&](long end) {
        const long begin = std::max(0L, first - kMargin);
        const long last = std::min(n, end + kMargin);
        const bool whole = last - begin >= n - 2;
        refine_chain(chain, points, options, whole ? Window{0, n} : Window{begin, last - begin}, aim,
                     kRefineNear);
        first = -1;
    };
    for (long k = 0; k < n; ++k) {
        if (missing[static_cast<std::size_t>(k)]) {
            if (first < 0) first = k;
            since = 0;
        } else if (first >= 0 && ++since > 2 * kMargin) {
            close_run(k - since + 1);
        }
    }
    if (first >= 0) close_run(n - since);
}

std::vector<bool> find_missing(const Chain& chain, const Points& points, const FitOptions& options) {
    std::vector<bool> missing;
    for (long k = 0; k < chain.size(); ++k) missing.push_back(misses(chain, points, options, k));
    return missing;
}

}  // namespace

void repair_chain(Chain& chain, const Points& points, const FitOptions& options) {
    assign_points(chain, points, {0, chain.size()});
    refine_chain(chain, points, options, {0, chain.size()}, Aim::mean_square, kRefineAll);
    // 12: each round takes the error of what it splits to a sixteenth; more would split noise.
    for (int round = 0; round < 12; ++round) {
        std::vector<bool> missing = find_missing(chain, points, options);
        if (std::find(missing.begin(), missing.end(), true) == missing.end()) return;
        refine_missing(chain, points, options, missing, Aim::largest);
        missing = find_missing(chain, points, options);
        if (split_missing(chain, points, options, missing) == 0) return;
        assign_points(chain, points, {0, chain.size()});
        refine_missing(chain, points, options, missing, Aim::mean_square);
    }
}

double judged_error(const Chain& chain, const Points& points, const FitOptions& options) {
    const double reach = options.corner_reach;
    double worst = 0.0;
    for (long k = 0; k < chain.size(); ++k) {
        if (!chain.at(k).corner) worst = std::max(worst, quadratic_error(chain, points, k, reach).judged);
        if (k < chain.sides() && chain.at(k).line)
            worst = std::max(worst, line_error(chain, points, k, reach).judged);
        const bool inner = chain.closed || (k > 0 && k < chain.size() - 1);
        if (chain.at(k).corner && inner) worst = std::max(worst, excess_at_corner(chain, points, k, reach));
    }
    return worst;
}

void simplify_chain(Chain& chain, const Points& points, const FitOptions& options) {
    const Input input{points, options};
    constexpr Move kMoves[] = {&straighten, &smooth_corner, &drop_line, &join_quadratics};
    for (int pass = 0; pass < 3; ++pass) {
        bool changed = false;
        for (unsigned m = 0; m < std::size(kMoves); ++m) {
            for (long k = 0; k < chain.sides(); ++k) {
                // A move that failed is tried again only after something near has changed.
                while (k < chain.sides() && (chain.at(k).tried >> m & 1u) == 0) {
                    if (try_move(chain, input, kMoves[m], k)) {
                        changed = true;
                    } else {
                        chain.at(k).tried |= 1u << m;
                    }
                }
            }
        }
        if (!changed) return;
    }
}

}  // namespace burin::fit
