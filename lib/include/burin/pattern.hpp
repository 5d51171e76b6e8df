// The pattern: paths with cross-sections, as a user or the vectorizer means them, before joins are resolved.
//
//     height map --[vectorize_map]--> Pattern --[resolve_pattern]--> ResolvedPattern --[build_grid, pack_textures]--> bytes
//
// Units: pattern space in metres, x along u, y along v (v down), origin at uv (0,0). Heights in metres above ground
// level 0; the object surface lies at z = base_offset, the lowest allowed point at z = base_offset - depth.
// A map's value is 1 + (z - base_offset) / depth: white = object surface, black = depth below it.
//
// Words are those of DESIGN: an element is one line or quadratic; a path is a chain of elements; offset b is the
// signed distance along n = (-t.y, t.x); left is b < 0, right is b > 0; a facet is one segment of a profile.
// Source: [2010] 4.1, 4.2; perturbation [2010] 5.5, [2008] 3.
#pragma once

#include <cstdint>
#include <vector>

#include <burin/geometry.hpp>

namespace burin {

enum class ElementKind : std::uint8_t { line, quadratic };

// One line or quadratic Bézier. Width and height scale run linearly in the curve parameter between the ends and
// multiply the profile's b and h, together with the path's perturbation. Range of each product: [0, 4).
struct Element {
    ElementKind kind = ElementKind::line;
    Vec2 p0;  // start
    Vec2 p1;  // control point of a quadratic; unused for a line
    Vec2 p2;  // end
    double width0 = 1.0, width1 = 1.0;
    double height0 = 1.0, height1 = 1.0;
    // Argument of the path's perturbation at both ends. Of no meaning in a Pattern: resolve_pattern measures it.
    double argument0 = 0.0, argument1 = 0.0;
};

struct ProfilePoint {
    double b = 0.0;  // offset in metres
    double h = 0.0;  // height in metres above the path's level
};

// Whether a facet is internal (it cuts) is decided by `resolve_pattern` from the outline, [2010] 5.3, unless given.
enum class FacetClass : std::uint8_t { automatic, internal, external };

// Cross-section: points left to right (b never decreases for a height field), 2 to BURIN_MAX_PROFILE_POINTS. The first
// and last point lie on the ground of their side. A step profile ends at different heights; the ground then changes
// at b = 0, and b = 0 lies within the profile's extent.
struct Profile {
    std::vector<ProfilePoint> points;
    std::vector<FacetClass> facets;  // empty, or one per facet
};

// Overrides of the glTF material. Material 0 is the glTF material itself.
struct Material {
    bool overrides = false;
    float base_color[4] = {1, 1, 1, 1};  // linear
    float metallic = 0.0f;               // [0, 1]
    float roughness = 1.0f;              // [0, 1]
};

// What multiplies the linear scales of a path as a function of x, the path's own arc length: metres from its start,
// on through smooth joints, corners and wherever the path is split. One for any number of paths. [2008] 3.
//   sine        1 + amplitude sin(2 pi (x / wavelength + phase))
//   polynomial  c[0] + c[1] u + c[2] u^2 + c[3] u^3, u = x / length of the path, in [0, 1]
//   noise       1 + amplitude n(x / wavelength), n in [-1, 1]: smooth noise of its own for width and for height, a sum of
//               octaves of half the wavelength and half the amplitude each (format/SPECIFICATION.md has the formula)
// On a closed path sine and noise close: the wavelength is rounded so that a whole number of them, one at least, fits; a
// polynomial must have the same value at 0 and 1. The height of a step path may not be perturbed.
enum class PerturbationKind : std::uint8_t { sine, polynomial, noise };
struct Perturbation {
    PerturbationKind kind = PerturbationKind::sine;
    double width = 0.0, height = 0.0;  // amplitudes of sine and noise, [-1, 1]
    double wavelength = 0.01;          // metres, > 0; sine and noise
    double phase = 0.0;                // sine, in wavelengths
    std::uint32_t seed = 0;            // noise
    int octaves = 1;                   // noise, [1, 8]
    double width_polynomial[4] = {1, 0, 0, 0};  // values in [0, 4) over all of [0, 1]
    double height_polynomial[4] = {1, 0, 0, 0};
};
inline constexpr std::uint32_t kNoPerturbation = 0xffffffffu;

enum class JoinKind : std::uint8_t { mitre, round, bevel };           // mitre limit 4 as in SVG, bevel beyond
enum class CapKind : std::uint8_t { hip, butt, round, taper };        // isolated ends only; hip is the default

struct Path {
    std::vector<Element> elements;  // consecutive: each p0 equals the p2 before it, bit by bit
    bool closed = false;            // the last p2 equals the first p0 (modulo the tile when the pattern repeats)
    std::uint32_t profile = 0;      // index into Pattern::profiles
    std::uint32_t material = 0;     // index into Pattern::materials
    // Height that h = 0 of the profile means: the ground of the region the path lies in; for a step path the ground
    // on its left. The ground on the right of a step path is level + (last h - first h) * height scale, and its
    // height scale is constant.
    double level = 0.0;
    JoinKind join = JoinKind::mitre;
    CapKind start_cap = CapKind::hip;
    CapKind end_cap = CapKind::hip;
    std::uint32_t perturbation = kNoPerturbation;  // index into Pattern::perturbations
};

enum class Wrap : std::uint8_t { repeat, clamp };

struct Pattern {
    Vec2 size{1.0, 1.0};       // metres per uv unit along u and v
    double depth = 0.01;       // metres, > 0
    double base_offset = 0.0;  // metres, >= 0: greatest height above ground level 0
    Wrap wrap = Wrap::repeat;  // clamp: outside [0, size] the ground is `outer_level` and no feature acts
    double outer_level = 0.0;  // ground where no step path encloses the point
    std::vector<Profile> profiles;
    std::vector<Material> materials{Material{}};
    std::vector<Path> paths;
    std::vector<Perturbation> perturbations;
};

// What a path is, by the profile it carries: a step's ends lie at different heights (by more than depth / 4096, as
// `resolve_pattern` has it); of the others, a groove goes farther down than up.
enum class PathKind : std::uint8_t { groove, ridge, step };
PathKind path_kind(const Pattern& pattern, const Path& path);
inline constexpr PathKind kPathKinds[] = {PathKind::groove, PathKind::ridge, PathKind::step};

// Relief that spans the height from `highest` to `lowest` metres, as `Pattern::depth` and `base_offset` bound it.
inline double highest(const Pattern& p) { return p.base_offset; }
inline double lowest(const Pattern& p) { return p.base_offset - p.depth; }

}  // namespace burin
