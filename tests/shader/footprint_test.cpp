// The pixel as a box filter, core/footprint.glsl: areas and places of polygons inside the unit square, against counting.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cpp/glsl_shim.hpp"

namespace burin::glsl {

struct Text {
#include "core/footprint.glsl"
};

}  // namespace burin::glsl

namespace burin::testing {
namespace {

using glm::vec2;
using glsl::Text;

bool inside(const vec2 (&p)[4], vec2 q) {
    const auto turn = [&](vec2 a, vec2 b) { return (b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x); };
    int left = 0;
    for (int i = 0; i < 4; ++i) left += turn(p[i], p[(i + 1) % 4]) > 0.0f;
    return left == 0 || left == 4;
}

double counted_area(const vec2 (&p)[4], int side) {
    int count = 0;
    for (int i = 0; i < side * side; ++i)
        count += inside(p, vec2((i % side + 0.5f) / side, (i / side + 0.5f) / side));
    return double(count) / (side * side);
}

// A parallelogram: convex, of any size and place.
void random_quad(std::mt19937& random, double size, vec2 (&p)[4]) {
    std::uniform_real_distribution<float> place(-0.5f, 1.5f), side(-1.0f, 1.0f);
    p[0] = vec2(place(random), place(random));
    const vec2 a = vec2(side(random), side(random)) * float(size), b = vec2(side(random), side(random)) * float(size);
    p[1] = p[0] + a;
    p[2] = p[0] + a + b;
    p[3] = p[0] + b;
}

TEST(Footprint, AreaOfQuadrilaterals) {
    const unsigned seed = 20261123;
    std::mt19937 random(seed);
    Text text;
    for (const double size : {0.2, 1.0, 5.0, 200.0}) {
        for (int i = 0; i < 200; ++i) {
            vec2 p[4];
            random_quad(random, size, p);
            EXPECT_NEAR(text.burin_quad_area(p[0], p[1], p[2], p[3]), counted_area(p, 100), 0.012)
                << "seed " << seed << ", size " << size << ", quadrilateral " << i;
        }
    }
}

// Stripes side by side fill the pixel: nothing is counted twice and nothing is left out.
TEST(Footprint, StripesAddUp) {
    Text text;
    for (int turn = 0; turn < 360; turn += 7) {
        const double angle = turn * 3.14159265358979 / 180.0;
        const vec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
        double sum = 0.0;
        for (int k = -20; k < 20; ++k) {
            const vec2 a = vec2(0.5f, 0.5f) + across * (0.13f * k), b = a + across * 0.13f;
            sum += text.burin_quad_area(a - along * 50.0f, b - along * 50.0f, b + along * 50.0f, a + along * 50.0f);
        }
        EXPECT_NEAR(sum, 1.0, 2e-4) << turn;
    }
}

TEST(Footprint, MaskNamesThePlacesInside) {
    std::mt19937 random(7);
    Text text;
    for (int i = 0; i < 500; ++i) {
        vec2 p[4];
        random_quad(random, 1.0, p);
        const unsigned mask = text.burin_quad_mask(p[0], p[1], p[2], p[3]);
        for (int k = 0; k < 16; ++k)
            EXPECT_EQ((mask >> k & 1u) != 0, inside(p, vec2(0.125f + 0.25f * (k % 4), 0.125f + 0.25f * (k / 4)))) << i << " " << k;
    }
}

TEST(Footprint, PixelCoordinatesUndoTheAxes) {
    Text text;
    const vec2 x(0.02f, 0.003f), y(-0.01f, 0.08f);
    const auto f = text.burin_footprint(x, y);
    for (const vec2 at : {vec2(0.5f, 0.5f), vec2(0.0f, 1.0f), vec2(0.3f, 0.9f)}) {
        const vec2 seen = text.burin_to_pixel(f, x * (at.x - 0.5f) + y * (at.y - 0.5f));
        EXPECT_NEAR(seen.x, at.x, 1e-5);
        EXPECT_NEAR(seen.y, at.y, 1e-5);
    }
    EXPECT_GE(f.radius, 0.5f * glm::length(x + y) * 0.999f);
}

}  // namespace
}  // namespace burin::testing
