// The residual of maps whose slopes are known, read back by a reader of its own from what the specification says.
#include <burin/residual.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace burin {
namespace {

constexpr double kPi = 3.14159265358979323846;

Image image_of(int w, int h, const std::function<double(double u, double v)>& height) {
    Image image(w, h);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) image.at(x, y) = static_cast<float>(height((x + 0.5) / w, (y + 0.5) / h));
    return image;
}

// A hill of 0.8 of the range, off the middle, level at the borders.
double hill(double u, double v) {
    return 0.1 + 0.8 * std::exp(-((u - 0.6) * (u - 0.6) + (v - 0.35) * (v - 0.35)) / (2 * 0.1 * 0.1));
}

struct Slopes {
    double along_u, along_v;
};

// Section 13 of the specification: interpolated, then divided by blue.
Slopes slopes_at(const Residual& residual, double u, double v, Wrap wrap) {
    const RgbaImage& p = residual.picture;
    const double x = u * p.width - 0.5, y = v * p.height - 0.5;
    double sums[3] = {0, 0, 0};
    for (int k = 0; k < 4; ++k) {
        int i = static_cast<int>(std::floor(x)) + k % 2, j = static_cast<int>(std::floor(y)) + k / 2;
        const double weight = (1 - std::abs(x - i)) * (1 - std::abs(y - j));
        i = wrap == Wrap::repeat ? (i + p.width) % p.width : std::clamp(i, 0, p.width - 1);
        j = wrap == Wrap::repeat ? (j + p.height) % p.height : std::clamp(j, 0, p.height - 1);
        for (std::size_t c = 0; c < 3; ++c)
            sums[c] += weight * (p.texels[4 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(p.width) +
                                               static_cast<std::size_t>(i)) + c] / 127.5 - 1.0);
    }
    return {-residual.scale * sums[0] / sums[2], residual.scale * sums[1] / sums[2]};
}

Residual bake(const Image& map, const Image& paths, Wrap wrap, const ResidualOptions& options = {}, Vec2 size = {1, 1},
              double depth = 0.2) {
    auto residual = bake_residual(map, paths, size, depth, wrap, options);
    EXPECT_TRUE(residual.ok());
    return residual ? std::move(*residual) : Residual{};
}

Image grain(int side, double deviation) {
    std::mt19937 random(7);
    std::normal_distribution<double> value(0.5, deviation);
    return image_of(side, side, [&](double, double) { return value(random); });
}

TEST(ResidualMap, SoftHillTakesAFewTexels) {
    const Residual r = bake(image_of(256, 256, hill), Image(256, 256, 0.1f), Wrap::repeat, {.tolerance = 1.0, .unneeded = 1.0});
    EXPECT_GT(r.error_without, 10.0);
    EXPECT_LE(r.error, 1.0);
    EXPECT_GE(r.picture.width, 8);
    EXPECT_LE(r.picture.width, 32);
    EXPECT_FALSE(r.png.empty());
}

TEST(ResidualMap, SlopesLeanAsTheSpecificationSays) {
    // Texels are square; the tile is twice as wide as high, so that u and v differ in metres.
    const Residual r = bake(image_of(256, 128, hill), Image(256, 128, 0.1f), Wrap::repeat, {.tolerance = 1.0}, {2, 1});
    const auto along_u = [](double u, double v) { return (hill(u + 1e-4, v) - hill(u - 1e-4, v)) / 2e-4 * 0.2 / 2; };
    const auto along_v = [](double u, double v) { return (hill(u, v + 1e-4) - hill(u, v - 1e-4)) / 2e-4 * 0.2 / 1; };
    for (const Vec2 at : {Vec2{0.5, 0.35}, Vec2{0.7, 0.35}, Vec2{0.6, 0.25}, Vec2{0.6, 0.45}, Vec2{0.67, 0.42}}) {
        const Slopes s = slopes_at(r, at.x, at.y, Wrap::repeat);
        EXPECT_NEAR(s.along_u, along_u(at.x, at.y), 0.06) << at.x << " " << at.y;
        EXPECT_NEAR(s.along_v, along_v(at.x, at.y), 0.06) << at.x << " " << at.y;
    }
    // The hill's near side, where height grows along v: the normal leans up the picture, and green says so.
    EXPECT_GT(slopes_at(r, 0.6, 0.25, Wrap::repeat).along_v, 0.3);
}

TEST(ResidualMap, OnlyWhatThePathsLeaveIsInIt) {
    const Image map = image_of(128, 128, [](double u, double v) { return (u < 0.5 ? 0.6 : 0.3) * hill(u, v); });
    const Image paths = image_of(128, 128, [](double u, double) { return u < 0.5 ? 0.06 : 0.03; });
    const Residual r = bake(map, paths, Wrap::repeat, {.tolerance = 1.5});
    EXPECT_LT(r.error, 0.2 * r.error_without);
    // The wall between both levels is the paths' own.
    EXPECT_NEAR(slopes_at(r, 0.5, 0.9, Wrap::repeat).along_u, 0.0, 0.05);
}

TEST(ResidualMap, GrainTakesAllItIsGiven) {
    const Image map = grain(64, 0.1), flat(64, 64, 0.5f);
    const Residual whole = bake(map, flat, Wrap::repeat);
    EXPECT_EQ(whole.picture.width, 64);
    EXPECT_LT(whole.error, 2.25);
    // Closer where more is asked, for more bytes.
    const Residual closer = bake(map, flat, Wrap::repeat, {.tolerance = 1.0});
    EXPECT_LT(closer.error, 1.0);
    EXPECT_GT(closer.png.size(), whole.png.size());
    // A 64th of the texels holds nothing of it, so that none are spent.
    const Residual bound = bake(map, flat, Wrap::repeat, {.most_texels = 64});
    EXPECT_EQ(bound.picture.width, 0);
    EXPECT_EQ(bound.error, bound.error_without);
    EXPECT_GT(bound.error, 30.0);
}

TEST(ResidualMap, KeepsToItsBytes) {
    const Image map = image_of(256, 256, hill), flat(256, 256, 0.1f);
    const ResidualOptions close{.tolerance = 0.3, .unneeded = 0.3};
    const Residual free = bake(map, flat, Wrap::repeat, close);
    ResidualOptions tight = close;
    tight.most_bytes = free.png.size();
    EXPECT_EQ(bake(map, flat, Wrap::repeat, tight).png, free.png);
    EXPECT_FALSE(free.is_short);
    tight.most_bytes = free.png.size() - 1;
    const Residual smaller = bake(map, flat, Wrap::repeat, tight);
    EXPECT_TRUE(smaller.is_short);
    EXPECT_LE(smaller.png.size(), tight.most_bytes);
    EXPECT_LT(smaller.error, smaller.error_without);
    tight.most_bytes = 0;
    const Residual none = bake(map, flat, Wrap::repeat, tight);
    EXPECT_TRUE(none.is_short);
    EXPECT_EQ(none.picture.width, 0);
    EXPECT_EQ(none.error, none.error_without);
    // What would not have been taken anyway is not missed.
    const ResidualOptions fussy{.unneeded = 0.0, .worthwhile = 1.0, .most_bytes = 0};
    const Image wave = image_of(64, 64, [](double u, double) { return 0.5 + 0.05 * std::sin(2 * kPi * u); });
    EXPECT_FALSE(bake(wave, Image(64, 64, 0.5f), Wrap::repeat, fussy).is_short);
}

TEST(ResidualMap, NothingLeftGivesNone) {
    const Residual constant = bake(Image(32, 16, 0.7f), Image(32, 16, 0.7f), Wrap::clamp);
    EXPECT_EQ(constant.picture.width, 0);
    EXPECT_TRUE(constant.png.empty());
    EXPECT_EQ(constant.error, 0.0);
    const Residual equal = bake(grain(32, 0.1), grain(32, 0.1), Wrap::repeat);
    EXPECT_EQ(equal.picture.width, 0);
    // Half a degree is left: not needed.
    const Image ripple = image_of(64, 64, [](double u, double) { return 0.5 + 0.01 * std::sin(2 * kPi * u); });
    EXPECT_EQ(bake(ripple, Image(64, 64, 0.5f), Wrap::repeat).picture.width, 0);
    EXPECT_GT(bake(ripple, Image(64, 64, 0.5f), Wrap::repeat, {.unneeded = 0.1}).picture.width, 0);
    EXPECT_EQ(bake(grain(32, 0.1), Image(32, 32, 0.5f), Wrap::repeat, {.most_texels = 0}).picture.width, 0);
}

TEST(ResidualMap, GoesOnAcrossTheSeam) {
    const auto wave = [](double phase) {
        return image_of(128, 128, [=](double u, double v) {
            return 0.5 + 0.2 * std::sin(2 * kPi * (u + phase)) + 0.2 * std::sin(2 * kPi * (v + phase));
        });
    };
    const Image flat(128, 128, 0.5f);
    const Residual seam = bake(wave(0.0), flat, Wrap::repeat, {.tolerance = 1.0});
    // Steepest right at the seam, on both sides alike.
    for (const double u : {0.999, 0.001}) {
        EXPECT_NEAR(slopes_at(seam, u, 0.25, Wrap::repeat).along_u, 0.2 * 0.2 * 2 * kPi, 0.02) << u;
        EXPECT_NEAR(slopes_at(seam, 0.25, u, Wrap::repeat).along_v, 0.2 * 0.2 * 2 * kPi, 0.02) << u;
    }
    EXPECT_NEAR(seam.error, bake(wave(0.31), flat, Wrap::repeat, {.tolerance = 1.0}).error, 0.3);
    // A ramp is level where it is clamped, and has a cliff at its seam where it repeats.
    const Image ramp = image_of(64, 64, [](double u, double) { return u; });
    const Residual clamped = bake(ramp, Image(64, 64, 0.5f), Wrap::clamp, {.tolerance = 1.0});
    EXPECT_LT(clamped.error, 0.5);
    EXPECT_LE(clamped.picture.width, 4);
    EXPECT_NEAR(slopes_at(clamped, 0.999, 0.5, Wrap::clamp).along_u, 0.2, 0.01);
    EXPECT_GT(bake(ramp, Image(64, 64, 0.5f), Wrap::repeat).error_without, clamped.error_without + 5.0);
}

TEST(ResidualMap, WallsDoNotTiltTheGroundBesideThem) {
    // The paths' wall stands half a texel off; that shows in the wall's own texels alone.
    const Image map = image_of(128, 128, [](double u, double) { return u < 0.5 ? 0.9 : 0.1; });
    Image paths = map;
    for (int y = 0; y < 128; ++y) paths.at(64, y) = 0.5f;
    const Residual r = bake(map, paths, Wrap::clamp, {.tolerance = 0.0, .unneeded = 0.0, .most_texels = 256});
    EXPECT_LE(r.error, r.error_without);
    if (r.picture.width > 0) {
        EXPECT_NEAR(slopes_at(r, 0.44, 0.5, Wrap::clamp).along_u, 0.0, 0.05);
    }
}

TEST(ResidualMap, LargeMapsAreAskedHereAndThere) {
    // Beyond 2^20 texels the figure is one of samples; the angle of a ramp is known.
    const Image ramp = image_of(1500, 1400, [](double u, double) { return u; });
    const Residual r = bake(ramp, Image(1500, 1400, 0.5f), Wrap::clamp, {.most_texels = 0}, {1, 1}, 1.0);
    EXPECT_NEAR(r.error_without, 45.0, 1e-3);
}

TEST(ResidualMap, ThreadsDoNotShow) {
    const Image map = grain(96, 0.05), flat(96, 96, 0.5f);
    for (const double tolerance : {0.5, 20.0}) {
        const Residual one = bake(map, flat, Wrap::repeat, {.tolerance = tolerance, .threads = 1});
        const Residual four = bake(map, flat, Wrap::repeat, {.tolerance = tolerance, .threads = 4});
        EXPECT_EQ(one.picture.texels, four.picture.texels);
        EXPECT_EQ(one.scale, four.scale);
        EXPECT_EQ(one.error, four.error);
    }
}

TEST(ResidualMap, OddSidesAndLinesOfTexelsWork) {
    for (const auto& [w, h] : {std::pair{37, 53}, std::pair{1, 64}, std::pair{64, 1}, std::pair{1, 1}, std::pair{3, 2}}) {
        const Image map = image_of(w, h, [](double u, double v) { return 0.5 + 0.4 * std::sin(9 * u + 7 * v); });
        for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
            const Residual r = bake(map, Image(w, h, 0.5f), wrap, {.tolerance = 2.0});
            EXPECT_TRUE(std::isfinite(r.error));
            EXPECT_LE(r.error, r.error_without);
        }
    }
}

}  // namespace
}  // namespace burin
