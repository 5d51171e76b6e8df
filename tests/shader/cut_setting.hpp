// Cut bodies with grooves over their borders, and where rays meet them: by a march through the body in small steps.
#pragma once

#include <memory>
#include <vector>

#include "embree_scene.hpp"
#include "rays.hpp"
#include "volumes.hpp"

namespace burin::testing {

inline constexpr double kCutWidth = 0.05;  // of the grooves, metres: the unit of all errors
inline constexpr double kCutTile = 0.25;

// Two grooves and a ridge over a ground that lies below the mesh, so that every ray has a way to go.
Pattern crossed_pattern();

struct CutSetting {
    Body body;
    CutMesh mesh;
    ChartTable table;
    PreparedPattern pattern;
    PathDetail detail;
    std::unique_ptr<EmbreeScene> base;
    std::vector<std::array<std::uint32_t, 2>> seam;  // triangles with an edge on a border: first corner, and that opposite of it
};
CutSetting prepare_cut(const Body& body, const Pattern& pattern = crossed_pattern());

// What a fragment shader has where a ray passes the mesh.
SurfacePlace place_of(const CutSetting& setting, const EmbreeHit& hit);

// Way to the first solid point; infinity where the ray leaves the body.
double march(const CutSetting& setting, const Truth& truth, const Vec3& entry, const Vec3& direction);

}  // namespace burin::testing
