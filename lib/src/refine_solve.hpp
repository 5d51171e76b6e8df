// Damped normal equations of a refinement, sparse, solved by conjugate gradients.
#pragma once

#include <cstdint>
#include <vector>

#include "refine_forward.hpp"

namespace burin::refinement {

// Symmetric matrix by rows.
class NormalEquations {
  public:
    // Sums the parts in their order: the result does not depend on who computed them.
    NormalEquations(int unknowns, const std::vector<ElementUnknowns>& elements, const Prediction& prediction);

    // Adds springs: weight_i / 2 * (moved_i + step_i)^2.
    void add_springs(const std::vector<double>& weight, double factor, const std::vector<double>& moved);

    // Step that minimizes the quadratic model plus each unknown's damping * diagonal. Unknowns that are held, or that nothing depends on,
    // stay.
    std::vector<double> step(const std::vector<double>& damping, const std::vector<std::uint8_t>& held) const;

  private:
    void multiply(const std::vector<double>& x, const std::vector<double>& damped, std::vector<double>& out) const;

    std::vector<std::size_t> first_;
    std::vector<int> column_;
    std::vector<double> value_;
    std::vector<double> diagonal_;
    std::vector<double> springs_;
    std::vector<double> gradient_;
};

}  // namespace burin::refinement
