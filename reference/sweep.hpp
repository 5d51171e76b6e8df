// The geometry near a footprint as flat pieces: profiles swept along their elements. [2008] 4 takes the surface inside a
// pixel to be a set of flat facets; here a bent or varying element gives as many as keep within a tolerance.
//
//     Gathered --[sweep_grooves]--> LocalGeometry: brushes (what is solid or cut) and faces (what may be seen)
//
// A brush stands upright over a convex polygon of the plan: everything below its top plane is added, or everything above its
// bottom plane is cut (between both, where a profile overhangs). Faces are the surfaces of the brushes, not yet carved by
// each other: facets, the ground of each zone, and the walls where an element stops acting. A zone is a part of the plan where the
// ground has one level: steps' path lines bound them.
#pragma once

#include "gather.hpp"
#include "stations.hpp"

namespace burin::reference {

// z = c + g . p
struct Plane {
    Vec2 g;
    double c = 0.0;
    double at(Vec2 p) const { return c + dot(g, p); }
};

struct Brush {
    std::uint32_t instance = 0;  // index into Gathered::instances
    bool cut = false;
    bool has_bottom = false, has_top = false;
    Plane bottom, top;
    std::uint32_t bottom_facet = 0, top_facet = 0;  // of the profile
    double level = 0.0;                             // of the ground that it acts over
    Polygon polygon;  // in LocalGeometry::plan
    Box box;          // in plan
};

enum class FaceKind : std::uint8_t { ground, add, cut };
struct Face {
    FaceKind kind = FaceKind::ground;
    bool wall = false;           // its own element's brushes carve it too
    std::uint32_t instance = 0;  // of add and cut, and of the ground's walls
    std::uint32_t facet = 0;     // of the profile; kWall, kGround as in evaluate.hpp
    double level = 0.0;          // of the ground there
    Vec3 normal;                 // away from the solid, unit length
    Polygon polygon;             // in LocalGeometry::points
    Box box;                     // in plan
};

struct Zone {
    Polygon polygon;  // in LocalGeometry::plan
    double level = 0.0;
    Box box;
    bool outside = false;  // of a clamped map: nothing acts there
    std::uint32_t first_edge = 0;  // into LocalGeometry::edges, one for each corner
};

// A straight piece of a step's path line.
struct Chord {
    Vec2 a, b;
    std::uint32_t instance = 0;
};

struct LocalGeometry {
    Polygons<Vec3> points;
    Polygons<Vec2> plan;
    std::vector<Zone> zones;
    std::vector<HalfPlane> edges;  // of zones
    std::vector<Chord> chords;     // of all steps that are near
    Stations stations;             // of the element at hand
    std::vector<Brush> brushes;
    std::vector<Face> faces;
    double fine = 0.0;  // heights and places nearer than this are equal, metres
};

struct SweepOptions {
    double tolerance = 0.0;  // how far flat pieces may lie from the surface, metres, > 0
};

// Only the brushes, each over the whole of its piece of an element: what of it lies over ground of its level is the caller's to see.
// Leaves out.zones and out.faces empty.
void sweep_brushes(const GroovedSurface& surface, const Gathered& gathered, const SweepOptions& options, LocalGeometry& out);

// Fills `out`, whose memory is used again. Faces and brushes reach no farther than the domain, but for those of elements.
void sweep_grooves(const GroovedSurface& surface, const Gathered& gathered, const SweepOptions& options, LocalGeometry& out);

}  // namespace burin::reference
