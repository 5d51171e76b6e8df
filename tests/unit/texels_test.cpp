// Exact round trip of the words, and the stated worst error of every quantizer.
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <burin/format/texels.hpp>

namespace burin {
namespace {

class Texels : public testing::Test {
  protected:
    void SetUp() override {
        seed_ = std::random_device{}();
        random_.seed(seed_);
        std::printf("seed %u\n", seed_);
    }
    std::uint32_t below(std::uint32_t limit) {
        return std::uniform_int_distribution<std::uint32_t>(0, limit - 1)(random_);
    }
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }

    std::uint32_t seed_ = 0;
    std::mt19937 random_;
};

TEST_F(Texels, CellsSurviveAllBits) {
    SCOPED_TRACE("seed " + std::to_string(seed_));
    for (int k = 0; k < 10000; ++k) {
        const CellTexel texel = {static_cast<std::uint32_t>(random_()),
                                 static_cast<std::uint32_t>(random_())};
        ASSERT_EQ(pack_cell(unpack_cell(texel)), texel);
    }
    const CellCode full{(1u << 20) - 1, 63, 15, 3, 65535, 255, 255};
    EXPECT_EQ(unpack_cell(pack_cell(full)), full);
}

TEST_F(Texels, ElementsSurviveAllBits) {
    SCOPED_TRACE("seed " + std::to_string(seed_));
    for (int k = 0; k < 20000; ++k) {
        Texel a{}, b{}, c{};
        for (std::uint32_t& word : a) word = static_cast<std::uint32_t>(random_());
        for (std::uint32_t& word : b) word = static_cast<std::uint32_t>(random_());
        for (std::uint32_t& word : c) word = static_cast<std::uint32_t>(random_());
        c[2] &= 0xFFFFu, c[3] = 0;
        if ((a[2] & 1u << 28) != 0) a[2] |= 1u << 29;
        if (!element_has_texel_b(a)) b = {};
        if (!element_has_texel_c(a)) c = {};
        const std::array<Texel, 3> packed = pack_element(unpack_element(a, b, c));
        ASSERT_EQ(packed[0], a);
        ASSERT_EQ(packed[1], b);
        ASSERT_EQ(packed[2], c);
    }
}

TEST_F(Texels, FieldsLieWhereTheLayoutSays) {
    ElementCode e;
    e.p0 = {1, 2};
    e.p1 = {3, 4};
    e.p2 = {5, 6};
    e.start = {BURIN_PRIORITY_LEFT, BURIN_CORNER_ROUND, 7};
    e.end = {BURIN_PRIORITY_BOTH, BURIN_END_CLIP, 8};
    e.quadratic = e.has_texel_b = true;
    e.style = 9;
    e.width0 = 10, e.width1 = 11, e.height0 = 12, e.height1 = 13;
    e.has_texel_c = true;
    e.argument0 = 14, e.argument1 = 15, e.function = 16;
    const std::array<Texel, 3> t = pack_element(e);
    EXPECT_EQ(t[0],
              (Texel{1u | 7u << 20, 2u | 8u << 20, 5u | 9u << 20 | 3u << 24 | 7u << 28, 6u | 9u << 20}));
    EXPECT_EQ(t[1], (Texel{3u, 4u, 10u | 11u << 16, 12u | 13u << 16}));
    EXPECT_EQ(t[2], (Texel{14u, 15u, 16u, 0u}));
    FunctionCode f;
    f.kind = BURIN_FUNCTION_NOISE, f.octaves = 5, f.width = -1, f.height = 2, f.seed = 3, f.period = 4;
    EXPECT_EQ(pack_function(f)[0], (Texel{2u | 5u << 2, 0x0002FFFFu, 3u, 4u}));
    EXPECT_EQ(unpack_function(pack_function(f)), f);
    FunctionCode p;
    p.kind = BURIN_FUNCTION_POLYNOMIAL, p.coefficients = {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f, 8.0f};
    EXPECT_EQ(pack_function(p)[1], (Texel{0x3F800000u, 0x40000000u, 0x40400000u, 0x40800000u}));
    EXPECT_EQ(unpack_function(pack_function(p)), p);
    const StyleCode s{1, 2, true, 3, 4, 5, 1.0f, 6};
    EXPECT_EQ(pack_style(s), (Texel{1u | 2u << 16 | 1u << 22 | 3u << 23, 4u | 5u << 16, 0x3F800000u, 6u}));
    EXPECT_EQ(pack_cell({1, 2, 3, 2, 4, 5, 6}),
              (CellTexel{1u | 2u << 20 | 3u << 26 | 2u << 30, 4u | 5u << 16 | 6u << 24}));
    EXPECT_EQ(pack_profile_point({-1, 2}), 0x0002FFFFu);
}

TEST_F(Texels, StylesProfilesAndMaterialsSurvive) {
    SCOPED_TRACE("seed " + std::to_string(seed_));
    for (int k = 0; k < 10000; ++k) {
        const auto word = static_cast<std::uint32_t>(random_());
        ASSERT_EQ(pack_profile_point(unpack_profile_point(word)), word);
        StyleCode s{below(65536), below(64),    below(2) == 1, below(512),
                    below(65536), below(65536), 0.5f,          word};
        ASSERT_EQ(unpack_style(pack_style(s)), s);
        MaterialCode m;
        for (std::uint32_t& channel : m.base_color) channel = below(256);
        m.metallic = below(256), m.roughness = below(256), m.overrides = below(2) == 1;
        ASSERT_EQ(unpack_material(pack_material(m)), m);
    }
}

// Largest |decode(encode(v)) - v| over the ends, zero, exact halves of a step, and random values.
template <typename Code>
double worst_error(const std::function<bool(double, Code&)>& encode,
                   const std::function<double(Code)>& decode, double low, double high, double step,
                   const std::function<double()>& random) {
    double worst = 0.0;
    const auto look = [&](double value) {
        Code code{};
        ASSERT_TRUE(encode(value, code)) << value;
        worst = std::max(worst, std::abs(decode(code) - value));
    };
    look(low), look(high), look(0.5 * (low + high));
    if (low <= 0.0 && high >= 0.0) look(0.0);
    for (int k = 0; k < 1000; ++k) {
        look(low + (k + 0.5) * step);
        look(high - (k + 0.5) * step);
    }
    for (int k = 0; k < 100000; ++k) look(random());
    return worst;
}

TEST_F(Texels, CoordinatesKeepTheirBound) {
    SCOPED_TRACE("seed " + std::to_string(seed_));
    const double step = 1.0 / 524288.0, high = 1.5 - step;
    const double worst = worst_error<std::uint32_t>(encode_coordinate, decode_coordinate, -0.5, high, step,
                                                    [&] { return between(-0.5, high); });
    EXPECT_LE(worst, std::ldexp(1.0, -20) * (1 + 1e-5));
    EXPECT_GE(worst, std::ldexp(1.0, -20) * 0.99);
}

TEST_F(Texels, CoordinatesOfNeighbouringTilesDifferByOneTile) {
    SCOPED_TRACE("seed " + std::to_string(seed_));
    for (int k = 0; k < 100000; ++k) {
        // Half of them exactly between two codes, where rounding noise would decide.
        double uv = between(-0.5, 0.499);
        if (k % 2 == 0) uv = (std::floor(uv * 524288.0) + 0.5) / 524288.0;
        const double metres = between(0.01, 30.0);
        std::uint32_t here = 0, beyond = 0;
        ASSERT_TRUE(encode_coordinate(uv * metres / metres, here));
        ASSERT_TRUE(encode_coordinate((uv * metres + metres) / metres, beyond));
        ASSERT_EQ(beyond - here, 524288u) << uv << " of " << metres;
    }
}

TEST_F(Texels, ClipAnglesKeepTheirBoundAndTurnModuloPi) {
    SCOPED_TRACE("seed " + std::to_string(seed_));
    constexpr double pi = std::numbers::pi;
    for (int k = 0; k < 100000; ++k) {
        const double angle = between(-10.0, 10.0);
        std::uint32_t code = 0, turned = 0;
        ASSERT_TRUE(encode_clip_angle(angle, code));
        ASSERT_TRUE(encode_clip_angle(angle + pi, turned));
        ASSERT_EQ(code, turned);
        const double off = std::remainder(decode_clip_angle(code) - angle, pi);
        ASSERT_LE(std::abs(off), pi / 8192.0 * (1 + 1e-6));
    }
    std::uint32_t code = 9;
    for (const double angle : {0.0, pi, -pi, pi - 1e-9, 1e-18, -1e-18}) {
        ASSERT_TRUE(encode_clip_angle(angle, code));
        EXPECT_EQ(code, 0u) << angle;
    }
    EXPECT_FALSE(encode_clip_angle(NAN, code));
}

TEST_F(Texels, ScalesKeepTheirBound) {
    SCOPED_TRACE("seed " + std::to_string(seed_));
    const double step = 1.0 / 16384.0, high = 4.0 - step;
    EXPECT_LE(worst_error<std::uint32_t>(encode_scale, decode_scale, 0.0, high, step,
                                         [&] { return between(0.0, high); }),
              std::ldexp(1.0, -15) * (1 + 1e-6));
    std::uint32_t code = 0;
    for (const double exact : {0.0, 1.0, 2.0, 3.0}) {
        ASSERT_TRUE(encode_scale(exact, code));
        EXPECT_EQ(decode_scale(code), exact);
    }
}

TEST_F(Texels, UnormAndSnormKeepTheirBounds) {
    SCOPED_TRACE("seed " + std::to_string(seed_));
    const auto unit = [&] { return between(0.0, 1.0); };
    EXPECT_LE(worst_error<std::uint32_t>(encode_unorm16, decode_unorm16, 0, 1, 1 / 65535.0, unit),
              1 / 131070.0 * (1 + 1e-6));
    EXPECT_LE(worst_error<std::uint32_t>(encode_unorm8, decode_unorm8, 0, 1, 1 / 65536.0, unit),
              1 / 510.0 * (1 + 1e-6));
    EXPECT_LE(worst_error<std::int32_t>(encode_snorm16, decode_snorm16, -1, 1, 1 / 32767.0,
                                        [&] { return between(-1.0, 1.0); }),
              1 / 65534.0 * (1 + 1e-6));
    for (const double exact : {0.0, 1.0}) {
        std::uint32_t code = 0;
        ASSERT_TRUE(encode_unorm16(exact, code));
        EXPECT_EQ(decode_unorm16(code), exact);
    }
    for (const double exact : {-1.0, 0.0, 1.0}) {
        std::int32_t code = 0;
        ASSERT_TRUE(encode_snorm16(exact, code));
        EXPECT_EQ(decode_snorm16(code), exact);
    }
    EXPECT_EQ(decode_snorm16(-32768), -1.0);
}

TEST_F(Texels, BoundsRoundToTheirSide) {
    SCOPED_TRACE("seed " + std::to_string(seed_));
    for (int k = 0; k < 100000; ++k) {
        const double value = k < 256 ? k / 255.0 : between(0.0, 1.0);
        std::uint32_t low = 0, high = 0;
        ASSERT_TRUE(encode_unorm8_floor(value, low));
        ASSERT_TRUE(encode_unorm8_ceil(value, high));
        ASSERT_LE(decode_unorm8(low), value + 1e-9);
        ASSERT_GE(decode_unorm8(high), value - 1e-9);
        ASSERT_LE(high - low, 1u);
        if (k < 256) {
            ASSERT_EQ(low, high);
        }
    }
}

TEST_F(Texels, OutOfRangeIsRefusedAndLeavesTheCode) {
    std::uint32_t code = 77;
    std::int32_t signed_code = 77;
    for (const double bad : {-0.51, 1.5, 1e300, -1e300, HUGE_VAL, static_cast<double>(NAN)}) {
        EXPECT_FALSE(encode_coordinate(bad, code)) << bad;
    }
    for (const double bad : {-0.001, 4.0, static_cast<double>(NAN), HUGE_VAL})
        EXPECT_FALSE(encode_scale(bad, code)) << bad;
    for (const double bad : {-0.01, 1.01, static_cast<double>(NAN)}) {
        EXPECT_FALSE(encode_unorm16(bad, code)) << bad;
        EXPECT_FALSE(encode_unorm8(bad, code)) << bad;
        EXPECT_FALSE(encode_unorm8_floor(bad, code)) << bad;
        EXPECT_FALSE(encode_unorm8_ceil(bad, code)) << bad;
    }
    for (const double bad : {-1.001, 1.001, static_cast<double>(NAN)})
        EXPECT_FALSE(encode_snorm16(bad, signed_code)) << bad;
    EXPECT_EQ(code, 77u);
    EXPECT_EQ(signed_code, 77);
}

}  // namespace
}  // namespace burin
