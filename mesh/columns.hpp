// What is solid over each triangle of the plan.
#pragma once

#include "edges.hpp"
#include "mesh.hpp"

namespace burin::mesh {

// An end of a solid stretch.
struct Boundary {
    reference::Plane plane;
    Origin origin;
};

// Boundaries of triangle t are [first[t], first[t + 1]), from the lowest to the highest: the solid begins at the first, which is the
// bottom, ends at the second, begins again at the third, and so on.
struct Columns {
    std::vector<Boundary> boundaries;
    std::vector<std::uint32_t> first;
    // Of the geometry, those that lie over each triangle, ascending, in ranges likewise.
    std::vector<std::uint32_t> brushes, first_brush;
    std::span<const Boundary> of(std::size_t t) const { return {boundaries.data() + first[t], first[t + 1] - first[t]}; }
    std::span<const std::uint32_t> brushes_of(std::size_t t) const { return {brushes.data() + first_brush[t], first_brush[t + 1] - first_brush[t]}; }
};

struct ColumnOptions {
    double bottom = 0.0;           // metres: where the solid begins
    double thin = 0.0;             // metres: a triangle narrower than this takes the column of its neighbour
    double level_tolerance = 0.0;  // metres: levels nearer than this are one
    int threads = 0;
};

// The level of the ground over each triangle. Path lines of steps part the plan into regions; a region has the level that most of it, by
// area, has according to `surface`: a straight piece of a bent line may leave a triangle on the wrong side of it.
std::vector<double> find_levels(const reference::GroovedSurface& surface, const Plan& plan);

// Cost: triangles times brushes near them.
Columns stack_columns(const reference::LocalGeometry& geometry, const reference::Gathered& gathered, const BrushBins& bins, const Plan& plan,
                      const std::vector<double>& levels, const ColumnOptions& options);

}  // namespace burin::mesh
