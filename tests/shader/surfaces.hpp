// Round surfaces to put patterns on, as formulas and as meshes with what convert would compute for them.
//
//     RoundSurface --[mesh_of]--> BaseMesh (vertices, frames)      RoundSurface + drop(uv) --[displace]--> triangles
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <burin/frames.hpp>
#include <burin/geometry.hpp>
#include <cpp/decode.hpp>

namespace burin::testing {

using Vec3 = std::array<double, 3>;

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3 operator*(const Vec3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double dot(const Vec3& a, const Vec3& b);
Vec3 cross(const Vec3& a, const Vec3& b);
Vec3 normalized(const Vec3& a);

struct SurfacePosition {
    Vec3 position, normal;  // metres; unit length, outwards
};

// uv runs from 0 to `span` in either direction.
struct RoundSurface {
    std::string name;
    Vec2 span;
    int columns, rows;  // of the base mesh
    std::function<SurfacePosition(Vec2)> at;
    Vec2 low{0.05, 0.05}, high{0.95, 0.95};  // where rays are aimed, of the span: not at seams nor poles
};

// Seven of them, about a metre large, with uv units of about 0.25 m; `detail` multiplies the columns and rows.
std::vector<RoundSurface> round_surfaces(double detail = 1.0);

struct BaseMesh {
    std::vector<float> positions, normals, uvs;
    std::vector<std::uint32_t> indices;
    std::vector<SurfaceFrame> frames;  // as compute_frames gives them
};
BaseMesh mesh_of(const RoundSurface& surface);

// What a fragment shader has at a point of a triangle: b and c weigh its second and third corner. Without frames the triangle
// itself says how the surface is stretched. The chart is that of `charts`, one per vertex, where given.
SurfacePlace place_on(const BaseMesh& mesh, std::size_t triangle, double b, double c, const std::vector<std::uint32_t>* charts = nullptr);

// The surface of mesh_of's triangles, with the normals interpolated between their corners.
RoundSurface faceted(const RoundSurface& surface);

struct Triangles {
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;
};

// P - drop N as triangles, finer where the drop, which is the same in every tile, is not linear: cells of 1/16 uv unit are
// halved up to `levels` times.
Triangles displace(const RoundSurface& surface, const std::function<double(Vec2)>& drop, double tolerance, int levels);

}  // namespace burin::testing
