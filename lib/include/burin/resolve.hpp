// Stage resolve: finds crossings, ends, corners and T-junctions, and gives every element end its priority.
//
//     Pattern --[resolve_pattern]--> ResolvedPattern
//
// A ResolvedPattern says for every element where in the plane it acts, so that truth, grid and shader need no
// neighbour. Source: [2010] 5.3 and 5.4, DESIGN 2. Predicates and intersections are exact (CGAL).
//
// WHERE AN ELEMENT ACTS. Let V be an end of the element, t the unit tangent there pointing along the path, p a point.
//   foot      the nearest point of the carrier: a line's infinite carrier; for a quadratic the arc itself, continued by
//             the tangent lines at its ends. b = signed distance to it along n, side left when b < 0.
//   a         how far p lies beyond the end: (V - p).t at the start, (p - V).t at the end; inside when a <= 0.
//   clip line the line through V in direction (cos clip_angle, sin clip_angle). p is on the element's side when it
//             lies on the same side as the element's interior near V.
// The element acts at p, with offset b', when both ends allow it:
//   priority none              a <= 0                                                    b' = b     (butt)
//   priority both,  clip       p on the element's side of the clip line (both sides)     b' = b     (joint, T)
//   priority both,  hip        always; where a > 0 b' = sign(b) max(|b|, a)
//   priority both,  round      always; where a > 0 b' = sign(b) hypot(b, a)
//   priority left (or right)   on that side, the outer sector: p on the element's side of the clip line; where a > 0
//                              mitre b' = b; round b' = -|p - V| (left) or +|p - V| (right);
//                              bevel b' = ((p - V).m) / cos(theta/2), m the unit sum of the two arms' normals n,
//                              theta the angle between the arms' tangents; m is the normal of the clip line's
//                              perpendicular, so it follows from clip angle and n: m = +-(cos, sin)(clip_angle), m.n > 0,
//                              cos(theta/2) = m.n
//                              on the other side, the inner sector: a <= 0
// and when, besides, |b'| is within the profile scaled by the width scale at the foot (end values beyond the ends), and
// the ground at p equals the level of the element's side there: `level` for a groove or the left of a step, the right
// level for the right of a step. Two arms of a corner share one clip line (their bisector), so outer sectors meet
// without gap. With height h = level + height_scale * profile(b' / width_scale):
//   solid = (ground U all add) \ all cut,   H(p) = min( max(ground, add heights), cut heights )
//   add: the part above the ground of that side;   cut: where b' lies in an internal facet, all above h (the wedge).
// ALONG THE PATH. Width and height scale at the foot are the linear ones of the element times the two factors of its
// function, where it has one, at the argument a there. a counts wavelengths (sine, noise) or is the share of the path's
// length (polynomial). resolve measures arc lengths and gives a at both ends of each element, in [0, 65536) and never
// falling; between them, with s the curve parameter,
//   line       a(s) = a0 + (a1 - a0) s
//   quadratic  a(s) = a0 + (a1 - a0) L(s) / L(1),  L the integral of the speed from 0 to s by Gauss's rule of three points:
//              the arc length to within 0.25 % of the element's, for turns up to 90 degrees
// and beyond the ends it stays. This is the definition, for truth and shaders alike.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <burin/pattern.hpp>
#include <burin/result.hpp>

namespace burin {

enum class Priority : std::uint8_t { none, left, right, both };  // values equal BURIN_PRIORITY_*
enum class CornerShape : std::uint8_t { mitre, bevel, round };   // with left or right; values equal BURIN_CORNER_*
enum class EndShape : std::uint8_t { clip, hip, round, tee };    // with both; values equal BURIN_END_*

struct ElementEnd {
    Priority priority = Priority::none;
    std::uint8_t shape = 0;   // CornerShape or EndShape, by priority; 0 with none
    double clip_angle = 0.0;  // radians in [0, pi); 0 where unused

    // Whether both sides of the profile run to the clip line: a smooth joint, or an end on another path's line.
    bool clips_both() const {
        return priority == Priority::both &&
               (EndShape(shape) == EndShape::clip || EndShape(shape) == EndShape::tee);
    }
};

// A perturbation as elements refer to it: the factors as functions of the argument a.
//   sine 1 + amplitude sin(2 pi a) · polynomial c[0] + c[1] a + c[2] a^2 + c[3] a^3 · noise 1 + amplitude n(a)
struct ScaleFunction {
    PerturbationKind kind = PerturbationKind::sine;
    double width = 0.0, height = 0.0;  // amplitudes
    std::uint32_t seed = 0;
    std::uint32_t octaves = 1;
    std::uint32_t period = 0;  // noise: it repeats after so many wavelengths; 0: never
    double width_polynomial[4] = {1, 0, 0, 0};
    double height_polynomial[4] = {1, 0, 0, 0};

    bool operator==(const ScaleFunction&) const = default;
};
inline constexpr std::uint32_t kNoFunction = 0xffffffffu;

struct ResolvedElement {
    Element element;
    ElementEnd start, end;
    std::uint32_t style = 0;
    std::uint32_t path = 0;  // which Pattern path it came from: neighbours of one path follow each other
    std::uint32_t function = kNoFunction;  // index into ResolvedPattern::functions
};

// Profile with classified facets, at the level of one region. Equal styles are stored once.
struct Style {
    std::uint32_t profile = 0;   // index into ResolvedPattern::profiles
    std::uint32_t material = 0;  // index into ResolvedPattern::materials
    double level = 0.0;          // height of h = 0
    bool step = false;           // the profile's ends differ: ground changes at b = 0
};

struct ResolvedProfile {
    std::vector<ProfilePoint> points;  // a point stands at b = 0 where a step profile crosses it
    std::uint32_t internal_mask = 0;   // bit i: facet i between points i and i + 1 cuts
};

// A place where several elements meet: tests aim rays here.
enum class JunctionKind : std::uint8_t { corner, crossing, tee, isolated_end, star };
struct Junction {
    JunctionKind kind = JunctionKind::corner;
    Vec2 position;
};

// Where two step paths cross, or one crosses itself: indices into Pattern::paths, and a place, metres, in the tile.
struct StepCrossing {
    std::uint32_t path[2] = {0, 0};
    Vec2 position;
};

// What was tolerated. Counts of zero mean that the pattern was taken exactly as given.
struct ResolveStats {
    int dropped_elements = 0;   // of length zero, or equal to another element of the same style
    int snapped_ends = 0;       // path ends moved onto another path or another end
    int releveled = 0;          // grooves whose level was not that of the ground they lie in
    int step_crossings = 0;     // places where a groove was split at a step
    int uneven_levels = 0;      // step paths off the level of a step facing them; brought together if near
    int dropped_paths = 0;      // lenient only: paths that would have been an error
    std::string first_dropped;  // the message that the first of them would have been
    std::vector<StepCrossing> crossings;  // lenient only: for the sake of which paths were dropped
};

struct ResolvedPattern {
    Vec2 size{1.0, 1.0};
    double depth = 0.01;
    double base_offset = 0.0;
    Wrap wrap = Wrap::repeat;
    double outer_level = 0.0;
    // When repeating: start in [0, size), box within [-0.5, 1.5) * size, and every point where the element acts lies within
    // 0.45 size of its chord's midpoint along each axis, so that "the nearest copy" (grid.hpp) is never in doubt.
    std::vector<ResolvedElement> elements;
    std::vector<Style> styles;
    std::vector<ResolvedProfile> profiles;
    std::vector<Material> materials;
    std::vector<ScaleFunction> functions;
    std::vector<Junction> junctions;
    ResolveStats stats;
};

struct ResolveOptions {
    // Ends nearer than this to another path's line are taken to lie on it, metres as a fraction of the larger of
    // size.x and size.y. Range [0, 0.01]. An open path no longer than twice that is a dot, which meets no other path.
    double snap = 1e-4;
    // Angle below which two consecutive elements are one smooth joint, radians, [0, 0.5].
    double smooth_angle = 0.05;
    double mitre_limit = 4.0;  // ratio as in SVG, >= 1; a sharper corner is bevelled
    bool lenient = false;      // drop a path that is in error, count it, and go on: what traced maps need
};

// The level of two sides of one region may differ by rounding: compare levels with a tolerance of depth / 4096.
//
// Ensures: elements that cross a step's path line are split there and carry the level of their side (where the step bends
// within the strip or is met at under 7 degrees both pieces reach beyond it, butt-ended, and the level bounds them); elements that
// leave [-0.5, 1.5) of the tile are split; a quadratic turns by at most 90 degrees; every end has its priority; output
// depends on the input alone. An open end on the border of a clamped map runs to it; a step path may end there.
// Fails with invalid_input, naming path and position: a path that does not connect, an index out of range, a profile
// with wrong order or point count, a perturbation out of range or one that makes a scale leave [0, 4), step paths that cross each other, a step path that ends nowhere, a profile that
// a vertical ray meets again above an internal facet and that has no explicit flags, a value that is not finite.
// Cost: about n log n in elements, plus crossings.
Result<ResolvedPattern> resolve_pattern(const Pattern& pattern, const ResolveOptions& options = {});

}  // namespace burin
