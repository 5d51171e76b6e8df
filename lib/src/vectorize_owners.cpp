// The nearest chain of every texel.
#include "vectorize_owners.hpp"

#include <burin/fit.hpp>

namespace burin::vectorizing {

std::vector<Piece> flatten(const FittedChain& fitted) {
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < fitted.elements.size(); ++i) {
        const Element& e = fitted.elements[i];
        int n = 1;
        if (e.kind == ElementKind::quadratic) {
            const double bend = length(e.p0 - 2.0 * e.p1 + e.p2);
            n = std::clamp(static_cast<int>(std::ceil(std::sqrt(bend / (4.0 * 0.02)))), 1, 64);
        }
        for (int k = 0; k < n; ++k)
            pieces.push_back({point_at(e, double(k) / n), point_at(e, double(k + 1) / n), static_cast<std::uint32_t>(i),
                              double(k) / n, double(k + 1) / n});
    }
    for (Piece& piece : pieces) piece.spot = fitted.chain.spot;
    if (!fitted.chain.closed && !pieces.empty()) {
        pieces.front().first = true;
        pieces.back().last = true;
    }
    return pieces;
}

bool columns_near(const Piece& piece, int y, double reach, int& first, int& last) {
    const Vec2 d = piece.b - piece.a;
    const double above = y + 0.5 - reach, below = y + 0.5 + reach;
    double low = 1e300, high = -1e300;
    for (const Vec2 p : {piece.a, piece.b})
        if (p.y >= above && p.y <= below) low = std::min(low, p.x), high = std::max(high, p.x);
    if (d.y != 0.0)
        for (const double edge : {above, below}) {
            const double s = (edge - piece.a.y) / d.y;
            if (s < 0.0 || s > 1.0) continue;
            low = std::min(low, piece.a.x + d.x * s);
            high = std::max(high, piece.a.x + d.x * s);
        }
    if (low > high) return false;
    first = static_cast<int>(std::floor(low - reach));
    last = static_cast<int>(std::ceil(high + reach));
    return true;
}

std::vector<Owner> find_owners(const std::vector<FittedChain>& chains, const Lattice& lattice, double reach) {
    std::vector<Owner> owners(static_cast<std::size_t>(lattice.size()));
    for (std::size_t c = 0; c < chains.size(); ++c)
        for (const Piece& piece : flatten(chains[c]))
            for_each_texel_of_piece(lattice, piece, reach, [&](int texel, const Place& place) {
                Owner& owner = owners[texel];
                if (place.distance >= static_cast<double>(owner.distance)) return;
                owner.distance = static_cast<float>(place.distance);
                owner.chain = static_cast<std::uint32_t>(c);
                owner.offset = static_cast<float>(place.offset);
                owner.beyond = place.beyond;
            });
    return owners;
}

}  // namespace burin::vectorizing
