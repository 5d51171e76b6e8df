// Perturbations along paths where the surface has a closed form, what resolve makes of them, and what it refuses.
#include <cmath>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include <burin/evaluate.hpp>
#include <burin/pack.hpp>
#include <burin/rasterize.hpp>

#include "../elements.hpp"

namespace burin {
namespace {

using testing::make_arc;
using testing::make_line;

constexpr double kHalf = 0.03, kDeep = 0.004;

Perturbation sine(double width, double height, double wavelength, double phase = 0.0) {
    Perturbation p;
    p.width = width, p.height = height;
    p.wavelength = wavelength, p.phase = phase;
    return p;
}

Perturbation noise(double width, double height, double wavelength, int octaves) {
    Perturbation p = sine(width, height, wavelength);
    p.kind = PerturbationKind::noise;
    p.octaves = octaves, p.seed = 99;
    return p;
}

// Factors that are the argument itself, so that heights show it.
Perturbation ramp() {
    Perturbation p;
    p.kind = PerturbationKind::polynomial;
    p.height_polynomial[0] = 0.0, p.height_polynomial[1] = 1.0;
    return p;
}

// One path with a V of half-width 0.03 and depth 0.004.
Pattern pattern_of(std::vector<Element> elements, const Perturbation& perturbation, bool closed = false) {
    Pattern pattern;
    pattern.depth = 0.02;
    pattern.profiles = {{{{-kHalf, 0}, {0, -kDeep}, {kHalf, 0}}, {}}};
    Path path;
    path.elements = std::move(elements);
    path.closed = closed;
    path.perturbation = 0;
    pattern.paths = {path};
    pattern.perturbations = {perturbation};
    return pattern;
}

Pattern straight(const Perturbation& perturbation) {
    return pattern_of({make_line({0.1, 0.5}, {0.9, 0.5})}, perturbation);
}

std::vector<Element> circle(Vec2 c, double r) {
    std::vector<Element> elements;
    const double part = 2.0 * std::numbers::pi / 8;
    const auto at = [&](double k, double radius) {
        return Vec2{c.x + radius * std::cos(k * part), c.y + radius * std::sin(k * part)};
    };
    for (int i = 0; i < 8; ++i)
        elements.push_back(make_arc(at(i, r), at(i + 0.5, r / std::cos(0.5 * part)), at((i + 1) % 8, r)));
    return elements;
}

ResolvedPattern resolve(const Pattern& pattern) {
    Result<ResolvedPattern> result = resolve_pattern(pattern);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? *result : ResolvedPattern{};
}

std::string refusal(const Pattern& pattern) {
    const Result<ResolvedPattern> result = resolve_pattern(pattern);
    return result.ok() ? "accepted" : result.error().message;
}

double vee(double b, double width, double height) {
    return std::abs(b) >= kHalf * width ? 0.0 : -kDeep * height * (1.0 - std::abs(b) / (kHalf * width));
}

TEST(Perturbation, SineOnALineInClosedForm) {
    Pattern pattern = straight(sine(0.3, -0.4, 0.13, 0.2));
    Element& e = pattern.paths[0].elements[0];
    e.width0 = 0.6, e.width1 = 1.4, e.height0 = 1.0, e.height1 = 2.0;
    const Truth truth(resolve(pattern));
    for (double x = 0.11; x < 0.9; x += 0.0137)
        for (double b = -0.05; b < 0.05; b += 0.0071) {
            const double s = (x - 0.1) / 0.8;
            const double wave = std::sin(2.0 * std::numbers::pi * ((x - 0.1) / 0.13 + 0.2));
            const double expected = vee(b, (0.6 + 0.8 * s) * (1.0 + 0.3 * wave), (1.0 + s) * (1.0 - 0.4 * wave));
            EXPECT_NEAR(truth.surface_at({x, 0.5 + b}).height, expected, 1e-12) << x << ", " << b;
        }
}

// The normal is that of the surface, asked beside the point.
TEST(Perturbation, NormalsFollowTheFactors) {
    Perturbation cubic;
    cubic.kind = PerturbationKind::polynomial;
    for (int i = 0; i < 4; ++i) cubic.width_polynomial[i] = 1.0 / (1 + i), cubic.height_polynomial[i] = 0.4;
    for (const Perturbation& p : {sine(0.3, -0.4, 0.13, 0.2), noise(0.5, 0.5, 0.2, 3), cubic})
        for (const Element& e : {make_line({0.1, 0.5}, {0.9, 0.5}), make_arc({0.1, 0.5}, {0.5, 0.3}, {0.9, 0.5})}) {
            const Truth truth(resolve(pattern_of({e}, p)));
            for (double s = 0.07; s < 0.95; s += 0.053) {
                const Vec2 on = e.kind == ElementKind::line ? lerp(e.p0, e.p2, s) : lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s);
                const Vec2 at = on + Vec2{0.0, 0.006};
                const SurfacePoint point = truth.surface_at(at);
                const auto slope = [&](Vec2 d) {
                    return (truth.surface_at(at + d).height - truth.surface_at(at - d).height) / (2.0 * length(d));
                };
                EXPECT_NEAR(point.normal[0] / point.normal[2], -slope({1e-6, 0}), 1e-5);
                EXPECT_NEAR(point.normal[1] / point.normal[2], -slope({0, 1e-6}), 1e-5);
            }
        }
}

TEST(Perturbation, ArgumentRunsThroughCornersAndJoints) {
    const Truth truth(resolve(pattern_of(
        {make_line({0.1, 0.2}, {0.5, 0.2}), make_line({0.5, 0.2}, {0.5, 0.4}), make_line({0.5, 0.4}, {0.7, 0.4})}, ramp())));
    for (const double u : {0.1, 0.45, 0.6, 0.7, 0.9}) {
        const double x = 0.8 * u;
        const Vec2 on = x < 0.4 ? Vec2{0.1 + x, 0.2} : x < 0.6 ? Vec2{0.5, x - 0.2} : Vec2{x - 0.1, 0.4};
        EXPECT_NEAR(truth.surface_at(on).height, -kDeep * u, 1e-12) << u;
    }
}

// Arc length of a quadratic: to a quarter of a percent of its own, for turns up to 90 degrees.
TEST(Perturbation, ArgumentOfACurveIsItsArcLength) {
    double worst = 0.0;
    for (double turn = 0.1; turn <= 90.0; turn += 8.99)
        for (const double second : {0.02, 0.1, 0.2, 0.4}) {
            const double a = turn * std::numbers::pi / 180.0;
            const Vec2 p0{0.2, 0.5}, p1{0.45, 0.5}, p2 = p1 + Vec2{std::cos(a), std::sin(a)} * second;
            const Truth truth(resolve(pattern_of({make_arc(p0, p1, p2)}, ramp())));
            constexpr int kParts = 2000;
            std::vector<double> metres{0.0};
            const auto at = [&](double s) { return lerp(lerp(p0, p1, s), lerp(p1, p2, s), s); };
            for (int i = 0; i < kParts; ++i)
                metres.push_back(metres.back() + length(at((i + 1.0) / kParts) - at(static_cast<double>(i) / kParts)));
            for (int i = 50; i < kParts; i += 50) {
                const double argument = truth.surface_at(at(static_cast<double>(i) / kParts)).height / -kDeep;
                worst = std::max(worst, std::abs(argument - metres[static_cast<std::size_t>(i)] / metres.back()));
            }
        }
    EXPECT_LT(worst, 0.0025);
    RecordProperty("worst", std::to_string(worst));
}

TEST(Perturbation, ClosedPathsClose) {
    for (const double count : {7.4, 0.2, 2.6}) {
        const double lap = 2.0 * std::numbers::pi * 0.2;
        for (const Perturbation& p : {sine(0.3, 0.4, lap / count, 0.3), noise(0.3, 0.4, lap / count, 3)}) {
            const ResolvedPattern resolved = resolve(pattern_of(circle({0.5, 0.5}, 0.2), p, true));
            ASSERT_FALSE(resolved.elements.empty());
            const double phase = p.kind == PerturbationKind::sine ? 0.3 : 0.0, whole = std::max(1.0, std::round(count));
            EXPECT_EQ(resolved.elements.front().element.argument0, phase);
            EXPECT_EQ(resolved.elements.back().element.argument1, phase + whole);
            const Truth truth(resolved);
            const auto height = [&](double y) { return truth.surface_at({0.7, 0.5 + y}).height; };
            EXPECT_NEAR(height(-1e-9), height(1e-9), 1e-9);
            EXPECT_NEAR(height(-1e-4) - height(0.0), height(0.0) - height(1e-4), 2e-6);
        }
    }
}

// Octaves and seeds change noise; it stays within its amplitude, reaches about that, and has no jump.
TEST(Perturbation, NoiseIsSmoothAndBounded) {
    double depths[3][2000];
    for (int k = 0; k < 3; ++k) {
        Perturbation p = noise(0.0, 0.5, 0.01, k == 2 ? 4 : 1);
        p.seed = static_cast<std::uint32_t>(k);
        const Truth truth(resolve(straight(p)));
        double least = 1e9, most = 0.0;
        for (int i = 0; i < 2000; ++i) {
            depths[k][i] = truth.surface_at({0.1 + 0.8 * (i + 0.5) / 2000.0, 0.5}).height / -kDeep;
            least = std::min(least, depths[k][i]), most = std::max(most, depths[k][i]);
            // At 1/25 of a wavelength from each other; the slope is at most 3 amplitudes per wavelength and octave.
            const double step = i > 0 ? depths[k][i] - depths[k][i - 1] : 0.0;
            EXPECT_LT(std::abs(step), 0.5 * 3.0 * 4 * 0.04 + 1e-9);
        }
        EXPECT_GE(least, 0.5);
        EXPECT_LE(most, 1.5);
        EXPECT_LT(least, 0.7);
        EXPECT_GT(most, 1.3);
    }
    int differ = 0;
    for (int i = 0; i < 2000; ++i) differ += std::abs(depths[0][i] - depths[1][i]) > 0.05 ? 1 : 0;
    EXPECT_GT(differ, 1000);
}

// Split at a step, and cut to the tile: each piece goes on where the one before ended.
TEST(Perturbation, ArgumentGoesOnThroughSplits) {
    Pattern pattern = pattern_of({make_line({0.1, 0.5}, {1.05, 0.5})}, sine(0.2, 0.2, 0.1));
    Path step;
    step.elements = {make_line({0.4, 0.3}, {0.6, 0.3}), make_line({0.6, 0.3}, {0.6, 0.7}), make_line({0.6, 0.7}, {0.4, 0.7}),
                     make_line({0.4, 0.7}, {0.4, 0.3})};
    step.closed = true;
    step.profile = 1;
    pattern.profiles.push_back({{{-0.01, 0}, {0.01, -0.003}}, {}});
    pattern.paths.push_back(step);
    const ResolvedPattern resolved = resolve(pattern);
    int pieces = 0;
    double argument = 0.0;
    for (const ResolvedElement& e : resolved.elements) {
        if (e.path != 0) {
            EXPECT_EQ(e.function, kNoFunction);
            continue;
        }
        ++pieces;
        EXPECT_EQ(e.element.argument0, argument);
        argument = e.element.argument1;
        EXPECT_NEAR(e.element.argument1 - e.element.argument0, length(e.element.p2 - e.element.p0) / 0.1, 1e-9);
    }
    EXPECT_GE(pieces, 3);
    EXPECT_NEAR(argument, 9.5, 1e-9);
    const Truth truth(resolved);
    EXPECT_NEAR(truth.surface_at({0.525, 0.5}).height, -0.003 - kDeep * 1.2, 1e-9);  // 4.25 wavelengths from the start
}

TEST(Perturbation, EqualFunctionsAreOne) {
    Pattern pattern = straight(sine(0.2, 0.2, 0.1));
    pattern.perturbations.push_back(sine(0.2, 0.2, 0.3));
    pattern.paths.push_back(pattern.paths[0]);
    pattern.paths[1].elements = {make_line({0.1, 0.8}, {0.4, 0.8})};
    pattern.paths[1].perturbation = 1;
    const ResolvedPattern resolved = resolve(pattern);
    EXPECT_EQ(resolved.functions.size(), 1u);
    EXPECT_NEAR(resolved.elements.back().element.argument1, 1.0, 1e-12);
}

// The map of the surface is the mean of what the truth says, whatever short cuts the rasterizer takes.
TEST(Perturbation, RasterIsTheTruthsMean) {
    Pattern pattern = straight(noise(0.4, 0.4, 0.1, 2));
    Path curve;
    curve.elements = {make_arc({0.1, 0.8}, {0.5, 0.6}, {0.9, 0.8})};
    curve.perturbation = 0;
    pattern.paths.push_back(curve);
    const ResolvedPattern resolved = resolve(pattern);
    const Image map = rasterize_height(resolved, 64, 64, {.samples = 4});
    const Truth truth(resolved);
    double worst = 0.0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            double sum = 0.0;
            for (int j = 0; j < 4; ++j)
                for (int i = 0; i < 4; ++i)
                    sum += truth.surface_at({(x + (i + 0.5) / 4) / 64, (y + (j + 0.5) / 4) / 64}).height;
            worst = std::max(worst, std::abs(static_cast<double>(map.at(x, y)) - (1.0 + sum / 16 / pattern.depth)));
        }
    EXPECT_LT(worst, 1e-6);
}

// What textures hold of a function comes back to within their steps; a pattern without has no such section.
TEST(Perturbation, TexturesHoldFunctions) {
    Perturbation cubic = ramp();
    cubic.width_polynomial[3] = 0.7;
    Pattern pattern = straight(noise(0.4, -0.3, 0.1, 5));
    pattern.perturbations.push_back(cubic);
    pattern.paths.push_back(pattern.paths[0]);
    pattern.paths[1].elements = {make_arc({0.1, 0.8}, {0.4, 0.7}, {0.7, 0.8})};
    pattern.paths[1].perturbation = 1;
    const ResolvedPattern resolved = resolve(pattern);
    const auto grid = build_grid(resolved);
    ASSERT_TRUE(grid.ok());
    const auto textures = pack_textures(resolved, *grid);
    ASSERT_TRUE(textures.ok()) << textures.error().message;
    EXPECT_EQ(textures->sections.function_texels, 4u);
    // The line is cut in two to fit the tile: A and C each. The curve: A, B and C.
    EXPECT_EQ(textures->sections.element_texels, 7u);
    const auto stored = unpack_textures(*textures, describe_pattern(resolved, *textures));
    ASSERT_TRUE(stored.ok()) << stored.error().message;
    ASSERT_EQ(stored->pattern.functions.size(), 2u);
    const ScaleFunction& n = stored->pattern.functions[0];
    EXPECT_EQ(n.kind, PerturbationKind::noise);
    EXPECT_NEAR(n.width, 0.4, 1.0 / 65534);
    EXPECT_NEAR(n.height, -0.3, 1.0 / 65534);
    EXPECT_EQ(n.octaves, 5u);
    EXPECT_EQ(n.seed, 99u);
    EXPECT_EQ(n.period, 0u);
    EXPECT_NEAR(stored->pattern.functions[1].width_polynomial[3], 0.7, 1e-7);
    ASSERT_EQ(stored->pattern.elements.size(), 3u);
    EXPECT_EQ(stored->pattern.elements[1].function, 0u);
    EXPECT_NEAR(stored->pattern.elements[1].element.argument1, 8.0, 1.0 / 131072);
    EXPECT_EQ(stored->pattern.elements[2].function, 1u);
    EXPECT_EQ(stored->pattern.elements[2].element.argument1, 1.0);

    pattern.paths[0].perturbation = pattern.paths[1].perturbation = kNoPerturbation;
    const ResolvedPattern plain = resolve(pattern);
    const auto plain_textures = pack_textures(plain, *build_grid(plain));
    ASSERT_TRUE(plain_textures.ok());
    EXPECT_EQ(plain_textures->sections.function_texels, 0u);
    EXPECT_EQ(plain_textures->sections.element_texels, 3u);  // less wide, the line fits in one
    EXPECT_EQ(write_extension(describe_pattern(plain, *plain_textures)).find("functions"), std::string::npos);
}

TEST(Perturbation, Refusals) {
    const auto expect = [](const Pattern& pattern, const std::string& part) {
        EXPECT_NE(refusal(pattern).find(part), std::string::npos) << refusal(pattern);
    };
    Pattern missing = straight(sine(0.1, 0.1, 0.1));
    missing.paths[0].perturbation = 3;
    expect(missing, "uses perturbation 3 of 1");
    expect(straight(sine(1.2, 0.0, 0.1)), "amplitude 1.2");
    expect(straight(sine(0.0, std::nan(""), 0.1)), "amplitude");
    expect(straight(sine(0.1, 0.1, 0.0)), "wavelength 0");
    expect(straight(sine(0.1, 0.1, 0.1, INFINITY)), "phase");
    expect(straight(noise(0.1, 0.1, 0.1, 9)), "9 octaves");
    expect(straight(sine(0.1, 0.1, 1e-6)), "wavelengths long");
    Pattern wide = straight(sine(0.5, 0.0, 0.1));
    wide.paths[0].elements[0].width1 = 3.0;
    expect(wide, "width scales from");
    Perturbation low = ramp();
    low.width_polynomial[1] = -1.5;
    expect(straight(low), "to 1.000000 by its perturbation");
    expect(pattern_of(circle({0.5, 0.5}, 0.2), ramp(), true), "does not close");
    Pattern step = pattern_of(circle({0.5, 0.5}, 0.2), sine(0.2, 0.1, 0.1), true);
    step.profiles[0] = {{{-0.01, 0}, {0.01, -0.003}}, {}};
    expect(step, "height may not be perturbed");
    step.perturbations[0].height = 0.0;
    EXPECT_EQ(refusal(step), "accepted");
    Pattern deep = straight(sine(0.0, 0.9, 0.1));
    deep.paths[0].elements[0].height0 = deep.paths[0].elements[0].height1 = 2.0;
    deep.depth = 0.014;
    expect(deep, "reaches height");
}

}  // namespace
}  // namespace burin
