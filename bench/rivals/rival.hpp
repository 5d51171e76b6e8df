// Raster rivals of path detail: the techniques that draw a displacement map on a mesh, under the same context, camera, light and
// shading text (gl/lamp.glsl) as burin's renderer.
//
//     Context + Asset --[Rival::load]--> Rival;    Rival + RivalSettings + a RivalMaps per material --[draw]--> Accumulator
#pragma once

#include <memory>

#include <gl/prepared_asset.hpp>
#include <gl/program.hpp>

#include "surface_maps.hpp"

namespace burin::rivals {

enum class Technique { normals, parallax, relief, cones, triangles };
inline constexpr Technique kTechniques[] = {Technique::normals, Technique::parallax, Technique::relief, Technique::cones, Technique::triangles};
const char* name_of(Technique technique);

// Where in a pixel samples go: the middles of a square grid, or Hammersley's points, of which no two share a row or a column.
enum class Places { grid, hammersley };

struct RivalSettings {
    Technique technique = Technique::relief;
    int size = 1024;        // of the map
    int samples = 4;        // per pixel, [1, 64]
    Places places = Places::grid;
    int steps = 32;         // of the search along a ray that runs as far over the plane as it falls; steeper ones take fewer
    int refinements = 5;    // of what the search found: halvings, or secants
    float bias = 0.0f;      // added to the mip level of a sample's own footprint
    float anisotropy = 4.0f;  // how much longer than wide the footprint is that a lookup filters with the detail of its width
    bool wide_heights = false;  // 16 bits instead of 8
    double edge = 1e-3;     // triangles: uv between vertices
    std::array<double, 4> window{-1e9, -1e9, 1e9, 1e9};  // triangles: low and high uv of the object surface, where the mesh reaches beyond
    float shadow_slack = 0.003f;  // of the map's range, beyond the step of its heights: what rises so little throws no shadow
    bool passes = false;    // every sample a pass of its own, instead of a loop in the shader; triangles always are
};

// Bytes of the maps with all mip levels. Uncompressed: heights 8 or 16 bits, cones 8, normals 2 x 8, shares 8 per material beyond
// the first. In blocks of 4 x 4: BC4 heights, cones and shares, BC5 normals; half of that.
struct MapBytes {
    double plain = 0.0, blocks = 0.0;
};
MapBytes bytes_of(const RivalSettings& settings, const SurfaceMaps& maps);

// Maps of one size in a context, for any number of rivals.
class RivalMaps {
  public:
    // `cones` are made where asked for. `cache` as in map_surface.
    struct Wanted {
        int size = 1024;
        bool wide_heights = false, cones = false;
        std::string cache, key;
    };
    RivalMaps(const gl::Functions& gl, const SurfaceMaps& maps, const Wanted& wanted);
    RivalMaps(const RivalMaps&) = delete;
    RivalMaps& operator=(const RivalMaps&) = delete;
    ~RivalMaps();

    // Requires: `program` is in use. Sets textures and what else the shader asks of a map.
    void bind(const gl::Program& program) const;
    const SurfaceMaps& maps() const { return maps_; }

  private:
    const gl::Functions& gl_;
    const SurfaceMaps& maps_;
    int size_;
    GLuint names_[3] = {0, 0, 0};  // heights and cones, normals, shares
};

// Sets albedos and metal_rough of a program that is in use; it may know of more paints than there are, which then show the first.
void bind_paints(const gl::Program& program, const std::vector<MapPaint>& paints);

// A primitive cut into triangles whose sides are no longer than `edge`, in uv.
Primitive subdivide(const Primitive& primitive, double edge);

// One technique's program, with an asset's meshes.
class Rival {
  public:
    // The context and the asset must outlive it; `channels`: the most that maps will have. `outlines`: the mesh's own are
    // seen, and smoothed by four samples of coverage. For triangles the primitives are subdivided
    // already. Fails as render_asset does.
    static Result<Rival> load(const gl::Context& context, const Asset& asset, const RenderOptions& options, Technique technique,
                              std::size_t channels, bool outlines);
    Rival(Rival&& other) noexcept;
    Rival& operator=(Rival&&) = delete;
    ~Rival();

    // `maps`: of every material of the asset, all of the settings' size. Requires: its technique; 1 to 64 samples.
    gl::Accumulator draw(const RivalSettings& settings, const std::vector<const RivalMaps*>& maps);

  private:
    struct State;
    explicit Rival(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace burin::rivals
