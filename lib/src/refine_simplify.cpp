#include "refine_simplify.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace burin::refinement {

double relief_of(const Profile& profile) {
    double low = 1e300, high = -1e300;
    for (const ProfilePoint& p : profile.points) low = std::min(low, p.h), high = std::max(high, p.h);
    return high - low;
}

namespace {

constexpr double kHeightShare = 0.03;    // of a profile's relief: what a dropped point may differ by in height ...
constexpr double kOffsetTexels = 0.2;    // ... or in place; either makes it droppable
constexpr double kSymmetryShare = 0.05;  // of the relief
constexpr double kSymmetryTexels = 0.3;
constexpr double kAlikeTexels = 0.05;    // that points of two profiles may differ by, which are one then ...
constexpr double kAlikeShare = 0.003;    // ... and of the relief
constexpr double kCentreTexels = 3.0;    // that a bare step may stand beside its rim
constexpr double kGroundShare = 0.01;    // of the relief: an end facet that rises less is ground

// Distance from the chord a-b in units of the two tolerances; the smaller counts, so that a point on a steep wall may
// be far off in height and one on a flat bottom far off in place.
double distance_from_chord(ProfilePoint p, ProfilePoint a, ProfilePoint b, double relief) {
    const Vec2 scale{1.0 / kOffsetTexels, 1.0 / (kHeightShare * relief)};
    const Vec2 d{(b.b - a.b) * scale.x, (b.h - a.h) * scale.y}, r{(p.b - a.b) * scale.x, (p.h - a.h) * scale.y};
    const double square = dot(d, d);
    const double t = square > 0.0 ? std::clamp(dot(r, d) / square, 0.0, 1.0) : 0.0;
    return length(r - d * t);
}

void keep_between(const std::vector<ProfilePoint>& points, std::size_t from, std::size_t to, double relief,
                  std::vector<char>& keep) {
    double worst = 1.0;
    std::size_t at = 0;
    for (std::size_t i = from + 1; i < to; ++i) {
        const double distance = distance_from_chord(points[i], points[from], points[to], relief);
        if (distance > worst) worst = distance, at = i;
    }
    if (at == 0) return;
    keep[at] = 1;
    keep_between(points, from, at, relief, keep);
    keep_between(points, at, to, relief, keep);
}

// Where the facets from `at` on in direction `step` leave the height of the end.
std::size_t first_off_ground(const std::vector<ProfilePoint>& points, std::size_t at, int step, double tolerance) {
    const double ground = points[at].h;
    std::size_t next = at + static_cast<std::size_t>(step);
    while (next > 0 && next + 1 < points.size() && std::abs(points[next].h - ground) < tolerance)
        at = next, next += static_cast<std::size_t>(step);
    return at;
}

bool simplify(Profile& profile) {
    const double relief = relief_of(profile);
    std::vector<ProfilePoint> points = profile.points;
    const bool step = points.front().h != points.back().h;
    if (points.size() < (step ? 3u : 4u) || relief <= 0.0 || !profile.facets.empty()) return false;
    const double left = points.front().h, right = points.back().h;
    const std::size_t first = first_off_ground(points, 0, 1, kGroundShare * relief);
    const std::size_t last = first_off_ground(points, points.size() - 1, -1, kGroundShare * relief);
    if (last < first + (step ? 1 : 2)) return false;
    points[first].h = left;
    points[last].h = right;
    std::vector<char> keep(points.size(), 0);
    keep[first] = keep[last] = 1;
    keep_between(points, first, last, relief, keep);
    std::vector<ProfilePoint> kept;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (keep[i]) kept.push_back(points[i]);
    if (kept.size() == points.size() || kept.size() < (step ? 2u : 3u)) return false;
    if (step && (kept.front().b > 0.0 || kept.back().b < 0.0)) return false;
    profile.points = kept;
    return true;
}

// A step of more facets has its point, the turned middle, where both halves are alike; a bare one always.
bool centre_step(std::vector<ProfilePoint>& points, double relief) {
    const std::size_t count = points.size();
    const double rise = points.back().h - points.front().h;
    bool already = true;
    for (std::size_t i = 0; i < (count + 1) / 2; ++i) {
        const ProfilePoint &a = points[i], &b = points[count - 1 - i];
        const double tilt = a.h + b.h - 2.0 * points.front().h - rise;
        if (std::abs(a.b + b.b) > 2.0 * kSymmetryTexels || std::abs(tilt) > kSymmetryShare * relief) return false;
        already &= a.b == -b.b;
    }
    for (std::size_t i = 0; i < (count + 1) / 2; ++i) {
        ProfilePoint &a = points[i], &b = points[count - 1 - i];
        const double offset = 0.5 * (b.b - a.b);
        a.b = -offset, b.b = offset;
    }
    return !already;
}

bool symmetrize(Profile& profile) {
    std::vector<ProfilePoint>& points = profile.points;
    const std::size_t count = points.size();
    const double relief = relief_of(profile);
    if (relief <= 0.0 || !profile.facets.empty()) return false;
    if (points.front().h != points.back().h) return centre_step(points, relief);
    bool already = true;
    for (std::size_t i = 0; i < count / 2; ++i) {
        const ProfilePoint &a = points[i], &b = points[count - 1 - i];
        if (std::abs(a.b + b.b) > kSymmetryTexels || std::abs(a.h - b.h) > kSymmetryShare * relief) return false;
        already &= a.b == -b.b && a.h == b.h;
    }
    if (already && (count % 2 == 0 || points[count / 2].b == 0.0)) return false;
    for (std::size_t i = 0; i < count / 2; ++i) {
        ProfilePoint &a = points[i], &b = points[count - 1 - i];
        const double offset = 0.5 * (b.b - a.b), height = 0.5 * (a.h + b.h);
        a = {-offset, height};
        b = {offset, height};
    }
    if (count % 2 == 1) points[count / 2].b = 0.0;
    return true;
}

Vec2 start_normal(const Element& e) { return normal_of(unit((e.kind == ElementKind::line ? e.p2 : e.p1) - e.p0)); }
Vec2 end_normal(const Element& e) { return normal_of(unit(e.p2 - (e.kind == ElementKind::line ? e.p0 : e.p1))); }

// Where two lines meet that are both moved along their normals, from where they met.
Vec2 mitre(Vec2 a, Vec2 b) { return (a + b) * (1.0 / std::max(0.2, 1.0 + dot(a, b))); }

// A closed path beside itself.
void move_aside(Path& path, double by) {
    const std::vector<Element> old = path.elements;
    for (std::size_t i = 0; i < old.size(); ++i) {
        const Element &before = old[(i + old.size() - 1) % old.size()], &e = old[i], &after = old[(i + 1) % old.size()];
        path.elements[i].p0 = e.p0 + mitre(end_normal(before), start_normal(e)) * by;
        path.elements[i].p1 = e.p1 + mitre(start_normal(e), end_normal(e)) * by;
        path.elements[i].p2 = e.p2 + mitre(end_normal(e), start_normal(after)) * by;
    }
}

// A bare step stands in the middle of its wall. Rims that all moved to one side, and their profile to the other, show the
// map no less, but the rim is not where it is looked for.
bool centre_rims(Pattern& pattern, std::size_t index) {
    std::vector<ProfilePoint>& points = pattern.profiles[index].points;
    const double off = 0.5 * (points.front().b + points.back().b);
    if (points.size() != 2 || points[0].h == points[1].h || std::abs(off) < kSymmetryTexels || std::abs(off) > kCentreTexels)
        return false;
    for (const Path& path : pattern.paths)
        if (path.profile == index && !path.closed) return false;
    for (Path& path : pattern.paths)
        if (path.profile == index) move_aside(path, off);
    for (ProfilePoint& point : points) point.b -= off;
    return true;
}

}  // namespace

bool make_symmetric(Pattern& pattern) {
    bool changed = false;
    for (Profile& profile : pattern.profiles) changed |= symmetrize(profile);
    return changed;
}

namespace {

bool are_alike(const Profile& a, const Profile& b) {
    const double relief = std::max(relief_of(a), relief_of(b));
    if (a.points.size() != b.points.size() || !a.facets.empty() || !b.facets.empty()) return false;
    for (std::size_t i = 0; i < a.points.size(); ++i)
        if (std::abs(a.points[i].b - b.points[i].b) > kAlikeTexels || std::abs(a.points[i].h - b.points[i].h) > kAlikeShare * relief)
            return false;
    return true;
}

// Profiles that differ next to nothing become one. Returns whether any did.
bool share_profiles(Pattern& pattern) {
    bool changed = false;
    for (Path& path : pattern.paths)
        for (std::uint32_t i = 0; i < path.profile; ++i) {
            if (!are_alike(pattern.profiles[i], pattern.profiles[path.profile])) continue;
            path.profile = i;
            changed = true;
        }
    return changed;
}

}  // namespace

bool simplify_profiles(Pattern& pattern) {
    bool changed = share_profiles(pattern);
    for (std::size_t i = 0; i < pattern.profiles.size(); ++i) {
        changed |= simplify(pattern.profiles[i]);
        changed |= centre_rims(pattern, i);
        changed |= symmetrize(pattern.profiles[i]);
    }
    return changed;
}

}  // namespace burin::refinement
