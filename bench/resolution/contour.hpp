// Level lines of two surfaces and the distance between them.
#pragma once

#include <cstdint>
#include <vector>

#include <burin/geometry.hpp>
#include <burin/image.hpp>

namespace burin::bench {

struct Segment {
    Vec2 a, b;
};

// Level lines of a surface given by samples on a fine grid, marching squares; points in units of `scale` samples.
void add_level_lines(const Image& surface, double level, double scale, std::vector<Segment>& out);

struct LineDistance {
    double rms = 0.0, p999 = 0.0, max = 0.0;
    Vec2 worst;               // where max was found
    double length = 0.0;      // of the first set
    // Squares of 16 units by what they add to the mean square, greatest first: where to look.
    struct Spot {
        Vec2 corner;
        double share = 0.0;
    };
    std::vector<Spot> spots;
    double lost = 0.0;        // share of both sets' length that is farther than 2 from the other set
};

// Symmetric: from each set to the other, weighted by length. Distances above 2 count as lost and as 2.
LineDistance distance_between(const std::vector<Segment>& first, const std::vector<Segment>& second);

}  // namespace burin::bench
