// Facets of a profile: which add, which cut. [2010] 5.3 and the rule of DESIGN 2 for what lies below the
// ground.
#include <algorithm>
#include <cmath>

#include "layout.h"
#include "resolve_internal.hpp"

namespace burin::resolving {
namespace {

struct Facet {
    ProfilePoint from, to;
    FacetClass given = FacetClass::automatic;
    bool internal = false;
    double low_b() const { return std::min(from.b, to.b); }
    double high_b() const { return std::max(from.b, to.b); }
};

Error profile_error(std::size_t index, const std::string& what) {
    return {ErrorCode::invalid_input, "profile " + std::to_string(index) + ": " + what};
}

std::string point_text(const ProfilePoint& p) {
    return "(b " + std::to_string(p.b) + ", h " + std::to_string(p.h) + ")";
}

Status check_points(const Profile& profile, std::size_t index, double depth) {
    const auto& points = profile.points;
    if (points.size() < 2 || points.size() > BURIN_MAX_PROFILE_POINTS)
        return profile_error(index, std::to_string(points.size()) + " points; 2 to " +
                                        std::to_string(BURIN_MAX_PROFILE_POINTS) + " are allowed");
    for (const ProfilePoint& p : points)
        if (!std::isfinite(p.b) || !std::isfinite(p.h)) return profile_error(index, "a point is not finite");
    if (!profile.facets.empty() && profile.facets.size() + 1 != points.size())
        return profile_error(index, std::to_string(profile.facets.size()) + " facet flags for " +
                                        std::to_string(points.size()) +
                                        " points; give one fewer than points, or none");
    if (std::abs(points.front().h) > depth * kLevelTolerance)
        return profile_error(index, "the first point " + point_text(points.front()) +
                                        " is not on the ground; its height must be 0");
    if (points.front().b > points.back().b)
        return profile_error(index, "the last point lies left of the first; list points left to right");
    return Done{};
}

// Facets with the ends exactly on the ground and, for a step, cut at b = 0.
std::vector<Facet> split_at_path_line(const Profile& profile, bool step, double rise) {
    std::vector<ProfilePoint> points = profile.points;
    points.front().h = 0.0;
    points.back().h = step ? rise : 0.0;
    std::vector<Facet> facets;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const FacetClass given = profile.facets.empty() ? FacetClass::automatic : profile.facets[i];
        const ProfilePoint a = points[i], b = points[i + 1];
        if (step && ((a.b < 0.0 && b.b > 0.0) || (a.b > 0.0 && b.b < 0.0))) {
            const ProfilePoint middle{0.0, a.h + (b.h - a.h) * (a.b / (a.b - b.b))};
            facets.push_back({a, middle, given});
            facets.push_back({middle, b, given});
        } else {
            facets.push_back({a, b, given});
        }
    }
    return facets;
}

// Height of the ground below a facet; a vertical facet on the path line of a step stands between both and has
// neither.
bool ground_below(const Facet& facet, double rise, double& ground) {
    if (facet.low_b() == 0.0 && facet.high_b() == 0.0 && rise != 0.0) return false;
    ground = facet.high_b() <= 0.0 ? 0.0 : rise;
    return true;
}

// A facet that passes the ground of its side becomes two, so that the part below can cut and the part above
// can add.
std::vector<Facet> split_at_ground(const std::vector<Facet>& facets, double rise) {
    std::vector<Facet> split;
    for (const Facet& facet : facets) {
        double ground = 0.0;
        const bool passes =
            ground_below(facet, rise, ground) && (facet.from.h - ground) * (facet.to.h - ground) < 0.0;
        if (!passes || facet.given != FacetClass::automatic) {
            split.push_back(facet);
            continue;
        }
        const double s = (ground - facet.from.h) / (facet.to.h - facet.from.h);
        const ProfilePoint middle{facet.from.b + s * (facet.to.b - facet.from.b), ground};
        split.push_back({facet.from, middle, facet.given, facet.internal});
        split.push_back({middle, facet.to, facet.given, facet.internal});
    }
    return split;
}

// External from each end inwards until the profile first turns back down.
void classify_runs(std::vector<Facet>& facets) {
    std::size_t left = 0, right = facets.size();
    while (left < facets.size() && facets[left].to.h >= facets[left].from.h) ++left;
    while (right > 0 && facets[right - 1].from.h >= facets[right - 1].to.h) --right;
    for (std::size_t i = 0; i < facets.size(); ++i) facets[i].internal = i >= left && i < right;
}

void classify_by_ground(std::vector<Facet>& facets, double rise) {
    for (Facet& facet : facets) {
        double ground = 0.0;
        if (ground_below(facet, rise, ground) && std::min(facet.from.h, facet.to.h) < ground &&
            std::max(facet.from.h, facet.to.h) <= ground)
            facet.internal = true;
        if (facet.given != FacetClass::automatic) facet.internal = facet.given == FacetClass::internal;
    }
}

double height_at(const Facet& facet, double b) {
    return facet.from.b == facet.to.b ? std::max(facet.from.h, facet.to.h)
                                      : facet.from.h + (facet.to.h - facet.from.h) *
                                                           ((b - facet.from.b) / (facet.to.b - facet.from.b));
}

// A vertical ray from an internal facet must not meet the profile again: what it cuts would be ambiguous.
Status check_overhang(const std::vector<Facet>& facets, std::size_t index) {
    for (const Facet& cut : facets) {
        if (!cut.internal || cut.given != FacetClass::automatic) continue;
        for (const Facet& above : facets) {
            const double low = std::max(cut.low_b(), above.low_b()),
                         high = std::min(cut.high_b(), above.high_b());
            if (&above == &cut || high <= low) continue;
            const double middle = 0.5 * (low + high);
            if (height_at(above, middle) > height_at(cut, middle))
                return profile_error(index, "overhangs its internal facet from " + point_text(cut.from) +
                                                " to " + point_text(cut.to) +
                                                "; flag every facet internal or external");
        }
    }
    return Done{};
}

}  // namespace

Result<ResolvedProfile> classify_profile(const Profile& profile, std::size_t index, double depth) {
    if (const Status status = check_points(profile, index, depth); !status.ok()) return status.error();
    const double difference = profile.points.back().h - profile.points.front().h;
    const bool step = std::abs(difference) > depth * kLevelTolerance;
    const double rise = step ? difference : 0.0;
    if (step && (profile.points.front().b > 0.0 || profile.points.back().b < 0.0))
        return profile_error(index, "a step profile must reach over b = 0");
    if (!step && profile.points.front().b == profile.points.back().b)
        return profile_error(index, "has no width");
    std::vector<Facet> facets = split_at_path_line(profile, step, rise);
    classify_runs(facets);
    // A groove's external runs never leave the ground downwards; only a step's can, on the side of the other
    // ground.
    if (step) facets = split_at_ground(facets, rise);
    classify_by_ground(facets, rise);
    if (const Status status = check_overhang(facets, index); !status.ok()) return status.error();
    if (facets.size() + 1 > BURIN_MAX_PROFILE_POINTS)
        return profile_error(index, "has " + std::to_string(facets.size() + 1) +
                                        " points once split at the ground; " +
                                        std::to_string(BURIN_MAX_PROFILE_POINTS) + " are allowed");
    ResolvedProfile resolved;
    resolved.points.push_back(facets.front().from);
    for (std::size_t i = 0; i < facets.size(); ++i) {
        resolved.points.push_back(facets[i].to);
        if (facets[i].internal) resolved.internal_mask |= 1u << i;
    }
    return resolved;
}

}  // namespace burin::resolving
