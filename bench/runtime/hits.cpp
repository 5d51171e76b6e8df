// Question: does the decoder meet what the truth meets?
//
// Half of the rays are aimed at features, a quarter at junctions, a quarter anywhere; from upright down to 2 degrees above
// the plane. A ray counts under the kind of junction that its aim is nearest to, within one and a half widths of it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include <scenes/drawing.hpp>

#include "questions.hpp"

namespace burin::bench {
namespace {

using testing::PreparedPattern;
using testing::Verdict;

constexpr const char* kKinds[] = {"corner", "crossing", "tee", "isolated end", "star", "isolated", "anywhere"};
constexpr std::size_t kIsolated = 5, kAnywhere = 6, kKindCount = 7;

struct Aimed {
    PatternRay ray;
    std::size_t kind = kAnywhere;
};

double reach_of(const ResolvedPattern& pattern, const ResolvedElement& e) {
    double reach = 0.0;
    for (const ProfilePoint& point : pattern.profiles[pattern.styles[e.style].profile].points)
        reach = std::max(reach, std::abs(point.b));
    return std::max(reach * std::max(e.element.width0, e.element.width1), 1e-9);
}

Vec2 point_on(const Element& e, double s) {
    if (e.kind == ElementKind::line) return lerp(e.p0, e.p2, s);
    return lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s);
}

std::size_t kind_at(const Subject& subject, Vec2 at) {
    const ResolvedPattern& pattern = subject.prepared.resolved;
    double nearest = 1.5 * subject.width;
    std::size_t kind = kIsolated;
    for (const Junction& junction : pattern.junctions) {
        Vec2 off = at - junction.position;
        if (pattern.wrap == Wrap::repeat)
            off = off - Vec2{pattern.size.x * std::round(off.x / pattern.size.x), pattern.size.y * std::round(off.y / pattern.size.y)};
        if (std::abs(off.x) > nearest || std::abs(off.y) > nearest || length(off) > nearest) continue;
        nearest = length(off);
        kind = std::size_t(junction.kind);
    }
    return kind;
}

Vec2 direction(scenes::Chance& chance) {
    const double a = chance.between(0.0, 2.0 * std::numbers::pi);
    return {std::cos(a), std::sin(a)};
}

// Where ray `i` is aimed; the kind is found later, since that is slow.
Vec2 aim(const ResolvedPattern& pattern, double width, int i, scenes::Chance& chance) {
    if (i % 4 == 1 && !pattern.junctions.empty()) {
        const Junction& junction = pattern.junctions[std::size_t(chance.below(int(pattern.junctions.size())))];
        return junction.position + direction(chance) * (width * chance.uniform());
    }
    // Anywhere: a quarter of the tile beyond its borders, too, where a ray wraps, or comes onto a map from outside.
    if (i % 4 == 3 || pattern.elements.empty())
        return {chance.between(-0.25, 1.25) * pattern.size.x, chance.between(-0.25, 1.25) * pattern.size.y};
    const ResolvedElement& e = pattern.elements[std::size_t(chance.below(int(pattern.elements.size())))];
    return point_on(e.element, chance.between(-0.05, 1.05)) + direction(chance) * (reach_of(pattern, e) * 1.2 * chance.uniform());
}

std::vector<Aimed> aim_rays(const Subject& subject, int count, std::uint64_t seed) {
    const ResolvedPattern& pattern = subject.prepared.resolved;
    scenes::Chance chance(seed);
    std::vector<Aimed> rays;
    std::vector<Vec2> aims;
    for (int i = 0; i < count; ++i) {
        aims.push_back(aim(pattern, subject.width, i, chance));
        const double above = chance.uniform() < 0.1 ? 90.0 : chance.between(2.0, 90.0);
        const Vec2 slope = direction(chance) * (above < 90.0 ? 1.0 / std::tan(above * std::numbers::pi / 180.0) : 0.0);
        const Vec2 origin = aims.back() - slope * (chance.uniform() * pattern.depth);
        rays.push_back({{{float(origin.x), float(origin.y)}, {float(slope.x), float(slope.y)}}, kAnywhere});
    }
    testing::in_parallel(rays.size(), [&](std::size_t i) {
        if (i % 4 != 3) rays[i].kind = kind_at(subject, aims[i]);
    });
    return rays;
}

// One ray judged, with the distance in widths of the feature that the truth met.
struct Judged {
    Verdict verdict;
    double distance = 0.0;  // of the stored pattern's truth
    double authored = 0.0;  // of the pattern's before it was stored
    bool quadratic = false, on_feature = false;
};

struct Judge {
    const Subject& subject;
    Truth stored, authored;

    explicit Judge(const Subject& s)
        : subject(s), stored(testing::truth_of_stored(s.prepared)), authored(s.prepared.resolved) {}

    double width_of(std::uint32_t element) const {
        const ResolvedPattern& pattern = subject.prepared.stored;
        return element < pattern.elements.size() ? 2.0 * reach_of(pattern, pattern.elements[element]) : subject.width;
    }

    Judged operator()(const Aimed& aimed, const ShadedHit& hit) const {
        Judged judged;
        const double run = std::hypot(1.0, double(aimed.ray.slope[0]), double(aimed.ray.slope[1]));
        judged.verdict = testing::compare_hit(stored, subject.prepared, aimed.ray, hit, 1e-4 * subject.width);
        const RayHit& right = judged.verdict.truth;
        const double width = width_of(right.element);
        judged.distance = judged.verdict.height * subject.prepared.resolved.depth * run / width;
        judged.on_feature = right.element != kGround;
        judged.quadratic = judged.on_feature && subject.prepared.stored.elements[right.element].element.kind == ElementKind::quadratic;
        Ray ray;
        for (std::size_t k = 0; k < 2; ++k) ray.origin[k] = double(aimed.ray.origin[k]), ray.direction[k] = double(aimed.ray.slope[k]);
        ray.origin[2] = subject.prepared.resolved.base_offset;
        judged.authored = std::abs(authored.trace_ray(ray).t - double(hit.drop)) * run / width;
        return judged;
    }
};

struct Tally {
    int rays = 0, differs = 0, borders = 0, sheets = 0;
    std::vector<double> lines, quadratics, authored;  // distances

    void add(const Judged& judged) {
        const Verdict& v = judged.verdict;
        ++rays;
        authored.push_back(judged.authored);
        if (v.sheet) ++sheets;
        else if (v.border) ++borders;
        else if (v.facet_differs) ++differs;
        else if (judged.on_feature) (judged.quadratic ? quadratics : lines).push_back(judged.distance);
    }
};

std::string share_of(std::vector<double> values, double share) {
    if (values.empty()) return "";
    const auto place = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    char text[24];
    std::snprintf(text, sizeof text, "%.1e", *place);
    return text;
}

void print_row(const std::string& name, const char* decoder, const char* kind, const Tally& tally) {
    const int asked = tally.rays - tally.borders - tally.sheets;
    std::printf("| %s | %s | %s | %d | %.4f | %d | %d | %d | %s | %s | %s | %s | %s |\n", name.c_str(), decoder, kind, tally.rays,
                asked > 0 ? 100.0 * (1.0 - double(tally.differs) / asked) : 100.0, tally.differs, tally.borders, tally.sheets,
                share_of(tally.lines, 0.999).c_str(), share_of(tally.lines, 1.0).c_str(), share_of(tally.quadratics, 0.999).c_str(),
                share_of(tally.quadratics, 1.0).c_str(), share_of(tally.authored, 0.999).c_str());
}

// The first rays that met something else, so that they can be followed by hand.
void print_wrong(const Subject& subject, const std::vector<Aimed>& rays, const std::vector<ShadedHit>& hits,
                 const std::vector<Judged>& judged) {
    int printed = 0;
    for (std::size_t i = 0; i < rays.size() && printed < 6; ++i) {
        const Verdict& v = judged[i].verdict;
        const bool far = judged[i].on_feature && judged[i].distance > (judged[i].quadratic ? 1e-2 : 1e-3);
        if (v.border || v.sheet || !(v.facet_differs || far)) continue;
        ++printed;
        const PatternRay& r = rays[i].ray;
        std::fprintf(stderr, "%s: %s ray %zu at (%.9g, %.9g) slope (%.9g, %.9g): drop %.7g element %d facet %d, truth %.7g element %d facet %d\n",
                     subject.name.c_str(), kKinds[rays[i].kind], i, double(r.origin[0]), double(r.origin[1]), double(r.slope[0]),
                     double(r.slope[1]), double(hits[i].drop), int(hits[i].element), hits[i].facet, v.truth.t,
                     v.truth.element == kGround ? -1 : int(subject.prepared.element_texels[v.truth.element]), int(v.truth.facet));
    }
}

void judge_hits(const Subject& subject, const char* decoder, const std::vector<Aimed>& rays, const std::vector<ShadedHit>& hits) {
    const Judge judge(subject);
    std::vector<Judged> judged(rays.size());
    testing::in_parallel(rays.size(), [&](std::size_t i) { judged[i] = judge(rays[i], hits[i]); });
    Tally all, kinds[kKindCount];
    for (std::size_t i = 0; i < rays.size(); ++i) {
        all.add(judged[i]);
        kinds[rays[i].kind].add(judged[i]);
    }
    for (std::size_t kind = 0; kind < kKindCount; ++kind)
        if (kinds[kind].rays > 0) print_row(subject.name, decoder, kKinds[kind], kinds[kind]);
    print_row(subject.name, decoder, "**all**", all);
    std::fflush(stdout);
    print_wrong(subject, rays, hits, judged);
}

void measure(const Settings& settings, const Subject& subject) {
    constexpr std::uint64_t kSeed = 20100705;
    const std::vector<Aimed> rays = aim_rays(subject, settings.quick ? 10000 : 100000, kSeed);
    std::vector<testing::AimedRay> aimed;
    std::vector<PatternRay> bare;
    for (const Aimed& ray : rays) {
        aimed.push_back({ray.ray, testing::RayKind::anywhere});
        bare.push_back(ray.ray);
    }
    judge_hits(subject, "C++", rays, testing::decode_rays(subject.prepared, aimed));
    const auto hits = shade_rays(subject.prepared.textures, subject.prepared.detail, bare, settings.backend);
    if (hits) judge_hits(subject, "shader", rays, *hits);
    else std::printf("| %s | shader: %s |\n", subject.name.c_str(), hits.error().message.c_str());
}

}  // namespace

void ask_hits(const Settings& settings) {
    std::printf("\n### Hits against the truth\n\nSame facet away from borders (1e-4 of the mean feature width); distance along the ray in widths of the\n"
                "feature met, for hits on lines and on quadratics; the last column against the pattern before it was stored.\n\n"
                "| scene | decoder | kind | rays | same facet %% | wrong | borders | sheets | lines 99.9 %% | worst | quadratics 99.9 %% | worst | authored 99.9 %% |\n"
                "|---|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for_each_subject(settings, [&](const Subject& subject) { measure(settings, subject); }, false);
}

}  // namespace burin::bench
