// Random fills, painted one over the other, against the painter's own rule at random points; and random strokes against the curves
// that they were drawn along. The truth evaluator judges the pattern that comes out.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include <gtest/gtest.h>

#include <burin/evaluate.hpp>
#include <burin/path_data.hpp>
#include <burin/resolve.hpp>
#include <burin/svg.hpp>

#include "random_pattern.hpp"

namespace burin::testing {
namespace {

constexpr std::uint64_t kSeed = 20261124;
constexpr double kMm = 1e-3;

// More of them by BURIN_ROUNDS, for a search on a larger scale.
std::uint64_t rounds() {
    const char* asked = std::getenv("BURIN_ROUNDS");
    return asked != nullptr ? std::strtoull(asked, nullptr, 10) : 60;
}

std::string number(double value) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.4f", value);
    return text.data();
}

std::string page(const std::string& content) {
    return "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='100mm' viewBox='0 0 100 100'>" + content + "</svg>";
}

struct Fill {
    std::vector<std::vector<Vec2>> outline;  // fine polygons, mm
    bool even_odd = false;
    double level = 0.0;  // mm

    bool holds(Vec2 p) const {
        int winding = 0;
        for (const auto& polygon : outline)
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
                if ((a.y <= p.y) == (b.y <= p.y)) continue;
                if ((cross(b - a, p - a) > 0.0) == (b.y > a.y)) winding += b.y > a.y ? 1 : -1;
            }
        return even_odd ? winding % 2 != 0 : winding != 0;
    }
    double distance(Vec2 p) const {
        double nearest = 1e300;
        for (const auto& polygon : outline)
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Vec2 a = polygon[i], d = polygon[(i + 1) % polygon.size()] - a;
                const double t = dot(d, d) > 0.0 ? std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0) : 0.0;
                nearest = std::min(nearest, length(p - (a + d * t)));
            }
        return nearest;
    }
};

// A blob, a star, a rectangle on a coarse lattice (so that edges coincide), or a ring of two loops.
std::string random_outline(Random& random, double tolerance, Fill& fill) {
    const int kind = random.below(4);
    std::string data;
    const auto loop = [&](Vec2 centre, double radius, bool turned) {
        const int n = 3 + random.below(4);
        const auto at = [&](double k, double r) {
            const double a = (turned ? -1.0 : 1.0) * 2.0 * 3.14159265358979 * k / n;
            return centre + Vec2{std::cos(a), std::sin(a)} * r;
        };
        for (int k = 0; k < n; ++k) {
            const Vec2 a = at(k, radius), c0 = at(k + 0.3, radius * random.between(0.6, 1.5)), c1 = at(k + 0.7, radius * random.between(0.6, 1.5)), b = at(k + 1.0, radius);
            if (k == 0) data += "M" + number(a.x) + " " + number(a.y);
            data += "C" + number(c0.x) + " " + number(c0.y) + " " + number(c1.x) + " " + number(c1.y) + " " + number(b.x) + " " + number(b.y);
        }
        data += "Z";
    };
    const Vec2 centre{random.between(15, 85), random.between(15, 85)};
    if (kind == 0) {
        loop(centre, random.between(4, 14), random.chance(0.5));
    } else if (kind == 1) {
        loop(centre, random.between(8, 14), false);
        loop(centre, random.between(3, 7), random.chance(0.5));
    } else if (kind == 2) {
        for (int k = 0; k < 5; ++k) {
            const double a = k * 4.0 * 3.14159265358979 / 5.0;
            data += (k == 0 ? "M" : "L") + number(centre.x + 10 * std::cos(a)) + " " + number(centre.y + 10 * std::sin(a));
        }
        data += "Z";
    } else {
        const int x = 10 * (1 + random.below(7)), y = 10 * (1 + random.below(7)), w = 10 * (1 + random.below(2)), h = 10 * (1 + random.below(2));
        data = "M" + number(x) + " " + number(y) + "h" + number(w) + "v" + number(h) + "h" + number(-w) + "z";
    }
    for (const Subpath& subpath : parse_path_data(data, {}, tolerance).subpaths) {
        std::vector<Vec2>& polygon = fill.outline.emplace_back();
        for (const Element& e : subpath.elements)
            for (int k = 0; k < (e.kind == ElementKind::line ? 1 : 16); ++k) {
                const double t = k / 16.0, s = 1.0 - t;
                polygon.push_back(e.kind == ElementKind::line ? e.p0 : e.p0 * (s * s) + e.p1 * (2 * s * t) + e.p2 * (t * t));
            }
    }
    return data;
}

TEST(SvgRegions, GroundIsWhatWasPaintedLast) {
    constexpr double kMargin = 0.02;  // mm: four times the tolerance of the reader
    int asked = 0;
    for (std::uint64_t round = 0; round < rounds(); ++round) {
        Random random(kSeed + round);
        const int levels = 1 + random.below(4);
        std::vector<Fill> fills;
        std::string content;
        const int count = 2 + random.below(14);
        for (int i = 0; i < count; ++i) {
            Fill& fill = fills.emplace_back();
            fill.even_odd = random.chance(0.5);
            fill.level = random.below(levels) - (levels > 2 ? 1 : -1);
            content += "<path d='" + random_outline(random, 1e-4, fill) + "' fill-rule='" + (fill.even_odd ? "evenodd" : "nonzero") + "' data-burin-fill='" +
                       (fill.level > 0 ? "plateau " : fill.level < 0 ? "sunken " : "ground") + (fill.level == 0 ? "" : number(std::abs(fill.level)) + "mm") + "'/>";
        }
        const auto drawing = read_svg(page(content));
        ASSERT_TRUE(drawing.ok()) << "seed " << kSeed + round << ": " << drawing.error().message;
        const auto resolved = resolve_pattern(drawing->pattern);
        ASSERT_TRUE(resolved.ok()) << "seed " << kSeed + round << ": " << resolved.error().message << "\n" << page(content);
        const Truth truth(*resolved);
        for (int i = 0; i < 1500; ++i) {
            const Vec2 p{random.between(0, 100), random.between(0, 100)};
            double expected = 0.0, nearest = 1e300;
            for (const Fill& fill : fills) {
                nearest = std::min(nearest, fill.distance(p));
                if (fill.holds(p)) expected = fill.level;
            }
            if (nearest < kMargin) continue;
            ++asked;
            ASSERT_NEAR(truth.ground_at(p * kMm) / kMm, expected, 1e-3) << "seed " << kSeed + round << " at " << p.x << ", " << p.y << "\n" << page(content);
        }
    }
    EXPECT_GT(asked, 80000);
}

// Whether the cubic has a place whose circle of curvature is smaller than `radius`.
bool bends_tightly(const Vec2* p, double radius) {
    for (int k = 0; k <= 1000; ++k) {
        const double t = k / 1000.0, s = 1.0 - t;
        const Vec2 d = ((p[1] - p[0]) * (s * s) + (p[2] - p[1]) * (2 * s * t) + (p[3] - p[2]) * (t * t)) * 3.0;
        const Vec2 dd = ((p[2] - p[1] * 2.0 + p[0]) * s + (p[3] - p[2] * 2.0 + p[1]) * t) * 6.0;
        if (std::abs(cross(d, dd)) * radius > std::pow(length(d), 3.0)) return true;
    }
    return false;
}

// The bottom of a groove that is as deep as half its width lies as deep at every place of the curve as it is true to it.
TEST(SvgStrokes, CurvesLieWhereTheyWereDrawn) {
    constexpr double kTolerance = 0.005;  // mm
    double worst = 0.0;
    std::uint64_t asked = 0;
    for (std::uint64_t round = 0; round < rounds(); ++round) {
        Random random(kSeed + round);
        Vec2 p[4];
        for (Vec2& q : p) q = {random.between(10, 90), random.between(10, 90)};
        // Where a curve bends within the stroke's own width the arms meet as those of a corner do.
        if (bends_tightly(p, 1.0)) continue;
        ++asked;
        const std::string data = "M" + number(p[0].x) + " " + number(p[0].y) + "C" + number(p[1].x) + " " + number(p[1].y) + " " + number(p[2].x) + " " +
                                 number(p[2].y) + " " + number(p[3].x) + " " + number(p[3].y);
        SvgOptions options;
        options.tolerance = kTolerance * kMm;
        const auto drawing = read_svg(page("<path d='" + data + "' fill='none' stroke='#000' stroke-width='2' stroke-linecap='round'/>"), options);
        ASSERT_TRUE(drawing.ok());
        // Hairpins are welded within the snap, which is wider than the tolerance that is asked about.
        const auto resolved = resolve_pattern(drawing->pattern, {.snap = 1e-6});
        ASSERT_TRUE(resolved.ok()) << resolved.error().message;
        const Truth truth(*resolved);
        for (int k = 0; k <= 200; ++k) {
            const double t = k / 200.0, s = 1.0 - t;
            const Vec2 q = p[0] * (s * s * s) + p[1] * (3 * s * s * t) + p[2] * (3 * s * t * t) + p[3] * (t * t * t);
            // Millimetres aside, since the flanks rise by one in one.
            worst = std::max(worst, truth.surface_at(q * kMm).height / kMm + 1.0);
        }
        ASSERT_LE(worst, kTolerance + 2e-4) << "seed " << kSeed + round << ": " << data;
    }
    EXPECT_GT(asked, rounds() / 2);
    std::cout << "farthest " << worst << " mm of " << kTolerance << "\n";
}

}  // namespace
}  // namespace burin::testing
