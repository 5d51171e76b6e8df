// The mean of a polyline profile over a small axis-aligned cell, in closed form, with its derivatives.
//
// Where the offset varies linearly over the cell, b = b0 + g.(q - centre), its distribution over the cell is the
// convolution of two boxes of widths u = |g.x| side.x and v = |g.y| side.y. The mean of a ramp (x)+ over that
// distribution is a difference of four cubics, and a polyline is a sum of ramps: the mean is exact however steep the
// walls are. Lengths in texels, heights in map scale.
#pragma once

#include <cstdint>
#include <vector>

#include <burin/resolve.hpp>

namespace burin::refinement {

constexpr int kMaxPoints = 40;  // BURIN_MAX_PROFILE_POINTS and the point that a step gets at b = 0
constexpr double kThinnestWall = 1e-3;  // texels: walls steeper than this are computed as if they were this wide

struct SweptProfile {
    std::vector<double> b, h;
    std::uint32_t internal_mask = 0;
    bool step = false;

    double left() const { return b.front(); }
    double right() const { return b.back(); }
};

// How b' spreads over a cell.
struct Spread {
    double u = 0.0, v = 0.0;
    double half() const { return 0.5 * (u + v); }
};

struct ProfileMean {
    double value = 0.0;
    double slope = 0.0;  // by b
};

SweptProfile swept(const ResolvedProfile& profile);

// Requires: spread.u + spread.v > 0. d_b and d_h have room for every point, or both are null.
ProfileMean profile_mean(const SweptProfile& profile, double b, Spread spread, double* d_b, double* d_h);

// Whether the facet at offset b cuts.
bool internal_at(const SweptProfile& profile, double b);

}  // namespace burin::refinement
