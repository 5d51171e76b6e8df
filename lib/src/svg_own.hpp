// Paths of a drawing that burin wrote (format/svg.md), as far as nobody took their attributes away.
#pragma once

#include <burin/pattern.hpp>
#include <burin/result.hpp>

#include "svg_document.hpp"

namespace burin::svg {

// Whether the shape is such a path.
bool is_own(const Document& document, const Shape& shape);

// Size, depth, profiles and all that stands at the root. Fails with invalid_input: attribute, line and value.
Result<Pattern> read_own_root(const Document& document);

// Adds the path, one for each subpath. A path that was moved, turned or scaled takes its width along; where its elements are no
// longer as many as its scales, these are spread along its length, and `notes` say so.
Status add_own_paths(const Shape& shape, Pattern& pattern, Notes& notes);

}  // namespace burin::svg
