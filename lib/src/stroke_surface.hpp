// The triangles that strokes are drawn on: neighbours, nearest places, straight ways. For the sources of this library only.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include <burin/strokes.hpp>

namespace burin::stroking {

inline Point3 operator+(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point3 operator*(Point3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Point3 a, Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Point3 cross(Point3 a, Point3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Point3 a) { return std::sqrt(dot(a, a)); }
// Of no length: stays so.
inline Point3 unit(Point3 a) {
    const double l = length(a);
    return l > 0.0 ? a * (1.0 / l) : Point3{};
}

inline constexpr std::uint32_t kNone = 0xffffffffu;

// Side k runs from corner k to corner (k + 1) % 3.
struct Triangle {
    std::array<std::uint32_t, 3> corner{};                 // equal positions have equal numbers
    std::array<Point3, 3> p;
    std::array<Vec2, 3> uv;                                // metres of the pattern
    std::array<std::uint32_t, 3> neighbour{kNone, kNone, kNone};
    std::array<bool, 3> joined{};                          // the pattern goes on over the side, if need be by whole tiles
    std::uint32_t chart = 0;                               // triangles that are joined have the same
    Point3 normal;                                         // unit length; 0 for a triangle without area
    std::array<Point3, 2> gradient;                        // of x and of y of the pattern, per metre; 0 without area
};

// A place in a triangle.
struct Place {
    Point3 p;
    std::uint32_t triangle = kNone;
};

class Surface {
  public:
    // Requires: find_material has passed for these options.
    Surface(const Model& model, const AttachOptions& attach, const MaterialTarget& target);
    ~Surface();

    const std::vector<Triangle>& triangles() const { return triangles_; }
    Vec2 pattern_size() const { return pattern_size_; }
    bool repeats() const { return repeats_; }
    double size() const { return size_; }  // diagonal of the box of all triangles
    std::size_t flat_uvs() const { return flat_uvs_; }  // triangles that have an area in space, but none in uv

    Place nearest(Point3 p) const;
    // Triangles that hold the place within `slack` metres, its own first.
    std::vector<std::uint32_t> around(const Place& place, double slack) const;
    bool on_open_side(const Place& place, double slack) const;

  private:
    void gather(const Model& model, const AttachOptions& attach, const MaterialTarget& target);
    void number_corners();
    void pair_sides();
    void number_charts();

    struct Tree;
    std::vector<Triangle> triangles_;
    std::vector<std::vector<std::uint32_t>> triangles_at_;  // per corner number
    Vec2 pattern_size_;
    bool repeats_ = false;
    double size_ = 0.0;
    std::size_t flat_uvs_ = 0;
    std::unique_ptr<Tree> tree_;
};

// The pattern's point for a point of the triangle's plane, and the step for a vector in it.
inline Vec2 step_in(const Triangle& t, Point3 v) { return {dot(t.gradient[0], v), dot(t.gradient[1], v)}; }
inline Vec2 pattern_point(const Triangle& t, Point3 p) { return t.uv[0] + step_in(t, p - t.p[0]); }
inline bool has_pattern(const Triangle& t) { return dot(t.gradient[0], t.gradient[0]) > 0.0; }

// A straight way over the mesh, one triangle after the other: `way` and `beside` are unit vectors in the triangle's plane.
struct WayStep {
    std::uint32_t triangle = kNone;
    Point3 from, way, beside;
    double length = 0.0;
    bool joined = true;  // the pattern goes on from the step before
};
// Ends after `length` metres, or before at an open side or a triangle without area.
std::vector<WayStep> straight_way(const Surface& surface, const Place& start, Point3 way, Point3 beside, double length);

}  // namespace burin::stroking
