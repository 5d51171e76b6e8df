// Capitals of single strokes, for patterns with text.
#pragma once

#include <string_view>
#include <vector>

#include "drawing.hpp"

namespace burin::bench {

// The strokes of a line of text whose capitals are `height` units high, starting at `at` (upper left), turned by
// `angle`. Spaces advance. Known: A D E H I K M N O P R S T U X Y Z 1 4 7; another letter is a mistake of the caller.
std::vector<Stroke> written(std::string_view text, double height, Vec2 at, double angle);

}  // namespace burin::bench
