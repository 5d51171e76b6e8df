// Capitals as outlines, in a box of height 1.
#include <cassert>
#include <cmath>

#include "drawing.hpp"

namespace burin::scenes {
namespace {

constexpr double kStem = 0.17;  // thickness of strokes
constexpr double kGap = 0.14;   // between letters

struct Letter {
    double width;
    std::vector<Stroke> bodies, holes;
};

// Clockwise on screen when `clockwise`, whatever way it was drawn.
Path turned_right(const Path& path, bool clockwise) {
    double area = 0.0;
    for (const Element& e : path.elements) {
        area += e.kind == ElementKind::line ? cross(e.p0, e.p2) : cross(e.p0, e.p1) + cross(e.p1, e.p2);
    }
    if ((area > 0.0) == clockwise) return path;
    Path back = path;
    back.elements.assign(path.elements.rbegin(), path.elements.rend());
    for (Element& e : back.elements) std::swap(e.p0, e.p2);
    return back;
}


// Two bows of an S, each half a ring and a bit, that pass into each other.
Stroke double_bow() {
    const Vec2 upper{0.32, 0.29}, lower{0.30, 0.705};
    const double small = 0.205, large = 0.21, h = kStem / 2, open = 0.45;
    const auto at = [](Vec2 c, double r, double angle) { return c + Vec2{std::cos(angle), std::sin(angle)} * r; };
    const double first = kPi + kPi / 2 - open, second = kPi + kPi / 2 - open;
    return Stroke(at(upper, small - h, -open)).arc(upper, -first)
        .line(at(lower, large + h, -kPi / 2)).arc(lower, second)
        .line(at(lower, large - h, -kPi / 2 + second)).arc(lower, -second)
        .line(at(upper, small + h, -open - first)).arc(upper, first).close();
}

Letter letter_g() {
    const Vec2 c{0.44, 0.5};
    const double outer = 0.5, inner = outer - kStem, open = 0.75, low = std::asin(kStem / inner);
    const auto at = [&](double r, double angle) { return c + Vec2{std::cos(angle), std::sin(angle)} * r; };
    return {0.94, {Stroke(at(outer, -open)).arc(c, -(2 * kPi - open)).line({c.x + 0.06, c.y}).line({c.x + 0.06, c.y + kStem})
                       .line(at(inner, low)).arc(c, 2 * kPi - open - low).close()}, {}};
}

// B and R: bowls of half rings on a stem.
Stroke bowl_hole(double top, double bottom, double x, double right) {
    const double r = (bottom - top) / 2;
    return Stroke({x, top}).line({right - r, top}).arc({right - r, top + r}, kPi).line({x, bottom}).close();
}

Letter letter_b() {
    const double s = kStem, right = 0.62;
    return {right, {Stroke({0, 0}).line({right - 0.25, 0}).arc({right - 0.25, 0.25}, kPi).arc({right - 0.25, 0.75}, kPi).line({0, 1}).close()},
            {bowl_hole(s * 0.85, 0.5 - s * 0.4, s, right - s), bowl_hole(0.5 + s * 0.4, 1 - s * 0.85, s, right - s)}};
}

Letter letter_r() {
    const double s = kStem, right = 0.62;
    return {0.68, {Stroke({0, 0}).line({right - 0.28, 0}).arc({right - 0.28, 0.28}, kPi / 2 + 0.9)
                       .line({0.70, 1}).line({0.49, 1}).line({0.27, 0.56}).line({s, 0.56}).line({s, 1}).line({0, 1}).close()},
            {bowl_hole(s * 0.85, 0.56 - s * 0.8, s, right - s)}};
}

Letter letter_of(char letter) {
    const double s = kStem, half = 0.42;
    switch (letter) {
        case 'A': return {0.84, {polygon({{0.32, 0}, {0.52, 0}, {0.84, 1}, {0.66, 1}, {0.58, 0.74}, {0.26, 0.74}, {0.18, 1}, {0, 1}})},
                          {polygon({{0.42, 0.2}, {0.54, 0.58}, {0.30, 0.58}})}};
        case 'B': return letter_b();
        case 'E': return {0.56, {polygon({{0, 0}, {0.56, 0}, {0.56, s}, {s, s}, {s, 0.42}, {0.48, 0.42}, {0.48, 0.42 + s}, {s, 0.42 + s},
                                          {s, 1 - s}, {0.56, 1 - s}, {0.56, 1}, {0, 1}})}, {}};
        case 'G': return letter_g();
        case 'I': return {s, {polygon({{0, 0}, {s, 0}, {s, 1}, {0, 1}})}, {}};
        case 'L': return {0.54, {polygon({{0, 0}, {s, 0}, {s, 1 - s}, {0.54, 1 - s}, {0.54, 1}, {0, 1}})}, {}};
        case 'N': return {0.70, {polygon({{0, 0}, {0.2, 0}, {0.53, 0.66}, {0.53, 0}, {0.7, 0}, {0.7, 1}, {0.5, 1}, {s, 0.34}, {s, 1}, {0, 1}})}, {}};
        case 'O': return {2 * half, {slab({half, 0.5}, {half, 0.5}, half - 1e-3)}, {slab({half, 0.5}, {half - s, 0.5 - s}, half - s - 1e-3)}};
        case 'R': return letter_r();
        case 'S': return {0.60, {double_bow()}, {}};
        case 'T': return {0.68, {polygon({{0, 0}, {0.68, 0}, {0.68, s}, {0.34 + s / 2, s}, {0.34 + s / 2, 1}, {0.34 - s / 2, 1}, {0.34 - s / 2, s}, {0, s}})}, {}};
        case 'U': return {0.68, {Stroke({0, 0}).line({s, 0}).line({s, 0.66}).arc({0.34, 0.66}, -kPi).line({0.68 - s, 0}).line({0.68, 0})
                                     .line({0.68, 0.66}).arc({0.34, 0.66}, kPi).close()}, {}};
        case 'V': return {0.80, {polygon({{0, 0}, {0.18, 0}, {0.40, 0.74}, {0.62, 0}, {0.80, 0}, {0.50, 1}, {0.30, 1}})}, {}};
        default: assert(letter == ' ' && "a letter that drawing.hpp does not list"); return {0.25, {}, {}};
    }
}

}  // namespace

std::vector<Path> outlines(std::string_view text, double height, Vec2 at, std::uint32_t profile) {
    std::vector<Path> paths;
    double advance = 0.0;
    for (const char character : text) {
        const Letter letter = letter_of(character);
        const auto place = [&](Vec2 p) { return at + (p + Vec2{advance, 0}) * height; };
        for (const Stroke& body : letter.bodies) paths.push_back(mapped(turned_right(body.path(profile), true), place));
        for (const Stroke& hole : letter.holes) paths.push_back(mapped(turned_right(hole.path(profile), false), place));
        advance += letter.width + kGap;
    }
    return paths;
}

double width_of(std::string_view text, double height) {
    double advance = -kGap;
    for (const char character : text) advance += letter_of(character).width + kGap;
    return advance * height;
}

}  // namespace burin::scenes
