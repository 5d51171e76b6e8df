// contour.hpp: topology, direction and position of marching squares, with and without wrapping.
#include <burin/contour.hpp>

#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace burin {
namespace {

Image make_image(int width, int height, const std::function<double(double, double)>& f) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at(x, y) = static_cast<float>(f(x + 0.5, y + 0.5));
    return image;
}

Image disc(int size, Vec2 centre, double radius, bool wrap) {
    return make_image(size, size, [=](double x, double y) {
        double dx = x - centre.x, dy = y - centre.y;
        if (wrap) dx -= size * std::round(dx / size), dy -= size * std::round(dy / size);
        return radius - std::hypot(dx, dy);
    });
}

TEST(trace_contours, a_constant_map_has_none) {
    EXPECT_TRUE(trace_contours(Image(5, 4, 0.2f), 0.5f, false).empty());
    EXPECT_TRUE(trace_contours(Image(5, 4, 0.5f), 0.5f, true).empty());
}

TEST(trace_contours, a_plateau_is_one_loop_with_high_values_on_the_left) {
    const auto contours = trace_contours(disc(40, {19.3, 20.8}, 9.0, false), 0.0f, false);
    ASSERT_EQ(contours.size(), 1u);
    const Contour& c = contours[0];
    EXPECT_TRUE(c.closed);
    EXPECT_LT(enclosed_area(c), 0.0);
    EXPECT_NEAR(enclosed_area(c), -M_PI * 81.0, 1.0);
    for (std::size_t i = 0; i < c.points.size(); ++i) {
        EXPECT_NEAR(length(c.points[i] - Vec2{19.3, 20.8}), 9.0, 0.03);
        // The left is b < 0, against n.
        const Vec2 t = unit(c.points[(i + 1) % c.points.size()] - c.points[i]);
        EXPECT_LT(dot(normal_of(t), Vec2{19.3, 20.8} - c.points[i]), 0.0);
    }
}

TEST(trace_contours, a_pit_encloses_a_positive_area) {
    Image image = disc(40, {20, 20}, 7.0, false);
    for (float& t : image.texels) t = -t;
    const auto contours = trace_contours(image, 0.0f, false);
    ASSERT_EQ(contours.size(), 1u);
    EXPECT_GT(enclosed_area(contours[0]), 0.0);
}

TEST(trace_contours, straight_edges_are_exact_on_a_ramp) {
    const Image ramp = make_image(20, 10, [](double x, double y) { return 0.1 * x + 0.03 * y; });
    const auto contours = trace_contours(ramp, 1.0f, false);
    ASSERT_EQ(contours.size(), 1u);
    EXPECT_FALSE(contours[0].closed);
    for (const Vec2 p : contours[0].points) EXPECT_NEAR(0.1 * p.x + 0.03 * p.y, 1.0, 1e-6);
    // Ends lie on the outermost rows of samples; growing values to the right are on the left of an upward
    // way.
    EXPECT_EQ(contours[0].points.front().y, 0.5);
    EXPECT_EQ(contours[0].points.back().y, 9.5);
}

TEST(trace_contours, a_loop_across_the_border_of_a_wrapping_map_stays_whole) {
    const auto contours = trace_contours(disc(32, {0.7, 31.5}, 6.0, true), 0.0f, true);
    ASSERT_EQ(contours.size(), 1u);
    EXPECT_TRUE(contours[0].closed);
    EXPECT_EQ(contours[0].period, Vec2{});
    EXPECT_NEAR(enclosed_area(contours[0]), -M_PI * 36.0, 1.0);
    for (std::size_t i = 1; i < contours[0].points.size(); ++i)
        EXPECT_LT(length(contours[0].points[i] - contours[0].points[i - 1]), 1.5);
}

TEST(trace_contours, a_band_across_a_wrapping_map_has_a_period) {
    const Image band = make_image(24, 16, [](double x, double y) {
        return 3.0 - std::fabs(y - 8.0 - std::sin(2.0 * M_PI * x / 24.0));
    });
    const auto contours = trace_contours(band, 0.0f, true);
    ASSERT_EQ(contours.size(), 2u);
    for (const Contour& c : contours) {
        EXPECT_TRUE(c.closed);
        EXPECT_EQ(std::fabs(c.period.x), 24.0);
        EXPECT_EQ(c.period.y, 0.0);
        EXPECT_LT(length(c.points.front() + c.period - c.points.back()), 1.5);
        EXPECT_EQ(enclosed_area(c), 0.0);
    }
    EXPECT_EQ(contours[0].period.x, -contours[1].period.x);
}

TEST(trace_contours, a_saddle_joins_by_the_mean) {
    Image saddle(4, 4, 0.0f);
    saddle.at(1, 1) = saddle.at(2, 2) = 1.0f;
    EXPECT_EQ(trace_contours(saddle, 0.4f, false).size(),
              1u);  // mean 0.5 is high: one figure of eight's outline
    EXPECT_EQ(trace_contours(saddle, 0.6f, false).size(), 2u);
}

TEST(trace_contours, samples_of_exactly_the_level_keep_points_apart) {
    Image image(7, 7, 0.0f);
    for (int i = 2; i < 5; ++i)
        for (int j = 2; j < 5; ++j) image.at(i, j) = 0.5f;
    const auto contours = trace_contours(image, 0.5f, false);
    ASSERT_EQ(contours.size(), 1u);
    const auto& p = contours[0].points;
    EXPECT_EQ(p.size(), 12u);
    for (std::size_t i = 0; i < p.size(); ++i) EXPECT_GT(length(p[i] - p[(i + 1) % p.size()]), 1e-5);
}

// Every crossed side of every cell belongs to exactly one contour.
TEST(trace_contours, every_crossing_is_traced_once) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> value(0.0f, 1.0f);
    for (const bool wrap : {false, true}) {
        Image image(23, 17);
        for (float& t : image.texels) t = value(random);
        const auto high = [&](int x, int y) { return image.at(x % 23, y % 17) >= 0.5f; };
        std::size_t crossings = 0, points = 0;
        for (int y = 0; y < 17; ++y)
            for (int x = 0; x < 23; ++x) {
                if (wrap || x + 1 < 23) crossings += high(x, y) != high(x + 1, y);
                if (wrap || y + 1 < 17) crossings += high(x, y) != high(x, y + 1);
            }
        for (const Contour& c : trace_contours(image, 0.5f, wrap)) points += c.points.size();
        EXPECT_EQ(points, crossings) << wrap;
    }
}

}  // namespace
}  // namespace burin
