// Ground and surface of the truth. The ray is in evaluate_ray.cpp.
#include <algorithm>
#include <cassert>

#include "evaluate_prepare.hpp"

namespace burin {
namespace {

using truth::Local;
using Prepared = Truth::Prepared;

// ---- ground
// --------------------------------------------------------------------------------------------------

// What a straight way from p to a target meets first.
struct Crossing {
    bool found = false;
    bool certain = false;  // not at an element's end, not along its tangent, no other line as near
    double level = 0.0;
};

Crossing first_crossing(const Prepared& truth, Vec2 p, Vec2 target) {
    const Vec2 d = target - p;
    const Vec2 low{std::min(p.x, target.x), std::min(p.y, target.y)};
    const Vec2 high{std::max(p.x, target.x), std::max(p.y, target.y)};
    Crossing best;
    double nearest = 2.0, second = 2.0;
    for (const std::uint32_t index : truth.steps) {
        const PreparedElement& e = truth.elements[index];
        truth::for_each_image(truth, e.box, low, high, [&](Vec2 shift) {
            double u[2];
            const int n = truth::meet_line(e, p - shift, d, u);
            for (int i = 0; i < n; ++i) {
                const double s = dot(truth::point_on(e, u[i]) + shift - p, d) / dot(d, d);
                if (s < 0.0 || s > 1.0 + 1e-9 || s >= second) continue;
                if (s >= nearest) {
                    second = s;
                    continue;
                }
                second = nearest;
                nearest = s;
                // p lies behind the crossing: to the right where d runs against n.
                const double across = dot(d, normal_of(truth::tangent_on(e, u[i])));
                best.found = true;
                best.certain = u[i] > 1e-6 && u[i] < 1.0 - 1e-6 && std::abs(across) > 1e-4 * length(d);
                best.level = across < 0.0 ? e.right_level : e.left_level;
            }
        });
    }
    best.certain = best.certain && second - nearest > 1e-12;
    return best;
}

// Step elements whose middle is nearest to p come first; only the first few are ever needed.
std::vector<std::pair<double, std::uint32_t>> nearest_steps(const Prepared& truth, Vec2 p) {
    std::vector<std::pair<double, std::uint32_t>> order;
    order.reserve(truth.steps.size());
    for (const std::uint32_t index : truth.steps) {
        Vec2 d = truth::point_on(truth.elements[index], 0.5) - p;
        if (truth.repeat) {
            d.x -= truth.size.x * std::round(d.x / truth.size.x);
            d.y -= truth.size.y * std::round(d.y / truth.size.y);
        }
        order.emplace_back(dot(d, d), index);
    }
    const std::size_t kept = std::min<std::size_t>(order.size(), 8);
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), order.end());
    if (truth.repeat) order.resize(kept);
    return order;
}

double find_ground(const Prepared& truth, Vec2 p) {
    if (truth.steps.empty() || !truth::inside_map(truth, p)) return truth.outer_level;
    Crossing fallback;
    // Irrational places on the element, so that designed patterns are met at generic points.
    static constexpr double kPlaces[] = {0.4370160244488211, 0.6180339887498949, 0.2360679774997897,
                                         0.8541019662496845};
    const auto order = nearest_steps(truth, p);
    for (const double place : kPlaces)
        for (const auto& [distance, index] : order) {
            Vec2 target = truth::point_on(truth.elements[index], place);
            if (truth.repeat) {
                target.x -= truth.size.x * std::round((target.x - p.x) / truth.size.x);
                target.y -= truth.size.y * std::round((target.y - p.y) / truth.size.y);
            } else if (!truth::inside_map(truth, target)) {
                continue;
            }
            const Crossing crossing = first_crossing(truth, p, target);
            if (crossing.found && crossing.certain) return crossing.level;
            if (crossing.found && !fallback.found) fallback = crossing;
        }
    return fallback.found ? fallback.level : truth.outer_level;
}

// ---- surface
// -------------------------------------------------------------------------------------------------

// A stretch of a vertical line that an element adds or cuts, and the facet that bounds it towards the solid's
// top.
struct Span {
    double low, high;
    std::uint32_t element, facet;
    std::uint32_t place;  // which acting element, for the normal
};

struct Acting {
    std::uint32_t index;
    Vec2 shift;
    Local local;
};

struct Column {
    std::vector<Span> adds, cuts;
    std::vector<Acting> acting;
};

struct FacetCrossing {
    double z;
    std::uint32_t facet;
};

// Heights where the vertical line at the element's b' meets facets of `mask`, ascending.
int crossings_of(const PreparedProfile& profile, const PreparedElement& e, const Local& local,
                 std::uint32_t first, std::uint32_t last, FacetCrossing* out) {
    const double b = local.offset / local.width;
    int n = 0;
    for (std::uint32_t i = first; i < last; ++i) {
        const ProfilePoint p = profile.points[i], q = profile.points[i + 1];
        if ((p.b <= b) == (q.b <= b)) continue;
        out[n++] = {e.level + local.height * (p.h + profile.slope[i] * (b - p.b)), i};
    }
    std::sort(out, out + n, [](const FacetCrossing& x, const FacetCrossing& y) { return x.z < y.z; });
    return n;
}

void add_spans(const Prepared& truth, const Acting& acting, std::uint32_t place, double ground,
               Column& column) {
    const PreparedElement& e = truth.elements[acting.index];
    const PreparedProfile& profile = truth.profiles[e.profile];
    const std::uint32_t facets = static_cast<std::uint32_t>(profile.points.size()) - 1;
    FacetCrossing z[32];
    int n = crossings_of(profile, e, acting.local, 0, facets, z);
    // Add: an odd number of facets above. The lowest stretch of odd parity reaches down to the ground.
    for (int i = n - 1; i >= 0; i -= 2) {
        const double low = i > 0 ? std::max(z[i - 1].z, ground) : ground;
        if (z[i].z > low) column.adds.push_back({low, z[i].z, acting.index, z[i].facet, place});
    }
    // Cut: per internal run, an odd number of facets below. The highest stretch is open upwards.
    for (std::uint32_t i = 0; i < facets;) {
        std::uint32_t end = i;
        while (end < facets && ((profile.internal_mask >> end) & 1u)) ++end;
        n = crossings_of(profile, e, acting.local, i, end, z);
        for (int k = 0; k < n; k += 2)
            column.cuts.push_back({z[k].z, k + 1 < n ? z[k + 1].z : 1e300, acting.index, z[k].facet, place});
        i = end + 1;
    }
}

void set_normal(const Prepared& truth, const Acting& acting, std::uint32_t facet, Vec2 p, SurfacePoint& out) {
    const PreparedElement& e = truth.elements[acting.index];
    const PreparedProfile& profile = truth.profiles[e.profile];
    const truth::Foot foot = truth::find_foot(e, p - acting.shift);
    const truth::Form form = truth::find_form(e, p - acting.shift, foot);
    const truth::LocalGradient g = truth::gradient_of(e, form, p - acting.shift, foot);
    // z = level + H (h_i + m (b' / W - b_i)), with W, H the scales.
    const double m = profile.slope[facet], b = acting.local.offset / acting.local.width;
    const double h = profile.points[facet].h + m * (b - profile.points[facet].b);
    const Vec2 slope =
        g.height * h + (g.offset - g.width * b) * (acting.local.height * m / acting.local.width);
    const double l = std::sqrt(1.0 + dot(slope, slope));
    out.normal[0] = -slope.x / l;
    out.normal[1] = -slope.y / l;
    out.normal[2] = 1.0 / l;
}

// Topmost end of (ground and adds) minus cuts: walks down from the highest end, leaving every cut at its
// floor.
SurfacePoint topmost(const Column& column, double ground, std::uint32_t& place) {
    SurfacePoint top;
    top.height = ground;
    for (const Span& add : column.adds)
        if (add.high > top.height) {
            top.height = add.high;
            top.element = add.element, top.facet = add.facet, place = add.place;
        }
    for (bool moved = true; moved;) {
        moved = false;
        for (const Span& cut : column.cuts)
            if (cut.low < top.height && top.height <= cut.high) {
                top.height = cut.low;
                top.element = cut.element, top.facet = cut.facet, place = cut.place;
                moved = true;
            }
        if (!moved) break;
        // What lies under the floor of the cut may be air below an overhang: go on to the next solid stretch.
        bool solid = top.height <= ground;
        double below = ground;
        const Span* next = nullptr;
        for (const Span& add : column.adds) {
            solid = solid || (add.low < top.height && top.height <= add.high);
            if (add.high < top.height && add.high > below) below = add.high, next = &add;
        }
        if (solid) continue;
        top.height = below;
        top.element = next ? next->element : kGround, top.facet = next ? next->facet : kGround;
        if (next) place = next->place;
    }
    return top;
}

SurfacePoint find_surface(const Prepared& truth, Vec2 p, std::span<const std::uint32_t> candidates,
                          double ground) {
    SurfacePoint out;
    out.height = out.ground = ground;
    if (!truth::inside_map(truth, p)) return out;
    Column column;
    for (const std::uint32_t index : candidates) {
        const PreparedElement& e = truth.elements[index];
        truth::for_each_image(truth, e.box, p, p, [&](Vec2 shift) {
            Acting acting{index, shift, {}};
            if (!truth::acts_at(truth, e, p - shift, ground, acting.local)) return;
            add_spans(truth, acting, static_cast<std::uint32_t>(column.acting.size()), ground, column);
            column.acting.push_back(acting);
        });
    }
    if (column.adds.empty() && column.cuts.empty()) return out;
    std::uint32_t place = 0;
    out = topmost(column, ground, place);
    out.ground = ground;
    if (out.element == kGround) return out;
    out.offset = column.acting[place].local.offset;
    set_normal(truth, column.acting[place], out.facet, p, out);
    return out;
}

}  // namespace

double Truth::ground_at(Vec2 p) const { return find_ground(*prepared_, truth::into_tile(*prepared_, p)); }

SurfacePoint Truth::surface_at(Vec2 p) const { return surface_at(p, prepared_->all); }

SurfacePoint Truth::surface_at(Vec2 p, std::span<const std::uint32_t> candidates) const {
    return surface_at(p, candidates, ground_at(p));
}

SurfacePoint Truth::surface_at(Vec2 p, std::span<const std::uint32_t> candidates, double ground) const {
    return find_surface(*prepared_, truth::into_tile(*prepared_, p), candidates, ground);
}

bool Truth::is_solid(Vec2 p, double z) const {
    const Vec2 q = truth::into_tile(*prepared_, p);
    return truth::solid_at(*prepared_, q, z, find_ground(*prepared_, q));
}

double ground_at(const ResolvedPattern& pattern, Vec2 p) { return Truth(pattern).ground_at(p); }
SurfacePoint surface_at(const ResolvedPattern& pattern, Vec2 p) { return Truth(pattern).surface_at(p); }
SurfacePoint surface_at(const ResolvedPattern& pattern, Vec2 p, std::span<const std::uint32_t> candidates) {
    return Truth(pattern).surface_at(p, candidates);
}
bool is_solid(const ResolvedPattern& pattern, Vec2 p, double z) { return Truth(pattern).is_solid(p, z); }
RayHit trace_ray(const ResolvedPattern& pattern, const Ray& ray) { return Truth(pattern).trace_ray(ray); }

}  // namespace burin
