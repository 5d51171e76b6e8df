// Authored patterns whose scales follow functions along the paths. Included by patterns.hpp, whose words it uses.
#pragma once

namespace burin::testing {

inline Perturbation wave(double width, double height, double wavelength, double phase = 0.0) {
    Perturbation p;
    p.width = width, p.height = height;
    p.wavelength = wavelength, p.phase = phase;
    return p;
}
inline Perturbation noise(double width, double height, double wavelength, int octaves, std::uint32_t seed) {
    Perturbation p = wave(width, height, wavelength);
    p.kind = PerturbationKind::noise;
    p.octaves = octaves, p.seed = seed;
    return p;
}
// Cubics in the share of the path's length.
inline Perturbation cubic(std::array<double, 4> width, std::array<double, 4> height) {
    Perturbation p;
    p.kind = PerturbationKind::polynomial;
    std::copy(width.begin(), width.end(), p.width_polynomial);
    std::copy(height.begin(), height.end(), p.height_polynomial);
    return p;
}
inline Path perturbed(Path path, std::uint32_t perturbation) {
    path.perturbation = perturbation;
    return path;
}

// Grooves and ridges that swell; one with a corner, one that is scaled as well, one across the tile's border, all caps.
inline Pattern sine_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.03, 0.006), ridge(0.02, 0.004), lipped(0.03, 0.006, 0.003)};
    p.perturbations = {wave(0.4, 0.3, 0.12), wave(0.3, -0.4, 0.2, 0.3), wave(0.25, 0.0, 0.05)};
    Path narrow = polyline({{0.1, 0.85}, {0.9, 0.9}}, 0);
    narrow.elements[0].width1 = 0.5, narrow.elements[0].height1 = 0.6;
    p.paths = {with_caps(perturbed(polyline({{0.1, 0.1}, {0.9, 0.15}}, 0), 0), CapKind::round),
               perturbed(polyline({{0.15, 0.3}, {0.5, 0.35}, {0.7, 0.25}, {0.9, 0.4}}, 2), 1),
               with_caps(perturbed(polyline({{0.1, 0.5}, {0.6, 0.55}}, 1), 2), CapKind::butt),
               with_caps(perturbed(polyline({{0.7, 0.65}, {1.25, 0.7}}, 2), 0), CapKind::taper), perturbed(narrow, 1)};
    return p;
}

inline Pattern waved_curve_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.02, 0.006), ridge(0.015, 0.005), lipped(0.03, 0.006, 0.003)};
    p.perturbations = {wave(0.4, 0.3, 0.1), wave(0.3, -0.4, 0.21, 0.3), noise(0.5, 0.4, 0.1, 1, 7),
                       noise(0.4, 0.4, 0.15, 3, 12)};
    p.paths = {perturbed(circle({0.3, 0.3}, 0.2, 0), 0), perturbed(circle({0.7, 0.3}, 0.15, 1, true), 2),
               perturbed(circle({0.6, 0.7}, 0.22, 2), 1)};
    Path snake;
    snake.profile = 0;
    snake.perturbation = 3;
    snake.elements = {make_arc({0.05, 0.9}, {0.15, 0.7}, {0.25, 0.9}), make_arc({0.25, 0.9}, {0.35, 1.1}, {0.45, 0.9})};
    p.paths.push_back(snake);
    return p;
}

inline Pattern noise_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.03, 0.005), ridge(0.02, 0.004), vee(0.02, 0.005)};
    p.perturbations = {noise(0.5, 0.5, 0.15, 1, 1), noise(0.4, 0.3, 0.3, 4, 2), noise(0.8, 0.2, 0.1, 2, 3)};
    p.paths = {perturbed(polyline({{0.1, 0.15}, {0.9, 0.1}}, 0), 0), perturbed(polyline({{0.1, 0.4}, {0.9, 0.35}}, 1), 1),
               perturbed(polyline({{0.15, 0.6}, {0.85, 0.6}, {0.8, 0.9}, {0.2, 0.85}}, 2, true), 2)};
    return p;
}

inline Pattern polynomial_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.03, 0.008), ridge(0.02, 0.006), lipped(0.03, 0.006, 0.003)};
    p.perturbations = {cubic({0.2, 4.0, -4.0, 0.0}, {0.3, 2.8, -2.8, 0.0}), cubic({1.5, -3.0, 2.2, 0.2}, {1.0, 0.0, -0.7, 0.0}),
                       cubic({1.0, 1.6, -4.8, 3.2}, {1.0, -1.0, 3.0, -2.0})};
    Path bent;
    bent.profile = 2;
    bent.elements = {make_arc({0.1, 0.6}, {0.3, 0.4}, {0.5, 0.6}), make_arc({0.5, 0.6}, {0.7, 0.8}, {0.9, 0.6})};
    p.paths = {perturbed(polyline({{0.1, 0.1}, {0.9, 0.15}}, 0), 0),
               perturbed(polyline({{0.9, 0.35}, {0.5, 0.25}, {0.1, 0.3}}, 1), 1), perturbed(bent, 0),
               perturbed(circle({0.5, 0.82}, 0.1, 0), 2)};
    return p;
}

// Waves shorter than the path is wide, and full ones that close the groove.
inline Pattern fine_waves_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.04, 0.005), ridge(0.03, 0.004), vee(0.03, 0.005)};
    p.perturbations = {wave(0.2, 0.3, 0.03), noise(0.3, 0.3, 0.06, 3, 9), wave(1.0, 0.6, 0.1), noise(0.2, 0.6, 0.02, 1, 4)};
    p.paths = {perturbed(polyline({{0.1, 0.15}, {0.9, 0.1}}, 0), 0), perturbed(polyline({{0.1, 0.35}, {0.9, 0.3}}, 1), 1),
               perturbed(polyline({{0.15, 0.5}, {0.85, 0.55}}, 2), 2), perturbed(circle({0.5, 0.78}, 0.13, 2), 3)};
    return p;
}

// Waved grooves and ridges that cross, end on each other, go over a waved step, and end free.
inline Pattern waved_junctions_pattern() {
    Pattern p = base(kRise);
    p.profiles = {groove(0.03, 0.004), ridge(0.025, 0.004), vee(0.02, 0.004), step(0.02, 0.004)};
    p.perturbations = {wave(0.4, 0.3, 0.13), noise(0.4, 0.3, 0.12, 2, 5), wave(0.3, 0.0, 0.11)};
    p.paths = {perturbed(polyline({{0.05, 0.3}, {0.95, 0.35}}, 0), 0), perturbed(polyline({{0.3, 0.1}, {0.35, 0.9}}, 2), 1),
               perturbed(polyline({{0.1, 0.75}, {0.5, 0.6}}, 1), 0), perturbed(polyline({{0.6, 0.05}, {0.55, 0.33}}, 2), 0),
               perturbed(polyline({{0.6, 0.55}, {0.9, 0.55}, {0.9, 0.9}, {0.6, 0.9}}, 3, true), 2),
               perturbed(polyline({{0.45, 0.7}, {0.8, 0.75}}, 0), 1)};
    return p;
}

}  // namespace burin::testing
