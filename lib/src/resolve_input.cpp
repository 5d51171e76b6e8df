// Checks of pattern and options, and paths made clean: welded, without elements of length zero, arcs that
// turn little.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "resolve_curve.hpp"
#include "resolve_internal.hpp"

namespace burin::resolving {
namespace {

bool finite(Vec2 p) { return std::isfinite(p.x) && std::isfinite(p.y); }

Error input_error(const std::string& message) { return {ErrorCode::invalid_input, message}; }
Error option_error(const std::string& message) { return {ErrorCode::invalid_argument, message}; }

Status check_options(const ResolveOptions& options) {
    if (!(options.snap >= 0.0 && options.snap <= 0.01))
        return option_error("snap is " + std::to_string(options.snap) + "; allowed is [0, 0.01]");
    if (!(options.smooth_angle >= 0.0 && options.smooth_angle <= 0.5))
        return option_error("smooth_angle is " + std::to_string(options.smooth_angle) +
                            "; allowed is [0, 0.5]");
    if (!(options.mitre_limit >= 1.0 && options.mitre_limit <= 16.0))
        return option_error("mitre_limit is " + std::to_string(options.mitre_limit) + "; allowed is [1, 16]");
    return Done{};
}

Status check_frame(const Pattern& pattern) {
    if (!finite(pattern.size) || pattern.size.x <= 0.0 || pattern.size.y <= 0.0)
        return input_error("pattern size " + position_text(pattern.size) + " must be positive");
    if (!std::isfinite(pattern.depth) || pattern.depth <= 0.0)
        return input_error("pattern depth " + std::to_string(pattern.depth) + " must be positive");
    if (!std::isfinite(pattern.base_offset) || pattern.base_offset < 0.0)
        return input_error("pattern base_offset " + std::to_string(pattern.base_offset) +
                           " must not be negative");
    const double slack = pattern.depth * kLevelTolerance;
    if (!(pattern.outer_level <= highest(pattern) + slack && pattern.outer_level >= lowest(pattern) - slack))
        return input_error("outer level " + std::to_string(pattern.outer_level) + " lies outside the depth");
    if (pattern.materials.empty()) return input_error("pattern has no material; material 0 must exist");
    return Done{};
}

std::string element_text(std::size_t path, std::size_t element, Vec2 p) {
    return "path " + std::to_string(path) + ", element " + std::to_string(element) + " at " +
           position_text(p);
}

bool valid_scale(double scale) { return scale >= 0.0 && scale < 4.0; }

// Tiles from the origin. Elements are cut to half a tile, so that this bounds what one element can become.
constexpr double kFarthest = 64.0;

Status check_element(const Element& e, Vec2 size, std::size_t path, std::size_t index) {
    const std::string where = element_text(path, index, e.p0);
    if (!finite(e.p0) || !finite(e.p2) || (e.kind == ElementKind::quadratic && !finite(e.p1)))
        return input_error(where + " has a point that is not finite");
    for (const Vec2 p : {e.p0, e.kind == ElementKind::quadratic ? e.p1 : e.p0, e.p2})
        if (std::abs(p.x) > kFarthest * size.x || std::abs(p.y) > kFarthest * size.y)
            return input_error(where + " lies more than " + std::to_string(static_cast<int>(kFarthest)) +
                               " tiles away, at " + position_text(p));
    for (const double scale : {e.width0, e.width1, e.height0, e.height1})
        if (!valid_scale(scale))
            return input_error(where + " has scale " + std::to_string(scale) + "; allowed is [0, 4)");
    return Done{};
}

double greatest_height_scale(const Path& path) {
    double scale = 0.0;
    for (const Element& e : path.elements) scale = std::max({scale, e.height0, e.height1});
    return scale;
}

Status check_path(const Work& work, const std::vector<Status>& profile_status, std::size_t index) {
    const Pattern& pattern = work.pattern;
    const Path& path = pattern.paths[index];
    const std::string name = "path " + std::to_string(index);
    if (path.elements.empty()) return input_error(name + " has no element");
    if (path.profile >= pattern.profiles.size())
        return input_error(name + " uses profile " + std::to_string(path.profile) + " of " +
                           std::to_string(pattern.profiles.size()));
    if (path.material >= pattern.materials.size())
        return input_error(name + " uses material " + std::to_string(path.material) + " of " +
                           std::to_string(pattern.materials.size()));
    if (!profile_status[path.profile].ok()) return profile_status[path.profile].error();
    if (path.perturbation != kNoPerturbation && path.perturbation >= pattern.perturbations.size())
        return input_error(name + " uses perturbation " + std::to_string(path.perturbation) + " of " +
                           std::to_string(pattern.perturbations.size()));
    if (!std::isfinite(path.level)) return input_error(name + " has a level that is not finite");
    for (std::size_t i = 0; i < path.elements.size(); ++i) {
        if (const Status status = check_element(path.elements[i], pattern.size, index, i); !status.ok())
            return status;
        if (i > 0 && length(path.elements[i].p0 - path.elements[i - 1].p2) > work.snap)
            return input_error(element_text(index, i, path.elements[i].p0) +
                               " does not start where the one before ends, at " +
                               position_text(path.elements[i - 1].p2));
    }
    if (work.rise[path.profile] != 0.0) {
        const double scale = path.elements.front().height0;
        if (scale <= 0.0) return input_error(name + " is a step path of height scale 0");
        for (std::size_t i = 0; i < path.elements.size(); ++i)
            if (std::abs(path.elements[i].height0 - scale) > 1e-9 ||
                std::abs(path.elements[i].height1 - scale) > 1e-9)
                return input_error(element_text(index, i, path.elements[i].p0) +
                                   " changes the height scale of a step path");
    }
    return work.options.lenient ? Status(Done{}) : check_heights(work, index, greatest_height_scale(path));
}

// Whole tiles between two points that should coincide modulo the tile; zero when clamped.
Vec2 tiles_between(const Work& work, Vec2 from, Vec2 to) {
    if (!work.repeats()) return {0.0, 0.0};
    const Vec2 size = work.pattern.size;
    return {std::round((to.x - from.x) / size.x) * size.x, std::round((to.y - from.y) / size.y) * size.y};
}

// Quadratics that are straight become lines; those that turn by more than 90 degrees become two.
void append_clean(std::vector<Element>& elements, Element e) {
    if (e.kind == ElementKind::quadratic) {
        const Vec2 chord = e.p2 - e.p0, arm = e.p1 - e.p0;
        const double along = dot(arm, chord), area = std::abs(cross(arm, chord));
        if (area <= 1e-9 * dot(chord, chord) && along >= 0.0 && along <= dot(chord, chord))
            e.kind = ElementKind::line;
    }
    if (e.kind == ElementKind::line) {
        e.p1 = lerp(e.p0, e.p2, 0.5);
        elements.push_back(e);
        return;
    }
    if (curve::turning(e) <= 0.5 * kPi) {
        elements.push_back(e);
        return;
    }
    // Where the tangent is parallel to the bisector of both end tangents.
    const Vec2 from = e.p1 - e.p0, to = e.p2 - e.p1;
    const Vec2 middle = unit(from) + unit(to);
    const double change = cross(to - from, middle);
    const double s = change != 0.0 ? std::clamp(-cross(from, middle) / change, 0.01, 0.99) : 0.5;
    elements.push_back(curve::part(e, 0.0, s));
    elements.push_back(curve::part(e, s, 1.0));
}

WorkPath copy_path(const Work& work, std::size_t index) {
    const Path& path = work.pattern.paths[index];
    WorkPath copy;
    copy.source = static_cast<std::uint32_t>(index);
    copy.profile = path.profile;
    copy.material = path.material;
    copy.closed = path.closed;
    copy.step = work.rise[path.profile] != 0.0;
    copy.level = path.level;
    copy.right_level = path.level + work.rise[path.profile] * path.elements.front().height0;
    copy.join = path.join;
    copy.cap[0] = path.start_cap;
    copy.cap[1] = path.end_cap;
    for (const ProfilePoint& p : work.profiles[path.profile].points)
        copy.reach = std::max(copy.reach, std::abs(p.b));
    return copy;
}

// Joins elements bit by bit and drops those shorter than can carry a direction.
Status weld_elements(Work& work, WorkPath& path, std::size_t index) {
    const double shortest =
        std::max(0.01 * work.snap, 1e-9 * std::max(work.pattern.size.x, work.pattern.size.y));
    std::vector<Element> kept;
    for (Element e : work.pattern.paths[index].elements) {
        if (!kept.empty()) e.p0 = kept.back().p2;
        if (length(e.p2 - e.p0) <= shortest &&
            (e.kind == ElementKind::line || length(e.p1 - e.p0) <= shortest))
            ++work.stats.dropped_elements;
        else
            kept.push_back(e);
    }
    if (kept.empty())
        return input_error(path_text(index, work.pattern.paths[index].elements.front().p0) +
                           " has length zero");
    if (path.closed) {
        const Vec2 start = kept.front().p0, end = kept.back().p2;
        const Vec2 tiles = tiles_between(work, start, end);
        if (length(end - (start + tiles)) > std::max(work.snap, shortest))
            return input_error(path_text(index, end) + " is closed but does not end where it starts, at " +
                               position_text(start));
        kept.back().p2 = start + tiles;
    }
    for (const Element& e : kept) append_clean(path.elements, e);
    return Done{};
}

bool equal_elements(const Element& a, const Element& b) {
    return a.kind == b.kind && a.p0 == b.p0 && a.p1 == b.p1 && a.p2 == b.p2 && a.width0 == b.width0 &&
           a.width1 == b.width1 && a.height0 == b.height0 && a.height1 == b.height1;
}

bool equal_paths(const WorkPath& a, const WorkPath& b) {
    return a.profile == b.profile && a.material == b.material && a.level == b.level && a.closed == b.closed &&
           a.function == b.function &&
           std::equal(a.elements.begin(), a.elements.end(), b.elements.begin(), b.elements.end(),
                      equal_elements);
}

// A path listed twice says nothing new, and two equal lines cross nowhere and everywhere.
void drop_duplicates(Work& work) {
    std::vector<std::size_t> order(work.paths.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto first = [&](std::size_t i) { return work.paths[i].elements.front().p0; };
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        if (first(a).x != first(b).x) return first(a).x < first(b).x;
        if (first(a).y != first(b).y) return first(a).y < first(b).y;
        return a < b;
    });
    std::vector<char> duplicate(work.paths.size(), 0);
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t k = i + 1; k < order.size() && first(order[k]) == first(order[i]); ++k)
            if (!duplicate[order[i]] && equal_paths(work.paths[order[i]], work.paths[order[k]]))
                duplicate[order[k]] = 1;
    std::vector<WorkPath> kept;
    for (std::size_t i = 0; i < work.paths.size(); ++i) {
        if (duplicate[i])
            work.stats.dropped_elements += static_cast<int>(work.paths[i].elements.size());
        else
            kept.push_back(std::move(work.paths[i]));
    }
    work.paths = std::move(kept);
}

}  // namespace

Status check_heights(const Work& work, std::size_t index, double scale) {
    const Pattern& pattern = work.pattern;
    const Path& path = pattern.paths[index];
    const double slack = pattern.depth / 256.0;
    for (const ProfilePoint& p : work.profiles[path.profile].points) {
        const double h = path.level + scale * p.h;
        if (h > highest(pattern) + slack || h < lowest(pattern) - slack)
            return input_error(path_text(index, path.elements.front().p0) + " reaches height " +
                               std::to_string(h) + ", outside [" + std::to_string(lowest(pattern)) + ", " +
                               std::to_string(highest(pattern)) + "]");
    }
    return Done{};
}

std::string position_text(Vec2 p) {
    char text[80];
    std::snprintf(text, sizeof text, "(%.6g, %.6g)", p.x, p.y);
    return text;
}

std::string path_text(std::size_t index, Vec2 p) {
    return "path " + std::to_string(index) + " at " + position_text(p);
}

bool tolerate(Work& work, const std::string& message) {
    if (!work.options.lenient) return false;
    if (work.stats.dropped_paths++ == 0) work.stats.first_dropped = message;
    return true;
}

double line_angle(Vec2 direction) {
    double angle = std::atan2(direction.y, direction.x);
    if (angle < 0.0) angle += kPi;
    return angle >= kPi ? 0.0 : angle;
}

Vec2 wrapped(const Work& work, Vec2 p) {
    if (!work.repeats()) return p;
    const Vec2 size = work.pattern.size;
    Vec2 inside = {p.x - std::floor(p.x / size.x) * size.x, p.y - std::floor(p.y / size.y) * size.y};
    if (inside.x >= size.x) inside.x = 0.0;
    if (inside.y >= size.y) inside.y = 0.0;
    return inside;
}

Vec2 copy_near(const Work& work, Vec2 target, Vec2 p) {
    if (!work.repeats()) return target;
    const Vec2 size = work.pattern.size;
    return {target.x + std::round((p.x - target.x) / size.x) * size.x,
            target.y + std::round((p.y - target.y) / size.y) * size.y};
}

Status prepare(Work& work) {
    const Pattern& pattern = work.pattern;
    if (const Status status = check_options(work.options); !status.ok()) return status;
    if (const Status status = check_frame(pattern); !status.ok()) return status;
    const double side = std::max(pattern.size.x, pattern.size.y);
    work.snap = work.options.snap * side;
    work.tolerance = std::max(0.25 * work.snap, 1e-6 * side);
    std::vector<Status> profile_status;
    for (std::size_t i = 0; i < pattern.profiles.size(); ++i) {
        Result<ResolvedProfile> profile = classify_profile(pattern.profiles[i], i, pattern.depth);
        if (!profile.ok() && !work.options.lenient) return profile.error();
        profile_status.push_back(profile.ok() ? Status(Done{}) : Status(profile.error()));
        // An unused place keeps the numbering; no path with a profile in error comes through.
        work.profiles.push_back(profile.ok() ? *profile
                                             : ResolvedProfile{{{-1e-3 * side, 0.0}, {1e-3 * side, 0.0}}, 0});
        work.rise.push_back(work.profiles.back().points.back().h);
    }
    for (std::size_t i = 0; i < pattern.paths.size(); ++i) {
        Status status = check_path(work, profile_status, i);
        if (status.ok()) {
            WorkPath path = copy_path(work, i);
            status = weld_elements(work, path, i);
            if (status.ok()) status = perturb_path(work, path);
            if (status.ok()) work.paths.push_back(std::move(path));
        }
        if (!status.ok() && !tolerate(work, status.error().message)) return status;
    }
    drop_duplicates(work);
    return Done{};
}

}  // namespace burin::resolving
