// Text in single-stroke fonts: what is engraved by one line rather than by outlines.
#pragma once

#include <string>
#include <vector>

#include <burin/path_data.hpp>
#include <burin/result.hpp>
#include <burin/svg.hpp>

namespace burin::svg {

// One glyph after the other along the guide, upright on it; without a guide on a level line through the middle of the page. The text
// is centred. Lines of all glyphs, in pattern space.
// Fails with invalid_input (the font is no SVG font, or lacks a character, which is named) and invalid_argument (the text is longer
// than the guide or the page; what size fits).
Result<std::vector<Subpath>> lay_text(const SvgText& text, const std::vector<Subpath>& guide, Vec2 page, double tolerance);

}  // namespace burin::svg
