// What is measured: a flat scene through all stages, and views of it that the renderer and the truth share.
#pragma once

#include <string>
#include <vector>

#include <burin/evaluate.hpp>
#include <gl/render.hpp>
#include <scenes/scenes.hpp>

#include "../../tests/judge/judge.hpp"

namespace burin::bench {

// One part of a scene, taken onto the plane of its own size.
struct Subject {
    std::string name;
    scenes::Scene scene;
    std::size_t index = 0;  // of the part
    const scenes::Part& part() const { return scene.parts[index]; }
    testing::PreparedPattern prepared;
    double width = 0.0;  // metres: mean width of the features, by length of path
    Vec2 focus;          // metres: the junction nearest to the middle, or else a place on a path
};
Result<Subject> prepare_subject(const scenes::SceneEntry& entry, std::size_t part = 0, const GridOptions& grid = {});
Result<Subject> prepare_subject(const std::string& name, scenes::Scene scene, std::size_t part = 0, const GridOptions& grid = {});

// All parts of a scene, as a file holds them, and the view that the scene is shown from; size and filter are the caller's.
struct OpenedScene {
    Asset asset;
    RenderOptions options;
};
Result<OpenedScene> open_scene(const scenes::Scene& scene);

// A perspective view of the plane, the same for the renderer and the truth.
struct PlaneView {
    std::string name;
    int width = 160, height = 120;  // pixels
    Vec2 focus;                     // metres of pattern space on the object surface, in the middle of the picture
    double azimuth = 30.0;          // degrees, as Camera
    double elevation = 50.0;
    double pixel = 1e-3;            // metres that a pixel is wide at the focus
    double field_of_view = 12.0;    // degrees
    Light light;
};

// Near (a feature is 40 pixels wide), middle, far, far away (several features to the pixel), and from 60 and 80
// degrees off the normal.
std::vector<PlaneView> standard_views(const Subject& subject, int width, int height);

// Camera of a view, in the world of make_plane(size): the pattern's middle is the origin.
struct PlaneCamera {
    std::array<double, 3> eye, target;
    std::array<double, 3> forward, right, up;  // unit length
    double tangent = 0.0;                      // of half the vertical angle
    double aspect = 1.0;
};
PlaneCamera camera_of(const PlaneView& view, Vec2 size);

// The rectangle of whole tiles (of one tile when the map is clamped) that a view is drawn on, in uv. It ends
// `most_tiles` from the origin.
struct Extent {
    Vec2 low, high;
};
Extent extent_of(const PlaneView& view, const ResolvedPattern& pattern, double most_tiles = 64.0);

// The subject's textures on that rectangle.
Asset asset_of(const Subject& subject, const Extent& extent);
RenderOptions options_of(const PlaneView& view, Vec2 size);

}  // namespace burin::bench
