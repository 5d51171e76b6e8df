// The mean height of one texel: one plane, a few lines, or what the truth says at every sample.
#include "rasterize_internal.hpp"

#include <algorithm>
#include <cmath>

namespace burin::rasterizing {

namespace {

// The rules of find_form for one end, for all points within `r` of p: `absent` where they keep the element from acting,
// `inside` where they leave b' = b. `straight`: the element goes on beyond the end as it came.
Nearness end_says(const PreparedEnd& end, Vec2 p, double offset, double reach, bool straight, double r) {
    const double beyond = dot(p - end.vertex, end.outward), inwards = dot(p - end.vertex, end.clip_inward);
    const auto judge = [](bool absent, bool inside) {
        return absent ? Nearness::absent : inside ? Nearness::inside : Nearness::partly;
    };
    if (end.priority == Priority::none) return judge(beyond > r, beyond < -r);
    if (end.priority == Priority::both) {
        if (end.end == EndShape::clip) return judge(inwards < -r, inwards > r);
        const bool no_hip = straight && end.end == EndShape::hip && beyond + r < std::abs(offset) - r;
        return judge(beyond > reach + r, beyond < -r || no_hip);
    }
    const Nearness inner = judge(beyond > r, beyond < -r);
    const Nearness outer = judge(inwards < -r, inwards > r && (beyond < -r || (straight && end.corner == CornerShape::mitre)));
    if (std::abs(offset) > r) return (end.priority == Priority::left) == (offset < 0.0) ? outer : inner;
    return inner == outer ? inner : Nearness::partly;
}

}  // namespace

// The second derivative of the offset along the path, -k / (1 - k b) with k the curvature; false where the curve is
// tighter than a texel's radius over `most`.
bool Rasterizer::find_bend(const PreparedElement& e, const Foot& foot, double most, double& bend) const {
    const Vec2 d = e.edge + e.bend * foot.parameter;
    const double l = length(d), k = l > 0.0 ? cross(d, e.bend) / (2.0 * l * l * l) : 1e300;
    const double inside = 1.0 - k * foot.offset;
    if (!(inside > 0.0) || std::abs(k) * radius_ > most * inside) return false;
    bend = -k / inside;
    return true;
}

// With b' = b over a whole block of texels, or one texel: which facets it meets. A curve bends the plane; its mean over one
// texel is known.
Cover Rasterizer::cover_by_offset(const PreparedElement& e, const Foot& foot, double ground, int side,
                                  Plane& plane) const {
    const PreparedProfile& profile = truth_.profiles[e.profile];
    const double width = e.width0, height = e.height0;
    const Vec2 t = truth::tangent_on(e, foot.parameter), n = normal_of(t);
    double reach = 0.5 * side * (std::abs(n.x) * texel_.x + std::abs(n.y) * texel_.y), bend = 0.0;
    if (e.kind == ElementKind::quadratic) {
        if (side > 1 || !find_bend(e, foot, 0.1, bend)) return Cover::mixed;
        reach += 0.6 * std::abs(bend) * radius_ * radius_;
    }
    const double low = (foot.offset - reach) / width, high = (foot.offset + reach) / width;
    if (high < profile.low || low > profile.high) return Cover::absent;
    if (e.step && std::abs(foot.offset) <= reach) return Cover::mixed;
    const double level = foot.offset < 0.0 ? e.left_level : e.right_level;
    if (std::abs(ground - level) > truth_.level_tolerance) return Cover::absent;
    for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
        if (low < profile.points[i].b || high > profile.points[i + 1].b) continue;
        const double slope = height * profile.slope[i] / width;
        const double h =
            height * (profile.points[i].h + profile.slope[i] * (foot.offset / width - profile.points[i].b));
        const double correction = 0.5 * slope * bend * (t.x * t.x * spread_.x + t.y * t.y * spread_.y);
        if (correction != 0.0 && !(std::abs(correction * bend) * radius_ < tolerance_)) return Cover::mixed;
        plane.middle = e.level + h + correction;
        plane.low = e.level + h - std::abs(slope) * reach;
        plane.high = e.level + h + std::abs(slope) * reach;
        plane.internal = (profile.internal_mask >> i) & 1u;
        plane.slope = n * slope;
        return Cover::plane;
    }
    return Cover::mixed;
}

// A curve's parameter for the feet within `radius` of the foot's point, or -1 where they may lie on two arcs of it: a
// point nearer to the curve than its centres of curvature has one nearest point.
double Rasterizer::guess_of(const PreparedElement& e, const Foot& foot, double radius) const {
    constexpr double kTame = 0.8;
    if (e.kind == ElementKind::line) return -1.0;
    const double bow = bows_[static_cast<std::size_t>(&e - truth_.elements.data())];
    return bow * (std::abs(foot.offset) + radius) < kTame ? foot.parameter : -1.0;
}

// From a guess by Newton's steps: of (B(u) - p) . B'(u) = 0, as find_foot.
Foot Rasterizer::foot_of(const Entry& entry, Vec2 p) const {
    const PreparedElement& e = *entry.element;
    // Beyond an end the nearest point may be one of its tangent.
    const auto beyond = [&](const PreparedEnd& end) { return dot(p - end.vertex, end.outward) >= 0.0; };
    if (entry.guess < 0.0 || beyond(e.ends[0]) || beyond(e.ends[1])) return truth::find_foot(e, p);
    const Vec2 c = e.p0 - p;
    const double k0 = dot(c, e.edge), k1 = dot(c, e.bend) + 2.0 * dot(e.edge, e.edge), k2 = 3.0 * dot(e.edge, e.bend),
                 k3 = dot(e.bend, e.bend);
    double u = entry.guess;
    for (int i = 0; i < 8; ++i) {
        const double slope = (3.0 * k3 * u + 2.0 * k2) * u + k1, step = (((k3 * u + k2) * u + k1) * u + k0) / slope;
        if (!(slope > 0.0)) break;
        u -= step;
        if (!(u > 0.0 && u < 1.0)) break;
        // The next step would be the square of this one.
        if (std::abs(step) < 1e-8) return {dot(p - truth::point_on(e, u), normal_of(truth::tangent_on(e, u))), u};
    }
    return truth::find_foot(e, p);
}

// Whether the offset alone tells the height wherever the ends leave it to act.
bool Rasterizer::is_plain(const PreparedElement& e) const {
    return !e.scaled && truth_.profiles[e.profile].height_field && e.width0 > 0.0;
}

Nearness Rasterizer::nearness_of(const Entry& entry, Vec2 centre, double radius, Foot& foot) const {
    const PreparedElement& e = *entry.element;
    const Vec2 p = centre - entry.shift;
    const double r = radius * (1.0 + 1e-9);
    if (entry.inside && e.kind == ElementKind::line) {
        foot = {dot(p - e.p0, normal_of(e.tangent)), 0.5};
        return std::abs(foot.offset) > e.reach + r ? Nearness::absent : Nearness::inside;
    }
    if (!near_box(e.box, p, r)) return Nearness::absent;
    foot = foot_of(entry, p);
    if (std::abs(foot.offset) > e.reach + r) return Nearness::absent;
    if (entry.inside) return Nearness::inside;
    Nearness all = is_plain(e) ? Nearness::inside : Nearness::partly;
    for (const PreparedEnd& end : e.ends) {
        const Nearness one = end_says(end, p, foot.offset, e.reach, e.kind == ElementKind::line, r);
        if (one == Nearness::absent) return one;
        if (one == Nearness::partly) all = one;
    }
    return all;
}

// min(max(ground, adds), cuts) where one plane rules over all of it; false where planes cross in it.
bool Rasterizer::merge_planes(const std::vector<Plane>& planes, double ground, Plane& ruler) const {
    Plane base{ground, ground, ground, false, {}};
    for (const Plane& plane : planes) {  // highest base
        if (plane.low >= base.high)
            base = plane;
        else if (plane.high > base.low)
            return false;
    }
    Plane cut{1e300, 1e300, 1e300, true, {}};
    for (const Plane& plane : planes) {  // lowest cut
        if (!plane.internal) continue;
        if (plane.high <= cut.low)
            cut = plane;
        else if (plane.low < cut.high)
            return false;
    }
    const bool same = cut.middle == base.middle && cut.low == base.low && cut.slope == base.slope;
    if (cut.low < base.high && cut.high > base.low && !same) return false;
    ruler = cut.middle < base.middle ? cut : base;
    return true;
}

// What an element does to the samples of a texel, asked of the truth: raises their bases, lowers their cuts.
void Rasterizer::sample_entry(const Entry& entry, Vec2 centre, const TexelRun& run, Samples& samples) const {
    const PreparedElement& e = *entry.element;
    const PreparedProfile& profile = truth_.profiles[e.profile];
    Local local;
    for (std::size_t k = 0; k < around_.size(); ++k) {
        const Vec2 p = centre + around_[k] - entry.shift;
        if (!near_box(e.box, p, 0.0) || !truth::acts_at(truth_, e, p, foot_of(entry, p), run.level_of(k), local)) continue;
        const double b = local.offset / local.width;
        for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
            if (!(profile.points[i].b <= b && b < profile.points[i + 1].b)) continue;
            const double z =
                e.level + local.height * (profile.points[i].h + profile.slope[i] * (b - profile.points[i].b));
            samples.add(k, z, (profile.internal_mask >> i) & 1u);
            break;
        }
    }
}

// False where the element's rules need more than its offset and its position to both ends.
bool Rasterizer::make_strip(const PreparedElement& e, Vec2 p, const Foot& foot, bool inside, Strip& strip) const {
    constexpr double kGentle = 0.02;  // a texel's radius over the curve's: the third derivative shows nothing
    if (e.function != nullptr) return false;
    if (!truth_.profiles[e.profile].height_field || !(std::min(e.width0, e.width0 + e.width_rise) > 0.0)) return false;
    double bend = 0.0;
    if (e.kind == ElementKind::quadratic && (e.scaled || !inside || !find_bend(e, foot, kGentle, bend))) return false;
    const Vec2 t = truth::tangent_on(e, foot.parameter);
    const double parameter = e.length > 0.0 ? dot(p - e.p0, t) / e.length : 0.0;
    strip = {&e, foot.offset, parameter, normal_of(t), bend, {}, 0};
    if (inside) return true;
    for (const PreparedEnd& end : e.ends) {
        const bool both = end.priority == Priority::both, none = end.priority == Priority::none;
        if (both && end.end != EndShape::clip && end.end != EndShape::hip) return false;
        if (!both && !none && end.corner != CornerShape::mitre) return false;
        strip.ends[strip.end_count++] = {&end, dot(p - end.vertex, end.outward), dot(p - end.vertex, end.clip_inward)};
    }
    return true;
}

// The rules of find_form for a point `d` from the texel's centre; a hip changes the offset. False where the line does not
// act.
bool follow_ends(const Strip& strip, Vec2 d, double& offset) {
    const double side = offset < 0.0 ? -1.0 : 1.0;
    double farthest = std::abs(offset);
    for (int k = 0; k < strip.end_count; ++k) {
        const PreparedEnd& end = *strip.ends[k].end;
        const double along = strip.ends[k].along + dot(end.outward, d);
        const double inwards = strip.ends[k].across_clip + dot(end.clip_inward, d);
        const bool both = end.priority == Priority::both;
        const bool clips = both ? end.end == EndShape::clip : (end.priority == Priority::left) == (side < 0.0);
        if (end.priority == Priority::none || (!both && !clips)) {
            if (along > 0.0) return false;
        } else if (clips) {
            if (inwards < 0.0) return false;
        } else if (along > farthest) {
            farthest = along;
            offset = side * along;
        }
    }
    return true;
}

// The same for a strip, without asking.
void Rasterizer::sample_strip(const Strip& strip, const TexelRun& run, Samples& samples) const {
    const PreparedElement& e = *strip.element;
    const PreparedProfile& profile = truth_.profiles[e.profile];
    const double half = 0.5 * (samples_ - 1) / samples_;
    const Vec2 tangent{strip.normal.y, -strip.normal.x};
    double per_width = 1.0 / e.width0, height = e.height0;
    const bool steady = strip.end_count == 0 && !e.scaled && strip.bend == 0.0;
    const double reach = half * (std::abs(strip.normal.x) * texel_.x + std::abs(strip.normal.y) * texel_.y);
    const double lowest = (strip.offset - reach) * per_width - 1e-12, on_line = 1e-12 * truth_.size.x;
    const ProfilePoint* const points = profile.points.data();
    const std::size_t last = profile.points.size() - 2;  // facet
    std::size_t first = 0;
    while (steady && first < last && points[first + 1].b <= lowest) ++first;
    bool left = true, right = true;  // whether the ground is that of a side
    const auto find_sides = [&](double ground) {
        left = std::abs(ground - e.left_level) <= truth_.level_tolerance;
        right = std::abs(ground - e.right_level) <= truth_.level_tolerance;
    };
    find_sides(run.level);
    for (std::size_t k = 0; k < around_.size(); ++k) {
        const double along = dot(tangent, around_[k]);
        double offset = strip.offset + dot(strip.normal, around_[k]) + 0.5 * strip.bend * along * along;
        if (e.scaled) {
            const double u = std::clamp(strip.parameter + along / e.length, 0.0, 1.0);
            per_width = 1.0 / (e.width0 + e.width_rise * u);
            height = e.height0 + e.height_rise * u;
        }
        if (!follow_ends(strip, around_[k], offset)) continue;
        const double b = offset * per_width;
        if (b < profile.low || b >= profile.high) continue;
        if (!run.levels.empty()) find_sides(run.levels[k]);
        if (std::abs(offset) <= on_line ? !left && !right : !(offset < 0.0 ? left : right)) continue;
        std::size_t i = first;
        while (i < last && points[i + 1].b <= b) ++i;
        const double z = e.level + height * (points[i].h + profile.slope[i] * (b - points[i].b));
        samples.add(k, z, (profile.internal_mask >> i) & 1u);
    }
}

double Rasterizer::mean_of_samples(Vec2 centre, const std::vector<Acting>& acting, const TexelRun& run) const {
    thread_local Samples samples;
    samples.bases.clear();
    for (std::size_t k = 0; k < around_.size(); ++k) samples.bases.push_back(run.level_of(k));
    samples.cuts.assign(around_.size(), 1e300);
    Strip strip;
    for (const Acting& a : acting)
        if (make_strip(*a.entry.element, centre - a.entry.shift, a.foot, a.inside, strip))
            sample_strip(strip, run, samples);
        else
            sample_entry(a.entry, centre, run, samples);
    double sum = 0.0;
    for (std::size_t k = 0; k < around_.size(); ++k) sum += seen(std::min(samples.bases[k], samples.cuts[k]));
    return sum / static_cast<double>(around_.size());
}

// Where a profile is no height field.
double Rasterizer::mean_of_surface(Vec2 centre, const std::vector<Acting>& acting, const TexelRun& run) const {
    std::vector<std::uint32_t> candidates;
    for (const Acting& a : acting)
        candidates.push_back(static_cast<std::uint32_t>(a.entry.element - truth_.elements.data()));
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    double sum = 0.0;
    for (std::size_t k = 0; k < around_.size(); ++k)
        sum += seen(owner_.surface_at(centre + around_[k], candidates, run.level_of(k)).height);
    return sum / static_cast<double>(around_.size());
}

float Rasterizer::draw_texel(int x, int y, const std::vector<Entry>& bucket, const TexelRun& run) const {
    const bool uniform = run.levels.empty();
    const Vec2 centre = texel_centre(x, y);
    thread_local std::vector<Acting> acting;
    thread_local std::vector<Plane> planes;
    acting.clear();
    planes.clear();
    bool mixed = !uniform, height_field = true;
    for (const Entry& entry : bucket) {
        Acting a{entry, {}, false};
        Plane plane;
        const Nearness nearness = nearness_of(entry, centre, radius_, a.foot);
        if (nearness == Nearness::absent) continue;
        a.inside = nearness == Nearness::inside;
        const Cover cover =
            uniform && a.inside ? cover_by_offset(*entry.element, a.foot, run.level, 1, plane) : Cover::mixed;
        if (cover == Cover::absent) continue;
        acting.push_back(a);
        planes.push_back(plane);
        mixed = mixed || cover == Cover::mixed;
        height_field = height_field && truth_.profiles[entry.element->profile].height_field;
    }
    Plane ruler;
    if (!mixed && merge_planes(planes, run.level, ruler)) return value_of(ruler.middle);
    return value_of(height_field ? mean_of_samples(centre, acting, run) : mean_of_surface(centre, acting, run));
}

}  // namespace burin::rasterizing
