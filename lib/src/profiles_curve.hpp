// The flank of a profile: the curve that its name stands for, as the best polyline of so many points.
#pragma once

#include <functional>
#include <vector>

#include <burin/geometry.hpp>

namespace burin::profiling {

// A curve over t in [0, 1].
using Curve = std::function<Vec2(double)>;

// Polyline of at most `count` points, >= 2, from the curve's start to its end, whose farthest distance from the curve is about the
// least that so many points can have. Points within lie beside the curve, on its outer side, which halves what chords would leave.
// Requires: a curve within the unit square whose coordinates do not fall; so are those of the polyline.
std::vector<Vec2> few_points(const Curve& curve, int count);

}  // namespace burin::profiling
