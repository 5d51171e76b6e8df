// Where in the plan the surface may have an edge: borders of brushes, and folds, where surfaces of brushes meet each other or the
// ground.
#pragma once

#include <span>

#include <reference/sweep.hpp>

#include "plan.hpp"

namespace burin::mesh {

// Brushes by where they lie in the map.
class BrushBins {
  public:
    BrushBins(const reference::LocalGeometry& geometry, Vec2 size);
    // Those that may lie over p, ascending.
    std::span<const std::uint32_t> at(Vec2 p) const { return of(row(p.y) * side_ + column(p.x)); }
    // Calls visit(a, b), a < b, once for every two brushes whose boxes meet inside the map.
    template <typename Visit>
    void for_each_pair(const Visit& visit) const {
        for (std::size_t bin = 0; bin < side_ * side_; ++bin)
            for (std::size_t i = 0; i < of(bin).size(); ++i)
                for (std::size_t k = i + 1; k < of(bin).size(); ++k)
                    if (is_first(bin, of(bin)[i], of(bin)[k])) visit(of(bin)[i], of(bin)[k]);
    }

  private:
    std::size_t column(double x) const;
    std::size_t row(double y) const;
    std::span<const std::uint32_t> of(std::size_t bin) const { return {brushes_.data() + first_[bin], first_[bin + 1] - first_[bin]}; }
    // Whether the boxes meet, and this is the first bin of what they share.
    bool is_first(std::size_t bin, std::uint32_t a, std::uint32_t b) const;

    const reference::LocalGeometry& geometry_;
    Vec2 size_;
    std::size_t side_ = 1;
    std::vector<std::uint32_t> brushes_, first_;
};

// Of brushes whose levels differ by more than `level_tolerance` (metres) nothing meets. Cost: pairs of brushes that lie over each other.
std::vector<PlanLine> find_edges(const reference::LocalGeometry& geometry, const BrushBins& bins, double level_tolerance);

}  // namespace burin::mesh
