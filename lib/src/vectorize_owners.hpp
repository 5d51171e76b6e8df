// Which chain every texel is nearest to, and where along and across the chain the texel lies. Texels.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "vectorize_internal.hpp"
#include "vectorize_profiles.hpp"

namespace burin::vectorizing {

inline constexpr std::uint32_t kNoChain = 0x7fffffffu;

// The nearest chain of a texel, and the signed offset from it.
struct Owner {
    float offset = 1e9f;
    std::uint32_t chain : 31 = kNoChain;
    std::uint32_t beyond : 1 = 0;  // past an open end, where the section does not hold

    float distance() const { return std::fabs(offset); }
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

// A piece that is looked at from many texels.
class PieceFrame {
  public:
    explicit PieceFrame(const Piece& piece)
        : piece_(piece), length_(length(piece.b - piece.a)), t_((piece.b - piece.a) * (1.0 / length_)), n_(normal_of(t_)) {}

    // The place of a texel's centre; false where it is not nearer than `reach`.
    bool find_place(Vec2 centre, double reach, Place& place) const {
        const Vec2 q = centre - piece_.a;
        const double along = dot(q, t_), across = dot(q, n_);
        const double past = along < 0.0 ? -along : along > length_ ? along - length_ : 0.0;
        const double square = past * past + across * across;
        if (square >= reach * reach) return false;
        place.distance = std::sqrt(square);
        // Round the end of a square spot its profile stands at the greater of both distances.
        const double around = piece_.spot == Spot::square ? std::max(past, std::fabs(across)) : place.distance;
        place.offset = past > 0.0 ? (across < 0.0 ? -around : around) : across;
        place.along = std::clamp(along / length_, 0.0, 1.0);
        const bool open = (along < 0.0 && piece_.first) || (along > length_ && piece_.last);
        place.beyond = past > 0.25 && piece_.spot == Spot::no && open;
        return true;
    }

  private:
    const Piece& piece_;
    double length_;
    Vec2 t_, n_;
};

// Columns of row y within reach of the piece; its box would be wasteful for long diagonals. False: none.
bool columns_near(const Piece& piece, int y, double reach, int& first, int& last);

// Calls visit(texel, place) for the texels whose centres lie nearer than `reach`.
template <typename Visit>
void for_each_texel_of_piece(const Lattice& lattice, const Piece& piece, double reach, const Visit& visit) {
    if (piece.a == piece.b) return;
    const PieceFrame frame(piece);
    Place place;
    const int y0 = static_cast<int>(std::floor(std::min(piece.a.y, piece.b.y) - reach));
    const int y1 = static_cast<int>(std::ceil(std::max(piece.a.y, piece.b.y) + reach));
    for (int y = y0; y <= y1; ++y) {
        int x0 = 0, x1 = -1;
        if (!columns_near(piece, y, reach, x0, x1)) continue;
        for (int x = x0; x <= x1; ++x) {
            const int texel = lattice.index(x, y);
            if (texel >= 0 && frame.find_place({x + 0.5, y + 0.5}, reach, place)) visit(texel, place);
        }
    }
}

std::vector<Owner> find_owners(const std::vector<FittedChain>& chains, const Lattice& lattice, double reach);

}  // namespace burin::vectorizing
