#include "refine_units.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace burin::refinement {
namespace {

// A step whose upper side came to lie above the object surface, or its lower below the deepest point, ends there.
void keep_levels_within(Pattern& refined) {
    for (Path& path : refined.paths) {
        path.level = std::clamp(path.level, 0.0, 1.0);
        std::vector<ProfilePoint>& points = refined.profiles[path.profile].points;
        const double rise = points.back().h - points.front().h;
        if (rise != 0.0) points.back().h = points.front().h + std::clamp(rise, -path.level, 1.0 - path.level);
    }
}

}  // namespace

Pattern to_texels(const Pattern& pattern, double texel) {
    Pattern out = pattern;
    const double inverse = 1.0 / texel;
    const auto height = [&](double z) { return 1.0 + (z - pattern.base_offset) / pattern.depth; };
    out.size = pattern.size * inverse;
    out.depth = 1.0;
    out.base_offset = 1.0;
    out.outer_level = height(pattern.outer_level);
    for (Profile& profile : out.profiles)
        for (ProfilePoint& point : profile.points) point.b *= inverse, point.h /= pattern.depth;
    for (Path& path : out.paths) {
        path.level = height(path.level);
        for (Element& e : path.elements) e.p0 = e.p0 * inverse, e.p1 = e.p1 * inverse, e.p2 = e.p2 * inverse;
    }
    return out;
}

void from_texels(Pattern refined, double texel, Pattern& pattern) {
    keep_levels_within(refined);
    const auto metres = [&](double value) { return pattern.base_offset + (value - 1.0) * pattern.depth; };
    pattern.outer_level = metres(refined.outer_level);
    pattern.profiles = std::move(refined.profiles);
    pattern.paths = std::move(refined.paths);
    for (Profile& profile : pattern.profiles)
        for (ProfilePoint& point : profile.points) point.b *= texel, point.h *= pattern.depth;
    for (Path& path : pattern.paths) {
        path.level = metres(path.level);
        for (Element& e : path.elements) e.p0 = e.p0 * texel, e.p1 = e.p1 * texel, e.p2 = e.p2 * texel;
    }
}

}  // namespace burin::refinement
