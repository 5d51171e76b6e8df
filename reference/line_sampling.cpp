#include "line_sampling.hpp"

#include <algorithm>
#include <cmath>

#include "evaluate_prepare.hpp"
#include "gather.hpp"

namespace burin::reference {
namespace {

// The common axes: t along the grooves, n across, from the middle of what matters.
struct Axes {
    Vec2 origin, t, n;
    double half_along = 0.0, half_across = 0.0;
};

// The axes as they lie along t, from the middle of the region.
void set_axes(const Region& region, Vec2 t, Axes& axes) {
    axes.t = t;
    axes.n = normal_of(t);
    double low, high, left, right;
    region.extent(axes.t, low, high);
    region.extent(axes.n, left, right);
    axes.origin = axes.t * (0.5 * (low + high)) + axes.n * (0.5 * (left + right));
    axes.half_along = 0.5 * (high - low);
    axes.half_across = 0.5 * (right - left);
}

// How far an end reaches back into the element.
double taken_by(const PreparedEnd& end, double reach) {
    if (end.priority == Priority::none) return 0.0;
    if (end.priority == Priority::both && end.end != EndShape::clip) return 0.0;
    const double along = std::abs(dot(end.clip_inward, normal_of(end.outward))), across = std::abs(dot(end.clip_inward, end.outward));
    return across < 1e-9 ? 0.0 : reach * along / across;
}

class Crosser {
  public:
    Crosser(const GroovedSurface& surface, const Gathered& gathered, double tolerance, LineSampling& work)
        : surface_(surface), gathered_(gathered), tolerance_(tolerance), work_(work) {}

    Axes axes;

    bool cross_all() {
        set_axes(gathered_.region, {1, 0}, axes);
        work_.crossed.clear();
        for (std::uint32_t i = 0; i < gathered_.instances.size(); ++i)
            if (!cross_one(i)) return false;
        std::sort(work_.crossed.begin(), work_.crossed.end(), [](const Crossed& a, const Crossed& b) { return a.at < b.at || (a.at == b.at && a.from < b.from); });
        return merge() && are_apart();
    }

  private:
    const PreparedElement& element(std::uint32_t instance) const {
        return surface_.truth().prepared().elements[gathered_.instances[instance].element];
    }

    bool cross_one(std::uint32_t i) {
        const PreparedElement& e = element(i);
        const SlabbedProfile& profile = surface_.profiles()[e.profile];
        if (!profile.height_field || e.function != nullptr) return false;
        const Vec2 shift = gathered_.instances[i].shift;
        const double u = e.kind == ElementKind::line ? 0.0 : truth::find_foot(e, axes.origin - shift).parameter;
        const Vec2 t = truth::tangent_on(e, u);
        if (i == 0) set_axes(gathered_.region, t, axes);
        if (std::abs(cross(t, axes.t)) * axes.half_along > tolerance_) return false;
        if (e.kind == ElementKind::quadratic && !is_straight(e, u)) return false;
        Crossed crossed;
        crossed.instance = i;
        crossed.turned = dot(t, axes.t) < 0.0;
        crossed.at = dot(truth::point_on(e, u) + shift - axes.origin, axes.n) + slant(e, u, shift);
        if (!set_section(e, crossed, shift)) return false;
        work_.crossed.push_back(crossed);
        return true;
    }
    // A line that leans a little is met in the middle of what matters.
    double slant(const PreparedElement& e, double u, Vec2 shift) const {
        const Vec2 t = truth::tangent_on(e, u), from = axes.origin - shift - truth::point_on(e, u);
        return dot(from, axes.t) * dot(t, axes.n) / dot(t, axes.t);
    }
    bool is_straight(const PreparedElement& e, double u) const {
        const Vec2 speed = (e.edge + e.bend * u) * 2.0;
        const double fast = dot(speed, speed);
        const double curvature = std::abs(cross(speed, e.bend * 2.0)) / std::max(fast * std::sqrt(fast), 1e-300);
        return 0.5 * curvature * axes.half_along * axes.half_along <= tolerance_ && curvature * axes.half_along <= 0.05;
    }

    bool set_section(const PreparedElement& e, Crossed& crossed, Vec2 shift) const {
        const double start = dot(e.p0 + shift - axes.origin, axes.t), end = dot(e.p2 + shift - axes.origin, axes.t);
        const double taken[2] = {taken_by(e.ends[0], e.reach), taken_by(e.ends[1], e.reach)};
        const double sign = crossed.turned ? -1.0 : 1.0, span = std::abs(end - start);
        crossed.from = std::min(start + sign * taken[0], end - sign * taken[1]);
        crossed.to = std::max(start + sign * taken[0], end - sign * taken[1]);
        if (e.scaled) {
            const double over = std::min(1.0, 2.0 * axes.half_along / std::max(span, 1e-300));
            if (std::max(std::abs(e.width_rise) * e.reach, std::abs(e.height_rise) * surface_.pattern().depth) * over > tolerance_) return false;
        }
        const double u = std::clamp(-start / (end - start == 0.0 ? 1.0 : end - start), 0.0, 1.0);
        crossed.width = e.width0 + e.width_rise * u;
        crossed.height = e.height0 + e.height_rise * u;
        const SlabbedProfile& profile = surface_.profiles()[e.profile];
        const double low = profile.lines.front() * crossed.width, high = profile.lines.back() * crossed.width;
        crossed.low = crossed.at + (crossed.turned ? -high : low);
        crossed.high = crossed.at + (crossed.turned ? -low : high);
        return true;
    }

    // Elements that go on in each other are one groove; each must hold all along.
    bool merge() {
        auto& list = work_.crossed;
        std::size_t kept = 0;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (kept > 0 && goes_on(list[kept - 1], list[i])) {
                list[kept - 1].from = std::min(list[kept - 1].from, list[i].from);
                list[kept - 1].to = std::max(list[kept - 1].to, list[i].to);
            } else {
                list[kept++] = list[i];
            }
        }
        list.resize(kept);
        return std::all_of(list.begin(), list.end(), [&](const Crossed& a) { return a.from <= -axes.half_along && a.to >= axes.half_along; });
    }
    bool goes_on(const Crossed& a, const Crossed& b) const {
        const auto& elements = surface_.pattern().elements;
        const ResolvedElement &first = elements[gathered_.instances[a.instance].element], &second = elements[gathered_.instances[b.instance].element];
        const bool touch = b.from <= a.to + tolerance_ && a.from <= b.to + tolerance_;
        return first.path == second.path && first.style == second.style && a.turned == b.turned && std::abs(a.at - b.at) <= tolerance_ && touch;
    }

    bool are_apart() const {
        const auto& list = work_.crossed;
        if (!surface_.truth().prepared().steps.empty() && !list.empty()) {
            // A groove that a step divides lies twice there, once for each level.
            const Vec2 beside = axes.origin + axes.n * (list.front().low - 1e-6 * axes.half_across);
            if (std::abs(ground_near(surface_, beside) - left_level(list.front())) > 1e-6 * surface_.pattern().depth) return false;
        }
        for (std::size_t i = 0; i + 1 < list.size(); ++i) {
            if (list[i].high > list[i + 1].low + 1e-9 * axes.half_across) return false;
            if (std::abs(right_level(list[i]) - left_level(list[i + 1])) > 1e-6 * surface_.pattern().depth) return false;
        }
        return true;
    }

  public:
    double left_level(const Crossed& c) const { return c.turned ? element(c.instance).right_level : element(c.instance).left_level; }
    double right_level(const Crossed& c) const { return c.turned ? element(c.instance).left_level : element(c.instance).right_level; }

    void build_segments() {
        auto& out = work_.segments;
        out.clear();
        double x = -4.0 * axes.half_across - 1e-9, z = work_.crossed.empty() ? 0.0 : left_level(work_.crossed.front());
        for (const Crossed& c : work_.crossed) {
            const PreparedElement& e = element(c.instance);
            const SlabbedProfile& profile = surface_.profiles()[e.profile];
            out.push_back({x, z, c.low, z, kGround, kGround});
            x = c.low;
            const std::size_t count = profile.facets.size();
            for (std::size_t k = 0; k < count; ++k) {
                const ProfileFacet& facet = profile.facets[c.turned ? count - 1 - k : k];
                add_facet(c, e, profile, facet, x, z);
            }
            const double level = right_level(c);
            if (std::abs(level - z) > 1e-9 * surface_.pattern().depth) out.push_back({x, z, x, level, c.instance, kWall});
            z = level;
        }
        out.push_back({x, z, 4.0 * axes.half_across + 1e-9, z, kGround, kGround});
    }

  private:
    void add_facet(const Crossed& c, const PreparedElement& e, const SlabbedProfile& profile, const ProfileFacet& facet, double& x, double& z) {
        const double b0 = profile.lines[facet.from] * c.width, b1 = profile.lines[facet.to] * c.width;
        double z0 = e.level + c.height * facet.h0, z1 = e.level + c.height * facet.h1, x1 = c.at + b1;
        if (c.turned) std::swap(z0, z1), x1 = c.at - b0;
        if (std::abs(z0 - z) > 1e-9 * surface_.pattern().depth) work_.segments.push_back({x, z, x, z0, c.instance, kWall});
        work_.segments.push_back({x, z0, x1, z1, c.instance, facet.facet});
        x = x1, z = z1;
    }

    const GroovedSurface& surface_;
    const Gathered& gathered_;
    double tolerance_;
    LineSampling& work_;
};

// [2008] 5.2: rays that move by `slope` per fall; those that move to larger offsets pass the segments in order.
template <typename Set>
void find_reached(std::vector<Segment>& segments, double slope, double top, const Set& set) {
    const bool forward = slope >= 0.0;
    double farthest = -1e300;
    const auto project = [&](double x, double z) { return (forward ? 1.0 : -1.0) * (x - slope * (top - z)); };
    for (std::size_t k = 0; k < segments.size(); ++k) {
        Segment& segment = segments[forward ? k : segments.size() - 1 - k];
        double near = project(segment.x0, segment.z0), far = project(segment.x1, segment.z1);
        if (!forward) std::swap(near, far);
        double from = 1.0;
        if (far > near && far > farthest) from = farthest > near ? (farthest - near) / (far - near) : 0.0;
        farthest = std::max(farthest, far);
        forward ? set(segment, from, 1.0) : set(segment, 0.0, 1.0 - from);
    }
}

void fill_table(const Footprint& footprint, const Axes& axes, OffsetTable& table) {
    const auto& p = footprint.corners;
    table.entries.clear();
    for (const Vec2 corner : p) table.entries.push_back({dot(corner - axes.origin, axes.n), 0.0, 0.0});
    std::sort(table.entries.begin(), table.entries.end(), [](const auto& a, const auto& b) { return a.offset < b.offset; });
    const auto chord = [&](double offset) {
        double low = 1e300, high = -1e300;
        for (std::size_t i = 0; i < p.size(); ++i) {
            const Vec2 a = p[i] - axes.origin, b = p[(i + 1) % p.size()] - axes.origin;
            const double at_a = dot(a, axes.n) - offset, at_b = dot(b, axes.n) - offset;
            if ((at_a < 0.0 && at_b < 0.0) || (at_a > 0.0 && at_b > 0.0)) continue;
            const double s = at_a == at_b ? 0.0 : at_a / (at_a - at_b);
            for (const double along : {dot(lerp(a, b, s), axes.t), at_a == at_b ? dot(b, axes.t) : dot(lerp(a, b, s), axes.t)}) {
                low = std::min(low, along);
                high = std::max(high, along);
            }
        }
        return std::max(0.0, high - low);
    };
    for (auto& entry : table.entries) entry.width = chord(entry.offset);
    for (std::size_t i = 1; i < table.entries.size(); ++i) {
        auto &a = table.entries[i - 1], &b = table.entries[i];
        b.below = a.below + 0.5 * (a.width + b.width) * (b.offset - a.offset);
    }
}

double seen_part(const Segment& s, double slope, double top, double from, double to, const OffsetTable& table) {
    const double low = s.x0 - slope * (top - s.z0), high = s.x1 - slope * (top - s.z1);
    return table.below(low + (high - low) * to) - table.below(low + (high - low) * from);
}

// Middle of the footprint and slope of the view along the grooves, and what of an offset the footprint holds.
struct Along {
    double middle, slope, top;
    double across, low, high;  // slope of the view across, and the footprint's extent
};

// The middle of what is seen of a segment, from 0 to 1 along it.
double middle_seen(const Segment& s, const Along& along) {
    const double first = s.x0 - along.across * (along.top - s.z0), last = s.x1 - along.across * (along.top - s.z1);
    if (!(last > first)) return 0.5 * (s.seen0 + s.seen1);
    const double low = std::max(s.seen0, (along.low - first) / (last - first)), high = std::min(s.seen1, (along.high - first) / (last - first));
    return 0.5 * (low + high);
}

void add_share(const Segment& s, const Gathered& gathered, const Axes& axes, const Along& along, double seen, double lit, std::vector<Share>& out) {
    Share share;
    share.element = s.instance == kGround ? kGround : gathered.instances[s.instance].element;
    share.facet = s.facet;
    const double run = s.x1 - s.x0, rise = s.z1 - s.z0, scale = 1.0 / std::sqrt(run * run + rise * rise);
    share.normal = {-axes.n.x * rise * scale, -axes.n.y * rise * scale, run * scale};
    share.seen = seen;
    share.lit = lit;
    const double middle = middle_seen(s, along), x = s.x0 + run * middle, z = s.z0 + rise * middle;
    const Vec2 at = axes.origin + axes.n * x + axes.t * (along.middle + along.slope * (along.top - z));
    share.place = {at.x, at.y, z};
    out.push_back(share);
}

}  // namespace

double OffsetTable::below(double offset) const {
    if (offset <= entries.front().offset) return 0.0;
    for (std::size_t i = 1; i < entries.size(); ++i) {
        const Entry &a = entries[i - 1], &b = entries[i];
        if (offset >= b.offset) continue;
        const double s = offset - a.offset, rise = (b.width - a.width) / (b.offset - a.offset);
        return a.below + s * (a.width + 0.5 * rise * s);
    }
    return entries.back().below;
}

bool sample_lines(const GroovedSurface& surface, const Gathered& gathered, const Footprint& footprint, const Slopes& slopes, double tolerance,
                  double whole, LineSampling& work, std::vector<Share>& out) {
    if (!is_inside_map(surface, gathered.region)) return false;
    Crosser crosser(surface, gathered, tolerance, work);
    if (!crosser.cross_all()) return false;
    crosser.build_segments();
    const Axes& axes = crosser.axes;
    const double view = dot(slopes.view, axes.n), light = dot(slopes.light, axes.n), top = surface.top();
    find_reached(work.segments, view, top, [](Segment& s, double from, double to) { s.seen0 = from, s.seen1 = to; });
    if (slopes.lit) find_reached(work.segments, light, top, [](Segment& s, double from, double to) { s.lit0 = from, s.lit1 = to; });
    fill_table(footprint, axes, work.table);
    const Along along{dot(middle_of(footprint) - axes.origin, axes.t), dot(slopes.view, axes.t), top,
                      view, work.table.entries.front().offset, work.table.entries.back().offset};
    for (const Segment& s : work.segments) {
        if (s.seen0 >= s.seen1) continue;
        const double seen = seen_part(s, view, top, s.seen0, s.seen1, work.table) / whole;
        if (!(seen > 0.0)) continue;
        const double from = std::max(s.seen0, s.lit0), to = std::min(s.seen1, s.lit1);
        add_share(s, gathered, axes, along, seen, from < to ? seen_part(s, view, top, from, to, work.table) / whole : 0.0, out);
    }
    return true;
}

}  // namespace burin::reference
