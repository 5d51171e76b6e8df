// A row of the table: what was measured of one map, and which figures it must reach.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "contour.hpp"
#include "damage.hpp"
#include "found.hpp"
#include "structure.hpp"

namespace burin::bench {

struct Row {
    std::string subject;
    double wall = 2.0;  // texels
    Damage damage = Damage::sixteen_bit;
    LineDistance contour{};  // half-height contours against the drawing's, texels
    Vec2 worst{};            // middle of the place that adds most to the contours' mean square
    // RMS errors of the height against the drawing, map scale: ours, bilinear interpolation of the map, and of a map
    // of twice the resolution with the same damage.
    double height = 0.0, bilinear = 0.0, bilinear_twice = 0.0;
    StructureScore structure{};
    double explained = 0.0;
    std::size_t texture_bytes = 0, elements = 0;
    double seconds = 0.0;  // of one processor
};

// "16", "8", "jpeg".
const char* name_of(Damage damage);
// "2", "0.4".
std::string text_of(double wall);

// What is listed below a row: how many of the places that add most to the contours' mean square, and what of the
// structure does not match.
struct Details {
    int spots = 0;
    bool misses = false;
};

// A figure that misses its bound is followed by an exclamation mark.
void print_head();
void print_row(const Row& row, const Details& details);

// Per wall and damage: median, worst, and how many patterns reach each figure.
void print_summary(const std::vector<Row>& rows);

}  // namespace burin::bench
