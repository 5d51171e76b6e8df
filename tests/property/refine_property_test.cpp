// Refinement: its model against the truth's rasterization, its derivatives against differences, and what it must keep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <burin/rasterize.hpp>
#include <burin/refine.hpp>
#include <burin/resolve.hpp>

#include "../../bench/resolution/authored.hpp"
#include "../../lib/src/refine_forward.hpp"
#include "../../lib/src/refine_parameters.hpp"
#include "../../lib/src/refine_profile.hpp"
#include "random_pattern.hpp"

namespace burin {
namespace {

ResolvedPattern resolved(const Pattern& pattern) {
    Result<ResolvedPattern> result = resolve_pattern(pattern);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? std::move(*result) : ResolvedPattern{};
}

Image map_of(const Pattern& pattern, int width, int height, int samples) {
    RasterizeOptions options;
    options.samples = samples;
    options.level_tolerance = 1e-6;
    return rasterize_height(resolved(pattern), width, height, options);
}

// The pattern in texels and map scale, as the forward model wants it.
Pattern in_texels(Pattern p, int width) {
    const double inverse = width / p.size.x;
    for (Profile& profile : p.profiles)
        for (ProfilePoint& point : profile.points) point.b *= inverse, point.h /= p.depth;
    for (Path& path : p.paths) {
        path.level = 1.0 + (path.level - p.base_offset) / p.depth;
        for (Element& e : path.elements) e.p0 = e.p0 * inverse, e.p1 = e.p1 * inverse, e.p2 = e.p2 * inverse;
    }
    p.outer_level = 1.0 + (p.outer_level - p.base_offset) / p.depth;
    p.size = p.size * inverse;
    p.depth = p.base_offset = 1.0;
    return p;
}

bool same_bits(const Pattern& a, const Pattern& b) {
    for (std::size_t p = 0; p < a.paths.size(); ++p)
        for (std::size_t i = 0; i < a.paths[p].elements.size(); ++i) {
            const Element &x = a.paths[p].elements[i], &y = b.paths[p].elements[i];
            if (!(x.p0 == y.p0 && x.p1 == y.p1 && x.p2 == y.p2 && x.width0 == y.width0 && x.height1 == y.height1))
                return false;
        }
    for (std::size_t p = 0; p < a.profiles.size(); ++p)
        for (std::size_t k = 0; k < a.profiles[p].points.size(); ++k)
            if (a.profiles[p].points[k].b != b.profiles[p].points[k].b || a.profiles[p].points[k].h != b.profiles[p].points[k].h)
                return false;
    return true;
}

TEST(RefineProfile, MeanEqualsFineSampling) {
    testing::Random random(11);
    for (int trial = 0; trial < 200; ++trial) {
        refinement::SweptProfile profile;
        double b = random.between(-3, -1);
        for (int i = 0; i < 5; ++i) {
            profile.b.push_back(b);
            profile.h.push_back(random.between(-1, 1));
            b += random.chance(0.3) ? 0.001 : random.between(0.05, 1.5);
        }
        const double place = random.between(-4, 5);
        const refinement::Spread spread{random.between(1e-9, 1.0), random.between(1e-9, 1.0)};
        double d_b[refinement::kMaxPoints], d_h[refinement::kMaxPoints];
        const refinement::ProfileMean mean = refinement::profile_mean(profile, place, spread, d_b, d_h);
        const auto height = [&](double x) {
            if (x <= profile.b.front()) return profile.h.front();
            for (int i = 0; i < 4; ++i)
                if (x <= profile.b[i + 1])
                    return profile.h[i] + (profile.h[i + 1] - profile.h[i]) * (x - profile.b[i]) / (profile.b[i + 1] - profile.b[i]);
            return profile.h.back();
        };
        double sum = 0.0;
        const int n = 200;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i)
                sum += height(place + spread.u * ((i + 0.5) / n - 0.5) + spread.v * ((j + 0.5) / n - 0.5));
        // A wall may fall between two samples: one column of them.
        EXPECT_NEAR(mean.value, sum / (n * n), 2.5 / n) << "trial " << trial;
        const auto value = [&] { return refinement::profile_mean(profile, place, spread, nullptr, nullptr).value; };
        for (int i = 0; i < 5; ++i) {
            const double step = 1e-6, h = profile.h[i], at = profile.b[i], middle = value();
            profile.h[i] = h + step;
            EXPECT_NEAR(d_h[i], (value() - middle) / step, 1e-5) << "trial " << trial;
            profile.h[i] = h;
            profile.b[i] = at + step;
            const double high = value();
            profile.b[i] = at - step;
            EXPECT_NEAR(d_b[i], (high - value()) / (2 * step), 2e-2 + 1e-3 * std::abs(d_b[i])) << "trial " << trial;
            profile.b[i] = at;
        }
    }
}

// The forward model shares nothing with the truth but the meaning of a resolved pattern.
TEST(RefineForward, EqualsTheTruthsMapOnHardPatterns) {
    for (const unsigned seed : {2u, 3u, 5u, 7u, 10u, 13u, 16u, 22u}) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        testing::RandomPatternOptions options;
        if (seed % 2 == 0) options.wrap = Wrap::clamp;
        const Pattern pattern = in_texels(testing::random_pattern(seed, options), 320);
        const Image truth = map_of(pattern, 320, 320, 16);
        const ResolvedPattern input = resolved(pattern);
        const Image model = refinement::Forward(input, truth, {1.0, 1.0}, refinement::every_texel(320, 320)).image({});
        double squares = 0.0;
        int far = 0;
        for (std::size_t k = 0; k < truth.texels.size(); ++k) {
            const double d = model.texels[k] - truth.texels[k];
            squares += d * d;
            if (std::abs(d) > 0.03) ++far;
        }
        EXPECT_LT(std::sqrt(squares / static_cast<double>(truth.texels.size())), 4e-4);
        EXPECT_LE(far, 2);
    }
}

TEST(RefineForward, TexelsNeedNotBeSquare) {
    testing::RandomPatternOptions options;
    options.wrap = Wrap::clamp;
    options.step_loops = 0;
    const Pattern pattern = in_texels(testing::random_pattern(21, options), 300);
    const Image truth = map_of(pattern, 300, 200, 16);
    const ResolvedPattern input = resolved(pattern);
    const Image model = refinement::Forward(input, truth, {1.0, 1.5}, refinement::every_texel(300, 200)).image({});
    double squares = 0.0;
    for (std::size_t k = 0; k < truth.texels.size(); ++k) squares += std::pow(model.texels[k] - truth.texels[k], 2);
    EXPECT_LT(std::sqrt(squares / static_cast<double>(truth.texels.size())), 4e-4);
}

// A closed step within another, with a wall that is gentle on its inner side and steep on its outer one: the ground
// between them is neither's inside.
TEST(RefineForward, AStepMayBeSoftOnOneSideOnly) {
    Pattern pattern;
    pattern.size = {128.0, 128.0};
    pattern.depth = pattern.base_offset = 1.0;
    pattern.wrap = Wrap::clamp;
    pattern.outer_level = 1.0;
    pattern.profiles = {{{{-1.0, 0.0}, {1.0, -0.5}}, {}}, {{{-20.0, 0.0}, {-15.0, -0.1}, {1.0, -0.3}}, {}}};
    const auto square = [](double low, double high, bool right_inside) {
        const Vec2 a{low, low}, b{high, low}, c{high, high}, d{low, high};
        const std::vector<Vec2> corners = right_inside ? std::vector<Vec2>{a, b, c, d} : std::vector<Vec2>{a, d, c, b};
        Path path;
        path.closed = true;
        for (std::size_t i = 0; i < 4; ++i) {
            Element e;
            e.p0 = corners[i], e.p2 = corners[(i + 1) % 4];
            path.elements.push_back(e);
        }
        return path;
    };
    pattern.paths = {square(10.0, 118.0, true), square(40.0, 88.0, false)};
    pattern.paths[0].level = 1.0;
    pattern.paths[1].profile = 1;
    pattern.paths[1].level = 0.8;  // inside; 0.5 around it
    const Image truth = map_of(pattern, 128, 128, 16);
    EXPECT_NEAR(truth.at(64, 30), 0.5, 1e-3);
    const ResolvedPattern input = resolved(pattern);
    const refinement::Sampling sampling = refinement::every_texel(128, 128);
    const Image model = refinement::Forward(input, truth, {1.0, 1.0}, sampling).image({});
    for (std::size_t k = 0; k < truth.texels.size(); ++k) ASSERT_NEAR(model.texels[k], truth.texels[k], 0.01) << k;
}

// The weights of a map's texels: together all of them, each on its own where the map bends.
TEST(RefineSampling, EveryTexelIsSpokenFor) {
    const Pattern drawn = bench::plate(256, {5.0, 1.5});
    Image map = map_of(drawn, 256, 256, 4);
    map.height = 251;  // not a multiple of a block
    map.texels.resize(static_cast<std::size_t>(map.width) * map.height);
    for (const bool sparse : {false, true}) {
        const refinement::Sampling sampling = refinement::sample_map(map, sparse);
        std::size_t sum = 0, asked = 0;
        for (const std::uint8_t weight : sampling.weights) sum += weight, asked += weight > 0;
        EXPECT_EQ(sum, map.texels.size());
        EXPECT_LT(asked, map.texels.size() * (sparse ? 6 : 9) / 10);
    }
    const refinement::Sampling sampling = refinement::sample_map(map, false);
    for (int y = 1; y + 1 < map.height; ++y)
        for (int x = 1; x + 1 < map.width; ++x)
            if (std::abs(map.at(x - 1, y) - 2.0f * map.at(x, y) + map.at(x + 1, y)) > 0.05f) {
                EXPECT_EQ(sampling.at(x, y), 1) << x << ", " << y;
            }
}

// Moves one unknown and compares the change of the squared misfit with the gradient of the equations.
TEST(RefineForward, GradientEqualsDifferences) {
    const Pattern drawn = bench::plate(256, {5.0, 1.5});
    const Image map = map_of(drawn, 256, 256, 8);
    Pattern start = in_texels(bench::disturbed(drawn, 256, 0.3, 0.05, 5), 256);
    const refinement::Parameters parameters(start, RefineOptions{});
    const refinement::Sampling sampling = refinement::every_texel(256, 256);
    const auto misfit = [&](const std::vector<double>& step, std::vector<double>* gradient) {
        Pattern moved = start;
        refinement::Parameters own = parameters;
        own.apply(step, 10.0, moved);
        const ResolvedPattern input = resolved(moved);
        const std::vector<refinement::ElementUnknowns> elements = own.of_elements(moved, input);
        const refinement::Prediction prediction = refinement::Forward(input, map, {1.0, 1.0}, sampling).predict(elements, {});
        if (gradient) {
            gradient->assign(static_cast<std::size_t>(own.count()), 0.0);
            for (const refinement::Equations& part : prediction.parts)
                for (std::size_t e = 0; e < part.gradients.size(); ++e)
                    for (std::size_t k = 0; k < part.gradients[e].size(); ++k)
                        (*gradient)[elements[e].unknowns[k]] += part.gradients[e][k];
        }
        return refinement::robust_cost(prediction.residuals, 1e30);
    };
    std::vector<double> step(static_cast<std::size_t>(parameters.count()), 0.0), gradient;
    misfit(step, &gradient);
    double norm = 0.0;
    for (const double g : gradient) norm = std::max(norm, std::abs(g));
    int compared = 0;
    for (std::size_t i = 0; i < step.size(); i += 11) {
        constexpr double h = 2e-3;
        step[i] = h;
        const double high = misfit(step, nullptr);
        step[i] = -h;
        const double low = misfit(step, nullptr);
        step[i] = 0.0;
        // What moves with the borders between elements is left out of the derivative on purpose.
        EXPECT_NEAR(gradient[i], (high - low) / (2 * h), 0.02 * norm + 0.1 * std::abs(gradient[i])) << "unknown " << i;
        ++compared;
    }
    EXPECT_GT(compared, 20);
}

double cross_distance(const Pattern& a, const Pattern& b) {
    double worst = 0.0;
    for (std::size_t p = 0; p < a.paths.size(); ++p)
        for (std::size_t i = 0; i < a.paths[p].elements.size(); ++i) {
            const Element &x = a.paths[p].elements[i], &y = b.paths[p].elements[i];
            if (x.kind != ElementKind::line) continue;
            const Vec2 n = normal_of(unit(y.p2 - y.p0));
            worst = std::max({worst, std::abs(dot(x.p0 - y.p0, n)), std::abs(dot(x.p2 - y.p0, n))});
        }
    return worst;
}

// A closed step path of straight lines: a regular polygon.
Path ring(Vec2 centre, int corners, double radius, double level, std::uint32_t profile) {
    Path path;
    path.closed = true;
    path.level = level;
    path.profile = profile;
    const auto corner = [&](int k) {
        const double angle = 2.0 * std::numbers::pi * (k % corners + 0.5) / corners;
        return centre + Vec2{std::cos(angle), std::sin(angle)} * radius;
    };
    for (int k = 0; k < corners; ++k) path.elements.push_back({ElementKind::line, corner(k), {}, corner(k + 1)});
    return path;
}

// Without a path yet; texels and map scale.
Pattern ground_of_rings(double side, double level) {
    Pattern pattern;
    pattern.size = {side, side};
    pattern.depth = pattern.base_offset = 1.0;
    pattern.outer_level = level;
    return pattern;
}

// The wall of a step that closed in one iteration would not open again.
TEST(RefineParameters, WallsNarrowByDegrees) {
    Pattern pattern = ground_of_rings(64.0, 0.8);
    pattern.profiles.push_back({{{-1.0, 0.0}, {1.0, -0.35}}, {}});
    pattern.paths = {ring({30.0, 30.0}, 4, 10.0 * std::numbers::sqrt2, 0.8, 0)};
    refinement::Parameters parameters(pattern, RefineOptions{});
    const std::vector<ProfilePoint>& points = pattern.profiles[0].points;
    const double width = points.back().b - points.front().b;
    parameters.apply(std::vector<double>(static_cast<std::size_t>(parameters.count()), 5.0), 0.1, pattern);
    EXPECT_LT(points.back().b - points.front().b, width);
    EXPECT_GE(points.back().b - points.front().b, 0.49 * width);
}

TEST(Refine, FindsTheDrawingAgain) {
    for (const bench::Walls walls : {bench::Walls{6.0, 2.0}, bench::Walls{6.0, 0.4}, bench::Walls{2.0, 0.0}}) {
        SCOPED_TRACE(::testing::Message() << "groove " << walls.groove << ", wall " << walls.wall);
        const Pattern drawn = bench::plate(512, walls);
        const Image map = map_of(drawn, 512, 512, 20);
        Pattern pattern = bench::disturbed(drawn, 512, 0.3, 0.05, 3);
        ASSERT_GT(cross_distance(pattern, drawn) * 512, 0.15);
        const Result<RefineReport> report = refine_pattern(pattern, map);
        ASSERT_TRUE(report.ok()) << report.error().message;
        EXPECT_LT(report->rms_after, 1e-3);
        EXPECT_LT(cross_distance(pattern, drawn) * 512, 0.03);
        for (std::size_t k = 0; k < drawn.profiles[0].points.size(); ++k) {
            EXPECT_NEAR(pattern.profiles[0].points[k].b * 512, drawn.profiles[0].points[k].b * 512, 0.02);
            EXPECT_NEAR(pattern.profiles[0].points[k].h / drawn.depth, drawn.profiles[0].points[k].h / drawn.depth, 0.01);
        }
    }
}

TEST(Refine, KeepsStructure) {
    const Pattern drawn = bench::plate(512, {6.0, 1.0});
    const Image map = map_of(drawn, 512, 512, 8);
    Pattern pattern = bench::disturbed(drawn, 512, 0.3, 0.05, 9);
    const ResolvedPattern before = resolved(pattern);
    ASSERT_TRUE(refine_pattern(pattern, map).ok());
    const ResolvedPattern after = resolved(pattern);
    const auto count = [](const ResolvedPattern& r, JunctionKind kind) {
        return std::count_if(r.junctions.begin(), r.junctions.end(), [&](const Junction& j) { return j.kind == kind; });
    };
    for (const JunctionKind kind : {JunctionKind::corner, JunctionKind::crossing, JunctionKind::tee, JunctionKind::isolated_end})
        EXPECT_EQ(count(before, kind), count(after, kind));
    for (const Path& path : pattern.paths) {
        for (std::size_t i = 0; i + 1 < path.elements.size(); ++i) {
            const Element &e = path.elements[i], &f = path.elements[i + 1];
            EXPECT_TRUE(e.p2 == f.p0);
            if (e.kind != ElementKind::quadratic || f.kind != ElementKind::quadratic) continue;
            EXPECT_LT(std::abs(cross(unit(e.p2 - e.p1), unit(f.p1 - f.p0))), 1e-9);
        }
        if (path.closed) {
            EXPECT_TRUE(path.elements.back().p2 == path.elements.front().p0);
        }
    }
    const std::vector<ProfilePoint>& groove = pattern.profiles[0].points;
    EXPECT_NEAR(groove[0].b, -groove[3].b, 1e-15);
    EXPECT_EQ(groove[1].h, groove[2].h);
    EXPECT_EQ(groove[0].h, 0.0);
}

// Two rims that the map shows as one would cross when they are fitted; a square elsewhere is fitted all the same.
TEST(Refine, StepsThatWouldCrossKeepNothingElseFromMoving) {
    Pattern drawn = ground_of_rings(128.0, 0.4);
    for (const double rise : {0.4, 0.2}) drawn.profiles.push_back({{{-0.5, 0.0}, {0.5, -rise}}, {}});
    const Vec2 plateau{90.0, 84.0};
    Pattern start = drawn;
    drawn.paths = {ring({34.0, 34.0}, 4, 18.0, 0.8, 0), ring(plateau, 12, 20.0, 0.8, 0)};
    start.paths = {ring({34.3, 33.8}, 4, 18.2, 0.8, 0), ring(plateau, 12, 20.4, 0.6, 1), ring(plateau, 8, 19.55, 0.8, 1)};
    const Image map = map_of(drawn, 128, 128, 16);
    for (Pattern* p : {&drawn, &start}) ASSERT_TRUE(resolve_pattern(*p).ok());
    ASSERT_TRUE(refine_pattern(start, map).ok());
    EXPECT_TRUE(resolve_pattern(start).ok());
    ASSERT_EQ(start.paths.size(), 3u);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_LT(length(start.paths[0].elements[i].p0 - drawn.paths[0].elements[i].p0), 0.1);  // its start is off by 0.17 to 0.56
}

TEST(Refine, ThreadsDoNotMatter) {
    const Pattern drawn = bench::random_plate(256, {5.0, 1.0}, 4);
    const Image map = map_of(drawn, 256, 256, 4);
    const Pattern start = bench::disturbed(drawn, 256, 0.3, 0.05, 4);
    Pattern one = start, three = start;
    RefineOptions options;
    options.threads = 1;
    ASSERT_TRUE(refine_pattern(one, map, options).ok());
    options.threads = 3;
    ASSERT_TRUE(refine_pattern(three, map, options).ok());
    EXPECT_TRUE(same_bits(one, three));
    EXPECT_FALSE(same_bits(one, start));
}

// Hard patterns against their own maps, shaken: every one still resolves, none gets worse.
TEST(Refine, HardPatternsImproveOrStay) {
    int refined = 0;
    for (unsigned seed = 40; seed < 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        testing::RandomPatternOptions options;
        if (seed % 2 == 0) options.wrap = Wrap::clamp;
        const Pattern drawn = testing::random_pattern(seed, options);
        const Image map = map_of(drawn, 256, 256, 6);
        Pattern pattern = drawn;
        const double texel = pattern.size.x / 256;
        for (Profile& profile : pattern.profiles)
            for (ProfilePoint& point : profile.points) point.b *= 1.04;
        pattern.outer_level += 1e-5;
        for (Path& path : pattern.paths) {
            path.level += 1e-5;
            // As one: no junction is torn.
            for (Element& e : path.elements)
                for (Vec2* p : {&e.p0, &e.p1, &e.p2}) *p = *p + Vec2{0.2 * texel, -0.1 * texel};
        }
        const Result<RefineReport> report = refine_pattern(pattern, map);
        if (!report.ok()) continue;  // moved across the border of a clamped map
        EXPECT_LE(report->rms_after, 0.8 * report->rms_before + 1e-4);
        EXPECT_TRUE(resolve_pattern(pattern).ok());
        ++refined;
    }
    EXPECT_GE(refined, 7);
}

TEST(Refine, APatternThatTheMapContradictsIsNotWorseAfterwards) {
    const Pattern drawn = bench::random_plate(256, {5.0, 1.0}, 2);
    Image map(256, 256);
    testing::Random random(8);
    for (float& v : map.texels) v = static_cast<float>(random.uniform());
    Pattern pattern = drawn;
    const Result<RefineReport> report = refine_pattern(pattern, map);
    ASSERT_TRUE(report.ok());
    EXPECT_LE(report->rms_after, report->rms_before * 1.05);
    EXPECT_TRUE(resolve_pattern(pattern).ok());
    EXPECT_LT(cross_distance(pattern, drawn) * 256, 4.0);
}

// The fit knows linear scales alone, so what a function changes stays as it is.
TEST(Refine, APerturbedPatternComesBackAsItCame) {
    Pattern pattern;
    pattern.profiles = {{{{-0.05, 0}, {0, -0.003}, {0.05, 0}}, {}}};
    Path path;
    path.elements.resize(1);
    path.elements[0].p0 = {0.1, 0.3}, path.elements[0].p2 = {0.9, 0.7};
    pattern.paths = {path};
    const Image map = map_of(pattern, 64, 64, 2);
    pattern.paths[0].elements[0].p0.y = 0.31;
    Pattern waved = pattern;
    waved.perturbations.push_back({});
    waved.paths[0].perturbation = 0;
    const Pattern before = waved;
    const Result<RefineReport> report = refine_pattern(waved, map);
    ASSERT_TRUE(report.ok());
    EXPECT_EQ(report->iterations, 0);
    EXPECT_TRUE(same_bits(waved, before));
    EXPECT_EQ(waved.paths[0].perturbation, 0u);
    ASSERT_TRUE(refine_pattern(pattern, map).ok());
    EXPECT_FALSE(same_bits(pattern, before));
}

TEST(Refine, SaysWhatIsWrong) {
    Pattern pattern = bench::plate(256, {5.0, 1.0});
    const Pattern before = pattern;
    EXPECT_EQ(refine_pattern(pattern, Image{}).error().code, ErrorCode::invalid_argument);
    RefineOptions options;
    options.max_shift_texels = 0.0;
    EXPECT_EQ(refine_pattern(pattern, Image(8, 8), options).error().code, ErrorCode::invalid_argument);
    pattern.paths[0].profile = 99;
    EXPECT_FALSE(refine_pattern(pattern, Image(8, 8)).ok());
    pattern.paths[0].profile = before.paths[0].profile;
    EXPECT_TRUE(same_bits(pattern, before));
    Pattern empty;
    EXPECT_TRUE(refine_pattern(empty, Image(8, 8)).ok());
}

}  // namespace
}  // namespace burin
