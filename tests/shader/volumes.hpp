// Bodies whose texture coordinates are cut: as meshes with charts, and as formulas that tell what each point inside belongs to.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <burin/charts.hpp>

#include "surfaces.hpp"

namespace burin::testing {

// One rectangle of parameters st in [0, 1]² on a body.
struct Patch {
    int columns, rows;
    std::function<SurfacePosition(Vec2 st)> at;
    std::function<Vec2(Vec2 st)> uv;
};

// Where a point of a body lies in the pattern: below which patch, at which parameters, how deep.
struct BodyPlace {
    std::size_t patch;
    Vec2 st;
    double drop;
};

struct Body {
    std::string name;
    std::vector<Patch> patches;
    std::function<BodyPlace(const Vec3&)> locate;  // drop < 0: outside
    bool creased;                                  // its faces meet in edges
};

// Two sheets side by side, a roof and a valley of two, a cube, a cylinder with lids, a sphere of six charts, a torus; about a metre large, each chart
// turned, mirrored or moved in uv; a uv unit is `unit` metres about everywhere. Round ones are cut so finely that their facets do not count.
std::vector<Body> cut_bodies(double unit);

struct CutMesh {
    BaseMesh base;                      // frames empty where it is flat
    std::vector<std::uint32_t> charts;  // per vertex
    ChartSet set;
};
// Vertices of different patches are never shared.
CutMesh mesh_of(const Body& body, const ChartOptions& options);

}  // namespace burin::testing
