// The nearest chain of every texel.
#include "vectorize_owners.hpp"

#include <burin/fit.hpp>

#include "parallel.hpp"

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

namespace {

// Squares of kCell texels, and the pieces that may be the nearest to one of their texels.
constexpr int kCell = 16;

struct Candidate {
    const Piece* piece;
    Vec2 shift;       // of the piece's image that is near
    double distance;  // of the cell's centre from it
};

double distance_to(const Piece& piece, Vec2 p) {
    const Vec2 d = piece.b - piece.a;
    const double t = std::clamp(dot(p - piece.a, d) / dot(d, d), 0.0, 1.0);
    return length(piece.a + d * t - p);
}

class Cells {
  public:
    Cells(const Lattice& lattice, double reach)
        : lattice_(lattice), reach_(reach), columns_((lattice.width + kCell - 1) / kCell),
          rows_((lattice.height + kCell - 1) / kCell), candidates_(static_cast<std::size_t>(columns_) * rows_) {}

    int rows() const { return rows_; }
    int columns() const { return columns_; }
    const std::vector<Candidate>& at(int column, int row) const { return candidates_[static_cast<std::size_t>(row) * columns_ + column]; }

    void add(const Piece& piece) {
        if (piece.a == piece.b) return;
        const Vec2 low{std::min(piece.a.x, piece.b.x) - reach_, std::min(piece.a.y, piece.b.y) - reach_};
        const Vec2 high{std::max(piece.a.x, piece.b.x) + reach_, std::max(piece.a.y, piece.b.y) + reach_};
        const int w = lattice_.width, h = lattice_.height;
        const auto first_tile = [&](double v, int n) { return lattice_.wrap ? static_cast<int>(std::floor(v / n)) : 0; };
        for (int ty = first_tile(low.y, h); ty <= first_tile(high.y, h); ++ty)
            for (int tx = first_tile(low.x, w); tx <= first_tile(high.x, w); ++tx)
                add_image(piece, {-double(tx) * w, -double(ty) * h}, low, high);
    }
    // A piece farther from the cell's centre than the nearest one by more than the cell's width is nowhere the nearest.
    void settle() {
        for_each_piece(candidates_.size(), lattice_.threads, [&](std::size_t cell) {
            double nearest = reach_ + kRadius;
            for (const Candidate& c : candidates_[cell]) nearest = std::min(nearest, c.distance);
            std::erase_if(candidates_[cell], [&](const Candidate& c) { return c.distance > nearest + 2.0 * kRadius + 1e-6; });
        });
    }

  private:
    static constexpr double kRadius = 0.7072 * kCell;

    void add_image(const Piece& piece, Vec2 shift, Vec2 low, Vec2 high) {
        const auto cell = [](double v, int n) { return std::clamp(static_cast<int>(std::floor(v / kCell)), 0, n - 1); };
        for (int y = cell(low.y + shift.y, rows_); y <= cell(high.y + shift.y, rows_); ++y)
            for (int x = cell(low.x + shift.x, columns_); x <= cell(high.x + shift.x, columns_); ++x) {
                const Vec2 centre{(x + 0.5) * kCell, (y + 0.5) * kCell};
                const double distance = distance_to(piece, centre - shift);
                if (distance < reach_ + kRadius)
                    candidates_[static_cast<std::size_t>(y) * columns_ + x].push_back({&piece, shift, distance});
            }
    }

    const Lattice& lattice_;
    double reach_;
    int columns_, rows_;
    std::vector<std::vector<Candidate>> candidates_;
};

// The texels [x0, x1) of row y that are nearer to the piece than to what they belong to become its own.
void claim_row(Owner* owners, const Candidate& candidate, std::uint32_t chain, int x0, int x1, int y, double reach) {
    const PieceFrame frame(*candidate.piece);
    Place place;
    for (int x = x0; x < x1; ++x) {
        Owner& owner = owners[x];
        const double limit = std::min(reach, static_cast<double>(owner.distance()));
        if (!frame.find_place(Vec2{x + 0.5, y + 0.5} - candidate.shift, limit, place)) continue;
        owner.chain = chain;
        owner.offset = static_cast<float>(place.offset);
        owner.beyond = place.beyond;
    }
}

}  // namespace

std::vector<Owner> find_owners(const std::vector<FittedChain>& chains, const Lattice& lattice, double reach) {
    std::vector<Piece> pieces;
    std::vector<std::uint32_t> chain_of;  // per piece
    for (std::size_t c = 0; c < chains.size(); ++c) {
        for (const Piece& piece : flatten(chains[c])) pieces.push_back(piece);
        chain_of.resize(pieces.size(), static_cast<std::uint32_t>(c));
    }
    Cells cells(lattice, reach);
    for (const Piece& piece : pieces) cells.add(piece);
    cells.settle();
    std::vector<Owner> owners(static_cast<std::size_t>(lattice.size()));
    for_each_piece(static_cast<std::size_t>(cells.rows()), lattice.threads, [&](std::size_t row) {
        const int y0 = static_cast<int>(row) * kCell, y1 = std::min(lattice.height, y0 + kCell);
        for (int column = 0; column < cells.columns(); ++column)
            for (const Candidate& candidate : cells.at(column, static_cast<int>(row)))
                for (int y = y0; y < y1; ++y)
                    claim_row(&owners[static_cast<std::size_t>(y) * lattice.width], candidate,
                              chain_of[static_cast<std::size_t>(candidate.piece - pieces.data())], column * kCell,
                              std::min(lattice.width, (column + 1) * kCell), y, reach);
    });
    return owners;
}

}  // namespace burin::vectorizing
