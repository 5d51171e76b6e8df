// A pattern as a drawing: what `burin vectorize` writes, for editing by hand.
//
//     Pattern --[write_svg]--> text of an SVG file
//
// Inkscape shows each path as a stroke as wide as its profile, in a layer named after what it is: grooves, ridges,
// steps. What SVG has no word for (sections, levels, scales, caps) stands in `data-burin-...` attributes; the format is
// format/svg.md. Nothing is lost: every number is written with as many digits as make a reader's double the same, so that
// the pattern can be built again exactly (but for the unused control points of lines).
//
// Units: one user unit is one metre, so that coordinates are those of the pattern; the page is as large as the map is.
#pragma once

#include <string>

#include <burin/pattern.hpp>

namespace burin {

// Requires: indices within the pattern's lists, finite numbers, elements of a path that follow each other.
// Ensures: well-formed XML in UTF-8 with the final newline; equal patterns give equal bytes. Cost: linear.
std::string write_svg(const Pattern& pattern);

}  // namespace burin
