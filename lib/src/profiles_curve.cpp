#include "profiles_curve.hpp"

#include <algorithm>
#include <cmath>

#include "steady_math.hpp"

namespace burin::profiling {
namespace {

constexpr int kSamples = 192;

struct Sample {
    Vec2 at;
    Vec2 outward;  // unit normal on the outer side of the bend; 0 at both ends, which stay where they are
};

std::vector<Sample> sampled(const Curve& curve) {
    std::vector<Sample> samples(kSamples + 1);
    for (int i = 0; i <= kSamples; ++i) samples[std::size_t(i)].at = curve(double(i) / kSamples);
    for (std::size_t i = 1; i < kSamples; ++i) {
        const Vec2 before = samples[i].at - samples[i - 1].at, after = samples[i + 1].at - samples[i].at;
        const Vec2 chord = before + after, side{chord.y, -chord.x};
        const double bend = cross(before, after), size = steady::distance(side);
        if (size > 0.0 && bend != 0.0) samples[i].outward = side * ((bend > 0.0 ? 1.0 : -1.0) / size);
    }
    return samples;
}

double distance_to(Vec2 p, Vec2 a, Vec2 b) {
    const Vec2 way = b - a;
    const double square = dot(way, way), s = square > 0.0 ? std::clamp(dot(p - a, way) / square, 0.0, 1.0) : 0.0;
    return steady::distance(p - (a + way * s));
}

// Where the polyline turns at a sample when the curve may lie `tolerance` off it.
Vec2 corner(const Sample& sample, double tolerance) {
    const Vec2 p = sample.at + sample.outward * tolerance;
    return {std::clamp(p.x, 0.0, 1.0), std::clamp(p.y, 0.0, 1.0)};
}

bool stays_near(const std::vector<Sample>& samples, std::size_t from, std::size_t to, double tolerance) {
    const Vec2 a = corner(samples[from], tolerance), b = corner(samples[to], tolerance);
    if (b.x < a.x || b.y < a.y) return false;
    for (std::size_t i = from; i <= to; ++i)
        if (distance_to(samples[i].at, a, b) > tolerance) return false;
    return true;
}

// Corners of the polyline that goes as far as the tolerance allows with every segment.
std::vector<std::size_t> reach(const std::vector<Sample>& samples, double tolerance) {
    std::vector<std::size_t> corners = {0};
    while (corners.back() + 1 < samples.size()) {
        const std::size_t from = corners.back();
        std::size_t near = from + 1, far = samples.size();
        if (stays_near(samples, from, far - 1, tolerance)) near = far - 1;
        while (near + 1 < far) {
            const std::size_t middle = (near + far) / 2;
            (stays_near(samples, from, middle, tolerance) ? near : far) = middle;
        }
        corners.push_back(near);
    }
    return corners;
}

}  // namespace

std::vector<Vec2> few_points(const Curve& curve, int count) {
    const std::vector<Sample> samples = sampled(curve);
    double low = 0.0, high = 1.0;
    for (int halving = 0; halving < 24; ++halving) {
        const double middle = 0.5 * (low + high);
        (reach(samples, middle).size() <= std::size_t(count) ? high : low) = middle;
    }
    std::vector<Vec2> points;
    for (const std::size_t i : reach(samples, high)) {
        const Vec2 p = corner(samples[i], high);
        // Where an S is upright in its middle, its outer sides lie the wrong way round.
        points.push_back(points.empty() ? p : Vec2{std::max(p.x, points.back().x), std::max(p.y, points.back().y)});
    }
    return points;
}

}  // namespace burin::profiling
