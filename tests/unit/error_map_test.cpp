#include <burin/error_map.hpp>

#include <gtest/gtest.h>

#include <cstdlib>

namespace burin {
namespace {

int channel(std::uint32_t color, int shift) { return static_cast<int>(color >> shift & 255u); }

double luma(std::uint32_t color) {
    return 0.299 * channel(color, 16) + 0.587 * channel(color, 8) + 0.114 * channel(color, 0);
}

TEST(ErrorMap, WhiteBetweenRedAndBlue) {
    EXPECT_EQ(error_color(0.0), 0xffffffu);
    EXPECT_GT(channel(error_color(1.0), 16), channel(error_color(1.0), 0) + 80);
    EXPECT_GT(channel(error_color(-1.0), 0), channel(error_color(-1.0), 16) + 80);
    EXPECT_EQ(error_color(7.0), error_color(1.0));
    EXPECT_EQ(error_color(-7.0), error_color(-1.0));
}

TEST(ErrorMap, DarkerWithTheErrorAndAlikeOnBothSides) {
    for (int i = 1; i <= 100; ++i) {
        EXPECT_LE(luma(error_color(i / 100.0)), luma(error_color((i - 1) / 100.0)));
        EXPECT_LE(luma(error_color(-i / 100.0)), luma(error_color((1 - i) / 100.0)));
        EXPECT_NEAR(luma(error_color(i / 100.0)), luma(error_color(-i / 100.0)), 20.0);
    }
    EXPECT_LT(luma(error_color(1.0)), 100.0);
}

TEST(ErrorMap, FullColourIsARoundNumberNotBelowTheError) {
    const std::pair<double, double> cases[] = {{0.0, 0.001},   {0.001, 0.001}, {0.0011, 0.002}, {0.004, 0.005},
                                               {0.0123, 0.02}, {0.3, 0.5},     {0.51, 1.0},     {1.0, 1.0}};
    for (const auto& [p999, full] : cases) EXPECT_DOUBLE_EQ(full_error(p999), full) << p999;
}

TEST(ErrorMap, DrawsReconstructionLessMap) {
    Image map(3, 1, 0.5f), heights(3, 1, 0.5f);
    heights.at(0, 0) = 0.6f;
    heights.at(2, 0) = 0.45f;
    const RgbaImage picture = draw_error(heights, map, 0.1);
    const auto color = [&](std::size_t i) {
        const std::uint8_t* t = picture.texels.data() + 4 * i;
        EXPECT_EQ(t[3], 255);
        return static_cast<std::uint32_t>(t[0] << 16 | t[1] << 8 | t[2]);
    };
    ASSERT_EQ(picture.texels.size(), 12u);
    EXPECT_EQ(color(0), error_color(1.0));
    EXPECT_EQ(color(1), error_color(0.0));
    EXPECT_EQ(color(2), error_color(-0.5));
}

}  // namespace
}  // namespace burin
