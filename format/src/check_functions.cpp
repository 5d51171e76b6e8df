// Checks of the function section and of what elements say about it, SPECIFICATION.md "Functions along a path".
#include <algorithm>
#include <cmath>

#include "texture_check.hpp"

namespace burin {
namespace {

constexpr double kSlack = 1e-6;  // what coefficients may be off by rounding

std::string text(std::uint32_t number) { return std::to_string(number); }

void check_polynomial(const float* c, const char* name, const std::string& place, Reporter& reporter) {
    const auto value = [c](double a) {
        return static_cast<double>(c[0]) +
               a * (static_cast<double>(c[1]) + a * (static_cast<double>(c[2]) + a * static_cast<double>(c[3])));
    };
    double low = std::min(value(0.0), value(1.0)), high = std::max(value(0.0), value(1.0));
    // Zeros of the derivative, without cancellation.
    const double b = static_cast<double>(c[2]), a = 3.0 * static_cast<double>(c[3]), d = static_cast<double>(c[1]);
    const double sum = -(b + std::copysign(std::sqrt(b * b - a * d), b));
    for (const double root : {sum / a, d / sum})
        if (root > 0.0 && root < 1.0) low = std::min(low, value(root)), high = std::max(high, value(root));
    const bool finite = std::all_of(c, c + 4, [](float x) { return std::isfinite(x); });
    if (finite && low >= -kSlack && high < 4.0 + kSlack) return;
    reporter.report(4063,
                    std::string(name) + " runs from " + number_text(low) + " to " + number_text(high) +
                        ", range [0, 4)",
                    place);
}

void check_function(const FunctionCode& f, const std::string& place, Reporter& reporter) {
    const bool noise = f.kind == BURIN_FUNCTION_NOISE, polynomial = f.kind == BURIN_FUNCTION_POLYNOMIAL;
    const bool idle = (!noise && (f.octaves != 0 || f.seed != 0 || f.period != 0)) ||
                      (polynomial && (f.width != 0 || f.height != 0));
    if (f.unused != 0 || idle) reporter.report(4061, "bits without meaning are set, all must be 0", place);
    if (f.width == -32768 || f.height == -32768)
        reporter.report(4062, "amplitude has code -32768, range [-32767, 32767]", place);
    if (noise && (f.octaves < 1 || f.octaves > BURIN_MAX_OCTAVES || f.period > BURIN_MAX_NOISE_PERIOD))
        reporter.report(4062,
                        "noise has " + text(f.octaves) + " octaves and period " + text(f.period) +
                            ", 1 to 8 and at most 65536 are needed",
                        place);
    if (!polynomial) return;
    check_polynomial(f.coefficients.data(), "width", place, reporter);
    check_polynomial(f.coefficients.data() + 4, "height", place, reporter);
}

bool leaves_height(const FunctionCode& f) {
    if (f.kind != BURIN_FUNCTION_POLYNOMIAL) return f.height == 0;
    return f.coefficients[4] == 1.0f && f.coefficients[5] == 0.0f && f.coefficients[6] == 0.0f && f.coefficients[7] == 0.0f;
}

}  // namespace

void check_functions(const PackedTextures& textures, DecodedData& data, Reporter& reporter) {
    const std::uint32_t count = textures.sections.function_texels;
    data.is_function.assign(count, 0);
    for (std::uint32_t at = 0; at < count;) {
        const std::string place = "function at texel " + text(at);
        const Texel head = data_texel(textures, textures.sections.functions_begin() + at);
        const std::uint32_t texels = function_texel_count(head);
        if ((head[0] & 3u) > BURIN_FUNCTION_NOISE || at + texels > count) {
            reporter.report(4060,
                            "kind " + text(head[0] & 3u) + " of " + text(texels) + " texels in a section of " + text(count) +
                                "; kinds are 0 to 2",
                            place);
        } else {
            data.is_function[at] = 1;
            check_function(function_at(textures, at), place, reporter);
        }
        at += texels;
    }
}

void check_function_of(const PackedTextures& textures, const DecodedData& data, const ElementCode& e,
                       const std::string& place, Reporter& reporter) {
    if (!e.has_texel_c) return;
    const auto arguments = [&e] {
        return "arguments are " + number_text(decode_argument(e.argument0)) + " at the start and " +
               number_text(decode_argument(e.argument1)) + " at the end";
    };
    if (e.argument1 < e.argument0) reporter.report(4013, arguments(), place);
    if (e.function >= data.is_function.size() || data.is_function[e.function] == 0) {
        reporter.report(4012, "function " + text(e.function) + " does not begin in the section of " +
                                  std::to_string(data.is_function.size()) + " texels", place);
        return;
    }
    const FunctionCode function = function_at(textures, e.function);
    if (function.period > 0 && decode_argument(e.argument1) > function.period)
        reporter.report(4013, arguments() + ", beyond the period of " + text(function.period), place);
    const StyleCode* style = data.style_of(e);
    if (style != nullptr && style->step && !leaves_height(function))
        reporter.report(4014, "the function of a step changes heights; it may change widths alone", place);
}

}  // namespace burin
