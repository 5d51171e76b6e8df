// Widths and heights that vary along a line: a groove that fades, swells or tapers stays one path whose elements carry
// scales ([2010] 5.5, DESIGN 1 "perturbation"). Part of stage vectorize; texels and map values.
#pragma once

#include "vectorize_owners.hpp"
#include "vectorize_profiles.hpp"

namespace burin::vectorizing {

struct ScaleOptions {
    double reach = 32.0;         // texels, as ProfileOptions::reach
    double least_gain = 0.0;     // squared height error that an element with scales has to take away
};

// Gives the elements of lines (not steps) width and height scales where the map asks for them, and divides elements
// where the scales bend; adds to `gain`. `owners`: whose every texel is.
void measure_scales(std::vector<FittedChain>& chains, const ProfileSet& set, const Image& map, const Lattice& lattice,
                    const Regions& regions, const std::vector<Owner>& owners, const ScaleOptions& options);

}  // namespace burin::vectorizing
