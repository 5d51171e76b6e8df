// Which traced chains are lines, and which texels they take. Part of stage vectorize.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "vectorize_internal.hpp"
#include "vectorize_parts.hpp"

namespace burin::vectorizing {

// Calls visit(point, normal, half_width) about once a texel along the chain.
template <typename Visit>
void for_each_place(const Chain& chain, const Visit& visit) {
    for (std::size_t i = 0; i + (chain.closed ? 0 : 1) < chain.points.size(); ++i) {
        const Vec2 a = chain.points[i];
        const Vec2 b = i + 1 < chain.points.size() ? chain.points[i + 1] : chain.points.front() + chain.winding;
        if (length(b - a) == 0.0) continue;
        const int pieces = std::max(1, static_cast<int>(std::ceil(length(b - a))));
        for (int piece = 0; piece <= pieces; ++piece)
            visit(lerp(a, b, static_cast<double>(piece) / pieces), normal_of(unit(b - a)),
                  std::lerp(chain.half_width_at(i), chain.half_width_at((i + 1) % chain.points.size()),
                            static_cast<double>(piece) / pieces));
    }
}

// Calls visit(index, centre) for the texels within `reach` of p; the centre is the one near p on a map that tiles.
template <typename Visit>
void for_each_texel_near(Vec2 p, const Lattice& lattice, int reach, const Visit& visit) {
    const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
    for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
            const int j = dx * dx + dy * dy <= reach * reach ? lattice.index(x + dx, y + dy) : -1;
            if (j >= 0) visit(j, Vec2{x + dx + 0.5, y + dy + 0.5});
        }
}

inline double chain_length(const Chain& chain) {
    double sum = 0.0;
    for (std::size_t i = 1; i < chain.points.size(); ++i) sum += length(chain.points[i] - chain.points[i - 1]);
    return sum;
}

inline constexpr std::int32_t kNobody = -1, kSeveral = -2;

// Which chain each texel is a part of: its index, nobody's, or several chains'.
std::vector<std::int32_t> claim_texels(const std::vector<Chain>& chains, const Lattice& lattice);

// The chains that are lines of a scale, or the parts of them that are. What explains less than `least_energy` is none.
// `shapes`: the connected parts of the mask whose skeleton the chains are.
std::vector<Chain> keep_lines(const std::vector<Chain>& chains, const std::vector<std::uint8_t>& mask, const Parts& shapes,
                              const Image& map, const Lattice& lattice, double noise, double least_energy,
                              const LineScale& scale);

}  // namespace burin::vectorizing
