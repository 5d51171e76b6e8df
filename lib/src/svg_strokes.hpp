// Strokes of a drawing: what is left of a line after dashes, caps and the transform of its width.
#pragma once

#include <string>
#include <vector>

#include <burin/pattern.hpp>
#include <burin/result.hpp>

#include "svg_document.hpp"
#include "svg_meaning.hpp"

namespace burin::svg {

// One line of even meaning. Widths of its elements are the stroke's, in metres, at their ends.
struct Stroke {
    std::vector<Element> elements;
    bool closed = false;
    JoinKind join = JoinKind::mitre;
    CapKind cap = CapKind::butt;
    bool square = false;  // half a width longer at open ends
    bool dashed = false;
    Meaning meaning;
    std::size_t shape = 0;  // in the document
};

inline constexpr std::size_t kMaxDashes = std::size_t{1} << 20;  // of one drawing

// Lines of one shape, dashes cut. Nothing for a stroke without width. Fails with invalid_input (a dash list or width that is no
// list of lengths) and limit_exceeded. `notes` learn of what is drawn in another way.
Result<std::vector<Stroke>> strokes_of(const Shape& shape, const Meaning& meaning, Vec2 size, Notes& notes);

// Lengthens open ends by half a width where caps are square.
void add_square_caps(Stroke& stroke);

}  // namespace burin::svg
