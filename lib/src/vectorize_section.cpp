// One measured section becomes a polyline of few points.
#include "vectorize_profiles.hpp"

#include <algorithm>
#include <cmath>

namespace burin::vectorizing {
namespace {

struct Knot {
    double b = 0.0, h = 0.0, weight = 0.0;
};

// The section ends where it has come to the ground for good: the last offset whose height stands out of the grain.
// Offsets that few texels have are near other chains and say little.
int find_reach(const std::vector<double>& height, const std::vector<double>& weight, int direction, double least) {
    const int half = static_cast<int>(height.size() / 2);
    double heaviest = 0.0;
    for (const double w : weight) heaviest = std::max(heaviest, w);
    int reach = 0;
    for (int k = 0; k <= half; ++k) {
        const std::size_t i = static_cast<std::size_t>(half + direction * k);
        if (weight[i] >= std::max(2.0, 0.35 * heaviest) && std::fabs(height[i]) > least) reach = k;
    }
    return reach;
}

std::vector<Knot> collect_knots(const std::vector<double>& height, const std::vector<double>& weight,
                                double right_level, double least) {
    const int half = static_cast<int>(height.size() / 2);
    const int left = std::max(1, find_reach(height, weight, -1, least) + 1);
    const int right = std::max(1, find_reach(height, weight, 1, least) + 1);
    std::vector<Knot> knots;
    knots.push_back({-left * kSectionStep, 0.0, 0.0});
    for (int k = -left + 1; k < right; ++k) {
        const std::size_t i = static_cast<std::size_t>(half + k);
        if (weight[i] <= 0.0) continue;
        // Offset 0 of a step is measured from both sides; it is where the ground changes.
        if (k == 0 && right_level != 0.0) continue;
        knots.push_back({k * kSectionStep, height[i] + (k > 0 ? right_level : 0.0), weight[i]});
    }
    knots.push_back({right * kSectionStep, right_level, 0.0});
    return knots;
}

double segment_error(const std::vector<Knot>& knots, std::size_t i, std::size_t j) {
    double sum = 0.0;
    for (std::size_t k = i + 1; k < j; ++k) {
        const double s = (knots[k].b - knots[i].b) / (knots[j].b - knots[i].b);
        const double d = knots[i].h + (knots[j].h - knots[i].h) * s - knots[k].h;
        sum += knots[k].weight * d * d;
    }
    return sum;
}

// Shortest polyline through a choice of the knots: every point costs as much as a little error over the whole section.
std::vector<Knot> simplify(const std::vector<Knot>& knots, double point_cost) {
    const std::size_t n = knots.size();
    std::vector<double> cost(n, 1e300);
    std::vector<std::size_t> from(n, 0);
    cost[0] = 0.0;
    for (std::size_t j = 1; j < n; ++j)
        for (std::size_t i = 0; i < j; ++i) {
            const double c = cost[i] + point_cost + segment_error(knots, i, j);
            if (c < cost[j]) cost[j] = c, from[j] = i;
        }
    std::vector<Knot> chosen;
    for (std::size_t k = n - 1; k > 0; k = from[k]) chosen.push_back(knots[k]);
    chosen.push_back(knots[0]);
    std::reverse(chosen.begin(), chosen.end());
    return chosen;
}

// A wall seen through texels is wider by their own extent: a ramp of width w and a box of width 1 have together the
// variance (w^2 + 1) / 12. Only walls that rise by a good part of the section are evidence of that.
void undo_blur(std::vector<Knot>& knots, double rise_least) {
    for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
        const double width = knots[k + 1].b - knots[k].b;
        const double rise = std::fabs(knots[k + 1].h - knots[k].h);
        if (rise < rise_least || width > 3.0) continue;
        const double sharp = std::sqrt(std::max(0.01, width * width - 1.0));
        const double shrink = 0.5 * (width - sharp);
        knots[k].b += shrink;
        knots[k + 1].b -= shrink;
    }
}

}  // namespace

Profile fit_profile(const std::vector<double>& height, const std::vector<double>& weight, double right_level,
                    double noise) {
    double most = std::fabs(right_level), total = 0.0, heaviest = 0.0;
    for (const double w : weight) heaviest = std::max(heaviest, w);
    for (std::size_t k = 0; k < height.size(); ++k) {
        if (weight[k] >= 0.35 * heaviest) most = std::max(most, std::fabs(height[k]));
        total += weight[k];
    }
    const double tolerance = 0.008 * most + 0.1 * noise;
    std::vector<Knot> knots = collect_knots(height, weight, right_level, 0.015 * most + 0.3 * noise);
    double inner = 0.0;
    for (const Knot& knot : knots) inner += knot.weight;
    std::vector<Knot> chosen;
    double point_cost = std::max(inner, 1.0) * tolerance * tolerance;
    do {
        chosen = simplify(knots, point_cost);
        point_cost *= 2.0;
    } while (chosen.size() > 14);
    undo_blur(chosen, 0.25 * most);
    Profile profile;
    for (const Knot& knot : chosen) profile.points.push_back({knot.b, knot.h});
    // The ground of a step changes at b = 0, so its section must reach to both sides of it.
    profile.points.front().b = std::min(profile.points.front().b, -0.02);
    profile.points.back().b = std::max(profile.points.back().b, 0.02);
    return profile;
}

}  // namespace burin::vectorizing
