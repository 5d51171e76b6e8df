#include <burin/bake.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace burin {
namespace {

// Normal stored in a texel, unit length up to the 8 bits.
struct Normal {
    double x, y, z;
};

Normal normal_at(const RgbaImage& image, int x, int y) {
    const std::uint8_t* t =
        image.texels.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                   static_cast<std::size_t>(x));
    return {t[0] / 127.5 - 1, t[1] / 127.5 - 1, t[2] / 127.5 - 1};
}

Image slope_image(int w, int h, double along_x, double along_y) {
    Image image(w, h);
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            image.at(x, y) =
                static_cast<float>(0.5 + along_x * ((x + 0.5) / w - 0.5) + along_y * ((y + 0.5) / h - 0.5));
    return image;
}

TEST(Bake, RampsLeanAsGltfAsks) {
    // Height 0.5 m over 2 m along u, 0.25 m over 1 m along v: slope 0.25 both ways.
    const Fallback f =
        bake_fallback(slope_image(64, 64, 0.5, 0.25), {2, 1}, 1.0, Wrap::clamp, {.normal_tolerance = 0.0});
    ASSERT_EQ(f.normal.width, 64);
    const Normal n = normal_at(f.normal, 20, 40);
    const double scale = 1 / std::sqrt(1 + 2 * 0.25 * 0.25);
    EXPECT_NEAR(n.x, -0.25 * scale, 0.006);  // rises along +u: leans back
    EXPECT_NEAR(n.y, 0.25 * scale, 0.006);   // rises down the picture: leans up
    EXPECT_NEAR(n.z, scale, 0.006);
}

TEST(Bake, FlatMapsGiveNothing) {
    const Fallback f = bake_fallback(Image(32, 32, 0.7f), {1, 1}, 0.1, Wrap::repeat);
    EXPECT_EQ(f.normal.width, 0);
    EXPECT_EQ(f.occlusion.width, 0);
}

TEST(Bake, SmoothMapsGetSmallTexturesAndFineOnesLargeOnes) {
    Image smooth(256, 128), fine(256, 128);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) {
            smooth.at(x, y) = static_cast<float>(0.5 + 0.5 * std::sin(x * 2 * 3.14159265 / 256));
            fine.at(x, y) = x % 8 < 4 ? 1.0f : 0.0f;
        }
    const FallbackOptions options{.max_side = 256, .normal_tolerance = 1.0};
    const Fallback a = bake_fallback(smooth, {1, 0.5}, 0.05, Wrap::repeat, options);
    const Fallback b = bake_fallback(fine, {1, 0.5}, 0.05, Wrap::repeat, options);
    EXPECT_LE(a.normal.width, 64);
    EXPECT_EQ(a.normal.width, 2 * a.normal.height);
    EXPECT_LE(a.normal_error, 1.0);
    EXPECT_EQ(b.normal.width, 256);
    EXPECT_EQ(bake_fallback(fine, {1, 0.5}, 0.05, Wrap::repeat, {.max_side = 100}).normal.width, 100);
}

TEST(Bake, TilingMapsWrapAtTheirEdges) {
    Image saw(64, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 64; ++x) saw.at(x, y) = static_cast<float>(x) / 64.0f;
    const FallbackOptions options{.normal_tolerance = 0.0};
    // At the seam the saw falls: it leans the other way when it repeats.
    EXPECT_GT(normal_at(bake_fallback(saw, {1, 1}, 1.0, Wrap::repeat, options).normal, 63, 1).x, 0.5);
    EXPECT_LT(normal_at(bake_fallback(saw, {1, 1}, 1.0, Wrap::clamp, options).normal, 63, 1).x, 0.0);
}

TEST(Bake, GroovesAreDarkerThanTheirBanks) {
    Image groove(64, 64, 1.0f);
    for (int y = 0; y < 64; ++y)
        for (int x = 30; x < 34; ++x) groove.at(x, y) = 0.0f;
    const Fallback f = bake_fallback(groove, {1, 1}, 0.1, Wrap::clamp, {.normal_tolerance = 0.0});
    ASSERT_EQ(f.occlusion.width, 32);
    const auto at = [&](int x) { return f.occlusion.texels[4 * (16 * 32 + static_cast<std::size_t>(x))]; };
    EXPECT_LT(at(15), 150);
    EXPECT_GT(at(4), 250);
}

TEST(Bake, EqualInputGivesEqualTexels) {
    const Image image = slope_image(50, 30, 0.3, -0.4);
    EXPECT_EQ(bake_fallback(image, {1, 1}, 0.1, Wrap::repeat).normal.texels,
              bake_fallback(image, {1, 1}, 0.1, Wrap::repeat).normal.texels);
}

}  // namespace
}  // namespace burin
