// Perturbations at random for the patterns of random_pattern.hpp: about every other path gets one of seven.
#pragma once

#include "random_pattern.hpp"

namespace burin::testing {

// Heights stay within what random_pattern leaves free; steps are perturbed in width alone, and polynomials close.
inline Pattern perturbed_pattern(std::uint64_t seed, const RandomPatternOptions& options = {}) {
    Pattern pattern = random_pattern(seed, options);
    Random random(seed ^ 0x70657274ull);
    const double unit = std::min(options.size.x, options.size.y);
    for (int i = 0; i < 6; ++i) {
        Perturbation p;
        p.kind = i % 2 == 0 ? PerturbationKind::sine : PerturbationKind::noise;
        p.width = random.between(-0.5, 0.5);
        p.height = i < 4 ? random.between(-0.5, 0.5) : 0.0;
        p.wavelength = random.between(0.03, 0.2) * unit;
        p.phase = random.between(-2.0, 2.0);
        p.seed = static_cast<std::uint32_t>(random.bits());
        p.octaves = 1 + random.below(4);
        pattern.perturbations.push_back(p);
    }
    Perturbation hump;  // 1 at both ends
    hump.kind = PerturbationKind::polynomial;
    const double width = random.between(-0.6, 0.6), height = random.between(-0.6, 0.6);
    hump.width_polynomial[1] = 4.0 * width, hump.width_polynomial[2] = -4.0 * width;
    hump.height_polynomial[1] = 4.0 * height, hump.height_polynomial[2] = -4.0 * height;
    pattern.perturbations.push_back(hump);
    for (Path& path : pattern.paths) {
        const bool step = path_kind(pattern, path) == PathKind::step;
        if (random.chance(0.6)) path.perturbation = static_cast<std::uint32_t>(step ? 4 + random.below(2) : random.below(7));
    }
    return pattern;
}

}  // namespace burin::testing
