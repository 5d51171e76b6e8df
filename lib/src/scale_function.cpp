#include "scale_function.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "resolve_curve.hpp"

namespace burin {
namespace {

struct Range {
    double low = 1e300, high = -1e300;
    void take(double value) { low = std::min(low, value), high = std::max(high, value); }
};

Range wave_range(double a0, double a1) {
    if (a1 - a0 >= 1.0) return {-1.0, 1.0};
    Range range;
    for (const double a : {a0, a1}) range.take(std::sin(2.0 * std::numbers::pi * a));
    // Crests and troughs lie at odd quarters.
    for (double k = std::ceil(2.0 * a0 - 0.5); 0.5 * k + 0.25 <= a1; k += 1.0)
        range.take(std::fmod(k, 2.0) == 0.0 ? 1.0 : -1.0);
    return range;
}

Range polynomial_range(const double c[4], double a0, double a1) {
    const auto value = [c](double a) { return c[0] + a * (c[1] + a * (c[2] + a * c[3])); };
    Range range;
    range.take(value(a0));
    range.take(value(a1));
    // Zeros of c1 + 2 c2 a + 3 c3 a^2, without cancellation; what does not exist is not finite and fails the test.
    const double sum = -(c[2] + std::copysign(std::sqrt(c[2] * c[2] - 3.0 * c[3] * c[1]), c[2]));
    for (const double root : {sum / (3.0 * c[3]), c[1] / sum})
        if (root > a0 && root < a1) range.take(value(root));
    return range;
}

// Lattice values of octave `octave`, for width and for height.
void lattice(const ScaleFunction& f, std::uint32_t octave, std::int64_t i, double out[2]) {
    if (f.period > 0) i %= static_cast<std::int64_t>(f.period) << octave;
    std::uint32_t h = static_cast<std::uint32_t>(i) + f.seed * 0x9e3779b9u + octave * 0x85ebca6bu;
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    h ^= h >> 16;
    out[0] = (h & 0xffffu) / 32767.5 - 1.0;
    out[1] = (h >> 16) / 32767.5 - 1.0;
}

// Each octave runs monotonously from one lattice value to the next.
void noise_range(const ScaleFunction& f, double a0, double a1, Range out[2]) {
    double low[2] = {0, 0}, high[2] = {0, 0}, weight = 1.0, sum = 0.0;
    for (std::uint32_t k = 0; k < f.octaves; ++k, weight *= 0.5) {
        const double shift = 0.375 * k, y0 = std::ldexp(a0, static_cast<int>(k)) + shift,
                     y1 = std::ldexp(a1, static_cast<int>(k)) + shift;
        Range range[2];
        if (y1 - y0 > 128.0) {
            range[0] = range[1] = {-1.0, 1.0};
        } else {
            for (const double y : {y0, y1}) {
                const double i = std::floor(y), t = y - i, share = t * t * (3.0 - 2.0 * t);
                double p[2], q[2];
                lattice(f, k, static_cast<std::int64_t>(i), p);
                lattice(f, k, static_cast<std::int64_t>(i) + 1, q);
                for (int c = 0; c < 2; ++c) range[c].take(p[c] + (q[c] - p[c]) * share);
            }
            for (double i = std::ceil(y0); i <= y1; i += 1.0) {
                double p[2];
                lattice(f, k, static_cast<std::int64_t>(i), p);
                for (int c = 0; c < 2; ++c) range[c].take(p[c]);
            }
        }
        for (int c = 0; c < 2; ++c) low[c] += weight * range[c].low, high[c] += weight * range[c].high;
        sum += weight;
    }
    for (int c = 0; c < 2; ++c) out[c] = {low[c] / sum, high[c] / sum};
}

void scaled(double amplitude, const Range& wave, double& low, double& high) {
    low = 1.0 + std::min(amplitude * wave.low, amplitude * wave.high);
    high = 1.0 + std::max(amplitude * wave.low, amplitude * wave.high);
}

}  // namespace

FactorRange factor_range(const ScaleFunction& f, double a0, double a1) {
    FactorRange out;
    if (f.kind == PerturbationKind::polynomial) {
        const Range width = polynomial_range(f.width_polynomial, a0, a1),
                    height = polynomial_range(f.height_polynomial, a0, a1);
        return {width.low, width.high, height.low, height.high};
    }
    Range wave[2];
    if (f.kind == PerturbationKind::sine)
        wave[0] = wave[1] = wave_range(a0, a1);
    else
        noise_range(f, a0, a1, wave);
    scaled(f.width, wave[0], out.width_low, out.width_high);
    scaled(f.height, wave[1], out.height_low, out.height_high);
    return out;
}

FactorRange factor_range(const ResolvedPattern& pattern, const ResolvedElement& element, double s0, double s1) {
    if (element.function == kNoFunction) return {};
    return factor_range(pattern.functions[element.function], curve::argument(element.element, s0),
                        curve::argument(element.element, s1));
}

}  // namespace burin
