// The surface of a pattern on the body that carries it.
//
//     TriangleMesh (one tile) + Primitive --[mesh_body]--> BodyMesh
//
// Every triangle of the body takes what of the tile, repeated as often as its texture coordinates ask, lies over it: a point at z of the
// pattern becomes P + N (z - base_offset), P and N interpolated on the triangle. Where neighbouring triangles of the body share their texture
// coordinates the surface is closed across their edge; over a seam it is as far as the pattern fits together there.
#pragma once

#include <burin/model.hpp>

#include "mesh.hpp"

namespace burin::mesh {

struct BodyMesh {
    std::vector<float> positions;  // three per vertex, metres, space of the primitive
    std::vector<float> normals;    // three per vertex, of the facets, bent as the body's are: corners are stored once for each facet that meets there
    std::vector<std::uint32_t> indices;
    std::vector<Origin> origins;  // of each triangle
};

// `tile` of `pattern`, not closed. Fails with limit_exceeded: more than kMaxTriangles triangles. Cost: tile triangles over each triangle of the body.
Result<BodyMesh> mesh_body(const TriangleMesh& tile, const ResolvedPattern& pattern, const Primitive& primitive);

// The tile alone, on the plane of make_plane(size): its corners as a BodyMesh.
BodyMesh lay_flat(const TriangleMesh& tile, Vec2 size);

}  // namespace burin::mesh
