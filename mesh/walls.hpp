// Which element an upright face between two columns is of.
#pragma once

#include "columns.hpp"

namespace burin::mesh {

// All must outlive it. `levels`: of the ground over each triangle, see find_levels.
class Walls {
  public:
    Walls(const reference::LocalGeometry& geometry, const reference::Gathered& gathered, const Columns& columns, const std::vector<double>& levels,
          double level_tolerance)
        : geometry_(geometry), gathered_(gathered), columns_(columns), levels_(levels), level_tolerance_(level_tolerance) {}

    // Of the wall over an edge of the plan at `at`, solid over triangle `solid` and open over `open`, as the truth has it: of the step whose
    // path line the edge is, where the ground changes there; else of the first element that cuts on the open side alone; else of the
    // first that stands on the solid side alone; else of the ground. `open` may be kBorder.
    std::uint32_t element_of(std::int32_t solid, std::int32_t open, std::uint32_t step, const reference::Vec3& at) const;

  private:
    bool reaches(const reference::Brush& brush, bool cut, const reference::Vec3& at) const;
    // The first that reaches it over triangle `there`, and not over triangle `here`; kGround: none.
    std::uint32_t first_beyond(std::int32_t there, std::int32_t here, bool cut, const reference::Vec3& at) const;
    std::span<const std::uint32_t> brushes_of(std::int32_t triangle) const;

    const reference::LocalGeometry& geometry_;
    const reference::Gathered& gathered_;
    const Columns& columns_;
    const std::vector<double>& levels_;
    double level_tolerance_;
};

}  // namespace burin::mesh
