// burin's own scenes: patterns authored as vectors, each on the surface it was drawn for.
//
//     scene_table() --> Scene --> per part: a Pattern, and the triangles that carry it
//
// They show what the format can say, and are what tests and benches of the runtime measure. The ideas of most come from the two
// papers that the runtime follows ("source"); the drawings are burin's own. Every scene is the same on every machine:
// chance comes from fixed seeds. Units: metres; axes and uv as in glTF (y up, v down).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <burin/model.hpp>
#include <burin/pattern.hpp>

namespace burin::scenes {

// Triangles, counter-clockwise seen from outside.
struct Mesh {
    std::vector<float> positions;  // three per vertex
    std::vector<float> normals;    // three per vertex, unit length
    std::vector<float> uvs;        // two per vertex
    std::vector<std::uint32_t> indices;
};

// One material: a pattern and all triangles that carry it. uv 0 to 1 is the pattern's tile.
struct Part {
    std::string name;
    Pattern pattern;
    Mesh mesh;
    std::array<float, 3> color = {0.8f, 0.8f, 0.8f};  // linear
    float metallic = 0.0f;
    float roughness = 0.5f;
    double erosion = 0.0;  // greatest slope of the grain that a residual adds, metres per metre; 0: none
};

// Where to look from, in degrees, as `burin render` takes them.
struct View {
    double azimuth = 30.0, elevation = 50.0, zoom = 1.0;
    std::optional<Vec2> center;  // uv of the first part
    // Where the camera stands in a scene that is seen from within; it replaces azimuth, elevation and zoom.
    struct Stand {
        std::array<double, 3> eye, target;  // metres
        double field_of_view = 30.0;        // degrees
    };
    std::optional<Stand> stand;
    double light_azimuth = -50.0, light_elevation = 35.0;
    bool room = false;  // light from all around is that of the grey room, which grooves shade
};

struct Scene {
    std::vector<Part> parts;  // at least one
    View view;
    bool flat = true;  // one part, the plane of make_plane(pattern.size)
};

struct SceneEntry {
    const char* name;    // of its file
    const char* source;  // where in the papers the idea is from
    Scene (*make)();
};

// Every scene there is, those of one source together.
const std::vector<SceneEntry>& scene_table();
// The one of that name; null where there is none.
const SceneEntry* find_scene(std::string_view name);

// The glTF model of a scene, one material per part, without the patterns.
Model model_of(const Scene& scene);

// What a part's surface looks like, without its pattern.
MaterialInfo material_of(const Part& part);

}  // namespace burin::scenes
