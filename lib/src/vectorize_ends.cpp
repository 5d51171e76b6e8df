// Corners and ends of traced chains, where the skeleton of a mask goes astray.
#include "vectorize_skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace burin::vectorizing {
namespace {

bool lies_straight(const std::vector<Vec2>& points, double most_misfit) {
    const LineFit line = fit_line(points);
    return std::all_of(points.begin(), points.end(),
                       [&](Vec2 p) { return std::fabs(cross(line.direction, p - line.mean)) < most_misfit; });
}

}  // namespace

// Least squares for a parabola over the chord, which an arc that turns little is.
TailCurve fit_tail(const std::vector<Vec2>& near, double half_width) {
    constexpr std::size_t kMany = 8, kLeast = 5;          // points of an arc
    const double straight = near.size() < kMany ? 0.2 : 0.1;  // texels, by which the points of a straight line may wobble
    const Vec2 origin = near.front();
    const double chord = length(near.front() - near.back());
    const Vec2 rough = unit(near.front() - near.back()), left = normal_of(rough);
    double m[3][4] = {};
    for (const Vec2 p : near) {
        const double s = dot(p - origin, rough), v = dot(p - origin, left), row[3] = {1.0, s, s * s};
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j) m[i][j] += row[i] * row[j];
            m[i][3] += row[i] * v;
        }
    }
    if (near.size() < kLeast || lies_straight(near, straight)) m[2][2] += 1e12;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            if (k == i || std::fabs(m[i][i]) < 1e-12) continue;
            const double f = m[k][i] / m[i][i];
            for (int j = i; j < 4; ++j) m[k][j] -= f * m[i][j];
        }
    const auto solved = [&](int i) { return std::fabs(m[i][i]) < 1e-12 ? 0.0 : m[i][3] / m[i][i]; };
    const double a = solved(0), b = solved(1), c = solved(2);
    const double tightest = 1.0 / std::max(3.0, half_width);
    const double curvature = std::clamp(2.0 * c / std::pow(1.0 + b * b, 1.5), -tightest, tightest);
    TailCurve tail{origin + left * a, unit(rough + left * b), curvature, std::fabs(curvature) * chord};
    for (const Vec2 p : near) {
        const double s = dot(p - origin, rough);
        tail.misfit = std::max(tail.misfit, std::fabs(dot(p - origin, left) - a - b * s - c * s * s));
    }
    return tail;
}

namespace {

// The points of a chain that lie straight on one side of a corner.
struct Side {
    std::ptrdiff_t nearest = 0;  // index of the point next to the corner
    LineFit line;                // its direction leads to the corner
    bool is_straight = false;
};

// The points from `gap` to `gap` + `span` before (step -1) or behind (step 1) point i.
Side fit_side(const std::vector<Vec2>& points, std::ptrdiff_t i, std::ptrdiff_t step, double gap, double span) {
    constexpr double kMostMisfit = 0.3;
    const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(points.size());
    const auto at = [&](std::ptrdiff_t k) { return points[static_cast<std::size_t>(k)]; };
    std::ptrdiff_t k = i;
    while (k >= 0 && k < count && length(at(k) - at(i)) < gap) k += step;
    Side side;
    side.nearest = k;
    std::vector<Vec2> near;
    for (; k >= 0 && k < count && length(at(k) - at(side.nearest)) <= span; k += step) {
        if (!near.empty() && length(at(k) - near.back()) > kBridge) break;
        near.push_back(at(k));
    }
    if (near.size() < 4 || length(near.back() - near.front()) < 0.6 * span) return side;
    side.line = fit_line(near);
    if (dot(side.line.direction, near.front() - near.back()) < 0.0) side.line.direction = -side.line.direction;
    side.is_straight = lies_straight(near, kMostMisfit);
    return side;
}

// Direction change at point i between what comes from `baseline` before it and what goes to as far behind it.
double turn_at(const std::vector<Vec2>& points, std::ptrdiff_t i, double baseline) {
    const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(points.size());
    const auto at = [&](std::ptrdiff_t k) { return points[static_cast<std::size_t>(k)]; };
    std::ptrdiff_t before = i, behind = i;
    while (before > 0 && length(at(before) - at(i)) < baseline) --before;
    while (behind + 1 < count && length(at(behind) - at(i)) < baseline) ++behind;
    if (at(before) == at(i) || at(behind) == at(i)) return 0.0;
    return std::acos(std::clamp(dot(unit(at(i) - at(before)), unit(at(behind) - at(i))), -1.0, 1.0));
}

// Puts the seam of a closed chain, where it lies in a corner, to where the chain turns least.
void turn_seam(Chain& chain, double baseline) {
    std::vector<Vec2>& points = chain.points;
    std::vector<Vec2> around(points.end() - static_cast<std::ptrdiff_t>(points.size() / 2), points.end());
    const std::ptrdiff_t seam = static_cast<std::ptrdiff_t>(around.size());
    for (std::size_t k = 0; k < points.size() / 2; ++k) around.push_back(points[k] + chain.winding);
    if (std::max(turn_at(around, seam - 1, baseline), turn_at(around, seam, baseline)) < 0.5) return;
    std::size_t calmest = points.size() / 2;
    double least = 10.0;
    for (std::size_t k = points.size() / 4; k < points.size() * 3 / 4; ++k) {
        const double turn = turn_at(points, static_cast<std::ptrdiff_t>(k), baseline);
        if (turn < least) least = turn, calmest = k;
    }
    for (std::size_t k = 0; k < calmest; ++k) points[k] = points[k] + chain.winding;
    std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(calmest), points.end());
}

// The width of a line at its last point, and what it loses by every texel towards there.
struct EndWidth {
    double half_width = 0.0, slope = 0.0;

    explicit EndWidth(const Chain& chain) : half_width(chain.half_width_at(chain.points.size() - 1)) {
        const std::size_t n = chain.points.size(), before = n - std::min<std::size_t>(n, 16);
        const double run = length(chain.points.back() - chain.points[before]);
        if (run > 0.0) slope = (chain.half_width_at(before) - half_width) / run;
    }
};

// The way up to point `last`, where the cap begins; none where the points are too few.
std::optional<TailCurve> follow_tail(const std::vector<Vec2>& points, std::size_t last, double half_width, double tightest) {
    // Of a tight curve, or behind a corner, fewer points tell more: a parabola is an arc only as long as it turns little.
    constexpr double kMostTurn = 1.2, kMostMisfit = 0.3;
    for (double reach = 4.0 * half_width + 8.0;; reach *= 0.75) {
        std::vector<Vec2> near;
        for (std::size_t k = last + 1; k-- > 0;) {
            if (near.size() >= 2 && length(points[k] - near.back()) > kBridge) break;
            if (near.size() >= 4 && length(points[k] - near.front()) > reach) break;
            near.push_back(points[k]);
        }
        if (near.size() < 2 || near.front() == near.back()) return {};
        const TailCurve tail = fit_tail(near, tightest);
        if ((tail.turn <= kMostTurn && tail.misfit <= kMostMisfit) || 0.75 * reach <= 4.0) return tail;
    }
}

// The visible end of a line lies where its response falls to half; a hip cap puts the path's end half a width before.
// The skeleton of a cap leads into one of its corners: the last points are put where the chain comes to from behind.
// One that tapers to a point shows there as much as it is wide in texels, and goes on a little beyond what is seen.
void settle_free_end(Chain& chain, const Image& response, const Lattice& lattice) {
    constexpr double kPoint = 0.3;     // of the line's usual half-width: an end narrower than that is a point
    constexpr double kVisible = 0.15;  // of the line's contrast
    constexpr double kMostUnseen = 6.0;
    std::vector<Vec2>& points = chain.points;
    if (points.size() < 2) return;
    const auto [half_width, slope] = EndWidth(chain);
    const bool is_point = half_width < kPoint * chain.half_width;
    const double disturbed = half_width + 1.0;
    std::size_t last = points.size() - 1;
    while (last > 3 && length(points[last] - points.back()) < disturbed && length(points[last] - points[last - 1]) < kBridge) --last;
    const std::optional<TailCurve> tail = follow_tail(points, last, half_width, std::max(half_width, 0.5 * chain.half_width));
    if (!tail) return;
    const double least = (is_point ? kVisible : 0.5) * chain.contrast;
    const double furthest = length(points.back() - points[last]) + 4.0 * chain.half_width + 8.0;
    double t = 0.0;
    while (t < furthest && sample(response, lattice, tail->at(t)) >= least) t += 0.25;
    const double unseen = std::min(0.5 * kVisible / std::max(1e-3, slope), kMostUnseen);
    const double end = t - 0.125 + (is_point ? unseen : -half_width);
    points.resize(last + 1);
    while (points.size() > 2 && dot(points.back() - tail->at(end), tail->along) > -0.25) points.pop_back();
    if (!chain.half_widths.empty()) chain.half_widths.resize(points.size());
    for (double s = 1.0; s < end - 0.5; s += 1.0) points.push_back(tail->at(s));
    if (end > -disturbed) points.push_back(tail->at(end));
    if (!chain.half_widths.empty()) chain.half_widths.resize(points.size(), half_width);
}

}  // namespace

// The skeleton cuts corners off; what lies straight on both sides says where they are.
void sharpen_corners(Chain& chain) {
    constexpr double kLeastTurn = 0.6, kLeastAngle = 0.5;  // radians
    const double baseline = 2.0 * chain.half_width + 2.0, span = std::max(6.0, 4.0 * chain.half_width);
    if (chain.points.size() < 12) return;
    if (chain.closed) turn_seam(chain, baseline);
    std::vector<Vec2>& points = chain.points;
    for (std::ptrdiff_t i = 1; i + 1 < static_cast<std::ptrdiff_t>(points.size()); ++i) {
        const double turn = turn_at(points, i, baseline);
        if (turn < kLeastTurn || turn_at(points, i - 1, baseline) > turn || turn_at(points, i + 1, baseline) > turn) continue;
        const double gap = chain.half_width + 0.5;
        const Side before = fit_side(points, i, -1, gap, span), behind = fit_side(points, i, 1, gap, span);
        if (!before.is_straight || !behind.is_straight) continue;
        const double sine = cross(before.line.direction, -behind.line.direction);
        const double cosine = dot(before.line.direction, -behind.line.direction);
        if (std::fabs(std::atan2(sine, cosine)) < kLeastAngle || std::fabs(sine) < 0.3) continue;
        const double s = cross(behind.line.mean - before.line.mean, -behind.line.direction) / sine;
        const Vec2 corner = before.line.mean + before.line.direction * s;
        const Vec2 first = points[static_cast<std::size_t>(before.nearest)], last = points[static_cast<std::size_t>(behind.nearest)];
        const bool is_ahead = dot(corner - first, before.line.direction) > 0.0 && dot(corner - last, behind.line.direction) > 0.0;
        if (!is_ahead || length(corner - points[static_cast<std::size_t>(i)]) > 4.0 * chain.half_width + 4.0) continue;
        points.erase(points.begin() + before.nearest + 1, points.begin() + behind.nearest);
        points.insert(points.begin() + before.nearest + 1, corner);
        i = before.nearest + 1;
    }
}

void settle_ends(Chain& chain, const Image& response, const Lattice& lattice) {
    measure_half_widths(chain, response, lattice);
    if (chain.closed || chain.points.empty()) return;
    for (const EndTie tie : {chain.end_tie, chain.start_tie}) {
        if (tie == EndTie::free) settle_free_end(chain, response, lattice);
        std::reverse(chain.points.begin(), chain.points.end());
        std::reverse(chain.half_widths.begin(), chain.half_widths.end());
    }
}

}  // namespace burin::vectorizing
