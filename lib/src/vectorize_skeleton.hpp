// The graph of a thinned mask: strands between nodes. Part of stage vectorize.
#pragma once

#include <cmath>

#include "vectorize_internal.hpp"
#include "vectorize_parts.hpp"

namespace burin::vectorizing {

// A run of skeleton texels between two nodes, a node and a free end, two free ends, or a loop.
struct Strand {
    std::vector<Vec2> texels;   // centres, unwrapped, in order
    std::vector<Vec2> points;   // sub-texel centre line, near nodes left out
    int node[2] = {-1, -1};     // at the front and at the back; -1 is a free end
    bool loop = false;
    bool gone = false;          // pruned or contracted
    double half_width = 0.0;    // median over the points, texels
    double contrast = 0.0;      // median peak of the response
};

struct SkeletonNode {
    Vec2 position;              // centre of its texels
    double radius = 0.0;        // half-width of the mask there
};

struct Skeleton {
    std::vector<Strand> strands;
    std::vector<SkeletonNode> nodes;
};

// Bits of a mask's texels.
struct Mask {
    static constexpr std::uint8_t shape = 1;    // it belongs to the mask
    static constexpr std::uint8_t thin = 2;     // and to its lines of one texel
    static constexpr std::uint8_t node = 4;     // lines meet here
    static constexpr std::uint8_t visited = 8;  // a strand was followed over it
};

// Thins the mask to lines one texel wide that keep its topology: what goes loses its bit `thin`, which all texels of
// `parts` have before.
void thin_mask(std::vector<std::uint8_t>& mask, const Parts& parts, const Lattice& lattice);

// Euclidean distance of the centre of texel (x, y) to that of the nearest texel outside of all parts.
double distance_inside(const Parts& parts, const Lattice& lattice, int x, int y);

// Follows the lines of a thinned mask; `parts` are those of the whole mask.
// Spurs shorter than the mask is wide at their node are pruned, nodes that one crossing split are joined again.
Skeleton trace_skeleton(std::vector<std::uint8_t>& mask, const Parts& parts, const Lattice& lattice);

// Sub-texel centres, widths and contrasts of every strand from the response across it.
void measure_strands(Skeleton& skeleton, const Image& response, const Lattice& lattice);

// Pairs the strands that continue each other at nodes and ties the rest.
std::vector<Chain> join_strands(Skeleton& skeleton, const Image& response, const Lattice& lattice,
                                ChainKind kind);

// The way a chain takes near its end: an arc, fitted to the points that the cap does not disturb.
struct TailCurve {
    Vec2 origin, along;
    double curvature = 0.0;  // to the left
    double turn = 0.0;       // of the points it was fitted to, radians
    double misfit = 0.0;     // greatest distance of these points from it

    Vec2 at(double s) const {
        const double angle = curvature * s;
        if (std::fabs(angle) < 1e-4) return origin + along * s + normal_of(along) * (0.5 * curvature * s * s);
        return origin + along * (std::sin(angle) / curvature) + normal_of(along) * ((1.0 - std::cos(angle)) / curvature);
    }
};

// `near`: at least two points, from the end backwards. The arc is no tighter than the half-width.
TailCurve fit_tail(const std::vector<Vec2>& near, double half_width);

// Puts corners that were cut off where the straight lines on both sides of them meet.
void sharpen_corners(Chain& chain);

// Fills Chain::half_widths of a line that clearly tapers or swells, and steadily so.
void measure_half_widths(Chain& chain, const Image& response, const Lattice& lattice);

// Puts the free ends of a chain where its response ends, on the way the chain comes from.
void settle_ends(Chain& chain, const Image& response, const Lattice& lattice);

}  // namespace burin::vectorizing
