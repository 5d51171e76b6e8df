// Numbers, lengths and transforms as SVG writes them.
#include <charconv>
#include <cmath>

#include "svg_document.hpp"

namespace burin::svg {
namespace {

// Reads a number off the front of `text`.
std::optional<double> take_number(std::string_view& text) {
    std::string_view rest = trimmed(text);
    if (!rest.empty() && rest.front() == '+') rest.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
    text = rest.substr(static_cast<std::size_t>(end - rest.data()));
    return value;
}

constexpr double kDegrees = 3.14159265358979323846 / 180.0;

std::optional<Affine> one_transform(std::string_view name, const std::vector<double>& n) {
    const std::size_t count = n.size();
    if (name == "matrix" && count == 6) return Affine{n[0], n[1], n[2], n[3], n[4], n[5]};
    if (name == "translate" && (count == 1 || count == 2)) return Affine{1, 0, 0, 1, n[0], count == 2 ? n[1] : 0.0};
    if (name == "scale" && (count == 1 || count == 2)) return Affine{n[0], 0, 0, count == 2 ? n[1] : n[0], 0, 0};
    if (name == "skewX" && count == 1) return Affine{1, 0, std::tan(n[0] * kDegrees), 1, 0, 0};
    if (name == "skewY" && count == 1) return Affine{1, std::tan(n[0] * kDegrees), 0, 1, 0, 0};
    if (name == "rotate" && (count == 1 || count == 3)) {
        const double c = std::cos(n[0] * kDegrees), s = std::sin(n[0] * kDegrees);
        const Affine turn{c, s, -s, c, 0, 0};
        return count == 1 ? turn : Affine{1, 0, 0, 1, n[1], n[2]} * (turn * Affine{1, 0, 0, 1, -n[1], -n[2]});
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
    std::vector<double> numbers;
    while (!(text = trimmed(text)).empty()) {
        if (!numbers.empty() && text.front() == ',') text.remove_prefix(1);
        const auto number = take_number(text);
        if (!number) return std::nullopt;
        numbers.push_back(*number);
    }
    return numbers;
}

std::optional<double> parse_length(std::string_view text, double percent_of) {
    const auto number = take_number(text);
    if (!number) return std::nullopt;
    const std::string_view unit = trimmed(text);
    constexpr double kInch = 96.0;  // CSS pixels
    struct Unit {
        const char* name;
        double size;
    };
    constexpr Unit kUnits[] = {{"", 1.0},          {"px", 1.0},          {"pt", kInch / 72.0}, {"pc", kInch / 6.0}, {"in", kInch},
                               {"mm", kInch / 25.4}, {"cm", kInch / 2.54}, {"em", 16.0},         {"ex", 8.0},         {"Q", kInch / 101.6}};
    if (unit == "%") return *number * percent_of / 100.0;
    for (const Unit& one : kUnits)
        if (unit == one.name) return *number * one.size;
    return std::nullopt;
}

std::optional<Affine> parse_transform(std::string_view text) {
    Affine all;
    while (!(text = trimmed(text)).empty()) {
        if (text.front() == ',') {
            text.remove_prefix(1);
            continue;
        }
        const std::size_t open = text.find('('), close = text.find(')');
        if (open == std::string_view::npos || close == std::string_view::npos || close < open) return std::nullopt;
        const auto numbers = parse_numbers(text.substr(open + 1, close - open - 1));
        const auto one = numbers ? one_transform(trimmed(text.substr(0, open)), *numbers) : std::nullopt;
        if (!one) return std::nullopt;
        all = all * *one;
        text.remove_prefix(close + 1);
    }
    return all;
}

double scale_of(const Affine& transform) { return std::sqrt(std::abs(transform.determinant())); }

}  // namespace burin::svg
