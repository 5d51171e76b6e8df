// Curves for traced chains. Part of stage vectorize; lengths in texels.
#pragma once

#include "vectorize_internal.hpp"
#include "vectorize_profiles.hpp"

namespace burin::vectorizing {

// Lines and quadratics within the tolerance of the chains' points, or corners alone where these are fewer. The map tells
// a corner of a wide line from a tight bend. Chains of no extent are left out; the result does not depend on `threads`.
std::vector<FittedChain> fit_chains(const std::vector<Chain>& chains, const Image& map, const Lattice& lattice,
                                    double tolerance, int threads);

// Where a line that ends in a node or on another line turns about within less than its width, it goes straight on.
void straighten_tails(FittedChain& fitted);

// Contours of one map never cross; where their fits do, they are fitted again by lines ever closer to the points.
void untangle_steps(std::vector<FittedChain>& chains, const Lattice& lattice, double tolerance);

// How many elements would follow the chains within the tolerance: a fast guess.
std::size_t foretell_elements(const std::vector<Chain>& chains, double tolerance);

}  // namespace burin::vectorizing
