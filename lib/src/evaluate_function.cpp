// Scales along a path by a function of its arc length: "ALONG THE PATH" of resolve.hpp, in double precision.
#include <algorithm>
#include <numbers>

#include "evaluate_prepare.hpp"

namespace burin::truth {
namespace {

struct Wave {
    double value, rate;
};

Wave sine_at(double a) {
    const double turn = 2.0 * std::numbers::pi, angle = turn * (a - std::floor(a));
    return {std::sin(angle), turn * std::cos(angle)};
}

Wave polynomial_at(const double c[4], double a) {
    return {((c[3] * a + c[2]) * a + c[1]) * a + c[0], (3.0 * c[3] * a + 2.0 * c[2]) * a + c[1]};
}

// A random number in [-1, 1] for each lattice point: half of the mixed bits for widths, half for heights.
double lattice_value(const ScaleFunction& f, std::uint32_t octave, std::uint32_t point, bool heights) {
    std::uint32_t bits = point + f.seed * 0x9e3779b9u + octave * 0x85ebca6bu;
    bits ^= bits >> 16;
    bits *= 0x7feb352du;
    bits ^= bits >> 15;
    bits *= 0x846ca68bu;
    bits ^= bits >> 16;
    const std::uint32_t half = heights ? bits >> 16 : bits & 0xffffu;
    return 2.0 * half / 65535.0 - 1.0;
}

Wave noise_at(const ScaleFunction& f, double a, bool heights) {
    Wave sum{0, 0};
    double whole = 0.0;
    for (std::uint32_t octave = 0; octave < f.octaves; ++octave) {
        const double frequency = static_cast<double>(1u << octave), weight = 1.0 / frequency;
        const double y = a * frequency + 0.375 * octave, cell = std::floor(y), t = y - cell;
        const auto point = [&](double k) {
            const auto i = static_cast<std::uint32_t>(k);
            return lattice_value(f, octave, f.period > 0 ? i % (f.period << octave) : i, heights);
        };
        const double from = point(cell), to = point(cell + 1.0);
        sum.value += weight * (from + (to - from) * t * t * (3.0 - 2.0 * t));
        sum.rate += (to - from) * 6.0 * t * (1.0 - t);
        whole += weight;
    }
    return {sum.value / whole, sum.rate / whole};
}

Wave factor_at(const ScaleFunction& f, double a, bool heights) {
    const double amplitude = heights ? f.height : f.width;
    if (f.kind == PerturbationKind::polynomial) return polynomial_at(heights ? f.height_polynomial : f.width_polynomial, a);
    const Wave wave = f.kind == PerturbationKind::sine ? sine_at(a) : noise_at(f, a, heights);
    return {1.0 + amplitude * wave.value, amplitude * wave.rate};
}

}  // namespace

Run run_to(const PreparedElement& e, double u) {
    constexpr double kWeight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    const double off = std::sqrt(0.6), node[3] = {0.5 - 0.5 * off, 0.5, 0.5 + 0.5 * off};
    Run run;
    for (int i = 0; i < 3; ++i) {
        const Vec2 d = e.edge + e.bend * (u * node[i]);
        const double speed = length(d);
        run.length += kWeight[i] * u * speed;
        run.rate += kWeight[i] * (speed + (speed > 0.0 ? u * node[i] * dot(d, e.bend) / speed : 0.0));
    }
    return run;
}

Factors factors_on(const PreparedElement& e, double u) {
    if (e.function == nullptr) return {};
    double share = u, rate = 1.0;
    if (e.kind == ElementKind::quadratic && e.run > 0.0) {
        const Run run = run_to(e, u);
        share = run.length / e.run, rate = run.rate / e.run;
    }
    const double a = e.argument0 + e.argument_rise * share;
    rate *= e.argument_rise;
    const Wave width = factor_at(*e.function, a, false), height = factor_at(*e.function, a, true);
    return {width.value, height.value, width.rate * rate, height.rate * rate};
}

void bound_factors(PreparedElement& e) {
    if (e.function == nullptr) return;
    const ScaleFunction& f = *e.function;
    const double from = e.argument0, to = e.argument0 + e.argument_rise;
    // A polynomial by the hull of its Bernstein coefficients over [from, to].
    const auto bound = [&](const double c[4], double amplitude) {
        if (f.kind != PerturbationKind::polynomial) return 1.0 + std::abs(amplitude);
        const Wave p = polynomial_at(c, from), q = polynomial_at(c, to);
        const double third = (to - from) / 3.0;
        return std::max({p.value, q.value, p.value + third * p.rate, q.value - third * q.rate});
    };
    e.width_bound = bound(f.width_polynomial, f.width);
    e.height_bound = bound(f.height_polynomial, f.height);
}

}  // namespace burin::truth
