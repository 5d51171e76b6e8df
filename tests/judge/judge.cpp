#include "judge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <burin/grid.hpp>
#include <cpp/decode.hpp>

#include "../property/random_pattern.hpp"

namespace burin::testing {
namespace {

Vec2 on_element(const Element& e, double s) {
    if (e.kind == ElementKind::line) return lerp(e.p0, e.p2, s);
    return lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s);
}

double reach_of(const ResolvedPattern& pattern, std::size_t element) {
    double reach = 0.0;
    for (const ProfilePoint& point :
         pattern.profiles[pattern.styles[pattern.elements[element].style].profile].points)
        reach = std::max(reach, std::abs(point.b));
    return std::max(reach, 1e-3);
}

Vec2 aim(const PreparedPattern& p, RayKind kind, Random& random) {
    const ResolvedPattern& pattern = p.resolved;
    if (kind == RayKind::junction && !pattern.junctions.empty()) {
        const Junction& junction =
            pattern.junctions[std::size_t(random.below(int(pattern.junctions.size())))];
        return junction.position + random.direction() * (0.06 * random.uniform());
    }
    if (kind == RayKind::anywhere || pattern.elements.empty())
        return {random.uniform() * pattern.size.x, random.uniform() * pattern.size.y};
    const std::size_t k = std::size_t(random.below(int(pattern.elements.size())));
    const Vec2 at = on_element(pattern.elements[k].element, random.between(-0.05, 1.05));
    return at + random.direction() * (reach_of(pattern, k) * 1.2 * random.uniform());
}

struct TruthHit {
    RayHit hit;
    double drop;
};

TruthHit ask(const Truth& truth, const PreparedPattern& p, PatternRay ray, Vec2 shift) {
    // From somewhat above: what lies flush with the object surface, as rounding leaves it, is met and not begun in.
    const double above = 1e-4 * p.detail.depth;
    Ray r;
    r.origin[0] = double(ray.origin[0]) + shift.x - double(ray.slope[0]) * above;
    r.origin[1] = double(ray.origin[1]) + shift.y - double(ray.slope[1]) * above;
    r.origin[2] = p.detail.base_offset + above;
    r.direction[0] = double(ray.slope[0]);
    r.direction[1] = double(ray.slope[1]);
    r.direction[2] = -1.0;
    RayHit hit = truth.trace_ray(r);
    hit.t = std::max(hit.t - above, 0.0);
    return {hit, hit.t};
}

bool same_facet(const RayHit& a, const RayHit& b) { return a.element == b.element && a.facet == b.facet; }

// The shader's facet in the truth's words.
std::uint32_t facet_word(int facet) {
    return facet >= 0 ? std::uint32_t(facet) : (facet == kDecodedGroundFacet ? kGround : kWall);
}

// Whether the truth met a sheet of solid thinner than 2e-5 of the tile, and what stands behind it is what the
// decoder met.
bool is_sheet(const Truth& truth, const PreparedPattern& p, PatternRay ray, const TruthHit& front,
              double drop) {
    const double run = std::hypot(double(ray.slope[0]), double(ray.slope[1]));
    if (run == 0.0) return false;
    const double past = front.drop + 2e-5 * std::max(p.detail.size_u, p.detail.size_v) / run;
    Ray r;
    r.origin[0] = double(ray.origin[0]) + double(ray.slope[0]) * past;
    r.origin[1] = double(ray.origin[1]) + double(ray.slope[1]) * past;
    r.origin[2] = p.detail.base_offset - past;
    r.direction[0] = double(ray.slope[0]);
    r.direction[1] = double(ray.slope[1]);
    r.direction[2] = -1.0;
    const RayHit behind = truth.trace_ray(r);
    return !behind.inside && std::abs(past + behind.t - drop) < 1e-3 * p.detail.depth;
}

}  // namespace

Verdict compare_hit(const Truth& truth, const PreparedPattern& p, const PatternRay& ray, const ShadedHit& hit,
                    double border) {
    const TruthHit right = ask(truth, p, ray, {});
    Verdict v;
    v.truth = right.hit;
    v.height = std::abs(double(hit.drop) - right.drop) / p.detail.depth;
    const std::uint32_t facet = facet_word(hit.facet);
    const std::uint32_t texel =
        right.hit.element == kGround ? kDecodedGround : p.element_texels[right.hit.element];
    // A wall belongs to whatever stops there; only its being a wall counts.
    v.facet_differs = facet != right.hit.facet || (facet < kWall && texel != hit.element);
    // Facets of two elements that lie in one plane where they meet are one facet.
    double cosine = 0.0;
    for (int i = 0; i < 3; ++i) cosine += double(hit.normal[i]) * right.hit.normal[i];
    if (v.height < 2e-5 && cosine > 0.99999) v.facet_differs = false;
    // The wall at the border of a map is the ground's.
    if (hit.element == kDecodedGround && hit.facet == kDecodedWall && right.hit.element == kGround)
        v.facet_differs = false;
    v.height_differs = v.height > 1e-3;
    if (!v.facet_differs && !v.height_differs) return v;
    v.sheet = is_sheet(truth, p, ray, right, double(hit.drop));
    if (v.sheet) v.facet_differs = v.height_differs = false;
    for (const Vec2 way : {Vec2{1, 0}, Vec2{-1, 0}, Vec2{0, 1}, Vec2{0, -1}, Vec2{0.7, 0.7}, Vec2{-0.7, -0.7},
                           Vec2{0.7, -0.7}, Vec2{-0.7, 0.7}}) {
        const TruthHit near = ask(truth, p, ray, way * border);
        if (!same_facet(near.hit, right.hit) || std::abs(near.drop - right.drop) > 0.05 * p.detail.depth)
            v.border = true;
    }
    return v;
}

Truth truth_of_stored(const PreparedPattern& p) {
    TruthOptions options;
    options.level_tolerance = 4e-5;
    return Truth(p.stored, options);
}

Result<PreparedPattern> prepare_pattern(const Pattern& pattern, const GridOptions& options) {
    PreparedPattern p;
    auto resolved = resolve_pattern(pattern);
    if (!resolved) return resolved.error();
    p.resolved = std::move(*resolved);
    const auto grid = build_grid(p.resolved, options);
    if (!grid) return grid.error();
    auto textures = pack_textures(p.resolved, *grid);
    if (!textures) return textures.error();
    p.textures = std::move(*textures);
    p.detail = describe_pattern(p.resolved, p.textures);
    auto stored = unpack_textures(p.textures, p.detail);
    if (!stored) return stored.error();
    p.stored = stored->pattern;
    for (std::uint32_t texel = 0; texel < p.textures.sections.element_texels;) {
        p.element_texels.push_back(texel);
        texel += element_texel_count(data_texel(p.textures, texel));
    }
    p.element_texels.resize(p.stored.elements.size());
    return p;
}

void put_pattern(const PreparedPattern& pattern, MaterialInfo& material) {
    material.has_detail = true;
    material.detail = pattern.detail;
    material.textures = pattern.textures;
}

std::vector<AimedRay> aim_rays(const PreparedPattern& p, int count, std::uint64_t seed) {
    Random random(seed);
    std::vector<AimedRay> rays;
    for (int i = 0; i < count; ++i) {
        const RayKind kind =
            i % 2 == 0 ? RayKind::feature : (i % 4 == 1 ? RayKind::junction : RayKind::anywhere);
        const Vec2 at = aim(p, kind, random);
        const double tangent = random.chance(0.1) ? 0.0 : 3.0 * random.uniform();
        const Vec2 slope = random.direction() * tangent;
        const Vec2 origin = at - slope * (random.uniform() * p.detail.depth);
        rays.push_back({{{float(origin.x), float(origin.y)}, {float(slope.x), float(slope.y)}}, kind});
    }
    return rays;
}

double Agreement::facet_share(RayKind kind) const {
    const int k = int(kind);
    const int asked = rays[std::size_t(k)] - borders[std::size_t(k)];
    return asked > 0 ? 1.0 - double(facet_differs[std::size_t(k)]) / asked : 1.0;
}

std::string Agreement::report(const std::string& name) const {
    std::string text;
    for (int k = 0; k < kRayKinds; ++k) {
        char row[200];
        const std::size_t i = std::size_t(k);
        std::snprintf(
            row, sizeof row,
            "%-10s %-10s %7d rays  same facet %9.5f %%  height off %5d  at borders %5d  sheets %4d\n",
            name.c_str(), kRayKindNames[k], rays[i], 100.0 * facet_share(RayKind(k)), height_differs[i],
            borders[i], sheets[i]);
        text += row;
    }
    char row[100];
    std::snprintf(row, sizeof row, "%-10s worst height %.2e of range, not met %d\n", name.c_str(),
                  worst_height, not_met);
    return text + row;
}

Agreement judge(const PreparedPattern& p, const std::vector<AimedRay>& rays,
                const std::vector<ShadedHit>& hits) {
    constexpr double kBorder = 2e-5;
    const Truth truth = truth_of_stored(p);
    std::vector<Verdict> verdicts(rays.size());
    in_parallel(rays.size(), [&](std::size_t i) { verdicts[i] = compare_hit(truth, p, rays[i].ray, hits[i], kBorder); });
    Agreement sum;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const std::size_t k = std::size_t(rays[i].kind);
        const Verdict& v = verdicts[i];
        ++sum.rays[k];
        sum.borders[k] += v.border && !v.sheet;
        sum.sheets[k] += v.sheet;
        sum.facet_differs[k] += v.facet_differs && !v.border;
        sum.height_differs[k] += v.height_differs && !v.border;
        if (!v.facet_differs && !v.sheet)
            sum.worst_height = std::max(sum.worst_height, v.border ? 0.0 : v.height);
        if ((v.facet_differs || v.height_differs) && !v.border && sum.worst.size() < 2000) {
            const PatternRay& r = rays[i].ray;
            const TruthHit right = ask(truth, p, r, {});
            char row[300];
            std::snprintf(row, sizeof row,
                          "  %s ray %zu origin %.6f %.6f slope %.4f %.4f: met drop %.7f element %d facet %d, "
                          "truth drop "
                          "%.7f element %d facet %d\n",
                          kRayKindNames[k], i, double(r.origin[0]), double(r.origin[1]), double(r.slope[0]),
                          double(r.slope[1]), double(hits[i].drop), int(hits[i].element), hits[i].facet,
                          right.drop,
                          right.hit.element == kGround ? -1 : int(p.element_texels[right.hit.element]),
                          int(right.hit.facet));
            sum.worst += row;
        }
    }
    return sum;
}

std::vector<ShadedHit> decode_rays(const PreparedPattern& p, const std::vector<AimedRay>& rays) {
    const Decoder decoder(p.textures, p.detail);
    std::vector<ShadedHit> hits(rays.size());
    in_parallel(rays.size(), [&](std::size_t i) {
        const PatternRay& r = rays[i].ray;
        const DecodedHit hit = decoder.trace({double(r.origin[0]), double(r.origin[1])},
                                             {double(r.slope[0]), double(r.slope[1])});
        hits[i] = {float(hit.drop),
                   hit.element,
                   hit.facet,
                   {float(hit.normal[0]), float(hit.normal[1]), float(hit.normal[2])}};
    });
    return hits;
}

}  // namespace burin::testing
