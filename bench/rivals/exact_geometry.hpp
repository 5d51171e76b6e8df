// The exact surface of a pattern as triangles (mesh/), rasterized in the same context, light and shading text as the other rivals; what
// throws shadows is found in a depth map seen from the lamp, which is drawn anew for every picture, as wherever a view moves.
//
//     Context + Subject + TriangleMesh (one tile) + PlaneView --[ExactGeometry::load]--> ExactGeometry --[draw]--> Accumulator
#pragma once

#include <mesh/mesh.hpp>

#include "stage.hpp"

namespace burin::rivals {

struct GeometrySettings {
    int passes = 1;           // of the picture, shifted by parts of a pixel
    bool coverage = false;    // four samples of coverage per pixel, of which a facet is shaded once; for one pass, since they reach its borders
    int shadow_texels = 1024; // per side of the depth map
};

class ExactGeometry {
  public:
    // `stage`: of the subject and the view. Context and stage must outlive it. Fails with unavailable as the driver does.
    static Result<ExactGeometry> load(const gl::Context& context, const bench::Subject& subject, const mesh::TriangleMesh& tile, const Stage& stage,
                                      const GeometrySettings& settings);
    ExactGeometry(ExactGeometry&& other) noexcept;
    ExactGeometry& operator=(ExactGeometry&&) = delete;
    ~ExactGeometry();

    gl::Accumulator draw();
    std::size_t drawn_triangles() const;  // of all tiles that the view needs
    double bytes() const;                 // of one tile: 16 a corner, its normal packed, 12 a triangle; the depth map comes on top, 4 a texel

  private:
    struct State;
    explicit ExactGeometry(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace burin::rivals
