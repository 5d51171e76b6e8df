// Strokes: polylines drawn in space on an object, and the pattern that shows them in its texture coordinates.
//
//     strokes.obj .gltf .glb --[read_strokes]--> Stroke
//     Stroke + Model --[project_strokes]--> Pattern + notes --[author_asset]--> OUT.glb
//
// A stroke is laid onto the nearest places of the material's triangles and led over the mesh from point to point, along the cut
// of the surface with the plane of its segment and the surface normal. Where the texture coordinates are cut, it is split: each
// chart gets a piece that shows what part of the stroke's whole width lies in it, butt-ended outside of the chart, so that
// the groove goes on over the border; a stroke along a border gets a piece on both sides. Widths are metres in space: the width
// scale of each element undoes the stretch of the texture coordinates across the stroke. Heights are metres along the normal.
//
// Source: [2010] 4.1, paths drawn by hand in texture space or on the object; [2008] 3.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burin/model.hpp>
#include <burin/pattern.hpp>
#include <burin/profiles.hpp>
#include <burin/result.hpp>

namespace burin {

// A place in space: metres, axes as glTF has them.
struct Point3 {
    double x = 0.0, y = 0.0, z = 0.0;
};

struct Stroke {
    std::string name;            // of the object or node it came from; may be empty
    std::vector<Point3> points;  // two or more (three or more where closed), neighbours differ
    bool closed = false;         // the last point leads on to the first, which is not repeated
};

// Reads the lines of a .obj, .gltf or .glb; the content decides, as in read_model. OBJ: v and l; o and g give names. glTF: primitives of
// LINES, LINE_STRIP and LINE_LOOP in the default scene, node transforms applied, named after the node. Faces, points, free-form
// curves are passed over. Lines of one object that share an end become one stroke, unless three or more meet there: Blender
// writes a curve as one line per edge. Equal neighbours become one point. Both formats: metres, y up.
// Fails as read_model does, and with invalid_input when there is no line (the message says what the file holds instead).
Result<std::vector<Stroke>> read_strokes(const std::string& path);

// The same for bytes in memory; `base_folder` as in read_model_bytes.
Result<std::vector<Stroke>> read_strokes_bytes(std::span<const std::uint8_t> bytes, const std::string& base_folder);

struct StrokeOptions {
    AttachOptions attach;   // which material and uv set the strokes lie on
    bool ridge = false;     // else grooves
    ProfileSpec profile;    // cross-section of all strokes
    double height = 0.0;    // metres from the ground to a groove's bottom or a ridge's top; 0: half of the width
    double width = 0.0;     // metres in space between the profile's ends; 0: 1/200 of the object's size
    JoinKind join = JoinKind::mitre;
    CapKind cap = CapKind::round;  // of the ends that were drawn; those at chart borders are butt
    // Farthest that a point may lie from the surface, metres; 0: 5 % of the object's size, the diagonal of its box.
    double max_distance = 0.0;
    // How far lines and quadratics may lie from the line on the surface, metres; 0: the lesser of 1/4000 of the object's size
    // and 1/100 of the width.
    double tolerance = 0.0;
};

// What strokes mean, in the words that svg.hpp has for strokes of drawings: "groove flat(floor=0.3) 0.5mm 2mm", KIND [PROFILE]
// [HEIGHT [WIDTH]]; KIND is groove or ridge. What is left out becomes the usual. Fails with invalid_argument: what is not understood.
Status mean_strokes(std::string_view meaning, StrokeOptions& options);

struct StrokeStats {
    int strokes = 0, pieces = 0;  // drawn, and the paths they became
    int borders = 0;              // times that a stroke's middle passed from one chart to another
    double length = 0.0;          // metres on the surface
    double farthest = 0.0;        // of the drawn points from the surface, metres
};

struct ProjectedStrokes {
    Pattern pattern;                 // profile 0 has the width in the middle of those needed; size as find_material has it
    std::vector<std::string> notes;  // what a user should know, one sentence each: gaps, places that show a stroke too
    StrokeStats stats;
};

// Requires: nothing of the strokes but finite numbers; all else is checked.
// Ensures: every path's middle lies within the tolerance of the line on the surface, its width within 1 % where the mesh's stretch
//          can be followed by linear pieces; the pattern repeats where texture coordinates leave [0, 1] or go on by whole tiles, else it clamps.
// Fails with invalid_argument: an option out of its range. With invalid_input: as find_material and make_profile do; no stroke; a point
// farther from the surface than max_distance (the message names stroke, point and distance); widths that differ more over
// the texture coordinates than scales in (0, 4) can say.
// Cost: n log m for points and triangles, some microseconds per eighth of a width of stroke. Equal input gives equal bits.
Result<ProjectedStrokes> project_strokes(const Model& model, std::span<const Stroke> strokes, const StrokeOptions& options);

}  // namespace burin
