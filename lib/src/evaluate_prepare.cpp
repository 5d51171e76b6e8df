// Turns a ResolvedPattern into prepared elements: tangents, ends, levels, boxes.
#include "evaluate_prepare.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace burin {
namespace {

void include(Box& box, Vec2 p) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
}

PreparedProfile prepare_profile(const ResolvedProfile& profile) {
    assert(profile.points.size() >= 2);
    PreparedProfile out;
    out.points = profile.points;
    out.internal_mask = profile.internal_mask;
    out.low = out.high = profile.points.front().b;
    for (std::size_t i = 0; i < profile.points.size(); ++i) {
        out.low = std::min(out.low, profile.points[i].b);
        out.high = std::max(out.high, profile.points[i].b);
        if (i == 0) continue;
        const ProfilePoint a = profile.points[i - 1], b = profile.points[i];
        out.height_field = out.height_field && b.b >= a.b;
        out.slope.push_back(b.b == a.b ? 0.0 : (b.h - a.h) / (b.b - a.b));
    }
    return out;
}

PreparedEnd prepare_end(const ElementEnd& end, Vec2 vertex, Vec2 along, bool at_start) {
    PreparedEnd out;
    out.vertex = vertex;
    out.outward = at_start ? -along : along;
    out.priority = end.priority;
    // A joint and an end on another path's line act alike.
    if (end.priority == Priority::both)
        out.end = end.clips_both() ? EndShape::clip : static_cast<EndShape>(end.shape);
    else
        out.corner = static_cast<CornerShape>(end.shape);
    const Vec2 clip{std::cos(end.clip_angle), std::sin(end.clip_angle)};
    const double lean = cross(clip, -out.outward);
    // A clip line along the tangent has no side; it acts as the normal of the end.
    out.clip_inward = std::abs(lean) < 1e-12 ? -out.outward : normal_of(clip) * (lean > 0 ? 1.0 : -1.0);
    const double across = dot(clip, normal_of(along));
    out.bevel = std::abs(across) < 1e-12 ? normal_of(along) : clip * (1.0 / across);
    return out;
}

// How far beyond an end the element can act, for |b'| up to reach.
double overhang_of(const PreparedEnd& end, double reach) {
    if (end.priority == Priority::none) return 0.0;
    const bool clipped =
        end.priority == Priority::both ? end.end == EndShape::clip : end.corner == CornerShape::mitre;
    if (!clipped) return reach;
    // On the clip line at b = +-reach: a = reach * |clip . outward| / |clip . n|.
    const double along = std::abs(dot(end.clip_inward, normal_of(end.outward)));
    const double across = std::abs(dot(end.clip_inward, end.outward));
    return across < 1e-12 ? 0.0 : reach * along / across;
}

Box box_of(const PreparedElement& e, const Element& source) {
    Box box;
    include(box, e.p0);
    include(box, e.p2);
    if (e.kind == ElementKind::quadratic) include(box, source.p1);
    box.low = box.low - Vec2{e.reach, e.reach};
    box.high = box.high + Vec2{e.reach, e.reach};
    for (const PreparedEnd& end : e.ends) {
        const Vec2 tip = end.vertex + end.outward * overhang_of(end, e.reach);
        const Vec2 side = normal_of(end.outward) * e.reach;
        include(box, tip + side);
        include(box, tip - side);
    }
    return box;
}

void prepare_function(const ResolvedElement& resolved, const std::vector<ScaleFunction>& functions, PreparedElement& e) {
    if (resolved.function == kNoFunction) return;
    const Element& source = resolved.element;
    e.function = &functions[resolved.function];
    e.argument0 = source.argument0;
    e.argument_rise = source.argument1 - source.argument0;
    e.run = truth::run_to(e, 1.0).length;
    e.scaled = true;
    truth::bound_factors(e);
}

PreparedElement prepare_element(const ResolvedElement& resolved, const Style& style, const PreparedProfile& profile,
                                const std::vector<ScaleFunction>& functions) {
    const Element& source = resolved.element;
    PreparedElement e;
    e.kind = source.kind;
    e.p0 = source.p0;
    e.p2 = source.p2;
    e.tangent = unit(source.p2 - source.p0);
    e.length = length(source.p2 - source.p0);
    e.edge = source.p1 - source.p0;
    e.bend = source.p0 - source.p1 * 2.0 + source.p2;
    e.width0 = source.width0;
    e.width_rise = source.width1 - source.width0;
    e.height0 = source.height0;
    e.height_rise = source.height1 - source.height0;
    e.scaled = e.width_rise != 0.0 || e.height_rise != 0.0;
    prepare_function(resolved, functions, e);
    e.step = style.step;
    e.profile = style.profile;
    e.level = e.left_level = e.right_level = style.level;
    if (style.step) e.right_level += (profile.points.back().h - profile.points.front().h) * source.height0;
    e.reach = std::max(-profile.low, profile.high) * std::max(source.width0, source.width1) * e.width_bound;
    e.ends[0] = prepare_end(resolved.start, e.p0, truth::tangent_on(e, 0.0), true);
    e.ends[1] = prepare_end(resolved.end, e.p2, truth::tangent_on(e, 1.0), false);
    e.box = box_of(e, source);
    return e;
}

void bound_heights(Truth::Prepared& truth) {
    truth.levels = {truth.outer_level};
    truth.lowest = truth.highest = truth.outer_level;
    for (const PreparedElement& e : truth.elements) {
        truth.levels.push_back(e.left_level);
        truth.levels.push_back(e.right_level);
        const double scale = std::max(e.height0, e.height0 + e.height_rise) * e.height_bound;
        for (const ProfilePoint& point : truth.profiles[e.profile].points) {
            truth.lowest = std::min(truth.lowest, e.level + std::min(0.0, scale * point.h));
            truth.highest = std::max(truth.highest, e.level + std::max(0.0, scale * point.h));
        }
    }
    std::sort(truth.levels.begin(), truth.levels.end());
    truth.levels.erase(std::unique(truth.levels.begin(), truth.levels.end()), truth.levels.end());
    truth.lowest = std::min(truth.lowest, truth.levels.front());
    truth.highest = std::max(truth.highest, truth.levels.back());
}

}  // namespace

Truth::Truth(const ResolvedPattern& pattern, const TruthOptions& options)
    : prepared_(std::make_unique<Prepared>()) {
    assert(pattern.size.x > 0 && pattern.size.y > 0 && pattern.depth > 0);
    Prepared& out = *prepared_;
    out.size = pattern.size;
    out.repeat = pattern.wrap == Wrap::repeat;
    out.outer_level = pattern.outer_level;
    out.depth = pattern.depth;
    out.level_tolerance = options.level_tolerance * pattern.depth;
    out.max_tiles = options.max_tiles;
    for (const ResolvedProfile& profile : pattern.profiles) out.profiles.push_back(prepare_profile(profile));
    out.functions = pattern.functions;
    for (const ResolvedElement& element : pattern.elements) {
        assert(element.style < pattern.styles.size());
        const Style& style = pattern.styles[element.style];
        assert(style.profile < pattern.profiles.size());
        if (style.step) out.steps.push_back(static_cast<std::uint32_t>(out.elements.size()));
        out.elements.push_back(prepare_element(element, style, out.profiles[style.profile], out.functions));
    }
    out.all.resize(out.elements.size());
    std::iota(out.all.begin(), out.all.end(), 0u);
    bound_heights(out);
}

Truth::~Truth() = default;
Truth::Truth(Truth&&) noexcept = default;
Truth& Truth::operator=(Truth&&) noexcept = default;

}  // namespace burin
