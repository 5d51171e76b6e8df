// Triangles traced by Embree: the rival of [2008], which draws the relief as geometry with several samples per pixel.
//
//     TriangleMesh (one tile) --[TracedMesh]--> BVH --[draw_traced]--> picture
//
// It stands on the same plane, in the same view and light, and is shaded by the same formula as the truth's pictures. Rays go in packets of
// 16; threads share tiles of the picture.
#pragma once

#include <memory>

#include <burin/image.hpp>
#include <mesh/mesh.hpp>
#include <runtime/truth_picture.hpp>

namespace burin::bench {

// How a tile is made into many.
class TracedMesh {
  public:
    // `extent` as the truth has it: the tiles that rays start on. A ring of tiles stands around them where the pattern repeats; around a map that
    // ends lies its outer level. Tiles are copied while they have at most 2^23 triangles in all, and are instances otherwise.
    TracedMesh(const mesh::TriangleMesh& tile, const ResolvedPattern& pattern, const Extent& extent);
    ~TracedMesh();
    TracedMesh(const TracedMesh&) = delete;

    std::size_t bytes() const;       // of one tile: corners, triangles, and what Embree builds over them
    std::size_t triangles() const;   // of one tile

    struct Parts;
    const Parts& parts() const { return *parts_; }

  private:
    std::unique_ptr<Parts> parts_;
};

struct TraceOptions {
    int samples = 4;        // per pixel, a square number; stratified and jittered
    bool adaptive = false;  // four at first; `samples` where these, or those of a neighbour, do not see the same
};

// Cost: samples times some 0.3 us.
RgbaImage draw_traced(const TracedMesh& mesh, const Subject& subject, const PlaneView& view, const TraceOptions& options);

}  // namespace burin::bench
