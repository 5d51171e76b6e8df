// fit.hpp: what each promise means on curves whose right answer is known.
#include <burin/fit.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace burin {
namespace {

using Row = std::vector<Vec2>;

// Points along a polyline, `step` apart.
Row sampled(const Row& corners, bool closed, double step) {
    Row out;
    double left = 0.0;
    for (std::size_t i = 0; i + (closed ? 0 : 1) < corners.size(); ++i) {
        const Vec2 a = corners[i], b = corners[(i + 1) % corners.size()];
        const double l = length(b - a);
        for (; left < l; left += step) out.push_back(lerp(a, b, left / l));
        left -= l;
    }
    if (!closed) out.push_back(corners.back());
    return out;
}

Row arc(Vec2 centre, double radius, double from, double to, double step = 0.8) {
    Row out;
    const int n = static_cast<int>(std::abs(to - from) * radius / step);
    for (int i = 0; i <= n; ++i) {
        const double a = from + (to - from) * i / n;
        out.push_back(centre + Vec2{std::cos(a), std::sin(a)} * radius);
    }
    return out;
}

void add_noise(Row& row, double sigma, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> d(0.0, sigma);
    for (Vec2& p : row) p = p + Vec2{d(random), d(random)};
}

std::size_t count(const FitResult& fit, ElementKind kind) {
    std::size_t n = 0;
    for (const Element& e : fit.elements) n += e.kind == kind;
    return n;
}

std::size_t corners(const FitResult& fit) {
    std::size_t n = 0;
    for (const auto c : fit.corner) n += c;
    return n;
}

FitResult fitted(const Row& row, FitOptions options) {
    Result<FitResult> fit = fit_curve(row, options);
    EXPECT_TRUE(fit.ok());
    return fit.ok() ? *fit : FitResult{};
}

TEST(fit_curve, a_noisy_straight_run_is_one_line_through_its_middle) {
    Row row = sampled({{10, 20}, {510, 57}}, false, 1.0);
    add_noise(row, 0.1, 4);
    const FitResult fit = fitted(row, {.tolerance = 0.5});
    ASSERT_EQ(fit.elements.size(), 1u);
    EXPECT_EQ(fit.elements[0].kind, ElementKind::line);
    // Least squares over 500 points: the ends are right to a few times noise / sqrt(n).
    EXPECT_NEAR(cross(unit(Vec2{500, 37}), fit.elements[0].p0 - Vec2{10, 20}), 0.0, 0.03);
    EXPECT_NEAR(cross(unit(Vec2{500, 37}), fit.elements[0].p2 - Vec2{10, 20}), 0.0, 0.03);
}

TEST(fit_curve, arcs_take_as_few_quadratics_as_the_error_law_says) {
    for (const double radius : {20.0, 100.0, 400.0}) {
        const FitResult fit = fitted(arc({0, 0}, radius, 0.0, M_PI / 2), {.tolerance = 0.05});
        const double law = M_PI / 2 / std::pow(256.0 * 0.05 / radius, 0.25);
        EXPECT_LE(fit.elements.size(), static_cast<std::size_t>(std::ceil(law * 1.15))) << radius;
        EXPECT_LE(fit.max_error, 0.075);
    }
}

TEST(fit_curve, a_circle_has_no_corner_and_no_line) {
    for (const double radius : {4.0, 10.0, 100.0}) {
        Row row = arc({150, 150}, radius, 0.0, 2 * M_PI);
        row.pop_back();
        const FitResult fit = fitted(row, {.tolerance = 0.1, .closed = true});
        EXPECT_EQ(corners(fit), 0u) << radius;
        EXPECT_EQ(count(fit, ElementKind::line), 0u) << radius;
        const double law = 2 * M_PI / std::pow(256.0 * 0.1 / radius, 0.25);
        EXPECT_LE(fit.elements.size(), static_cast<std::size_t>(std::ceil(law * 1.15)) + 1) << radius;
    }
}

TEST(fit_curve, corners_lie_where_their_sides_meet) {
    for (int degrees = 30; degrees <= 150; degrees += 20) {
        const double turn = degrees * M_PI / 180.0;
        const Vec2 out{std::cos(turn), std::sin(turn)};
        Row row = sampled({{-40.0, 0.0}, {0.0, 0.0}, out * 40.0}, false, 0.83);
        add_noise(row, 0.02, static_cast<unsigned>(degrees));
        const FitResult fit = fitted(row, {.tolerance = 0.15});
        ASSERT_EQ(fit.elements.size(), 2u) << degrees;
        EXPECT_EQ(fit.corner[1], 1) << degrees;
        EXPECT_LT(length(fit.elements[0].p2), 0.06) << degrees;
    }
}

TEST(fit_curve, a_rounded_tip_within_reach_is_taken_for_a_corner) {
    // What a box filter makes of a right angle: (x + 1/2)(y + 1/2) = 1/2 within half a texel of it.
    Row row;
    for (double x = 30.0; x > 0.5; x -= 1.0) row.push_back({x, 0.0});
    for (double x = 0.45; x > 0.0; x -= 0.2) row.push_back({x, 0.5 / (x + 0.5) - 0.5});
    for (double y = 0.6; y < 30.0; y += 1.0) row.push_back({0.0, y});
    const FitResult fit = fitted(row, {.tolerance = 0.1});
    ASSERT_EQ(fit.elements.size(), 2u);
    EXPECT_EQ(count(fit, ElementKind::line), 2u);
    EXPECT_LT(length(fit.elements[0].p2), 0.02);
}

TEST(fit_curve, a_line_runs_smoothly_into_an_arc) {
    Row row = sampled({{-60, 0}, {-0.5, 0}}, false, 0.8);
    for (const Vec2 p : arc({0, 20}, 20.0, -M_PI / 2, M_PI / 6)) row.push_back(p);
    const Vec2 end = row.back(), t{-std::sin(M_PI / 6), std::cos(M_PI / 6)};
    for (double s = 0.8; s < 50.0; s += 0.8) row.push_back(end + t * s);
    add_noise(row, 0.01, 9);
    const FitResult fit = fitted(row, {.tolerance = 0.1});
    EXPECT_EQ(count(fit, ElementKind::line), 2u);
    EXPECT_EQ(count(fit, ElementKind::quadratic), 2u);
    EXPECT_EQ(corners(fit), 1u);  // the start
    EXPECT_NEAR(
        std::atan2(fit.elements[0].p2.y - fit.elements[0].p0.y, fit.elements[0].p2.x - fit.elements[0].p0.x),
        0.0, 1e-3);
}

TEST(fit_curve, a_hexagon_has_six_lines_at_any_turn) {
    for (int k = 0; k < 12; ++k) {
        Row shape;
        for (int i = 0; i < 6; ++i)
            shape.push_back(Vec2{50, 50} +
                            Vec2{std::cos(i * M_PI / 3 + k * 0.09), std::sin(i * M_PI / 3 + k * 0.09)} *
                                30.0);
        Row row = sampled(shape, true, 0.8);
        add_noise(row, 0.05, static_cast<unsigned>(k));
        const FitResult fit = fitted(row, {.tolerance = 0.2, .closed = true});
        EXPECT_EQ(count(fit, ElementKind::line), 6u) << k;
        EXPECT_EQ(fit.elements.size(), 6u) << k;
        for (const Element& e : fit.elements) {
            double nearest = 1e9;
            for (const Vec2 v : shape) nearest = std::min(nearest, length(v - e.p0));
            EXPECT_LT(nearest, 0.15) << k;
        }
    }
}

TEST(fit_curve, pinned_ends_are_met_bit_by_bit) {
    Row row = sampled({{0, 0}, {40, 7}}, false, 1.0);
    add_noise(row, 0.05, 3);
    FitOptions options{.tolerance = 0.3};
    options.pin_start = options.pin_end = true;
    const FitResult fit = fitted(row, options);
    EXPECT_EQ(fit.elements.front().p0, row.front());
    EXPECT_EQ(fit.elements.back().p2, row.back());
    // Free ends lie beside the end points, not on them.
    const FitResult free = fitted(row, {.tolerance = 0.3});
    EXPECT_FALSE(free.elements.front().p0 == row.front());
    EXPECT_LT(length(free.elements.front().p0 - row.front()), 0.3);
}

TEST(fit_curve, a_line_around_a_tile_meets_itself) {
    Row row = sampled({{0.2, 5}, {199.6, 5}}, false, 0.7);
    add_noise(row, 0.03, 2);
    const FitResult fit = fitted(row, {.tolerance = 0.15, .closed = true, .period = {200, 0}});
    ASSERT_EQ(fit.elements.size(), 1u);
    EXPECT_EQ(fit.elements[0].p2, fit.elements[0].p0 + (Vec2{200, 0}));
    EXPECT_EQ(fit.corner[0], 0);
}

TEST(fit_curve, points_of_weight_zero_are_not_looked_at) {
    Row row = sampled({{0, 0}, {60, 0}}, false, 1.0);
    std::vector<double> weights(row.size(), 1.0);
    for (std::size_t i = 20; i < 26; ++i) row[i].y = 5.0, weights[i] = 0.0;
    FitOptions options{.tolerance = 0.1};
    options.weights = weights;
    const FitResult fit = fitted(row, options);
    EXPECT_EQ(fit.elements.size(), 1u);
    EXPECT_LT(fit.max_error, 0.01);
}

TEST(fit_curve, first_point_covers_the_row_in_order) {
    Row row = sampled({{0, 0}, {40, 0}, {40, 30}, {0, 30}}, true, 0.9);
    const FitResult fit = fitted(row, {.tolerance = 0.1, .closed = true});
    ASSERT_EQ(fit.first_point.size(), fit.elements.size() + 1);
    EXPECT_LT(fit.first_point.front(), row.size());
    EXPECT_EQ(fit.first_point.back(), fit.first_point.front() + row.size());
    for (std::size_t i = 0; i < fit.elements.size(); ++i) {
        const Element& e = fit.elements[i];
        ASSERT_LE(fit.first_point[i], fit.first_point[i + 1]);
        for (std::size_t j = fit.first_point[i]; j < fit.first_point[i + 1]; ++j)
            EXPECT_LT(std::abs(cross(unit(e.p2 - e.p0), row[j % row.size()] - e.p0)), 0.5);
    }
}

TEST(fit_curve, small_loops_keep_an_inside) {
    for (int n = 2; n < 20; ++n) {
        Row row;
        for (int i = 0; i < n; ++i)
            row.push_back(Vec2{5, 5} + Vec2{std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n)} * 0.6);
        const FitResult fit = fitted(row, {.tolerance = 0.3, .closed = true});
        double twice = 0.0;
        for (const Element& e : fit.elements) {
            const Vec2 middle = e.kind == ElementKind::line ? e.p0 : e.p1;
            twice +=
                cross(e.p0 - Vec2{5, 5}, middle - Vec2{5, 5}) + cross(middle - Vec2{5, 5}, e.p2 - Vec2{5, 5});
        }
        EXPECT_GT(std::abs(twice), 0.05) << n;
    }
}

TEST(fit_curve, refuses_what_is_no_curve) {
    EXPECT_EQ(fit_curve(Row{}).error().code, ErrorCode::invalid_input);
    EXPECT_EQ(fit_curve(Row{{1, 2}}).error().code, ErrorCode::invalid_input);
    EXPECT_EQ(fit_curve(Row{{1, 2}, {1, 2}, {1, 2}}).error().code, ErrorCode::invalid_input);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Result<FitResult> bad = fit_curve(Row{{1, 2}, {nan, 2}});
    ASSERT_FALSE(bad.ok());
    EXPECT_NE(bad.error().message.find("point 1"), std::string::npos);
    EXPECT_TRUE(fit_curve(Row{{1, 2}, {1, 2}, {3, 2}}).ok());
}

TEST(fit_curve, point_and_derivative_of_elements) {
    Element e;
    e.kind = ElementKind::quadratic;
    e.p0 = {0, 0}, e.p1 = {1, 2}, e.p2 = {4, 0};
    EXPECT_EQ(point_at(e, 0.5), (Vec2{1.5, 1.0}));
    EXPECT_EQ(derivative_at(e, 0.0), (Vec2{2, 4}));
    e.kind = ElementKind::line;
    EXPECT_EQ(point_at(e, 0.25), (Vec2{1.0, 0.0}));
    EXPECT_EQ(derivative_at(e, 0.9), (Vec2{4, 0}));
}

}  // namespace
}  // namespace burin
