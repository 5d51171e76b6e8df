#include "refine_curves.hpp"

#include <algorithm>
#include <cmath>

namespace burin::refinement {
namespace {

constexpr double kLeastTurn = 0.02;       // radians at a corner of a polyline that means a curve
constexpr double kMostTurn = 0.55;
constexpr double kTurnPerQuadratic = 0.5; // an arc of 29 degrees is off by 1/2000 of its radius at most
constexpr double kStrayTurn = 0.4;         // radians
constexpr double kLongestLine = 24.0;     // texels
constexpr std::size_t kLeastLines = 4;

bool may_bend(const Element& e) {
    return e.kind == ElementKind::line && length(e.p2 - e.p0) <= kLongestLine;
}

double turn_between(const Element& a, const Element& b) {
    const Vec2 in = a.p2 - a.p0, out = b.p2 - b.p0;
    return std::atan2(cross(in, out), dot(in, out));
}

bool goes_round(double turn, double former) {
    return std::abs(turn) >= kLeastTurn && std::abs(turn) <= kMostTurn && (former == 0.0 || turn * former > 0.0);
}

// Quadratic from a to b with the given tangents; false when they do not meet properly in between.
bool make_quadratic(Vec2 a, Vec2 ta, Vec2 b, Vec2 tb, const Element& first, const Element& last, Element& out) {
    const double turn = cross(ta, tb);
    if (std::abs(turn) < 1e-4) return false;
    const double along = cross(b - a, tb) / turn, back = cross(b - a, ta) / turn;
    const double chord = length(b - a);
    if (along < 0.2 * chord || -back > -0.2 * chord || along > chord || back > chord) return false;
    out = first;
    out.kind = ElementKind::quadratic;
    out.p0 = a;
    out.p1 = a + ta * along;
    out.p2 = b;
    out.width1 = last.width1;
    out.height1 = last.height1;
    return true;
}

class PolylineCurver {
  public:
    explicit PolylineCurver(Path& path) : path_(path) {}

    bool run() {
        bool changed = false;
        if (path_.closed && path_.elements.front().p0 == path_.elements.back().p2) rotate_to_corner();
        for (std::size_t i = 0; i < path_.elements.size();) {
            const std::size_t end = run_end(i);
            if (end - i < kLeastLines || !replace(i, end)) {
                out_.insert(out_.end(), path_.elements.begin() + static_cast<std::ptrdiff_t>(i),
                            path_.elements.begin() + static_cast<std::ptrdiff_t>(std::max(end, i + 1)));
                i = std::max(end, i + 1);
                continue;
            }
            changed = true;
            i = end;
        }
        if (changed) path_.elements = out_;
        return changed;
    }

  private:
    // A closed path starts where a run of curve would not be cut in two, when there is such a place.
    void rotate_to_corner() {
        std::vector<Element>& e = path_.elements;
        for (std::size_t i = 0; i < e.size(); ++i) {
            const Element& before = e[(i + e.size() - 1) % e.size()];
            if (may_bend(before) && may_bend(e[i]) && goes_round(turn_between(before, e[i]), 0.0)) continue;
            std::rotate(e.begin(), e.begin() + static_cast<std::ptrdiff_t>(i), e.end());
            return;
        }
        round_ = e.size() >= kLeastLines;
    }

    std::size_t run_end(std::size_t i) const {
        const std::vector<Element>& e = path_.elements;
        if (!may_bend(e[i])) return i + 1;
        double former = 0.0;
        while (i + 1 < e.size() && may_bend(e[i + 1])) {
            const double turn = turn_between(e[i], e[i + 1]);
            if (!goes_round(turn, former)) break;
            former = turn;
            ++i;
        }
        return i + 1;
    }

    // The curve's direction at the start of element i of the run from..end.
    Vec2 tangent_at(std::size_t i, std::size_t from, std::size_t end) const {
        const std::vector<Element>& e = path_.elements;
        const auto direction = [&](std::size_t k) { return unit(e[k].p2 - e[k].p0); };
        if (i > from && i < end) return unit(direction(i - 1) + direction(i));
        if (round_) return unit(direction(end - 1) + direction(from));
        // At the ends of a run: as far beyond the first line as the next corner lies before it.
        const Vec2 at = i == from ? direction(from) : direction(end - 1);
        const Vec2 inner = i == from ? unit(at + direction(from + 1)) : unit(at + direction(end - 2));
        return unit(at * (2.0 * dot(at, inner)) - inner);
    }

    bool replace(std::size_t from, std::size_t end) {
        const std::vector<Element>& e = path_.elements;
        std::vector<Element> chain;
        std::size_t start = from;
        while (start < end) {
            std::size_t stop = start + 1;
            const Vec2 first = tangent_at(start, from, end);
            while (stop < end) {
                const Vec2 last = tangent_at(stop + 1, from, end);
                if (std::abs(std::atan2(cross(first, last), dot(first, last))) > kTurnPerQuadratic) break;
                ++stop;
            }
            Element quadratic;
            if (!make_quadratic(e[start].p0, first, e[stop - 1].p2, tangent_at(stop, from, end), e[start], e[stop - 1],
                                quadratic))
                return false;
            chain.push_back(quadratic);
            start = stop;
        }
        out_.insert(out_.end(), chain.begin(), chain.end());
        return true;
    }

    Path& path_;
    std::vector<Element> out_;
    bool round_ = false;  // the whole closed path is one run
};

}  // namespace

bool curve_polylines(Pattern& pattern) {
    bool changed = false;
    for (Path& path : pattern.paths)
        if (path.elements.size() >= kLeastLines) changed |= PolylineCurver(path).run();
    return changed;
}

namespace {

void reverse(Path& path) {
    std::reverse(path.elements.begin(), path.elements.end());
    for (Element& e : path.elements) {
        std::swap(e.p0, e.p2);
        std::swap(e.width0, e.width1);
        std::swap(e.height0, e.height1);
    }
}

// At the end of the path only.
bool tidy_tail(Path& path, double reach) {
    if (path.elements.size() < 2) return false;
    Element& last = path.elements.back();
    const Element& before = path.elements[path.elements.size() - 2];
    const Vec2 in = unit(before.kind == ElementKind::line ? before.p2 - before.p0 : before.p2 - before.p1);
    const Vec2 out = unit(last.kind == ElementKind::line ? last.p2 - last.p0 : last.p1 - last.p0);
    const double angle = std::atan2(std::abs(cross(in, out)), dot(in, out));
    const double size = length(last.p2 - last.p0);
    if (angle > kStrayTurn && size < reach) return path.elements.pop_back(), true;
    if (last.kind != ElementKind::line || before.kind != ElementKind::quadratic) return false;
    if (angle < 0.03 || angle > 2.0 * kMostTurn || size > 1.5 * length(before.p2 - before.p0)) return false;
    last.kind = ElementKind::quadratic;
    last.p1 = last.p0 + in * (0.5 * size);
    return true;
}

}  // namespace

bool tidy_tails(Pattern& pattern) {
    bool changed = false;
    for (Path& path : pattern.paths) {
        const std::vector<ProfilePoint>& points = pattern.profiles[path.profile].points;
        if (path.closed || points.front().h != points.back().h) continue;
        const double reach = std::max(-points.front().b, points.back().b);
        changed |= tidy_tail(path, reach);
        reverse(path);
        changed |= tidy_tail(path, reach);
        reverse(path);
    }
    return changed;
}

void split_quadratics(Pattern& pattern, const std::vector<ElementIndex>& which) {
    std::vector<std::vector<char>> marked(pattern.paths.size());
    for (std::size_t p = 0; p < marked.size(); ++p) marked[p].assign(pattern.paths[p].elements.size(), 0);
    for (const ElementIndex& index : which) marked[index.path][index.element] = 1;
    for (std::size_t p = 0; p < marked.size(); ++p) {
        std::vector<Element> out;
        for (std::size_t i = 0; i < marked[p].size(); ++i) {
            const Element& e = pattern.paths[p].elements[i];
            if (!marked[p][i] || e.kind != ElementKind::quadratic) {
                out.push_back(e);
                continue;
            }
            const Vec2 a = lerp(e.p0, e.p1, 0.5), b = lerp(e.p1, e.p2, 0.5), middle = lerp(a, b, 0.5);
            Element first = e, second = e;
            first.p1 = a, first.p2 = second.p0 = middle, second.p1 = b;
            first.width1 = second.width0 = 0.5 * (e.width0 + e.width1);
            first.height1 = second.height0 = 0.5 * (e.height0 + e.height1);
            out.push_back(first);
            out.push_back(second);
        }
        pattern.paths[p].elements = std::move(out);
    }
}

}  // namespace burin::refinement
