#include "stroke_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace burin::stroking {
namespace {

// Beyond half the width, so that no tip of a chart slips between two samples.
constexpr double kReach = 1.25;
// Nearer than this, in half widths, a chart gets a piece.
constexpr double kNear = 1.13;
// Of what is across in space from what is across in the pattern: the tangent, as charts stretched four to one have it.
constexpr double kMostLean = 2.0;

struct Sample {
    double s = 0.0;
    Place place;
    Point3 tangent;
};

// A trace by its length: places and tangents.
class Ruler {
  public:
    explicit Ruler(const Trace& trace) : trace_(trace) {
        at_.push_back(0.0);
        for (std::size_t i = 0; i + 1 < trace.points.size(); ++i) at_.push_back(at_.back() + length(trace.points[i + 1] - trace.points[i]));
    }

    double total() const { return at_.back(); }
    double at(std::size_t point) const { return at_[point]; }

    Place place(double s) const {
        const std::size_t i = segment(s);
        const double share = std::clamp((s - at_[i]) / (at_[i + 1] - at_[i]), 0.0, 1.0);
        return {trace_.points[i] + (trace_.points[i + 1] - trace_.points[i]) * share, trace_.triangles[i]};
    }

    // Of the chord over `reach` to both sides, so that a corner has the direction between its arms.
    Point3 direction(double s, double reach) const {
        return unit(place(around(s + reach)).p - place(around(s - reach)).p);
    }

  private:
    double around(double s) const {
        if (!trace_.closed) return std::clamp(s, 0.0, total());
        return s < 0.0 ? s + total() : s > total() ? s - total() : s;
    }
    std::size_t segment(double s) const {
        const auto above = std::upper_bound(at_.begin() + 1, at_.end() - 1, s);
        return static_cast<std::size_t>(above - at_.begin()) - 1;
    }

    const Trace& trace_;
    std::vector<double> at_;
};

Point3 in_plane(const Triangle& t, Point3 v) { return unit(v - t.normal * dot(v, t.normal)); }

// Samples at both ends and at drawn points, and evenly between them.
std::vector<Sample> sample_trace(const Surface& surface, const Trace& trace, double spacing) {
    const Ruler ruler(trace);
    std::vector<double> marks{0.0};
    for (std::size_t i = 1; i + 1 < trace.points.size(); ++i)
        if (trace.drawn[i] && ruler.at(i) > marks.back() + 0.5 * spacing && ruler.at(i) < ruler.total() - 0.5 * spacing) marks.push_back(ruler.at(i));
    marks.push_back(ruler.total());
    std::vector<Sample> samples;
    const auto add = [&](double s) {
        const Place place = ruler.place(s);
        const Triangle& t = surface.triangles()[place.triangle];
        if (dot(t.normal, t.normal) > 0.0) samples.push_back({s, place, in_plane(t, ruler.direction(s, 0.5 * spacing))});
    };
    for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
        const double count = std::ceil((marks[i + 1] - marks[i]) / spacing);
        for (double k = 0; k < count; ++k) add(marks[i] + (marks[i + 1] - marks[i]) * k / count);
    }
    if (!trace.closed) add(ruler.total());
    return samples;
}

// Beyond an end, straight on: where its cap may lie. Nearest to the end first.
std::vector<Sample> sample_beyond(const Surface& surface, const Sample& end, double sign, const PieceOptions& options) {
    const Triangle& t = surface.triangles()[end.place.triangle];
    std::vector<Sample> samples;
    double gone = 0.0, next = options.spacing;
    for (const WayStep& step : straight_way(surface, end.place, end.tangent * sign, cross(t.normal, end.tangent), kReach * 0.5 * options.width)) {
        for (; next <= gone + step.length; next += options.spacing)
            samples.push_back({end.s + sign * next, {step.from + step.way * (next - gone), step.triangle}, step.way * sign});
        gone += step.length;
    }
    return samples;
}

// What one chart shows of the stroke at one sample.
struct View {
    std::uint32_t chart = 0;
    double distance = 0.0;  // of the chart from the middle, metres
    Vec2 p, along;
    double across = 0.0;  // sum over the way of the pattern's step across, times metres
    double gone = 0.0;    // metres of the way
    double ahead = 0.0, behind = 0.0;  // as a PiecePoint has them
    double scale() const { return across / gone; }
};

void add_side(const Surface& surface, const Sample& sample, double sign, double width, std::vector<View>& views) {
    const Triangle& first = surface.triangles()[sample.place.triangle];
    const Point3 across = cross(first.normal, sample.tangent) * sign;
    double gone = 0.0, next = 0.0;
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::size_t view = has_pattern(first) ? 0 : none;
    bool begun = false;
    for (const WayStep& step : straight_way(surface, sample.place, across, sample.tangent, kReach * 0.5 * width)) {
        const Triangle& t = surface.triangles()[step.triangle];
        gone = std::exchange(next, next + step.length);
        if (begun && !step.joined) {
            view = none;
            if (has_pattern(t)) {
                view = views.size();
                views.push_back({t.chart, gone, pattern_point(t, step.from) - step_in(t, step.way) * gone, step_in(t, step.beside)});
            }
        }
        begun = true;
        if (view != none) {
            // What lies beyond half the width says something only where there is nothing else.
            const double metres = std::clamp(0.5 * width - gone, 1e-6 * step.length, step.length);
            View& seen = views[view];
            const Vec2 step_across = step_in(t, step.way), along = unit(seen.along);
            seen.across += std::abs(dot(normal_of(along), step_across)) * metres;
            seen.gone += metres;
            if (gone > 0.5 * width) continue;
            // Slivers lean without bound; a piece that followed them would show elsewhere.
            const double lean = std::clamp(dot(along, step_across) / length(seen.along), -kMostLean, kMostLean) * std::min(0.5 * width, next);
            seen.ahead = std::max(seen.ahead, lean), seen.behind = std::max(seen.behind, -lean);
        }
    }
}

// The chart under the middle first, if there is a pattern.
std::vector<View> views_at(const Surface& surface, const Sample& sample, double width) {
    std::vector<View> views;
    const Triangle& t = surface.triangles()[sample.place.triangle];
    if (has_pattern(t)) views.push_back({t.chart, 0.0, pattern_point(t, sample.place.p), step_in(t, sample.tangent)});
    for (const double sign : {-1.0, 1.0}) add_side(surface, sample, sign, width, views);
    std::erase_if(views, [](const View& view) { return !(view.gone > 0.0) || !(view.across > 0.0); });
    return views;
}

// A piece as it grows.
struct Run : Piece {
    std::size_t last = 0;   // sample
    double nearest = 1e300;  // of the chart's distances
};

class Pieceworker {
  public:
    Pieceworker(const Surface& surface, const Trace& trace, const PieceOptions& options) : surface_(surface), trace_(trace), options_(options) {}

    Pieces run() {
        Pieces out;
        std::vector<Sample> samples = sample_trace(surface_, trace_, options_.spacing);
        out.length = total_ = Ruler(trace_).total();
        if (samples.empty()) return out;
        if (!trace_.closed && options_.open_caps) extend(samples);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double step = i > 0 ? samples[i].s - samples[i - 1].s : 0.0;
            std::vector<View> views = views_at(surface_, samples[i], options_.width);
            const bool middle = !views.empty() && views.front().distance == 0.0;
            if (middle && views.front().chart != chart_ && inside(samples[i].s)) out.borders += std::exchange(chart_, views.front().chart) != kNone;
            if (!has_pattern(surface_.triangles()[samples[i].place.triangle]) && inside(samples[i].s)) out.lost += step;
            for (const View& view : views) take(view, i, samples[i], step);
        }
        if (trace_.closed) join_ends(samples);
        for (Run& run : runs_)
            if (run.nearest <= kNear * 0.5 * options_.width) finish(run, out);
        return out;
    }

  private:
    bool inside(double s) const { return s >= 0.0 && s <= total_; }

    void extend(std::vector<Sample>& samples) const {
        std::vector<Sample> before = sample_beyond(surface_, samples.front(), -1.0, options_);
        const std::vector<Sample> after = sample_beyond(surface_, samples.back(), 1.0, options_);
        std::reverse(before.begin(), before.end());
        samples.insert(samples.begin(), before.begin(), before.end());
        samples.insert(samples.end(), after.begin(), after.end());
    }

    // Whole tiles from p to the image of it nearest to q.
    Vec2 tiles(Vec2 p, Vec2 q) const {
        if (!surface_.repeats()) return {};
        const Vec2 size = surface_.pattern_size();
        return {std::round((q.x - p.x) / size.x) * size.x, std::round((q.y - p.y) / size.y) * size.y};
    }

    // Whether a point goes on from another, `step` metres before. Elsewhere in the same chart the stroke is another piece.
    bool follows(const PiecePoint& before, Vec2 p, Vec2 along, double step) const {
        const double most = 3.0 * step * std::max({length(before.along), length(along), before.width / options_.width});
        return length(p + tiles(p, before.p) - before.p) <= most;
    }

    void take(const View& view, std::size_t sample, const Sample& at, double step) {
        const PiecePoint point{at.s, view.p, view.along, view.scale() * options_.width, at.place.p, view.ahead, view.behind};
        for (Run& run : runs_)
            if (run.chart == view.chart && run.last + 1 >= sample && follows(run.points.back(), view.p, view.along, std::max(step, 0.05 * options_.spacing))) {
                if (run.last < sample || run.points.size() == 0) {
                    run.points.push_back(point);
                    run.points.back().p = view.p + tiles(view.p, run.points.end()[-2].p);
                    run.last = sample;
                }
                run.nearest = std::min(run.nearest, view.distance);
                return;
            }
        Run run;
        run.chart = view.chart, run.points = {point}, run.last = sample, run.nearest = view.distance;
        runs_.push_back(std::move(run));
    }

    // Over the seam of a closed trace.
    void join_ends(const std::vector<Sample>& samples) {
        const double step = total_ - samples.back().s;
        for (std::size_t i = 0; i < runs_.size(); ++i)
            for (std::size_t k = 0; k < runs_.size(); ++k) {
                Run &end = runs_[i], &start = runs_[k];
                if (end.chart != start.chart || end.last + 1 != samples.size() || start.points.front().s != samples.front().s || end.closed) continue;
                if (!follows(end.points.back(), start.points.front().p, start.points.front().along, step)) continue;
                const Vec2 by = tiles(start.points.front().p, end.points.back().p);
                if (i == k) {
                    end.closed = end.points.size() > 3;
                    end.period = by;
                    break;
                }
                for (PiecePoint point : start.points) {
                    point.s += total_, point.p = point.p + by;
                    end.points.push_back(point);
                }
                end.nearest = std::min(end.nearest, start.nearest);
                end.last = start.last;
                runs_.erase(runs_.begin() + static_cast<std::ptrdiff_t>(k));
                return join_ends(samples);
            }
    }

    static PiecePoint moved(const PiecePoint& from, double by) { return {from.s + by, from.p + from.along * by, from.along, from.width, from.place, from.ahead, from.behind}; }

    // Ends: those of the trace exactly, those at borders a little outside of the chart.
    void finish(Run& run, Pieces& out) const {
        Piece piece = run;
        if (!run.closed) {
            const double slack = 1e-9 * options_.width;
            piece.starts = !trace_.closed && run.points.front().s <= slack;
            piece.ends = !trace_.closed && run.points.back().s >= total_ - slack;
            std::vector<PiecePoint>& points = piece.points;
            std::erase_if(points, [&](const PiecePoint& p) { return !trace_.closed && (p.s < -slack || p.s > total_ + slack); });
            // Only a cap reaches into the chart.
            if (points.empty()) points = {piece.starts ? moved(run.points.back(), -run.points.back().s) : moved(run.points.front(), total_ - run.points.front().s)};
            double first = points.front().s, last = points.back().s;
            for (const PiecePoint& p : points) first = std::min(first, p.s - p.behind), last = std::max(last, p.s + p.ahead);
            if (!piece.starts) points.insert(points.begin(), moved(points.front(), first - points.front().s - options_.spacing));
            if (!piece.ends) points.push_back(moved(points.back(), last - points.back().s + options_.spacing));
        }
        out.pieces.push_back(std::move(piece));
    }

    const Surface& surface_;
    const Trace& trace_;
    const PieceOptions& options_;
    std::vector<Run> runs_;
    double total_ = 0.0;
    std::uint32_t chart_ = kNone;
};

}  // namespace

Pieces pieces_of(const Surface& surface, const Trace& trace, const PieceOptions& options) { return Pieceworker(surface, trace, options).run(); }

}  // namespace burin::stroking
