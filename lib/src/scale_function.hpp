// The functions that perturb scales along paths, for the stages from resolve to pack: values and bounds. Private to lib.
// The truth has its own formulas on purpose.
#pragma once

#include <burin/resolve.hpp>

namespace burin {

// Of both factors; the bounds hold, and are near to what is reached.
struct FactorRange {
    double width_low = 1.0, width_high = 1.0;
    double height_low = 1.0, height_high = 1.0;
};
// Over the arguments from a0 to a1, a0 <= a1. Cost: of noise, a look at each lattice point between, some hundreds at most.
FactorRange factor_range(const ScaleFunction& function, double a0, double a1);
// The same of an element; 1 where it has no function.
FactorRange factor_range(const ResolvedPattern& pattern, const ResolvedElement& element, double s0, double s1);

}  // namespace burin
