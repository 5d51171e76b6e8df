// fit.hpp on random shapes, most of them rasterized with a box filter and contoured as a map's plateaus are.
// The seed of a failing shape is printed.
#include <burin/contour.hpp>
#include <burin/fit.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#include <gtest/gtest.h>

namespace burin {
namespace {

using Row = std::vector<Vec2>;
using Random = std::mt19937;

double uniform(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

Image rasterized(int size, const std::function<bool(Vec2)>& inside) {
    constexpr int kSamples = 10;
    Image image(size, size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            int hits = 0;
            for (int j = 0; j < kSamples; ++j)
                for (int i = 0; i < kSamples; ++i)
                    hits += inside({x + (i + 0.5) / kSamples, y + (j + 0.5) / kSamples});
            image.at(x, y) = static_cast<float>(hits) / (kSamples * kSamples);
        }
    return image;
}

bool in_polygon(const Row& polygon, Vec2 p) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        if ((a.y <= p.y) != (b.y <= p.y) && a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) > p.x)
            inside = !inside;
    }
    return inside;
}

double turn_at(const Row& polygon, std::size_t i) {
    const std::size_t n = polygon.size();
    const Vec2 in = unit(polygon[i] - polygon[(i + n - 1) % n]),
               out = unit(polygon[(i + 1) % n] - polygon[i]);
    return std::abs(std::atan2(cross(in, out), dot(in, out)));
}

// Star-shaped about the middle, sides of at least 10 texels, turns of 35 to 125 degrees either way.
Row random_polygon(Random& random) {
    while (true) {
        const int n = 3 + static_cast<int>(uniform(random, 0.0, 6.0));
        Row polygon;
        double a = uniform(random, 0.0, 6.0);
        for (int i = 0; i < n; ++i) {
            a += 2.0 * M_PI / n * uniform(random, 0.8, 1.2);
            polygon.push_back(Vec2{32, 32} + Vec2{std::cos(a), std::sin(a)} * uniform(random, 13.0, 28.0));
        }
        bool good = true;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const double turn = turn_at(polygon, i);
            good = good && turn > 0.6 && turn < 2.2;
            good = good && length(polygon[i] - polygon[(i + 1) % polygon.size()]) > 10.0;
            // Sides do not cross: the angle about the middle grows all the way.
            good = good &&
                   cross(polygon[i] - Vec2{32, 32}, polygon[(i + 1) % polygon.size()] - Vec2{32, 32}) > 60.0;
        }
        if (good) return polygon;
    }
}

// r = a (1 + b cos(k t + c)): smooth, with bends both ways.
struct Blob {
    double a, b, c;
    int k;
    Vec2 at(double t) const {
        const double r = a * (1.0 + b * std::cos(k * t + c));
        return Vec2{32, 32} + Vec2{std::cos(t), std::sin(t)} * r;
    }
};

// Elements that the error law of an arc gives, summed over the blob's curvature: a piece of radius r spans
// (256 tolerance r^3)^(1/4).
double law_of(const Blob& blob, double tolerance) {
    double sum = 0.0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
        const double h = 2.0 * M_PI / kSteps;
        const Vec2 p = blob.at(i * h - h), q = blob.at(i * h), r = blob.at(i * h + h);
        const double ds = 0.5 * (length(q - p) + length(r - q));
        const double turn = std::abs(std::atan2(cross(q - p, r - q), dot(q - p, r - q)));
        const double radius = ds / std::max(turn, 1e-6);
        sum += ds / std::pow(256.0 * tolerance * radius * radius * radius, 0.25);
    }
    return sum;
}

std::size_t corners(const FitResult& fit) {
    return static_cast<std::size_t>(std::count(fit.corner.begin(), fit.corner.end(), 1));
}

// What holds of every result, whatever the points.
void expect_sound(const FitResult& fit, const FitOptions& options, unsigned seed) {
    ASSERT_FALSE(fit.elements.empty());
    ASSERT_EQ(fit.corner.size(), fit.elements.size());
    ASSERT_EQ(fit.first_point.size(), fit.elements.size() + 1);
    for (std::size_t i = 0; i < fit.elements.size(); ++i) {
        const Element& e = fit.elements[i];
        ASSERT_TRUE(std::isfinite(e.p0.x + e.p0.y + e.p1.x + e.p1.y + e.p2.x + e.p2.y)) << seed;
        const bool last = i + 1 == fit.elements.size();
        if (last && !options.closed) break;
        const Element& next = fit.elements[last ? 0 : i + 1];
        ASSERT_EQ(e.p2, last ? next.p0 + options.period : next.p0) << "seed " << seed << " element " << i;
        if (fit.corner[last ? 0 : i + 1] != 0) continue;
        const Vec2 in = unit(derivative_at(e, 1.0)), out = unit(derivative_at(next, 0.0));
        ASSERT_LT(std::abs(cross(in, out)), 1e-6) << "seed " << seed << " element " << i;
        ASSERT_GT(dot(in, out), 0.0) << "seed " << seed << " element " << i;
    }
}

TEST(fit_property, polygons_come_back_with_their_corners) {
    for (unsigned seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        const Row polygon = random_polygon(random);
        const Image image = rasterized(64, [&](Vec2 p) { return in_polygon(polygon, p); });
        const auto contours = trace_contours(image, 0.5f, false);
        ASSERT_EQ(contours.size(), 1u) << seed;
        const FitOptions options{.tolerance = 0.2, .closed = true};
        const Result<FitResult> fit = fit_curve(contours[0].points, options);
        ASSERT_TRUE(fit.ok()) << seed;
        expect_sound(*fit, options, seed);
        EXPECT_EQ(fit->elements.size(), polygon.size()) << "seed " << seed;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            double nearest = 1e9;
            for (const Element& e : fit->elements) nearest = std::min(nearest, length(e.p0 - polygon[i]));
            // A sharp corner magnifies the raster's error along its axis.
            EXPECT_LT(nearest, 0.15 / std::cos(0.5 * turn_at(polygon, i)))
                << "seed " << seed << " corner " << i;
        }
    }
}

TEST(fit_property, smooth_shapes_have_no_corner_and_few_elements) {
    double elements = 0.0, law = 0.0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        const int k = 2 + static_cast<int>(uniform(random, 0.0, 3.0));
        const Blob blob{uniform(random, 14.0, 24.0), uniform(random, 0.0, 0.7) / (1.0 + k * k),
                        uniform(random, 0, 6), k};
        const Image image = rasterized(64, [&](Vec2 p) {
            const Vec2 d = p - Vec2{32, 32};
            return length(d) < length(blob.at(std::atan2(d.y, d.x)) - Vec2{32, 32});
        });
        const auto contours = trace_contours(image, 0.5f, false);
        ASSERT_EQ(contours.size(), 1u) << seed;
        const FitOptions options{.tolerance = 0.2, .closed = true};
        const Result<FitResult> fit = fit_curve(contours[0].points, options);
        ASSERT_TRUE(fit.ok()) << seed;
        expect_sound(*fit, options, seed);
        EXPECT_EQ(corners(*fit), 0u) << "seed " << seed;
        EXPECT_LE(fit->max_error, 1.5 * options.tolerance) << "seed " << seed;
        EXPECT_LE(static_cast<double>(fit->elements.size()), 1.4 * law_of(blob, 0.2) + 3.0)
            << "seed " << seed;
        elements += static_cast<double>(fit->elements.size());
        law += law_of(blob, 0.2);
    }
    // The raster's own error takes a part of the tolerance, so the law is not quite reached.
    EXPECT_LT(elements, 1.35 * law);
}

TEST(fit_property, roads_of_lines_and_arcs_come_back_with_little_more) {
    std::size_t given = 0, found = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        Random random(seed);
        std::normal_distribution<double> noise(0.0, 0.03);
        Row row;
        Vec2 p{0, 0};
        double heading = uniform(random, 0.0, 6.0), left = 0.0;
        const FitOptions options{.tolerance = 0.15};
        for (int piece = 0; piece < 7; ++piece) {
            const bool bend = piece % 2 == 1;
            const double radius = uniform(random, 8.0, 60.0), turn = uniform(random, 0.4, 2.0);
            const double extent = bend ? radius * turn : uniform(random, 15.0, 60.0);
            const double rate = bend ? (random() % 2 ? 1.0 : -1.0) / radius : 0.0;
            given +=
                bend ? static_cast<std::size_t>(std::ceil(turn / std::pow(256.0 * 0.15 / radius, 0.25))) : 1;
            for (double s = 0.0; s < extent; s += 0.05) {
                heading += rate * 0.05;
                p = p + Vec2{std::cos(heading), std::sin(heading)} * 0.05;
                left += 0.05;
                if (left < 0.8) continue;
                left = 0.0;
                row.push_back(p + Vec2{noise(random), noise(random)});
            }
        }
        const Result<FitResult> fit = fit_curve(row, options);
        ASSERT_TRUE(fit.ok()) << seed;
        expect_sound(*fit, options, seed);
        EXPECT_EQ(corners(*fit), 1u) << "seed " << seed;
        EXPECT_LE(fit->max_error, 1.5 * options.tolerance) << "seed " << seed;
        found += fit->elements.size();
    }
    EXPECT_LT(static_cast<double>(found), 1.15 * static_cast<double>(given));
}

TEST(fit_property, noise_does_not_shred_a_polygon) {
    for (unsigned seed = 1; seed <= 40; ++seed) {
        Random random(seed);
        const Row polygon = random_polygon(random);
        const double sigma = uniform(random, 0.02, 0.25);
        std::normal_distribution<double> noise(0.0, sigma);
        Row row;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
            const int n = static_cast<int>(length(b - a) / 0.7);
            for (int j = 0; j < n; ++j)
                row.push_back(lerp(a, b, static_cast<double>(j) / n) + Vec2{noise(random), noise(random)});
        }
        const FitOptions options{.tolerance = std::max(0.15, 3.5 * sigma), .closed = true};
        const Result<FitResult> fit = fit_curve(row, options);
        ASSERT_TRUE(fit.ok()) << seed;
        expect_sound(*fit, options, seed);
        EXPECT_LE(fit->elements.size(), polygon.size() + 2) << "seed " << seed << " sigma " << sigma;
    }
}

// Anything goes: thresholded noise of all sizes, wrapping or not, any tolerance.
TEST(fit_property, wild_contours_stay_sound_and_equal_in_two_runs) {
    std::size_t curves = 0, missed = 0;
    for (unsigned seed = 1; seed <= 30; ++seed) {
        Random random(seed);
        const int size = 24 + static_cast<int>(uniform(random, 0.0, 40.0));
        const double f = uniform(random, 0.05, 0.6), g = uniform(random, 0.05, 0.6),
                     grain = uniform(random, 0.0, 0.3);
        Image image(size, size);
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x)
                image.at(x, y) = static_cast<float>(std::sin(f * x) + std::cos(g * y + f * x) +
                                                    uniform(random, -grain, grain));
        FitOptions options{.tolerance = uniform(random, 0.05, 0.8)};
        for (const Contour& contour : trace_contours(image, 0.1f, seed % 2 == 0)) {
            options.closed = contour.closed;
            options.period = contour.period;
            const Result<FitResult> one = fit_curve(contour.points, options),
                                    two = fit_curve(contour.points, options);
            ASSERT_TRUE(one.ok()) << seed;
            expect_sound(*one, options, seed);
            ASSERT_EQ(one->elements.size(), two->elements.size());
            for (std::size_t i = 0; i < one->elements.size(); ++i) {
                EXPECT_EQ(one->elements[i].p0, two->elements[i].p0);
                EXPECT_EQ(one->elements[i].p1, two->elements[i].p1);
            }
            if (contour.points.size() < 16) continue;
            ++curves;
            missed += one->max_error > 1.5 * options.tolerance;
        }
    }
    // Detail finer than five points an element cannot be met.
    EXPECT_LT(static_cast<double>(missed), 0.05 * static_cast<double>(curves)) << curves;
}

}  // namespace
}  // namespace burin
