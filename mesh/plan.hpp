// The plan of a pattern cut into triangles.
#pragma once

#include <cstdint>
#include <vector>

#include <burin/geometry.hpp>

namespace burin::mesh {

inline constexpr std::uint32_t kNoStep = 0xffffffffu;
inline constexpr std::int32_t kBorder = -1;

// A line along which triangles shall end.
struct PlanLine {
    Vec2 a, b;
    std::uint32_t step = kNoStep;  // the step element whose path line this is: ground changes here
};

struct PlanTriangle {
    std::uint32_t corner[3];  // counter-clockwise with y up: cross(b - a, c - a) > 0
    std::int32_t across[3];   // the triangle beyond the edge from corner i to the next; kBorder
    std::uint32_t step[3];    // whose path line that edge lies on; kNoStep
};

struct Plan {
    std::vector<Vec2> corners;
    std::vector<PlanTriangle> triangles;
};

// Covers [0, size] with triangles that no line crosses. Lines may cross, touch and lie on each other; what of them leaves the rectangle
// is left out. Ends nearer to each other than `snap` (metres) become one corner. Cost: n log n in corners and crossings.
Plan divide_plan(const std::vector<PlanLine>& lines, Vec2 size, double snap);

}  // namespace burin::mesh
