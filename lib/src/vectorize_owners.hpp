// Which chain every texel is nearest to, and where along and across the chain the texel lies. Texels.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "vectorize_internal.hpp"
#include "vectorize_profiles.hpp"

namespace burin::vectorizing {

inline constexpr std::uint32_t kNoChain = 0xffffffffu;

// The nearest chain of a texel, and the signed offset from it.
struct Owner {
    float distance = 1e9f;
    float offset = 0.0f;
    std::uint32_t chain = kNoChain;
    bool beyond = false;  // past an open end, where the section does not hold
};

// A straight piece of an element; t runs over it from t0 to t1.
struct Piece {
    Vec2 a, b;
    std::uint32_t element = 0;
    double t0 = 0.0, t1 = 1.0;
    bool first = false, last = false;  // at an open end of the chain
    Spot spot = Spot::no;
};
std::vector<Piece> flatten(const FittedChain& fitted);

// A texel's place beside a piece.
struct Place {
    double distance = 0.0, offset = 0.0;
    double along = 0.0;   // share of the piece, 0 to 1
    bool beyond = false;  // past an open end of the chain
};

// Columns of row y within reach of the piece; its box would be wasteful for long diagonals. False: none.
bool columns_near(const Piece& piece, int y, double reach, int& first, int& last);

// Calls visit(texel, place) for the texels whose centres lie nearer than `reach`.
template <typename Visit>
void for_each_texel_of_piece(const Lattice& lattice, const Piece& piece, double reach, const Visit& visit) {
    const Vec2 d = piece.b - piece.a;
    const double l = length(d);
    if (l == 0.0) return;
    const Vec2 t = d * (1.0 / l), n = normal_of(t);
    const int y0 = static_cast<int>(std::floor(std::min(piece.a.y, piece.b.y) - reach));
    const int y1 = static_cast<int>(std::ceil(std::max(piece.a.y, piece.b.y) + reach));
    for (int y = y0; y <= y1; ++y) {
        int x0 = 0, x1 = -1;
        if (!columns_near(piece, y, reach, x0, x1)) continue;
        for (int x = x0; x <= x1; ++x) {
            const int texel = lattice.index(x, y);
            if (texel < 0) continue;
            const Vec2 q = Vec2{x + 0.5, y + 0.5} - piece.a;
            const double along = dot(q, t), across = dot(q, n);
            const double past = along < 0.0 ? -along : along > l ? along - l : 0.0;
            const double square = past * past + across * across;
            if (square >= reach * reach) continue;
            const double distance = std::sqrt(square);
            Place place;
            place.distance = distance;
            // Round the end of a square spot its profile stands at the greater of both distances.
            const double around = piece.spot == Spot::square ? std::max(past, std::fabs(across)) : distance;
            place.offset = past > 0.0 ? (across < 0.0 ? -around : around) : across;
            place.along = std::clamp(along / l, 0.0, 1.0);
            place.beyond = past > 0.25 && piece.spot == Spot::no && ((along < 0.0 && piece.first) || (along > l && piece.last));
            visit(texel, place);
        }
    }
}

std::vector<Owner> find_owners(const std::vector<FittedChain>& chains, const Lattice& lattice, double reach);

}  // namespace burin::vectorizing
