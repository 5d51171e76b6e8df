#include "stroke_trace.hpp"

#include <algorithm>
#include <cstdio>

namespace burin::stroking {
namespace {

// What a walk from one place to another met.
struct Walk {
    std::vector<Place> places;  // where sides are crossed, each with the triangle that follows; then the target, if reached
    bool reached = false;
    bool fell_off = false;  // over an open side
};

// The plane of a segment: through its start, along it and the normals of the surface at its ends.
struct Cut {
    Point3 origin, way, across;
    double height(Point3 p) const { return dot(p - origin, across); }
    double run(Point3 p) const { return dot(p - origin, way); }
};

bool holds(const Triangle& t, Point3 p, double slack) {
    if (dot(t.normal, t.normal) == 0.0) return false;
    if (std::abs(dot(p - t.p[0], t.normal)) > slack) return false;
    for (std::size_t k = 0; k < 3; ++k) {
        const Point3 inwards = unit(cross(t.normal, t.p[(k + 1) % 3] - t.p[k]));
        if (dot(p - t.p[k], inwards) < -slack) return false;
    }
    return true;
}

class Walker {
  public:
    explicit Walker(const Surface& surface) : surface_(surface), slack_(1e-9 * surface.size()) {}

    Walk walk(const Place& from, const Place& to) const {
        Walk walk;
        const auto triangles = surface_.around(from, slack_);
        for (const std::uint32_t i : triangles)
            if (i == to.triangle || holds(surface_.triangles()[i], to.p, slack_)) {
                walk.reached = true;
                walk.places = {{from.p, i}, to};
                return walk;
            }
        const auto cut = cut_between(from, to);
        if (!cut.way.x && !cut.way.y && !cut.way.z) return walk;
        follow(cut, from, to, triangles, walk);
        return walk;
    }

  private:
    // No way: the surface looks the other way at the other end, and the plane says nothing.
    Cut cut_between(const Place& from, const Place& to) const {
        const Point3 d = to.p - from.p;
        const Point3 a = surface_.triangles()[from.triangle].normal, b = surface_.triangles()[to.triangle].normal;
        const Point3 across = cross(a + b, d);
        if (dot(a, b) < -0.7 || !(length(across) > 0.05 * length(d))) return {};
        return {from.p, unit(d), unit(across)};
    }

    // Heights at corners decide, and a corner has one height for all of its triangles: the way through them never tears.
    static bool above(const Cut& cut, Point3 p) { return cut.height(p) >= 0.0; }

    static Point3 crossing(const Cut& cut, const Triangle& t, std::size_t side) {
        Point3 a = t.p[side], b = t.p[(side + 1) % 3];
        if (t.corner[side] > t.corner[(side + 1) % 3]) std::swap(a, b);  // the same point from both sides
        const double ha = cut.height(a), hb = cut.height(b);
        return a + (b - a) * (ha / (ha - hb));
    }

    // The triangle at the start, and its side, that lead farthest ahead.
    bool begin(const Cut& cut, const std::vector<std::uint32_t>& triangles, std::uint32_t& triangle, std::size_t& side) const {
        double most = slack_;
        bool found = false;
        for (const std::uint32_t i : triangles) {
            const Triangle& t = surface_.triangles()[i];
            for (std::size_t k = 0; k < 3; ++k) {
                if (above(cut, t.p[k]) == above(cut, t.p[(k + 1) % 3])) continue;
                if (const double run = cut.run(crossing(cut, t, k)); run > most) most = run, triangle = i, side = k, found = true;
            }
        }
        return found;
    }

    void follow(const Cut& cut, const Place& from, const Place& to, const std::vector<std::uint32_t>& triangles, Walk& walk) const {
        std::uint32_t triangle = kNone;
        std::size_t side = 0;
        if (!begin(cut, triangles, triangle, side)) {
            walk.fell_off = surface_.on_open_side(from, slack_);
            return;
        }
        walk.places.push_back({from.p, triangle});
        const double far = 4.0 * cut.run(to.p);
        for (std::size_t n = 0; n < surface_.triangles().size(); ++n) {
            const Triangle& t = surface_.triangles()[triangle];
            if (triangle == to.triangle || holds(t, to.p, slack_)) {
                walk.places.push_back(to);
                walk.reached = true;
                return;
            }
            const Point3 at = crossing(cut, t, side);
            walk.places.push_back({at, t.neighbour[side]});
            walk.fell_off = t.neighbour[side] == kNone;
            if (walk.fell_off || std::abs(cut.run(at)) > far) return;
            triangle = t.neighbour[side];
            side = other_side(cut, t, side, surface_.triangles()[triangle]);
            if (side == 3) return;
        }
    }

    // Of two sides that the plane cuts in the next triangle, the one that is not `side` of this one.
    static std::size_t other_side(const Cut& cut, const Triangle& t, std::size_t side, const Triangle& next) {
        const std::uint32_t a = t.corner[side], b = t.corner[(side + 1) % 3];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t c = next.corner[k], d = next.corner[(k + 1) % 3];
            const bool entry = (c == a && d == b) || (c == b && d == a);
            if (!entry && above(cut, next.p[k]) != above(cut, next.p[(k + 1) % 3])) return k;
        }
        return 3;
    }

    const Surface& surface_;
    double slack_;
};

double distance_to(Point3 p, Point3 a, Point3 b) {
    const Point3 d = b - a;
    const double along = dot(d, d) > 0.0 ? std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0) : 0.0;
    return length(p - a - d * along);
}

class Tracer {
  public:
    Tracer(const Surface& surface, const TraceOptions& options) : surface_(surface), walker_(surface), options_(options) {}

    std::vector<Trace> run(const std::vector<Place>& places, const std::vector<Point3>& drawn, bool closed) {
        const auto end = [&](std::size_t i) { return End{places[i], drawn[i], is_off(places[i], drawn[i])}; };
        if (!end(0).off) begin(places.front());
        for (std::size_t i = 0; i + (closed ? 0 : 1) < places.size(); ++i) add_segment(end(i), end((i + 1) % places.size()));
        if (closed && !traces_.empty() && length(traces_.back().points.back() - traces_.front().points.front()) <= 1e-12 * surface_.size()) {
            if (traces_.size() == 1)
                traces_.front().closed = true;
            else
                join_around();
        }
        std::erase_if(traces_, [](const Trace& trace) { return trace.points.size() < 2; });
        return std::move(traces_);
    }

  private:
    static constexpr int kMostHalvings = 16;

    // A drawn point, its nearest place, and whether it lies off the open side of the mesh.
    struct End {
        Place place;
        Point3 drawn;
        bool off = false;
    };

    bool is_off(const Place& place, Point3 drawn) const {
        return length(drawn - place.p) > 4.0 * options_.fine && surface_.on_open_side(place, 1e-9 * surface_.size());
    }

    // Of a segment whose ends lie on and off the surface: the last that is on it.
    End rim(End on, End off) const {
        for (int i = 0; i < kMostHalvings; ++i) {
            const Point3 middle = (on.drawn + off.drawn) * 0.5;
            const Place place = surface_.nearest(middle);
            const End end{place, middle, is_off(place, middle)};
            (end.off ? off : on) = end;
        }
        return on;
    }

    void add_segment(const End& a, const End& b) {
        if (a.off && b.off) return;
        const End from = a.off ? rim(b, a) : a, to = b.off ? rim(a, b) : b;
        if (a.off) {
            const bool again = !traces_.empty();
            begin(from.place);
            traces_.back().gaps += again;
        }
        link(from.place, from.drawn, to.place, to.drawn, kMostHalvings);
    }

    void begin(const Place& place) {
        traces_.emplace_back();
        traces_.back().points.push_back(place.p);
        traces_.back().drawn.push_back(true);
    }

    // Goes on from the last point; a step of no length says nothing.
    void add(Point3 p, std::uint32_t triangle, bool drawn) {
        Trace& trace = traces_.back();
        if (length(p - trace.points.back()) <= 1e-12 * surface_.size()) {
            trace.drawn.back() = trace.drawn.back() || drawn;
            return;
        }
        trace.points.push_back(p);
        trace.triangles.push_back(triangle);
        trace.drawn.push_back(drawn);
    }

    void append(const Walk& walk, bool to_drawn) {
        for (std::size_t i = 1; i < walk.places.size(); ++i)
            add(walk.places[i].p, walk.places[i - 1].triangle, to_drawn && walk.reached && i + 1 == walk.places.size());
    }

    // Whether the cut stays by the segment, as far as a bent surface allows.
    bool stays(const Walk& walk, Point3 a, Point3 b) const {
        const double most = 0.3 * length(b - a) + options_.fine;
        return std::all_of(walk.places.begin(), walk.places.end(), [&](const Place& place) { return distance_to(place.p, a, b) <= most; });
    }

    // `a` and `b` are the nearest places to the ends of the drawn segment from `drawn_a` to `drawn_b`.
    void link(const Place& a, Point3 drawn_a, const Place& b, Point3 drawn_b, int halvings) {
        const bool drawn = halvings == kMostHalvings;  // b is the place of a drawn point, not of one between
        link_between(a, drawn_a, b, drawn_b, halvings);
        if (drawn) traces_.back().drawn.back() = true;
    }

    void link_between(const Place& a, Point3 drawn_a, const Place& b, Point3 drawn_b, int halvings) {
        const Walk walk = walker_.walk(a, b);
        if (walk.reached && (halvings == 0 || stays(walk, a.p, b.p))) return append(walk, false);
        if (length(a.p - b.p) <= options_.fine && !walk.fell_off) return add(b.p, b.triangle, false);
        const Point3 middle = (drawn_a + drawn_b) * 0.5;
        const Place place = surface_.nearest(middle);
        const bool missing = walk.fell_off && surface_.on_open_side(place, 1e-9 * surface_.size());
        if (halvings > 0 && !missing && length(drawn_b - drawn_a) > options_.fine) {
            link(a, drawn_a, place, middle, halvings - 1);
            return link(place, middle, b, drawn_b, halvings - 1);
        }
        if (length(a.p - b.p) <= options_.fine) return add(b.p, b.triangle, false);
        leap(walk, a, b);
    }

    // Ends where the surface does, and begins anew where it comes back.
    void leap(const Walk& there, const Place& a, const Place& b) {
        if (there.fell_off) append(there, false);
        const Walk back = walker_.walk(b, a);
        if (!back.fell_off || back.places.empty()) {
            begin(b);
        } else {
            begin(back.places.back());
            for (std::size_t i = back.places.size() - 1; i-- > 0;) add(back.places[i].p, back.places[i].triangle, false);
        }
        ++traces_.back().gaps;
    }

    // A closed stroke with gaps: its last trace leads on into its first.
    void join_around() {
        Trace first = std::move(traces_.front());
        traces_.erase(traces_.begin());
        for (std::size_t i = 0; i < first.triangles.size(); ++i) add(first.points[i + 1], first.triangles[i], first.drawn[i + 1]);
    }

    const Surface& surface_;
    Walker walker_;
    const TraceOptions& options_;
    std::vector<Trace> traces_;
};

Error too_far(const std::string& name, std::size_t index, const Stroke& stroke, double distance, double allowed) {
    char text[192];
    const Point3 p = stroke.points[index];
    std::snprintf(text, sizeof text, ": point %zu of %zu at (%.4g, %.4g, %.4g) is %.4g m away from the surface, allowed is %.4g m", index + 1, stroke.points.size(), p.x,
                  p.y, p.z, distance, allowed);
    return {ErrorCode::invalid_input, name + text};
}

}  // namespace

Result<std::vector<Trace>> trace_stroke(const Surface& surface, const Stroke& stroke, const std::string& name, const TraceOptions& options,
                                        double& farthest) {
    std::vector<Place> places;
    for (std::size_t i = 0; i < stroke.points.size(); ++i) {
        const Point3 p = stroke.points[i];
        places.push_back(surface.nearest(p));
        const double distance = length(p - places.back().p);
        farthest = std::max(farthest, distance);
        if (!(distance <= options.max_distance))
            return too_far(name, i, stroke, distance, options.max_distance);
    }
    return Tracer(surface, options).run(places, stroke.points, stroke.closed);
}

}  // namespace burin::stroking
