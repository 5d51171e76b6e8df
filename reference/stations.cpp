#include "evaluate_prepare.hpp"
#include "stations.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace burin::reference {
namespace {

Station across(const PreparedElement& e, Vec2 shift, double u) {
    Station station;
    station.u = u;
    station.origin = (u <= 0.0 ? e.p0 : u >= 1.0 ? e.p2 : truth::point_on(e, u)) + shift;
    station.n = normal_of(truth::tangent_on(e, u));
    station.width = e.width0 + e.width_rise * u;
    station.height = e.height0 + e.height_rise * u;
    if (e.function != nullptr) {
        const truth::Factors factors = truth::factors_on(e, u);
        station.width *= factors.width;
        station.height *= factors.height;
    }
    return station;
}

// What one end asks for beyond the section across it, from the element outwards.
struct EndMaker {
    const PreparedElement& e;
    Vec2 shift;
    double tolerance;
    int which;  // 0 start, 1 end
    std::vector<Station>& made;

    Station base() const {
        Station station = across(e, shift, which == 0 ? 0.0 : 1.0);
        const PreparedEnd& end = e.ends[which];
        station.outward = end.outward;
        station.clip = -normal_of(end.clip_inward);
        return station;
    }
    void put(Station::Kind kind, bool left = true, bool right = true) {
        Station station = base();
        station.kind = kind;
        station.holds[0] = left;
        station.holds[1] = right;
        made.push_back(station);
    }
    // Rays of a fan, from across on to `angle`.
    void fan(double angle, bool left, bool right) {
        const double radius = std::max(e.reach, 1e-12);
        const double step = std::clamp(2.0 * std::acos(std::max(-1.0, 1.0 - tolerance / radius)), 0.02, 0.6);
        const int count = std::max(1, static_cast<int>(std::ceil(angle / step)));
        for (int k = 0; k <= count; ++k) {
            const double a = angle * k / count;
            Station station = base();
            station.kind = Station::Kind::turned;
            station.turned[0] = station.outward * std::sin(a) - station.n * std::cos(a);
            station.turned[1] = station.outward * std::sin(a) + station.n * std::cos(a);
            station.holds[0] = left;
            station.holds[1] = right;
            made.push_back(station);
        }
    }
    void corner(const PreparedEnd& end) {
        const bool left = end.priority == Priority::left;
        if (end.corner == CornerShape::mitre) return put(Station::Kind::clip, left, !left);
        if (end.corner == CornerShape::bevel) {
            put(Station::Kind::across);
            return put(Station::Kind::bevel, left, !left);
        }
        // The clip line's own direction on the outer side.
        const Station station = base();
        const Vec2 side = station.n * (left ? -1.0 : 1.0);
        const Vec2 clip = station.clip * (dot(station.clip, side) < 0.0 ? -1.0 : 1.0);
        fan(std::acos(std::clamp(dot(clip, side), -1.0, 1.0)), left, !left);
    }
    void make() {
        const PreparedEnd& end = e.ends[which];
        if (end.priority == Priority::none) return put(Station::Kind::across);
        if (end.priority != Priority::both) return corner(end);
        if (end.end == EndShape::clip) return put(Station::Kind::clip);
        if (end.end == EndShape::round) return fan(0.5 * std::numbers::pi, true, true);
        put(Station::Kind::hip);
        put(Station::Kind::apex);
    }
};

double off_chord(const Station& a, const Station& b, const Station& middle, double offset) {
    const Vec2 expected = lerp(a.at(offset * a.width), b.at(offset * b.width), 0.5);
    return length(middle.at(offset * middle.width) - expected);
}

struct Divider {
    const PreparedElement& e;
    Vec2 shift;
    const StationOptions& options;
    double low, high;  // extent of the profile
    std::vector<Station>& list;

    bool is_far(const Station& a, const Station& b) const {
        Box box;
        include(box, a.origin);
        include(box, b.origin);
        // The arc bulges by no more than half of what the control polygon does.
        const double bulge = e.kind == ElementKind::quadratic ? length(e.bend) * (b.u - a.u) * (b.u - a.u) : 0.0;
        const Vec2 margin{e.reach + bulge, e.reach + bulge};
        return !options.near->meets({box.low - margin, box.high + margin});
    }
    // How far the four corners of a facet from the path to `offset` are from flat, by half of what a plane through three misses.
    double twist(const Station& a, const Station& b, double offset) const {
        const Vec2 p = a.at(0.0), u = b.at(0.0) - p, v = a.at(offset * a.width) - p, far = b.at(offset * b.width) - p;
        const double det = cross(u, v);
        if (std::abs(det) < 1e-300) return 0.0;
        // The path's line lies deepest, the other on the ground.
        const double along = cross(far, v) / det, aside = cross(u, far) / det;
        return 0.5 * options.deep * std::abs(a.height + along * (b.height - a.height) - aside * a.height);
    }
    // Adds what lies between a and b, and b itself.
    void divide(const Station& a, const Station& b, int depth) {
        const bool even = e.kind == ElementKind::line && e.function == nullptr && !e.scaled;
        if (depth < 12 && !even && !is_far(a, b)) {
            const Station middle = across(e, shift, 0.5 * (a.u + b.u));
            const double rise = std::abs(middle.height - 0.5 * (a.height + b.height)) * options.deep;
            const bool coarse = depth < 2 && e.function != nullptr;  // a wave may be met in its nodes
            const double off = std::max({rise, twist(a, b, low), twist(a, b, high), off_chord(a, b, middle, low), off_chord(a, b, middle, high)});
            if (coarse || off > options.tolerance) {
                divide(a, middle, depth + 1);
                divide(middle, b, depth + 1);
                return;
            }
        }
        list.push_back(b);
    }
};

}  // namespace

Vec2 Station::at(double b) const {
    const int side = b < 0.0 ? 0 : 1;
    const Vec2 plain = origin + n * b;
    if (!holds[side] || b == 0.0) return b == 0.0 ? origin : plain;
    switch (kind) {
        case Kind::clip: {
            const double lean = dot(n, clip);
            return std::abs(lean) < 1e-9 ? plain : origin + clip * (b / lean);
        }
        case Kind::hip:
            return plain + outward * std::abs(b);
        case Kind::apex:
            return origin + outward * std::abs(b);
        case Kind::turned:
            return origin + turned[side] * std::abs(b);
        case Kind::bevel:
            return origin + clip * (b * dot(n, clip));
        default:
            return plain;
    }
}

void place_stations(const PreparedElement& e, const ResolvedElement& resolved, Vec2 shift, const StationOptions& options, Stations& out) {
    out.list.clear();
    for (std::vector<Station>& made : out.made) made.clear();
    EndMaker start{e, shift, options.tolerance, 0, out.made[0]}, end{e, shift, options.tolerance, 1, out.made[1]};
    start.make();
    end.make();
    std::reverse(start.made.begin(), start.made.end());
    for (const Station& station : start.made) out.list.push_back(station);
    // Bent and varying elements are divided between the sections across their ends.
    const Station first = across(e, shift, 0.0), last = across(e, shift, 1.0);
    const double span = e.reach / std::max({e.width0, e.width0 + e.width_rise, 1e-9});
    Divider divider{e, shift, options, -span, span, out.list};
    divider.divide(first, last, 0);
    out.list.pop_back();
    for (const Station& station : end.made) out.list.push_back(station);
    const ElementEnd* ends[2] = {&resolved.start, &resolved.end};
    for (int k = 0; k < 2; ++k) {
        const PreparedEnd& prepared = e.ends[k];
        const bool tee = prepared.priority == Priority::both && EndShape(ends[k]->shape) == EndShape::tee;
        out.ends[k].station = k == 0 ? 0 : out.list.size() - 1;
        out.ends[k].open[0] = prepared.priority == Priority::none || prepared.priority == Priority::right || tee;
        out.ends[k].open[1] = prepared.priority == Priority::none || prepared.priority == Priority::left || tee;
        out.capped[k] = prepared.priority == Priority::both && prepared.end != EndShape::clip;
    }
}

}  // namespace burin::reference
