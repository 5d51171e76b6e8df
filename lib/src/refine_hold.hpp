// Steps of the refinement that would break the pattern: where its step paths would cross, they stay as they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <burin/pattern.hpp>
#include <burin/resolve.hpp>

#include "refine_forward.hpp"
#include "refine_parameters.hpp"

namespace burin::refinement {

// By path: 1 where anything is left of it once it is resolved.
std::vector<std::uint8_t> resolving_paths(const Pattern& pattern, const ResolvedPattern& resolved);

// The paths that resolved before and no longer do.
std::vector<std::size_t> lost_paths(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& after);

// Of the paths that cross in `next`, the elements beside the crossings stay from now on. Lengths in texels.
void hold_crossings(const std::vector<StepCrossing>& crossings, const Pattern& next, Parameters& parameters);

// Whole paths stay, with their profiles and levels: one may have become too wide, or a step of no height.
void hold_paths(const std::vector<std::size_t>& paths, const std::vector<ElementUnknowns>& elements, Parameters& parameters);

}  // namespace burin::refinement
