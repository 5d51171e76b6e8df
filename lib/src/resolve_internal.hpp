// What the parts of the resolve stage share. Private to lib.
//
// The stage works on WorkPaths, copies of the pattern's paths whose elements may move (snapping) and split:
//   resolve_profile.cpp  facets of a profile         resolve_input.cpp   checks, cleaning
//   resolve_perturbation.cpp  functions along paths
//   resolve_chords.*     chords in buckets, exact crossings, nearest points
//   resolve_ends.cpp     ends that meet, T-junctions  resolve_crossings.cpp  what crosses what
//   resolve_split.cpp    grooves split at steps       resolve_ground.cpp  levels
//   resolve_joints.cpp   priorities                   resolve_output.cpp  cutting to the tile, numbering
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <burin/resolve.hpp>

#include "resolve_chords.hpp"

namespace burin::resolving {

inline constexpr double kPi = 3.14159265358979323846;

// Levels nearer to each other than this part of the depth count as equal.
inline constexpr double kLevelTolerance = 1.0 / 4096.0;

// One end of an open path and what it meets.
struct PathEnd {
    int cluster = -1;        // ends with one number meet; -1 on a closed path
    bool on_path = false;    // lies on another path's interior: `clip` is that path's tangent
    bool on_border = false;  // clamped maps: on the border, `clip` is its direction
    bool outside = false;    // clamped maps: beyond the border
    bool extended = false;   // reaches beyond the step it ends on, whose line bounds it by the level
    Vec2 clip;
    std::size_t target = 0, target_element = 0;  // with on_path: what it lies on
    double target_s = 0.0;
};

struct WorkPath {
    std::uint32_t source = 0;  // index into Pattern::paths
    std::uint32_t profile = 0, material = 0;
    bool closed = false, step = false;
    bool dot = false;  // open, and so short that its ends are one place: they meet nothing, and nothing ends on it
    double level = 0.0, right_level = 0.0;
    double reach = 0.0;  // greatest |b| of the profile times the greatest factor of the perturbation, metres
    std::uint32_t function = kNoFunction;
    JoinKind join = JoinKind::mitre;
    CapKind cap[2] = {CapKind::hip, CapKind::hip};
    PathEnd end[2];

    std::vector<Element> elements;
    std::vector<ElementEnd> starts, ends;  // parallel to elements, once the joints are known
    std::vector<char> region_starts;  // parallel to elements: a step's line was crossed before this element
    std::vector<std::vector<Vec2>> samples;  // per run between steps: points that lie in its region
    std::vector<double> levels;              // parallel to elements, once the ground is known
};

struct Work {
    const Pattern& pattern;
    const ResolveOptions& options;
    double snap = 0.0;       // metres
    double tolerance = 0.0;  // metres: chords leave arcs by at most this
    std::vector<ResolvedProfile> profiles;
    std::vector<double> rise;  // per profile: last h - first h; 0 for grooves
    std::vector<WorkPath> paths;
    std::vector<ScaleFunction> functions;
    std::vector<Junction> junctions;
    ResolveStats stats;
    bool repeats() const { return pattern.wrap == Wrap::repeat; }
};

std::string position_text(Vec2 p);
std::string path_text(std::size_t index, Vec2 p);  // "path 3 at (0.1, 0.2)"

// Facets split at b = 0 (steps) and where they pass the ground of their side; which of them cut, [2010] 5.3.
Result<ResolvedProfile> classify_profile(const Profile& profile, std::size_t index, double depth);

// Checks pattern and options and fills `work` with clean paths. Lenient: drops what is in error.
Status prepare(Work& work);
// Counts a path in error; true when the options allow to go on without it.
bool tolerate(Work& work, const std::string& message);

// Heights that path `index` reaches on its own ground, at height scales up to `scale`, must lie within the depth.
Status check_heights(const Work& work, std::size_t index, double scale);
// Gives the elements of a path with a perturbation their arguments and the path its function and reach; checks the scales.
Status perturb_path(Work& work, WorkPath& path);

// Arcs as chords, path by path in order.
std::vector<Chord> flatten(const Work& work, bool steps_only);

// Ends that meet, ends on other paths: moves them together. Ends that fade out get their taper. Bad step ends
// are named by path index.
struct PathError {
    std::size_t path = 0;
    std::string message;
};
std::vector<PathError> connect_ends(Work& work);

// A crossing of two arcs; parameters on the elements, position near the first path.
struct ArcCrossing {
    std::uint32_t path[2], element[2];
    double s[2];
    Vec2 position;
};
// All crossings of paths, without those at ends that were joined; touches are left out.
std::vector<ArcCrossing> find_arc_crossings(const Work& work);

// Records crossings as junctions and splits grooves at steps. Crossings of steps are errors.
std::vector<PathError> split_at_steps(Work& work);
// Tangent of a path at a parameter; at a vertex inside the path the mean of both sides.
Vec2 tangent_at(const Work& work, const WorkPath& path, std::size_t element, double s);
// Level of every element: the ground its run between steps lies in.
void find_levels(Work& work);

// End that runs up to a line of direction `clip`. A line nearly along the element's own tangent would cut it
// lengthwise far beyond the end; a hip ends it instead (a step's line still bounds it by the level).
ElementEnd clip_or_hip(Vec2 tangent, Vec2 clip);

// Priority of every element end.
void find_priorities(Work& work);

// Cuts elements to the tile and numbers styles.
Result<ResolvedPattern> assemble(Work& work);

// A direction as the angle of an undirected line, [0, pi).
double line_angle(Vec2 direction);
Vec2 wrapped(const Work& work, Vec2 p);
// The copy of `target` nearest to p; target itself when clamped.
Vec2 copy_near(const Work& work, Vec2 target, Vec2 p);

}  // namespace burin::resolving
