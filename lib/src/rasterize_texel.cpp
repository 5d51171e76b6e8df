// The mean height of one texel: one plane, a few lines, or what the truth says at every sample.
#include "rasterize_internal.hpp"

#include <algorithm>
#include <cmath>

namespace burin::rasterizing {

// With b' = b over the whole texel: which facets it meets, and how much a curve bends the plane.
Cover Rasterizer::cover_by_offset(const PreparedElement& e, Vec2 p, const Foot& foot, double ground,
                                  Plane& plane) const {
    const PreparedProfile& profile = truth_.profiles[e.profile];
    const double width = e.width0, height = e.height0;
    const Vec2 t = truth::tangent_on(e, foot.parameter), n = normal_of(t);
    double reach = 0.5 * (std::abs(n.x) * texel_.x + std::abs(n.y) * texel_.y), bend = 0.0;
    if (e.kind == ElementKind::quadratic) {
        // Second derivative of b along t: -k / (1 - k b), k the curvature.
        const Vec2 d = e.edge + e.bend * foot.parameter;
        const double l = length(d), k = l > 0.0 ? cross(d, e.bend) / (2.0 * l * l * l) : 1e300;
        const double inside = 1.0 - k * foot.offset;
        if (!(inside > 0.0) || std::abs(k) * radius_ > 0.1 * inside) return Cover::mixed;
        bend = -k / inside;
        reach += 0.6 * std::abs(bend) * radius_ * radius_;
        static_cast<void>(p);
    }
    const double low = (foot.offset - reach) / width, high = (foot.offset + reach) / width;
    if (high < profile.low || low > profile.high) return Cover::absent;
    if (e.step && std::abs(foot.offset) <= reach) return Cover::mixed;
    const double side = foot.offset < 0.0 ? e.left_level : e.right_level;
    if (std::abs(ground - side) > truth_.level_tolerance) return Cover::absent;
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
        return Cover::plane;
    }
    return Cover::mixed;
}

Nearness Rasterizer::nearness_of(const Entry& entry, Vec2 centre, Foot& foot) const {
    const PreparedElement& e = *entry.element;
    const Vec2 p = centre - entry.shift;
    const double r = radius_ * (1.0 + 1e-9);
    if (entry.inside && e.kind == ElementKind::line) {
        foot = {dot(p - e.p0, normal_of(e.tangent)), 0.5};
        return std::abs(foot.offset) > e.reach + r ? Nearness::absent : Nearness::inside;
    }
    if (!near_box(e.box, p, r)) return Nearness::absent;
    foot = truth::find_foot(e, p);
    if (std::abs(foot.offset) > e.reach + r) return Nearness::absent;
    if (entry.inside) return Nearness::inside;
    for (const PreparedEnd& end : e.ends) {
        const double a = dot(p - end.vertex, end.outward), c = dot(p - end.vertex, end.clip_inward);
        const bool stops = end.priority == Priority::none;
        const bool caps = end.priority == Priority::both && end.end != EndShape::clip;
        const bool clips = end.priority == Priority::both && end.end == EndShape::clip;
        if (stops && a > r) return Nearness::absent;
        if (clips && c < -r) return Nearness::absent;
        if (caps && a > e.reach + r) return Nearness::absent;
    }
    return acts_by_offset(e, p, r) ? Nearness::inside : Nearness::partly;
}

// min(max(ground, adds), cuts) where one plane rules over the whole texel; false where planes cross in it.
bool Rasterizer::merge_planes(const std::vector<Plane>& planes, double ground, double& mean) const {
    Plane base{ground, ground, ground, false};
    for (const Plane& plane : planes) {  // highest base
        if (plane.low >= base.high)
            base = plane;
        else if (plane.high > base.low)
            return false;
    }
    Plane cut{1e300, 1e300, 1e300, true};
    for (const Plane& plane : planes) {  // lowest cut
        if (!plane.internal) continue;
        if (plane.high <= cut.low)
            cut = plane;
        else if (plane.low < cut.high)
            return false;
    }
    if (cut.low < base.high && cut.high > base.low && !(cut.middle == base.middle && cut.low == base.low))
        return false;
    mean = std::min(base.middle, cut.middle);
    return true;
}

double Rasterizer::sample(const std::vector<Entry>& entries, Vec2 p, double ground) const {
    double base = ground, cut = 1e300;
    Local local;
    for (const Entry& entry : entries) {
        const PreparedElement& e = *entry.element;
        if (!near_box(e.box, p - entry.shift, 0.0) ||
            !truth::acts_at(truth_, e, p - entry.shift, ground, local))
            continue;
        const PreparedProfile& profile = truth_.profiles[e.profile];
        const double b = local.offset / local.width;
        for (std::size_t i = 0; i + 1 < profile.points.size(); ++i) {
            if (!(profile.points[i].b <= b && b < profile.points[i + 1].b)) continue;
            const double z =
                e.level + local.height * (profile.points[i].h + profile.slope[i] * (b - profile.points[i].b));
            base = std::max(base, z);
            if ((profile.internal_mask >> i) & 1u) cut = std::min(cut, z);
            break;
        }
    }
    return std::min(base, cut);
}

// False where the element's rules need more than its offset and its position to both ends.
bool Rasterizer::make_strip(const PreparedElement& e, Vec2 p, const Foot& foot, bool inside, Strip& strip) const {
    if (e.kind != ElementKind::line || e.scaled || !truth_.profiles[e.profile].height_field || !(e.width0 > 0.0)) return false;
    strip = {&e, foot.offset, normal_of(e.tangent), {}, 0};
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

// What a strip does to the samples of a texel: raises their bases, lowers their cuts.
void Rasterizer::sample_strip(const Strip& strip, const TexelRun& run, std::vector<double>& bases,
                              std::vector<double>& cuts) const {
    const PreparedElement& e = *strip.element;
    const PreparedProfile& profile = truth_.profiles[e.profile];
    const double half = 0.5 * (samples_ - 1) / samples_, per_width = 1.0 / e.width0;
    const double reach = half * (std::abs(strip.normal.x) * texel_.x + std::abs(strip.normal.y) * texel_.y);
    const double lowest = (strip.offset - reach) * per_width - 1e-12, on_line = 1e-12 * truth_.size.x;
    const ProfilePoint* const points = profile.points.data();
    const std::size_t last = profile.points.size() - 2;  // facet
    std::size_t first = 0;
    while (strip.end_count == 0 && first < last && points[first + 1].b <= lowest) ++first;
    bool left = true, right = true;  // whether the ground is that of a side
    const auto find_sides = [&](double ground) {
        left = std::abs(ground - e.left_level) <= truth_.level_tolerance;
        right = std::abs(ground - e.right_level) <= truth_.level_tolerance;
    };
    find_sides(run.level);
    for (std::size_t k = 0; k < bases.size(); ++k) {
        double offset = strip.offset + dot(strip.normal, around_[k]);
        if (!follow_ends(strip, around_[k], offset)) continue;
        const double b = offset * per_width;
        if (b < profile.low || b >= profile.high) continue;
        if (!run.levels.empty()) find_sides(run.levels[k]);
        if (std::abs(offset) <= on_line ? !left && !right : !(offset < 0.0 ? left : right)) continue;
        std::size_t i = first;
        while (i < last && points[i + 1].b <= b) ++i;
        const double z = e.level + e.height0 * (points[i].h + profile.slope[i] * (b - points[i].b));
        bases[k] = std::max(bases[k], z);
        if ((profile.internal_mask >> i) & 1u) cuts[k] = std::min(cuts[k], z);
    }
}

double Rasterizer::mean_of_strips(const std::vector<Strip>& strips, const TexelRun& run) const {
    thread_local std::vector<double> bases, cuts;
    const std::size_t count = static_cast<std::size_t>(samples_) * static_cast<std::size_t>(samples_);
    if (run.levels.empty())
        bases.assign(count, run.level);
    else
        bases = run.levels;
    cuts.assign(count, 1e300);
    for (const Strip& strip : strips) sample_strip(strip, run, bases, cuts);
    double sum = 0.0;
    for (std::size_t k = 0; k < count; ++k) sum += seen(std::min(bases[k], cuts[k]));
    return sum / static_cast<double>(count);
}

double Rasterizer::mean_of_samples(int x, int y, const std::vector<Entry>& entries, const TexelRun& run,
                                   bool height_field) const {
    std::vector<std::uint32_t> candidates;
    if (!height_field)
        for (const Entry& entry : entries)
            candidates.push_back(static_cast<std::uint32_t>(entry.element - truth_.elements.data()));
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    const std::size_t n = static_cast<std::size_t>(samples_);
    double sum = 0.0;
    for (std::size_t k = 0; k < n * n; ++k) {
        const double ground = run.levels.empty() ? run.level : run.levels[k];
        const Vec2 p{(x + (static_cast<double>(k % n) + 0.5) / samples_) * texel_.x,
                     (y + (static_cast<double>(k / n) + 0.5) / samples_) * texel_.y};
        sum += seen(height_field ? sample(entries, p, ground) : owner_.surface_at(p, candidates, ground).height);
    }
    return sum / static_cast<double>(n * n);
}

float Rasterizer::draw_texel(int x, int y, const std::vector<Entry>& bucket, const TexelRun& run) const {
    const bool uniform = run.levels.empty();
    const Vec2 centre = texel_centre(x, y);
    thread_local std::vector<Entry> entries;  // those that act in this texel
    thread_local std::vector<Plane> planes;
    thread_local std::vector<Strip> strips;
    entries.clear();
    planes.clear();
    strips.clear();
    bool mixed = !uniform, height_field = true;
    for (const Entry& entry : bucket) {
        const PreparedElement& e = *entry.element;
        Foot foot;
        Plane plane;
        const Nearness nearness = nearness_of(entry, centre, foot);
        if (nearness == Nearness::absent) continue;
        const bool inside = nearness == Nearness::inside;
        const Cover cover =
            uniform && inside ? cover_by_offset(e, centre - entry.shift, foot, run.level, plane) : Cover::mixed;
        if (cover == Cover::absent) continue;
        entries.push_back(entry);
        planes.push_back(plane);
        Strip strip;
        if (make_strip(e, centre - entry.shift, foot, inside, strip)) strips.push_back(strip);
        mixed = mixed || cover == Cover::mixed;
        height_field = height_field && truth_.profiles[e.profile].height_field;
    }
    double mean = 0.0;
    if (!mixed && merge_planes(planes, run.level, mean)) return value_of(mean);
    if (strips.size() == entries.size()) return value_of(mean_of_strips(strips, run));
    return value_of(mean_of_samples(x, y, entries, run, height_field));
}

}  // namespace burin::rasterizing
