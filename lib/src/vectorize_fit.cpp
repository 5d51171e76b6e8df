// Fits curves to traced chains.
#include "vectorize_fit.hpp"

#include <algorithm>
#include <cmath>

#include <burin/fit.hpp>

#include "parallel.hpp"
#include "resolve_curve.hpp"

namespace burin::vectorizing {
namespace {

double chain_length(const std::vector<Element>& elements) {
    double sum = 0.0;
    for (const Element& e : elements) sum += curve::arc_length(e);
    return sum;
}

// A line that is drawn beside its place by half of its width explains nothing.
double tolerance_for(const Chain& chain, double tolerance) {
    if (chain.kind == ChainKind::step) return tolerance;
    return std::min(tolerance, std::max(kUsualTolerance, 0.35 * chain.half_width));
}

FitOptions fit_options(const Chain& chain, double tolerance) {
    FitOptions options;
    options.tolerance = tolerance;
    options.closed = chain.closed;
    options.period = chain.winding;
    options.corner_reach = chain.kind == ChainKind::step ? 1.2 : std::max(1.0, chain.half_width);
    if (chain.kind == ChainKind::step) options.blunt_cost = 0.8;
    options.pin_start = chain.start_tie != EndTie::free;
    options.pin_end = chain.end_tie != EndTie::free;
    return options;
}

// An element that ends where it began, a texel's fraction apart, shows nothing: its neighbour starts where it did.
void drop_knots(std::vector<Element>& elements) {
    constexpr double kShortest = 0.02;
    for (std::size_t i = 0; i + 1 < elements.size();) {
        if (length(elements[i].p2 - elements[i].p0) >= kShortest) {
            ++i;
            continue;
        }
        elements[i + 1].p0 = elements[i].p0;
        elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(i));
    }
    if (elements.size() < 2 || length(elements.back().p2 - elements.back().p0) >= kShortest) return;
    elements[elements.size() - 2].p2 = elements.back().p2;
    elements.pop_back();
}

double distance_to_points(Vec2 p, const std::vector<Vec2>& points) {
    double nearest = 1e300;
    for (const Vec2 q : points) nearest = std::min(nearest, length(q - p));
    return nearest;
}

// The centre line of a wide line cuts its corners, so that points near a corner are not looked at; but then a tight bend
// looks like a corner. At a corner the line reaches as far out from the tip as it is wide; in a bend the tip lies beyond
// the centre line, and what is as far out from it lies outside of the line.
bool is_bend(const Element& before, const Element& after, const Chain& chain, const Image& map, const Lattice& lattice) {
    const Vec2 tip = after.p0;
    const Vec2 in = unit(before.kind == ElementKind::line ? tip - before.p0 : tip - before.p1);
    const Vec2 out = unit(after.kind == ElementKind::line ? after.p2 - tip : after.p1 - tip);
    const double beyond = distance_to_points(tip, chain.points);
    if (beyond < 0.75 || length(in - out) < 0.1) return false;
    const Vec2 rim = tip + unit(in - out) * (chain.half_width - 0.4 * beyond);
    const Vec2 ground = tip + unit(in - out) * (chain.half_width + 4.0 * beyond + 2.0);
    const double line = sample(map, lattice, tip - unit(in - out) * beyond), beside = sample(map, lattice, ground);
    return std::fabs(sample(map, lattice, rim) - beside) < 0.5 * std::fabs(line - beside);
}

// Whether every control point stays near the points of the chain that the curve was fitted to; that of a round bend lies outside of
// their box by up to half the bend's chord.
bool stays_near(const Chain& chain, const std::vector<Element>& elements, double slack) {
    Box box;
    const auto cover = [&](Vec2 p) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
    };
    // A curve that closes round the tile may start anywhere.
    for (const Vec2 p : chain.points)
        for (const double times : {0.0, 1.0, 2.0}) cover(p + chain.winding * times);
    const auto inside = [&](Vec2 p, double far) {
        return p.x >= box.low.x - far && p.x <= box.high.x + far && p.y >= box.low.y - far && p.y <= box.high.y + far;
    };
    return std::all_of(elements.begin(), elements.end(), [&](const Element& e) {
        if (!inside(e.p0, slack) || !inside(e.p2, slack)) return false;
        return e.kind == ElementKind::line || inside(e.p1, slack + 0.5 * length(e.p2 - e.p0));
    });
}

// Keeps the points that a polyline within the tolerance needs, between two kept ones (Douglas and Peucker 1973).
void keep_points(const std::vector<Vec2>& points, std::size_t first, std::size_t last, double tolerance,
                 std::vector<std::uint8_t>& keep) {
    std::vector<std::pair<std::size_t, std::size_t>> stack{{first, last}};
    while (!stack.empty()) {
        const auto [a, b] = stack.back();
        stack.pop_back();
        const Vec2 d = points[b] - points[a];
        double worst = tolerance;
        std::size_t at = a;
        for (std::size_t k = a + 1; k < b; ++k) {
            const Vec2 q = points[k] - points[a];
            const double s = std::clamp(dot(q, d) / std::max(1e-12, dot(d, d)), 0.0, 1.0);
            const double distance = length(q - d * s);
            if (distance > worst) worst = distance, at = k;
        }
        if (at == a) continue;
        keep[at] = 1;
        stack.push_back({a, at});
        stack.push_back({at, b});
    }
}

// What always works: lines through some of the points.
std::vector<Element> fit_polyline(const Chain& chain, double tolerance) {
    std::vector<Vec2> points = chain.points;
    if (chain.closed) points.push_back(points.front() + chain.winding);
    std::vector<std::uint8_t> keep(points.size(), 0);
    keep.front() = keep.back() = 1;
    keep_points(points, 0, points.size() - 1, tolerance, keep);
    std::vector<Element> elements;
    Vec2 start = points.front();
    for (std::size_t k = 1; k < points.size(); ++k) {
        if (!keep[k] || length(points[k] - start) == 0.0) continue;
        elements.push_back({ElementKind::line, start, {}, points[k]});
        start = points[k];
    }
    return elements;
}

// Texels of the data texture: one a line, two a quadratic.
std::size_t texels_of(const std::vector<Element>& elements) {
    std::size_t sum = elements.size();
    for (const Element& e : elements) sum += e.kind == ElementKind::quadratic;
    return sum;
}

// How many elements a polyline comes to once its bends are curves and its corners sharp: of lines that turn on and on to one
// side, a quadratic takes the place of two and a half; one short line between two long ones is a corner.
std::size_t count_as_curves(const std::vector<Element>& lines) {
    constexpr double kCorner = 0.9, kShort = 2.5, kLong = 4.0;  // radians; texels
    const auto way = [&](std::size_t i) { return lines[i].p2 - lines[i].p0; };
    std::size_t sum = 0, bent = 0;
    double last_turn = 0.0;
    const auto finish = [&] { sum += bent < 3 ? bent : (2 * bent + 4) / 5, bent = 0; };
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const Vec2 in = way(i > 0 ? i - 1 : lines.size() - 1), out = way(i), after = way((i + 1) % lines.size());
        if (length(out) < kShort && length(in) > kLong && length(after) > kLong) {
            finish();
            continue;
        }
        const double turn = turn_between(in, out);
        if (std::fabs(turn) > kCorner || turn * last_turn < 0.0) finish();
        last_turn = turn;
        ++bent;
    }
    finish();
    return sum;
}

Result<FitResult> fit_curves(const Chain& chain, const Image& map, const Lattice& lattice, double tolerance) {
    FitOptions options = fit_options(chain, tolerance);
    Result<FitResult> fit = fit_curve(chain.points, options);
    if (!fit || chain.kind == ChainKind::step || chain.half_width < 2.0) return fit;
    bool any_corner = false, any_bend = false;
    for (std::size_t i = 1; i < fit->elements.size(); ++i) {
        if (!fit->corner[i]) continue;
        any_corner = true;
        any_bend |= is_bend(fit->elements[i - 1], fit->elements[i], chain, map, lattice);
    }
    if (!any_corner) return fit;
    options.corner_reach = 1.2;
    Result<FitResult> bent = fit_curve(chain.points, options);
    if (!bent) return fit;
    // What a curve describes about as shortly is a curve.
    return any_bend || texels_of(bent->elements) <= texels_of(fit->elements) + 1 ? bent : fit;
}

}  // namespace

std::vector<FittedChain> fit_chains(const std::vector<Chain>& chains, const Image& map, const Lattice& lattice,
                                    double loosest, int threads) {
    std::vector<FittedChain> fitted(chains.size());
    // Curve fitting takes some 20 microseconds a point on ragged rims; where there are very many, corners have to do.
    constexpr std::size_t kMostCurvePoints = 120000;
    std::size_t points = 0;
    for (const Chain& chain : chains) points += chain.points.size();
    const bool curves = points <= kMostCurvePoints;
    for_each_piece(chains.size(), threads, [&](std::size_t c) {
        const double tolerance = tolerance_for(chains[c], loosest);
        const Result<FitResult> fit = curves ? fit_curves(chains[c], map, lattice, tolerance)
                                             : Result<FitResult>(FitResult{{}, {}, {}, 1e9, 1e9});
        if (!fit) return;  // all points coincide: nothing to draw
        fitted[c].chain = chains[c];
        const bool sound = fit->max_error < 3.0 * tolerance + 0.5 &&
                           stays_near(chains[c], fit->elements, 2.0 + 2.0 * chains[c].half_width);
        // Along a ragged rim a smooth chain needs more elements than corners do, and shows no more.
        const std::vector<Element> polyline = fit_polyline(chains[c], tolerance);
        const bool smooth = sound && 3 * texels_of(fit->elements) <= 4 * texels_of(polyline);
        fitted[c].elements = smooth ? fit->elements : polyline;
        drop_knots(fitted[c].elements);
        straighten_tails(fitted[c]);
        fitted[c].length = chain_length(fitted[c].elements);
    });
    fitted.erase(std::remove_if(fitted.begin(), fitted.end(), [](const FittedChain& f) { return f.elements.empty(); }),
                 fitted.end());
    return fitted;
}

void untangle_steps(std::vector<FittedChain>& chains, const Lattice& lattice, double tolerance) {
    for (const double closer : {0.5, 0.15, 0.0}) {
        const std::vector<std::uint8_t> tangled = find_tangled_steps(chains, lattice);
        if (std::find(tangled.begin(), tangled.end(), 1) == tangled.end()) return;
        for (std::size_t c = 0; c < chains.size(); ++c) {
            if (!tangled[c]) continue;
            chains[c].elements = fit_polyline(chains[c].chain, closer * tolerance);
            chains[c].length = chain_length(chains[c].elements);
        }
    }
}

std::size_t foretell_elements(const std::vector<Chain>& chains, double tolerance) {
    std::size_t sum = 0;
    for (const Chain& chain : chains) sum += count_as_curves(fit_polyline(chain, tolerance_for(chain, tolerance)));
    return sum;
}

}  // namespace burin::vectorizing
