// The truth: what surface a ResolvedPattern means, by brute force in double precision.
//
//     ResolvedPattern --[Truth]--> ground, height, solid or not, first hit of a ray
//
// No grid, no texture, no code shared with grid, pack or shader: this module judges them. Slow but certain is
// right here. The meaning is that of resolve.hpp ("WHERE AN ELEMENT ACTS") and DESIGN 2; what they leave open
// is said below.
//
// Units: pattern space, metres; z as in pattern.hpp (object surface at base_offset). Normals have length 1, z
// upwards. Sources: [2010] 5.3, 5.4 (CSG of features, priorities), [2008] 4 (intersection along a ray).
//
// What is fixed here:
//   ground       The level beside the nearest step path line that a straight way from p meets, on the side p
//   lies on:
//                left style.level, right style.level + (last h - first h) * height scale. Any direction gives
//                the same in a consistent pattern; the module picks one that meets a line well inside an
//                element. Without any step element: outer_level.
//   solid        add(e) at offset b: heights above the ground at p that have an odd number of facets above
//   them.
//                cut(e): heights with an odd number of facets of one internal run below them. For profiles
//                that are height fields this is min(max(ground, adds), cuts).
//   borders      A point exactly on a clip line, on a = 0 or on b = 0 of a step belongs to the element; b = 0
//   is the
//                right side otherwise. A clip line along the tangent itself acts as a = 0.
//   repeat       Every element acts at all its tile images. p may be any point of the plane.
//   clamp        Outside [0, size] the surface is outer_level; walls may stand on the border of the map.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include <burin/resolve.hpp>

namespace burin {

inline constexpr std::uint32_t kGround = 0xffffffffu;  // as element: the ground itself; as facet: no facet
inline constexpr std::uint32_t kWall =
    0xfffffffeu;  // as facet: a vertical wall that is no facet of a profile: where
                  // an element stops acting, or above the end of a cut

// The surface at one point, seen from above: the topmost solid height.
struct SurfacePoint {
    double height = 0.0;
    std::uint32_t element = kGround;  // which element's add or cut bounds the solid there
    std::uint32_t facet = kGround;    // facet of its profile; kGround together with element
    double normal[3] = {0, 0, 1};
    double ground = 0.0;  // level of the region
    double offset = 0.0;  // b' of that element in metres, 0 on the ground
};

struct Ray {
    double origin[3] = {0, 0, 0};
    double direction[3] = {0, 0, -1};  // any length > 0; t counts in its lengths
};

struct RayHit {
    bool hit = false;
    bool inside = false;  // the origin lies in the solid: then t = 0, no element, normal against the ray
    double t = 0.0;
    double position[3] = {0, 0, 0};
    double normal[3] = {0, 0, 1};
    std::uint32_t element = kGround;
    std::uint32_t facet = kGround;
};

struct TruthOptions {
    // Levels nearer than this are the same level, as a fraction of depth. Quantized patterns
    // (unpack_textures) need about 4e-5, two steps of 16 bits. Range (0, 0.01].
    double level_tolerance = 1e-9;
    // A ray is followed for at most this many sides of the tile (repeat only). Range [1, 1e6].
    double max_tiles = 4096.0;
};

// Prepared once, asked many times; every member function is const and safe to call from several threads.
class Truth {
  public:
    // Requires: indices in range, every profile with at least 2 points, size and depth > 0, all values finite
    // (as resolve_pattern and unpack_textures ensure). Keeps its own copy of what it needs.
    explicit Truth(const ResolvedPattern& pattern, const TruthOptions& options = {});
    ~Truth();
    Truth(Truth&&) noexcept;
    Truth& operator=(Truth&&) noexcept;

    // Cost: number of step elements.
    double ground_at(Vec2 p) const;

    // Cost: number of elements. With `candidates` only these elements (at all their images) are asked; the
    // ground is the same in either form. Requires: candidate indices in range, each once.
    SurfacePoint surface_at(Vec2 p) const;
    SurfacePoint surface_at(Vec2 p, std::span<const std::uint32_t> candidates) const;
    // The same where the caller knows the ground at p.
    SurfacePoint surface_at(Vec2 p, std::span<const std::uint32_t> candidates, double ground) const;

    // Whether (p, z) lies in the solid. On the surface itself either answer may come.
    bool is_solid(Vec2 p, double z) const;

    // First point of the ray, t >= 0, that lies in the solid. Rays may point down, up or level and may start
    // anywhere. Ensures: t exact to about 1e-12 of the feature's size; a piece of solid thinner than that may
    // be passed. Cost: elements near the ray times events on it; some ten microseconds for a handful of
    // elements.
    RayHit trace_ray(const Ray& ray) const;

    struct Prepared;  // evaluate_prepare.hpp, internal to lib
    const Prepared& prepared() const { return *prepared_; }

  private:
    std::unique_ptr<Prepared> prepared_;
};

// One question, everything prepared anew: for tests and few points.
double ground_at(const ResolvedPattern& pattern, Vec2 p);
SurfacePoint surface_at(const ResolvedPattern& pattern, Vec2 p);
SurfacePoint surface_at(const ResolvedPattern& pattern, Vec2 p, std::span<const std::uint32_t> candidates);
bool is_solid(const ResolvedPattern& pattern, Vec2 p, double z);
RayHit trace_ray(const ResolvedPattern& pattern, const Ray& ray);

}  // namespace burin
