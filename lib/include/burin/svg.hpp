// Patterns as drawings: what `burin vectorize` writes, and what `burin pack` reads.
//
//     Pattern --[write_svg]--> text of an SVG file --[read_svg]--> Pattern
//
// WRITING. Inkscape shows each path as a stroke as wide as its profile, in a layer named after what it is: grooves, ridges,
// steps. What SVG has no word for (sections, levels, scales, caps) stands in `data-burin-...` attributes; the format is
// format/svg.md. Nothing is lost: every number is written with as many digits as make a reader's double the same, so that
// the pattern can be built again exactly (but for the unused control points of lines). One user unit is one metre.
//
// READING. Any SVG of Inkscape, Illustrator or a text editor: strokes become grooves or ridges as wide as they are, fills sunken
// regions or plateaus bounded by steps. What each of them means is said by attributes, by layers and classes, or by the options
// (docs/drawing.md). In a drawing that burin wrote, paths that nobody touched come back bit by bit.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <burin/pattern.hpp>
#include <burin/result.hpp>

namespace burin {

// Requires: indices within the pattern's lists, finite numbers, elements of a path that follow each other.
// Ensures: well-formed XML in UTF-8 with the final newline; equal patterns give equal bytes. Cost: linear.
std::string write_svg(const Pattern& pattern);

inline constexpr std::size_t kMaxSvgBytes = std::size_t{256} << 20;  // that are read

// A line of text in a single-stroke font, engraved like any stroke.
struct SvgText {
    std::string words;     // UTF-8; "": none
    std::string font;      // text of an SVG file with a <font>
    std::string path;      // id of the path that it runs along, which is then not drawn; "": across the middle of the page
    double size = 0.0;     // of an em, metres; 0: a tenth of the page's shorter side
    double width = 0.0;    // of the stroke, metres; 0: a twelfth of the size
};

struct SvgOptions {
    // Of the page, metres; one side follows from the other. Without both, the size that the drawing itself states.
    std::optional<double> width, height;
    // Farthest that a curve of the pattern may lie from the drawing's, metres; 0: 5e-5 of the page's longer side.
    double tolerance = 0.0;
    std::optional<Wrap> wrap;  // clamp, but what the file says in a drawing that burin wrote
    // Meanings: KIND [PROFILE] [HEIGHT [WIDTH]], words parted by blanks or colons. KIND: groove, ridge, plateau, sunken, ground, none.
    // PROFILE: as parse_profile takes it. HEIGHT, WIDTH: lengths such as 0.5mm; metres without a unit.
    //   groove, ridge     of strokes. HEIGHT: usually half of the stroke's width. WIDTH: instead of the stroke's
    //   plateau, sunken   of fills. HEIGHT: usually 1/200 of the page's shorter side. WIDTH: of the edge; with a PROFILE usually
    //                     as wide as high, else an upright wall
    //   ground            of fills: level 0, which takes away what was painted below
    std::string stroke = "groove", fill = "sunken";
    // Name of a layer, class, id or colour, and what strokes and fills with it mean.
    std::vector<std::pair<std::string, std::string>> rules;
    SvgText text;
    int threads = 0;  // 0: all cores; the result does not depend on it
};

struct SvgDrawing {
    Pattern pattern;
    std::vector<std::string> sources;  // of each path of the pattern: "line 12, path 'id'"
    std::vector<std::string> notes;    // what was left out or taken in another way, one sentence each
};

// Fails with invalid_input (line, element and value), limit_exceeded (bytes, nesting, shapes), invalid_argument (an option).
// Ensures: no two step paths cross; a pattern that resolve_pattern takes, but for what own data attributes say. Equal input gives
// an equal pattern. Cost: about n log n in the drawing's points.
Result<SvgDrawing> read_svg(std::string_view text, const SvgOptions& options = {});

}  // namespace burin
