// compare.hpp, compare_edges: walls moved by a known way, at many angles, places within the texel, and
// sharpness.
#include <burin/compare.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

#include "../sampled_image.hpp"

namespace burin {
namespace {

using Surface = std::function<double(double, double)>;

// Box-filtered, as image.hpp says.
Image map_of(const Surface& surface, int width, int height) { return testing::sampled_image(width, height, 24, surface); }

double wall(double distance, double width) {
    if (width <= 0.0) return distance < 0.0 ? 0.2 : 0.8;
    return 0.2 + 0.6 * std::clamp(distance / width + 0.5, 0.0, 1.0);
}

// Distances to the wall grow to the right; `moved` outwards by so much.
Surface straight(double angle, double moved, double width) {
    const Vec2 normal{std::cos(angle), std::sin(angle)};
    return [=](double x, double y) { return wall(dot(normal, {x - 24.0, y - 24.0}) - 0.3 - moved, width); };
}

Surface disc(double moved, double width) {
    return [=](double x, double y) { return wall(17.3 + moved - length(Vec2{x - 24.2, y - 23.7}), width); };
}

class MovedWall : public ::testing::TestWithParam<double> {};  // width of the wall, texels

TEST_P(MovedWall, a_straight_one_reports_the_way) {
    for (const double degrees : {0.0, 7.0, 30.0, 44.0, 45.0, 71.0, 90.0, 123.0, 180.0, 270.0}) {
        for (const double phase : {0.0, 0.2, 0.45, 0.7}) {
            const double angle = degrees * M_PI / 180.0;
            const Image input = map_of(straight(angle, phase, GetParam()), 48, 48);
            const Image moved = map_of(straight(angle, phase + 0.25, GetParam()), 48, 48);
            const EdgeError same = compare_edges(input, input, Wrap::clamp);
            EXPECT_EQ(same.rms, 0.0);
            EXPECT_EQ(same.p999, 0.0);
            const EdgeError edges = compare_edges(moved, input, Wrap::clamp);
            EXPECT_NEAR(edges.rms, 0.25, 0.02) << degrees << " degrees, phase " << phase;
            EXPECT_EQ(edges.rms_found, edges.rms);
            // Where the wall leaves a map that does not repeat, the border row takes its place.
            EXPECT_NEAR(edges.p999, 0.25, 0.16) << degrees << " degrees, phase " << phase;
            EXPECT_EQ(edges.lost, 0.0);
            const double across = std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
            EXPECT_NEAR(edges.length, 48.0 / across, 4.0) << degrees;
        }
    }
}

TEST_P(MovedWall, a_round_one_reports_the_way_and_its_length) {
    const Image input = map_of(disc(0.0, GetParam()), 48, 48);
    for (const double way : {0.1, 0.25, -0.25, 0.8, 1.5}) {
        const EdgeError edges = compare_edges(map_of(disc(way, GetParam()), 48, 48), input, Wrap::repeat);
        EXPECT_NEAR(edges.rms, std::abs(way), 0.02 + 0.02 * std::abs(way)) << way;
        EXPECT_EQ(edges.lost, 0.0);
        EXPECT_NEAR(edges.length, 2.0 * M_PI * 17.3, 5.0);
    }
}

INSTANTIATE_TEST_SUITE_P(widths, MovedWall, ::testing::Values(0.0, 1.0, 2.5, 5.0));

TEST(compare_edges, across_the_border_of_a_repeating_map) {
    const auto strip = [](double moved) {
        return [=](double x, double) { return std::fmod(x + 32.0 - moved, 32.0) < 12.0 ? 0.9 : 0.1; };
    };
    const Image input = map_of(strip(0.0), 32, 8);
    const EdgeError edges = compare_edges(map_of(strip(0.25), 32, 8), input, Wrap::repeat);
    EXPECT_NEAR(edges.length, 16.0, 1e-9);
    EXPECT_NEAR(edges.rms, 0.25, 0.02);
    EXPECT_NEAR(compare_edges(input, input, Wrap::clamp).length, 8.0, 1e-9);
}

// Both walls of a narrow groove count, and neither is taken for the other.
TEST(compare_edges, a_narrow_groove) {
    const auto groove = [](double moved) {
        return
            [=](double x, double y) { return std::abs(0.8 * x + 0.6 * y - 30.2 - moved) < 1.0 ? 0.3 : 0.8; };
    };
    const Image input = map_of(groove(0.0), 48, 48);
    EXPECT_NEAR(compare_edges(map_of(groove(0.25), 48, 48), input, Wrap::clamp).rms, 0.25, 0.02);
    EXPECT_NEAR(compare_edges(map_of(groove(1.9), 48, 48), input, Wrap::clamp).rms, 1.9, 0.1);
    const EdgeError gone = compare_edges(Image(48, 48, 0.8f), input, Wrap::clamp);
    EXPECT_EQ(gone.lost, 1.0);
    EXPECT_EQ(gone.rms, 2.0);
    EXPECT_EQ(gone.rms_found, 0.0);
    EXPECT_EQ(gone.p999, 2.0);
}

TEST(compare_edges, half_of_the_edges_lost) {
    const auto two = [](bool both) {
        return [=](double x, double) { return (x > 10.4 ? 0.3 : 0.0) + (x > 22.7 && both ? 0.3 : 0.0); };
    };
    const EdgeError edges = compare_edges(map_of(two(false), 32, 16), map_of(two(true), 32, 16), Wrap::clamp);
    EXPECT_NEAR(edges.lost, 0.5, 1e-12);
    EXPECT_NEAR(edges.rms_found, 0.0, 1e-6);
    EXPECT_NEAR(edges.rms, std::sqrt(2.0), 1e-6);
}

// A reconstruction whose heights are wrong by a few per cent, or whose walls are steeper, has its edges in
// place.
TEST(compare_edges, heights_and_steepness_alone_do_not_move_an_edge) {
    const Image input = map_of(disc(0.0, 2.0), 48, 48);
    Image lower = input;
    for (float& t : lower.texels) t = 0.03f + 0.94f * t;
    EXPECT_LT(compare_edges(lower, input, Wrap::clamp).rms, 0.01);
    EXPECT_LT(compare_edges(map_of(disc(0.0, 0.0), 48, 48), input, Wrap::clamp).rms, 0.02);
}

TEST(compare_edges, what_is_no_strong_edge) {
    const auto length_of = [](const Image& map) {
        const EdgeError edges = compare_edges(Image(map.width, map.height, 0.5f), map, Wrap::repeat);
        EXPECT_TRUE(std::isfinite(edges.rms) && std::isfinite(edges.rms_found) && std::isfinite(edges.p999) &&
                    std::isfinite(edges.lost));
        if (edges.length <= 0.0) {
            EXPECT_EQ(edges.rms + edges.rms_found + edges.p999 + edges.lost, 0.0);
        }
        return edges.length;
    };
    EXPECT_EQ(length_of(Image(40, 30, 0.7f)), 0.0);
    EXPECT_EQ(length_of(Image(1, 1, 0.7f)), 0.0);
    EXPECT_EQ(
        length_of(map_of(
            [](double x, double y) { return 0.5 + 0.2 * std::sin(M_PI * x / 24) * std::cos(M_PI * y / 24); },
            48, 48)),
        0.0);
    // Grey steps of an 8-bit ramp.
    EXPECT_EQ(
        length_of(map_of([](double x, double) { return std::floor(std::abs(x - 24) * 1.5) / 255; }, 48, 48)),
        0.0);
    std::mt19937 random(7);
    std::normal_distribution<float> grain(0.5f, 0.05f);
    Image noise(64, 64);
    for (float& t : noise.texels) t = grain(random);
    EXPECT_EQ(length_of(noise), 0.0);
}

// Grain well below the wall shifts the figure by about what it shifts the contour.
TEST(compare_edges, grain_on_the_map) {
    std::mt19937 random(3);
    std::normal_distribution<float> grain(0.0f, 0.02f);
    Image input = map_of(disc(0.0, 1.0), 48, 48);
    for (float& t : input.texels) t += grain(random);
    EXPECT_LT(compare_edges(map_of(disc(0.0, 1.0), 48, 48), input, Wrap::clamp).rms, 0.12);
    const EdgeError moved = compare_edges(map_of(disc(0.5, 1.0), 48, 48), input, Wrap::clamp);
    EXPECT_NEAR(moved.rms, 0.5, 0.03);
    EXPECT_NEAR(moved.length, 2.0 * M_PI * 17.3, 6.0);
}

}  // namespace
}  // namespace burin
