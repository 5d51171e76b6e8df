// Parts of the plan with one level of ground, and what of an element's pieces lies in those that it acts in.
#pragma once

#include "sweep.hpp"

namespace burin::reference {

// Cuts the domain along the step paths and, of a clamped map, along its borders; puts the ground's faces and its walls.
// Sets out.zones. Cost: zones times pieces of steps.
void divide_zones(const GroovedSurface& surface, const Gathered& gathered, const SweepOptions& options, LocalGeometry& out);

// Whether what belongs to ground of that level acts in the zone.
bool acts_in(const LocalGeometry& out, const Zone& zone, double level);

// The part of the way from a to b that runs through the inside of a zone, from 0 to 1; low >= high: none.
struct Stretch {
    double low = 0.0, high = 1.0;
};
Stretch stretch_inside(const LocalGeometry& out, const Zone& zone, Vec2 a, Vec2 b);

// Adds the brush or face, or what of it lies over ground of its level. Faces end up with the walls that they need there.
void limit_to_zones(LocalGeometry& out, const Brush& brush);
void limit_to_zones(LocalGeometry& out, const Face& face);

// Makes the face an upright wall between the edge from a to b and the height `to`, and looks to `toward`.
void raise_wall(LocalGeometry& out, Face& face, Vec3 a, Vec3 b, double to, Vec2 toward);

}  // namespace burin::reference
