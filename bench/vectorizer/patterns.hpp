// The twenty authored patterns that the vectorizer is measured on, each for a map of 512 x 512.
//
// They are what artists draw: grooves mostly 3 to 12 texels wide, with ends, crossings, joints and corners of all
// angles, letters, scrolls, plateaus and what tiles; and what breaks tracers: tapers, strokes hardly apart, strokes
// wider than their length, grooves thinner than a texel. Nothing about them is known to the library.
//
// A path is authored as the measure of structure counts it (structure.hpp): a stroke that goes straight on through a
// crossing or past a stem is one path; where three or more strokes meet and none goes straight on, each ends.
#pragma once

#include <string>
#include <vector>

#include <burin/image.hpp>
#include <burin/pattern.hpp>

namespace burin::bench {

inline constexpr int kPatternTexels = 512;

struct Subject {
    std::string name;
    Pattern (*draw)(double wall);       // width of every wall, texels
    void (*spoil)(Image&) = nullptr;    // what is done to its map
};

// In the order of the table.
const std::vector<Subject>& subjects();
// Measured on demand: patterns_trials.cpp.
const std::vector<Subject>& trials();

// Lines and how they meet: patterns_lines.cpp.
Pattern draw_grid(double wall);
Pattern draw_crossings(double wall);
Pattern draw_junctions(double wall);
Pattern draw_corners(double wall);
Pattern draw_hexagons(double wall);
Pattern draw_bricks(double wall);
Pattern draw_widths(double wall);
Pattern draw_slots(double wall);

// Curves and letters: patterns_curves.cpp.
Pattern draw_arcs(double wall);
Pattern draw_concentric(double wall);
Pattern draw_spirals(double wall);
Pattern draw_scrolls(double wall);
Pattern draw_tapers(double wall);
Pattern draw_stroke_text(double wall);

// Plateaus and what mixes kinds: patterns_plateaus.cpp.
Pattern draw_outline_text(double wall);
Pattern draw_discs(double wall);
Pattern draw_plateaus(double wall);
Pattern draw_engraved(double wall);
Pattern draw_ridges(double wall);
Pattern draw_tile(double wall);

}  // namespace burin::bench
