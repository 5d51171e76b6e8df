// compare.hpp: the fast wide Gaussian against the direct sum in double precision, and the plain figures by
// hand.
#include <burin/compare.hpp>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace burin {
namespace {

int folded(int i, int n, bool wrap) {
    if (wrap) return ((i % n) + n) % n;
    const int m = ((i % (2 * n)) + 2 * n) % (2 * n);
    return m < n ? m : 2 * n - 1 - m;
}

// One axis of the Gaussian of DESIGN 7, texel by texel, 4 sigma wide.
std::vector<double> direct_blur(const std::vector<double>& in, int width, int height, bool wrap, bool across,
                                double sigma) {
    const int radius = static_cast<int>(std::floor(4.0 * sigma));
    std::vector<double> kernel;
    double sum = 0.0;
    for (int i = -radius; i <= radius; ++i) kernel.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    for (double w : kernel) sum += w;
    std::vector<double> out(in.size());
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            double v = 0.0;
            for (int i = -radius; i <= radius; ++i) {
                const int sx = across ? folded(x + i, width, wrap) : x;
                const int sy = across ? y : folded(y + i, height, wrap);
                v += kernel[static_cast<std::size_t>(i + radius)] *
                     in[static_cast<std::size_t>(sy * width + sx)];
            }
            out[static_cast<std::size_t>(y * width + x)] = v / sum;
        }
    }
    return out;
}

double direct_variance(const std::vector<double>& map, int width, int height, bool wrap) {
    const double sigma = std::min(width, height) / 16.0;
    const std::vector<double> rows = direct_blur(map, width, height, wrap, true, sigma);
    const std::vector<double> smooth = direct_blur(rows, width, height, wrap, false, sigma);
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < map.size(); ++i) {
        sum += map[i] - smooth[i];
        squares += (map[i] - smooth[i]) * (map[i] - smooth[i]);
    }
    const double n = static_cast<double>(map.size());
    return squares / n - (sum / n) * (sum / n);
}

double direct_explained(const Image& reconstruction, const Image& input, bool wrap) {
    std::vector<double> value, error;
    for (std::size_t i = 0; i < input.texels.size(); ++i) {
        value.push_back(static_cast<double>(input.texels[i]));
        error.push_back(static_cast<double>(input.texels[i]) - static_cast<double>(reconstruction.texels[i]));
    }
    return 1.0 - direct_variance(error, input.width, input.height, wrap) /
                     direct_variance(value, input.width, input.height, wrap);
}

// A map of soft ground, grooves, a plateau and grain, and a reconstruction that misses some of each.
struct Pair {
    Image input, reconstruction;
};

Pair make_pair(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> grain(0.0f, 0.02f);
    Pair pair{Image(width, height), Image(width, height)};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(width);
            const float v = static_cast<float>(y) / static_cast<float>(height);
            const float ground = 0.5f + 0.2f * std::sin(5.0f * u + 3.0f * v) + 0.1f * u;
            const float groove = std::fabs(std::sin(21.0f * u + 9.0f * v)) < 0.2f ? -0.2f : 0.0f;
            const float plateau = u > 0.3f && u < 0.6f && v > 0.2f && v < 0.9f ? 0.15f : 0.0f;
            pair.input.at(x, y) = ground + groove + plateau + grain(random);
            pair.reconstruction.at(x, y) = 0.5f + 0.9f * groove + (v > 0.22f ? plateau : 0.0f);
        }
    }
    return pair;
}

struct Size {
    int width, height;
};

class ExplainedAgainstDirect : public ::testing::TestWithParam<Size> {};

TEST_P(ExplainedAgainstDirect, within_1e_4) {
    const auto [width, height] = GetParam();
    const Pair pair = make_pair(width, height, 5);
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
        const Comparison c = compare_heights(pair.reconstruction, pair.input, wrap);
        EXPECT_NEAR(c.explained, direct_explained(pair.reconstruction, pair.input, wrap == Wrap::repeat),
                    1e-4)
            << width << " x " << height << (wrap == Wrap::repeat ? " repeat" : " clamp");
    }
}

INSTANTIATE_TEST_SUITE_P(sizes, ExplainedAgainstDirect,
                         ::testing::Values(Size{64, 64}, Size{257, 190}, Size{230, 391}, Size{500, 128},
                                           Size{420, 420}),
                         [](const auto& p) {
                             return std::to_string(p.param.width) + "x" + std::to_string(p.param.height);
                         });

TEST(compare_heights, equal_maps_are_explained_entirely) {
    const Pair pair = make_pair(70, 50, 1);
    const Comparison c = compare_heights(pair.input, pair.input, Wrap::clamp);
    EXPECT_EQ(c.explained, 1.0);
    EXPECT_EQ(c.rms, 0.0);
    EXPECT_EQ(c.max, 0.0);
    EXPECT_EQ(c.p999, 0.0);
}

TEST(compare_heights, a_flat_plane_explains_nothing) {
    const Pair pair = make_pair(128, 128, 2);
    const Comparison c = compare_heights(Image(128, 128, 0.3f), pair.input, Wrap::repeat);
    EXPECT_NEAR(c.input_variance, c.error_variance, 1e-12);
    for (unsigned seed = 0; seed < 8; ++seed)
        for (const float level : {0.0f, 0.3f, 0.7f, 1.0f})
            EXPECT_EQ(compare_heights(Image(128, 128, level), make_pair(128, 128, seed).input, Wrap::repeat)
                          .explained,
                      0.0);
}

TEST(compare_heights, a_wrong_level_shows_in_the_mean_and_not_in_explained) {
    const Pair pair = make_pair(96, 96, 3);
    Image lifted = pair.input;
    for (float& t : lifted.texels) t += 0.125f;
    const Comparison c = compare_heights(lifted, pair.input, Wrap::repeat);
    EXPECT_NEAR(c.mean_error, 0.125, 1e-6);
    EXPECT_NEAR(c.mean_abs, 0.125, 1e-6);
    EXPECT_NEAR(c.rms, 0.125, 1e-6);
    EXPECT_NEAR(c.explained, 1.0, 1e-9);
}

TEST(compare_heights, constant_input) {
    EXPECT_EQ(compare_heights(Image(32, 20, 0.7f), Image(32, 20, 0.7f), Wrap::repeat).explained, 1.0);
    EXPECT_EQ(compare_heights(Image(32, 20, 0.6f), Image(32, 20, 0.7f), Wrap::repeat).explained, 0.0);
    Image spot(32, 20, 0.7f);
    spot.at(3, 4) = 0.9f;
    EXPECT_EQ(compare_heights(spot, Image(32, 20, 0.7f), Wrap::clamp).explained, 0.0);
}

TEST(compare_heights, worst_texel_and_percentile) {
    Image input(100, 40, 0.5f), reconstruction(100, 40, 0.5f);
    reconstruction.at(17, 31) = 0.1f;
    reconstruction.at(90, 39) = 0.9f;
    // Four texels in 4000 may err by more than the 99.9th percentile; the fifth largest error is it.
    for (int i = 0; i < 3; ++i) reconstruction.at(i, 0) = 0.7f;
    const Comparison c = compare_heights(reconstruction, input, Wrap::clamp);
    EXPECT_EQ(c.worst_x, 17);
    EXPECT_EQ(c.worst_y, 31);
    EXPECT_NEAR(c.max, 0.4, 1e-6);
    EXPECT_NEAR(c.p999, 0.2, 1e-6);
    EXPECT_NEAR(c.rms, std::sqrt((2 * 0.16 + 3 * 0.04) / 4000.0), 1e-7);
}

// A bend of the ground that is missing shows in the errors, and hardly in those without the smooth part; a
// missing spot shows in both.
TEST(compare_heights, errors_without_the_smooth_part) {
    constexpr int n = 200;
    Image input(n, n), reconstruction(n, n, 0.5f);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            input.at(x, y) = 0.5f + 0.2f * static_cast<float>(std::cos(2.0 * M_PI * x / n));
    const Comparison bent = compare_heights(reconstruction, input, Wrap::repeat);
    const double left = 1.0 - std::exp(-2.0 * M_PI * M_PI / 256.0);  // see subtract_smooth below
    EXPECT_NEAR(bent.p999, 0.2, 1e-3);
    EXPECT_NEAR(bent.p999_without_smooth, 0.2 * left, 1e-3);
    EXPECT_NEAR(bent.rms_without_smooth, 0.2 * left / std::sqrt(2.0), 1e-3);
    for (int k = 0; k < 50; ++k) reconstruction.at(50, 2 * k) += 0.3f;
    EXPECT_NEAR(compare_heights(reconstruction, input, Wrap::repeat).p999_without_smooth, 0.3, 0.02);
}

TEST(compare_heights, one_texel) {
    const Comparison c = compare_heights(Image(1, 1, 0.25f), Image(1, 1, 0.75f), Wrap::repeat);
    EXPECT_DOUBLE_EQ(c.max, 0.5);
    EXPECT_DOUBLE_EQ(c.p999, 0.5);
    EXPECT_EQ(c.explained, 0.0);
}

TEST(subtract_smooth, takes_soft_ground_and_leaves_detail) {
    constexpr int n = 256;
    Image map(n, n);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const double soft = std::cos(2.0 * M_PI * x / n),
                         detail = 0.1 * std::cos(2.0 * M_PI * 40.0 * x / n);
            map.at(x, y) = static_cast<float>(soft + detail);
        }
    const Image high = subtract_smooth(map, Wrap::repeat);
    // The Gaussian of sigma n / 16 passes a wave of period n by exp(-2 (pi / 16)^2), and one of period n / 40
    // not at all.
    const double left = 1.0 - std::exp(-2.0 * M_PI * M_PI / 256.0);
    for (int x = 0; x < n; ++x) {
        const double expected =
            left * std::cos(2.0 * M_PI * x / n) + 0.1 * std::cos(2.0 * M_PI * 40.0 * x / n);
        EXPECT_NEAR(static_cast<double>(high.at(x, 100)), expected, 2e-4) << x;
    }
}

}  // namespace
}  // namespace burin
