#include "refine_profile.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace burin::refinement {
namespace {

double square_part(double x) { return x > 0.0 ? 0.5 * x * x : 0.0; }
double cube_part(double x) { return x > 0.0 ? x * x * x / 6.0 : 0.0; }

struct RampMean {
    double ramp = 0.0;  // mean of (x)+
    double step = 0.0;  // its derivative, the mean of the unit step
};

// Means over the convolution of two boxes of widths u >= v.
RampMean ramp_mean(double x, double u, double v) {
    const double outer = 0.5 * (u + v);
    if (x >= outer) return {x, 1.0};
    if (x <= -outer) return {0.0, 0.0};
    // One box: what the narrow one adds is below 1e-9, and the difference of cubics would lose its digits.
    if (v < 1e-4 * u) {
        if (x >= 0.5 * u) return {x, 1.0};
        const double part = std::max(0.0, x + 0.5 * u);
        return {0.5 * part * part / u, part / u};
    }
    const double inner = 0.5 * (u - v);
    const double scale = 1.0 / (u * v);
    return {scale * (cube_part(x + outer) - cube_part(x + inner) - cube_part(x - inner) + cube_part(x - outer)),
            scale * (square_part(x + outer) - square_part(x + inner) - square_part(x - inner) +
                     square_part(x - outer))};
}

}  // namespace

SweptProfile swept(const ResolvedProfile& profile) {
    SweptProfile out;
    out.internal_mask = profile.internal_mask;
    for (const ProfilePoint& point : profile.points) {
        out.b.push_back(point.b);
        out.h.push_back(point.h);
    }
    // A vertical wall is opened evenly about its place; longer runs of equal offsets are pushed on to the right.
    for (std::size_t i = 0; i + 1 < out.b.size(); ++i) {
        if (out.b[i + 1] - out.b[i] >= kThinnestWall) continue;
        const double middle = 0.5 * (out.b[i] + out.b[i + 1]);
        const double least = i > 0 ? out.b[i - 1] + kThinnestWall : -1e300;
        out.b[i] = std::max(least, middle - 0.5 * kThinnestWall);
        out.b[i + 1] = out.b[i] + kThinnestWall;
    }
    assert(out.b.size() >= 2 && out.b.size() <= kMaxPoints);
    return out;
}

bool internal_at(const SweptProfile& profile, double b) {
    std::size_t facet = 0;
    while (facet + 2 < profile.b.size() && b > profile.b[facet + 1]) ++facet;
    return (profile.internal_mask >> facet) & 1u;
}

ProfileMean profile_mean(const SweptProfile& profile, double b, Spread spread, double* d_b, double* d_h) {
    const std::size_t count = profile.b.size();
    const double u = std::max(spread.u, spread.v);
    const double v = std::min(spread.u, spread.v);
    // Facets that lie wholly on the left have risen.
    std::size_t first = 0;
    while (first + 1 < count && profile.b[first + 1] <= b - spread.half()) ++first;
    ProfileMean mean{profile.h[first], 0.0};
    if (d_b) std::fill(d_b, d_b + count, 0.0);
    if (d_h) std::fill(d_h, d_h + count, 0.0);
    if (d_h) d_h[first] = 1.0;
    RampMean low = ramp_mean(b - profile.b[first], u, v);
    for (std::size_t i = first; i + 1 < count && low.ramp > 0.0; ++i) {
        const RampMean high = ramp_mean(b - profile.b[i + 1], u, v);
        const double width = profile.b[i + 1] - profile.b[i];
        const double rise = profile.h[i + 1] - profile.h[i];
        const double share = (low.ramp - high.ramp) / width;  // how much of the facet's rise has happened
        mean.value += rise * share;
        mean.slope += rise * (low.step - high.step) / width;
        if (d_b) {
            d_b[i] += rise * (share - low.step) / width;
            d_b[i + 1] += rise * (high.step - share) / width;
            d_h[i] -= share;
            d_h[i + 1] += share;
        }
        low = high;
    }
    return mean;
}

}  // namespace burin::refinement
