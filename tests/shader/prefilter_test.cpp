// The prefilter counts every path once, with its length, its width and its direction.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cpp/prefilter.hpp"
#include "rays.hpp"

namespace burin::testing {
namespace {

Pattern lines_pattern(bool curved) {
    Pattern pattern;
    pattern.size = {2.0, 1.0};
    pattern.depth = 0.02;
    pattern.wrap = Wrap::clamp;
    pattern.profiles.push_back({{{-0.01, 0.0}, {0.0, -0.02}, {0.01, 0.0}}, {}});
    Path path;
    Element element;
    element.kind = curved ? ElementKind::quadratic : ElementKind::line;
    element.p0 = {0.3, 0.2};
    element.p1 = {1.0, 0.2};
    element.p2 = {1.0, 0.8};
    element.width0 = 1.0;
    element.width1 = 0.5;
    path.elements.push_back(element);
    pattern.paths.push_back(path);
    return pattern;
}

double total(const Prefilter& filter) {
    double sum = 0.0;
    for (const float weight : filter.weights) sum += double(weight);
    return sum;
}

TEST(Prefilter, CountsLengthTimesWidth) {
    const PreparedPattern p = prepare(lines_pattern(false));
    const Prefilter filter = prefilter_pattern(p.textures, p.detail);
    const double block = 2.0 / filter.columns * 1.0 / filter.rows;
    // The mean width scale is 3/4; the reach of the profile 1 cm.
    EXPECT_NEAR(total(filter) * block, std::hypot(0.7, 0.6) * 0.75 * 0.01, 1e-5);
    ASSERT_EQ(filter.classes.size(), 1u);
    const double angle = std::atan2(0.6, 0.7);
    EXPECT_LT(std::acos(filter.classes[0].tangent.x * std::cos(angle) + filter.classes[0].tangent.y * std::sin(angle)),
              std::numbers::pi / Prefilter::kDirections + 1e-6);
    EXPECT_EQ(filter.weight(0, 0, filter.rows - 1), 0.0f);
}

TEST(Prefilter, BendsAreOfSeveralDirections) {
    const PreparedPattern p = prepare(lines_pattern(true));
    const Prefilter filter = prefilter_pattern(p.textures, p.detail);
    EXPECT_GE(filter.classes.size(), 4u);
    for (const PrefilterClass& kind : filter.classes) {
        EXPECT_GT(kind.tangent.x, -0.2);
        EXPECT_GT(kind.tangent.y, -0.2);
    }
}

}  // namespace
}  // namespace burin::testing
