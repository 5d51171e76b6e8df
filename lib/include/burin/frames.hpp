// How a mesh bends and stretches under its texture coordinates: what a ray needs to stay straight in space while it
// is followed in the plane of the pattern.
//
//     positions, normals, uvs, triangles --[compute_frames]--> one SurfaceFrame per vertex
//
// The object surface is P(u, v) with the unit normals N(u, v) of the mesh; a point `drop` metres below it is
// P - drop N. A frame holds the derivatives of P at the vertex, first and second:
//
//     metres per uv unit along u, along v: |du|, |dv|      skew: du . dv      curvature: duu . N, duv . N, dvv . N
//     how the stretch changes from place to place: what of duu, duv, dvv lies in the surface
//
// Derivatives are vectors in the space of the mesh: a node's matrix, whatever it scales, moves them as it moves any
// direction. The normal turns by the curvature (N_u . du = -duu . N), so that nothing more is needed to second order.
// Source: [2010] 4.1 and 5.1, which track an approximate curvature, and the stretch, along the ray.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace burin {

// Metres per uv unit (du, dv) and per uv unit squared. All zero: unknown, and the triangle itself says what it can.
struct SurfaceFrame {
    std::array<float, 3> du{}, dv{}, duu{}, duv{}, dvv{};
};

// Triangles of one material in the space of the mesh.
struct SurfaceMesh {
    std::span<const float> positions;        // three per vertex, metres
    std::span<const float> normals;          // three per vertex, unit length
    std::span<const float> uvs;              // two per vertex
    std::span<const std::uint32_t> indices;  // three per triangle
};

struct FrameOptions {
    // Neighbours whose normals differ by more say nothing about how round the surface is: there is an edge, or the mesh is
    // too coarse to tell. Cosine, range (-1, 1).
    double crease_cosine = 0.8;
    // A mesh whose first derivatives change by less from each vertex to the next is flat and evenly stretched: no frames
    // are needed. Part of their length, range [0, 1).
    double flat = 1e-4;
};

// One frame per vertex, in the order of the vertices: least squares over the vertices one edge away, two edges where that
// is a border, of the positions and, for the curvature, the normals. Vertices that are stored more than once with equal
// position, normal and uv count as one; across a seam of the uvs nothing is shared. Where that says nothing, or something
// else than the triangles around the vertex, first derivatives are their mean and second ones 0.
// Requires: sizes that belong together, indices in range, finite values.
// Ensures: finite values; `du` and `dv` are square to the normal; none at all (an empty vector) when the whole mesh is flat
// and evenly stretched, so that its triangles tell as much.
// Cost: linear, about a microsecond per vertex and neighbour; equal input gives equal bits.
std::vector<SurfaceFrame> compute_frames(const SurfaceMesh& mesh, const FrameOptions& options = {});

}  // namespace burin
