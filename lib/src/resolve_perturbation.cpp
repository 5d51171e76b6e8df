// Perturbations: a path's own arc length becomes the argument of a function, and the scales it makes are checked.
#include <algorithm>
#include <cmath>

#include "resolve_curve.hpp"
#include "resolve_internal.hpp"
#include "scale_function.hpp"

namespace burin::resolving {
namespace {

// What textures hold of an argument: 16 bits before the point.
constexpr double kMostArguments = 65536.0;
constexpr int kMostOctaves = 8;

Error input_error(const std::string& message) { return {ErrorCode::invalid_input, message}; }

Status check_amplitudes(const Perturbation& p, const std::string& name) {
    for (const double amplitude : {p.width, p.height})
        if (!(std::abs(amplitude) <= 1.0))
            return input_error(name + " has amplitude " + std::to_string(amplitude) + "; allowed is [-1, 1]");
    if (!(p.wavelength > 0.0) || !std::isfinite(p.wavelength))
        return input_error(name + " has wavelength " + std::to_string(p.wavelength) + " m; it must be positive");
    if (!std::isfinite(p.phase)) return input_error(name + " has a phase that is not finite");
    if (p.kind == PerturbationKind::noise && (p.octaves < 1 || p.octaves > kMostOctaves))
        return input_error(name + " has " + std::to_string(p.octaves) + " octaves; allowed is [1, " +
                           std::to_string(kMostOctaves) + "]");
    return Done{};
}

Status check_polynomial(const double c[4], bool closed, const std::string& name) {
    for (int i = 0; i < 4; ++i)
        if (!std::isfinite(c[i])) return input_error(name + " has a coefficient that is not finite");
    const double difference = c[1] + c[2] + c[3];
    if (closed && std::abs(difference) > 1e-6)
        return input_error(name + " does not close: at the end of a closed path it is " + std::to_string(c[0] + difference) +
                           ", at its start " + std::to_string(c[0]));
    return Done{};
}

Status check(const Perturbation& p, bool closed, const std::string& name) {
    if (p.kind != PerturbationKind::polynomial) return check_amplitudes(p, name);
    if (const Status status = check_polynomial(p.width_polynomial, closed, name); !status.ok()) return status;
    return check_polynomial(p.height_polynomial, closed, name);
}

// Without what its kind does not use, so that equal functions compare equal. `lap`: wavelengths around a closed path.
ScaleFunction function_of(const Perturbation& p, double lap) {
    ScaleFunction f;
    f.kind = p.kind;
    if (p.kind == PerturbationKind::polynomial) {
        std::copy_n(p.width_polynomial, 4, f.width_polynomial);
        std::copy_n(p.height_polynomial, 4, f.height_polynomial);
        return f;
    }
    f.width = p.width, f.height = p.height;
    if (p.kind == PerturbationKind::noise) {
        f.seed = p.seed;
        f.octaves = static_cast<std::uint32_t>(p.octaves);
        f.period = static_cast<std::uint32_t>(lap);
    }
    return f;
}

std::uint32_t number_of(Work& work, const ScaleFunction& f) {
    const auto known = static_cast<std::size_t>(std::find(work.functions.begin(), work.functions.end(), f) -
                                                work.functions.begin());
    if (known == work.functions.size()) work.functions.push_back(f);
    return static_cast<std::uint32_t>(known);
}

Status check_scales(const Element& e, const FactorRange& factors, bool step, const std::string& where) {
    const struct {
        const char* name;
        double low, high;
    } scales[] = {
        {"width", std::min(e.width0, e.width1) * factors.width_low, std::max(e.width0, e.width1) * factors.width_high},
        {"height", std::min(e.height0, e.height1) * factors.height_low, std::max(e.height0, e.height1) * factors.height_high}};
    for (const auto& scale : scales)
        if (scale.low < -1e-9 || scale.high >= 4.0)
            return input_error(where + " gets " + scale.name + " scales from " + std::to_string(scale.low) + " to " +
                               std::to_string(scale.high) + " by its perturbation; allowed is [0, 4)");
    if (step && (factors.height_low != 1.0 || factors.height_high != 1.0))
        return input_error(where + " belongs to a step path, whose height may not be perturbed");
    return Done{};
}

// Arguments of all elements, one behind the other; the last ends on `last` exactly.
void set_arguments(WorkPath& path, double first, double last, double per_metre) {
    double metres = 0.0;
    for (Element& e : path.elements) {
        e.argument0 = first + metres * per_metre;
        metres += curve::arc_length(e);
        e.argument1 = first + metres * per_metre;
    }
    path.elements.back().argument1 = last;
}

}  // namespace

Status perturb_path(Work& work, WorkPath& path) {
    const std::uint32_t index = work.pattern.paths[path.source].perturbation;
    if (index == kNoPerturbation) return Done{};
    const Perturbation& p = work.pattern.perturbations[index];
    if (const Status status = check(p, path.closed, "perturbation " + std::to_string(index)); !status.ok()) return status;
    double length = 0.0;
    for (const Element& e : path.elements) length += curve::arc_length(e);
    const bool share = p.kind == PerturbationKind::polynomial;
    double count = share ? 1.0 : length / p.wavelength;
    if (path.closed && !share) count = std::max(1.0, std::round(count));
    const double first = p.kind == PerturbationKind::sine ? p.phase - std::floor(p.phase) : 0.0;
    if (!(first + count < kMostArguments - 1.0))
        return input_error(path_text(path.source, path.elements.front().p0) + " is " + std::to_string(count) +
                           " wavelengths long; allowed is less than " + std::to_string(static_cast<int>(kMostArguments) - 2));
    set_arguments(path, first, first + count, count / length);
    const ScaleFunction f = function_of(p, path.closed ? count : 0.0);
    double greatest = 0.0;
    for (const Element& e : path.elements) {
        const FactorRange factors = factor_range(f, e.argument0, e.argument1);
        const Status status = check_scales(e, factors, path.step, path_text(path.source, e.p0));
        if (!status.ok()) return status;
        greatest = std::max(greatest, std::max(e.height0, e.height1) * factors.height_high);
    }
    if (!work.options.lenient)
        if (const Status status = check_heights(work, path.source, greatest); !status.ok()) return status;
    path.function = number_of(work, f);
    path.reach *= factor_range(f, first, first + count).width_high;
    return Done{};
}

}  // namespace burin::resolving
