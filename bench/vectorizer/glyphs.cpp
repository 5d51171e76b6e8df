#include "glyphs.hpp"

#include <cassert>

namespace burin::bench {
namespace {

constexpr double kGap = 0.36;  // between letters, of their height

struct Glyph {
    double width;
    std::vector<Stroke> strokes;  // in a box of height 1; what ends on another stroke ends on its line
};

Stroke bowl() {
    return Stroke({0.0, 1.0}).line({0.0, 0.0}).line({0.36, 0.0}).arc({0.36, 0.26}, 0.26, -kQuarter, kQuarter).line({0.0, 0.52});
}

Stroke double_bend() {
    return arc({0.31, 0.25}, 0.25, -0.35, -3.0 * kQuarter).arc({0.31, 0.75}, 0.25, -kQuarter, 2.0 * kQuarter - 0.35);
}

Glyph glyph_of(char letter) {
    switch (letter) {
        case 'A': return {0.8, {polyline({{0.0, 1.0}, {0.4, 0.0}, {0.8, 1.0}}), polyline({{0.14, 0.65}, {0.66, 0.65}})}};
        case 'D': return {0.75, {Stroke({0.0, 0.0}).line({0.25, 0.0}).arc({0.25, 0.5}, 0.5, -kQuarter, kQuarter).line({0.0, 1.0}).close()}};
        case 'E': return {0.6, {polyline({{0.6, 0.0}, {0.0, 0.0}, {0.0, 1.0}, {0.6, 1.0}}), polyline({{0.0, 0.48}, {0.5, 0.48}})}};
        case 'H': return {0.7, {polyline({{0.0, 0.0}, {0.0, 1.0}}), polyline({{0.7, 0.0}, {0.7, 1.0}}), polyline({{0.0, 0.5}, {0.7, 0.5}})}};
        case 'I': return {0.0, {polyline({{0.0, 0.0}, {0.0, 1.0}})}};
        case 'K': return {0.66, {polyline({{0.0, 0.0}, {0.0, 1.0}}), polyline({{0.65, 0.0}, {0.0, 0.6}}), polyline({{0.26, 0.36}, {0.66, 1.0}})}};
        case 'M': return {0.8, {polyline({{0.0, 1.0}, {0.0, 0.0}, {0.4, 0.62}, {0.8, 0.0}, {0.8, 1.0}})}};
        case 'N': return {0.7, {polyline({{0.0, 1.0}, {0.0, 0.0}, {0.7, 1.0}, {0.7, 0.0}})}};
        case 'O': return {0.84, {Stroke({0.84, 0.42}).line({0.84, 0.58}).arc({0.42, 0.58}, 0.42, 0.0, 2.0 * kQuarter).line({0.0, 0.42}).arc({0.42, 0.42}, 0.42, -2.0 * kQuarter, 0.0).close()}};
        case 'P': return {0.62, {bowl()}};
        case 'R': return {0.66, {bowl(), polyline({{0.3, 0.52}, {0.66, 1.0}})}};
        case 'S': return {0.56, {double_bend()}};
        case 'T': return {0.76, {polyline({{0.0, 0.0}, {0.76, 0.0}}), polyline({{0.38, 0.0}, {0.38, 1.0}})}};
        case 'U': return {0.7, {Stroke({0.0, 0.0}).line({0.0, 0.65}).arc({0.35, 0.65}, 0.35, 2.0 * kQuarter, 0.0).line({0.7, 0.0})}};
        case 'X': return {0.7, {polyline({{0.0, 0.0}, {0.7, 1.0}}), polyline({{0.7, 0.0}, {0.0, 1.0}})}};
        case 'Y': return {0.7, {polyline({{0.0, 0.0}, {0.35, 0.5}}), polyline({{0.7, 0.0}, {0.35, 0.5}}), polyline({{0.35, 0.5}, {0.35, 1.0}})}};
        case 'Z': return {0.66, {polyline({{0.0, 0.0}, {0.66, 0.0}, {0.0, 1.0}, {0.66, 1.0}})}};
        case '1': return {0.25, {polyline({{0.0, 0.25}, {0.25, 0.0}, {0.25, 1.0}})}};
        case '4': return {0.66, {polyline({{0.46, 1.0}, {0.46, 0.0}, {0.0, 0.7}, {0.66, 0.7}})}};
        case '7': return {0.6, {polyline({{0.0, 0.0}, {0.6, 0.0}, {0.18, 1.0}})}};
        default: assert(letter == ' ' && "a letter that glyphs.hpp does not list"); return {0.1, {}};
    }
}

}  // namespace

std::vector<Stroke> written(std::string_view text, double height, Vec2 at, double angle) {
    std::vector<Stroke> strokes;
    double advance = 0.0;
    for (const char letter : text) {
        const Glyph glyph = glyph_of(letter);
        for (const Stroke& stroke : glyph.strokes)
            strokes.push_back(stroke.placed(height, 0.0, {advance, 0.0}).placed(1.0, angle, at));
        advance += height * (glyph.width + kGap);
    }
    return strokes;
}

}  // namespace burin::bench
