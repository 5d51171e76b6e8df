// Draws an asset with the fragment shader of this folder, off screen: what a viewer that knows the extension
// shows.
//
//     Asset --[render_asset]--> RgbaImage (sRGB)      Asset --[render_top]--> Image (heights)
//     PackedTextures + rays --[shade_rays]--> hits    (the tests' way into the shader)
//
// World space is glTF's: right-handed, y up, metres. Directions are given as azimuth and elevation in
// degrees: azimuth 0 is +z (in front of a model, at the lower edge of a plane), 90 is +x; elevation 90 is +y.
// Shading: metallic-roughness of the glTF material with its textures, looked up where the ray meets the relief, or the pattern's
// own (SPECIFICATION.md, section 10); one directional light, and a soft ambient term or an environment; the residual's slopes added to the
// paths' (section 13). Where a detail is drawn the core normal texture and the occlusion that burin baked are its fallback and are not
// used; without detail the normal texture is not either. Source: [2010] 5; perspective and shadows 5.6.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <burin/geometry.hpp>
#include <burin/image.hpp>
#include <burin/image_io.hpp>
#include <burin/model.hpp>
#include <burin/radiance.hpp>
#include <burin/result.hpp>

namespace burin {

// OSMesa needs no GPU. EGL takes the first device that opens without a window. Both are loaded when asked
// for.
enum class Backend { osmesa, egl };

struct Camera {
    double azimuth = 30.0;        // degrees, where the camera stands around the asset
    double elevation = 50.0;      // degrees, [-90, 90]; 90 is straight above with u to the right and v down
    double zoom = 1.0;            // 1 shows all of the asset; > 0
    double field_of_view = 30.0;  // degrees, vertical, (0, 120]
    bool orthographic = false;
    // Point of the pattern that the camera looks at, uv; without it the middle of the asset's box.
    std::optional<Vec2> center;
    // These replace azimuth, elevation and zoom when given. Without `target` the point above.
    std::optional<std::array<double, 3>> eye;
    std::optional<std::array<double, 3>> target;
};

struct Light {
    double azimuth = -50.0;   // degrees, where the light comes from
    double elevation = 35.0;  // degrees
    double strength = 3.0;    // irradiance of the directional light in units of pi / white
    double ambient = 0.22;    // of the same, from a soft surround; not asked where there is an environment
};

// Light from all around, and what smooth metals mirror. What lies in a groove gets as much of it as an endless one of its profile
// lets in; it throws no shadows.
struct Environment {
    std::shared_ptr<const RadianceMap> map;  // null: a grey room without a file
    double rotation = 0.0;                   // degrees about y, towards larger azimuths; 0: the picture's middle lies at azimuth 90
    double strength = 1.0;                   // factor of its radiance, >= 0; a matt white surface shows its mean where that is 1
};

// How the shader filters a pixel. points: the mean of rays. regions: the features of a pixel as areas, exact where they
// do not meet, and rays where they do; [2010] 5.7.
enum class Antialiasing { points, regions };

struct RenderOptions {
    int width = 1024, height = 768;  // pixels, [1, 8192]
    Camera camera;
    Light light;
    std::optional<Environment> environment;  // none: the light's ambient term
    bool shadows = true;
    // Depths are those of the relief, not of the mesh, so that other things that stand in it, and effects that read the
    // depth, agree with it. Costs the early depth test: what is hidden is drawn all the same.
    bool correct_depth = false;
    // Per pixel, [1, 256], rounded up to a square number; 2 stays 2. Four come first; the rest go where those or their
    // neighbours differ by a step of the picture's 8 bits. One is enough for regions; points want 4 or 16.
    int samples = 1;
    Antialiasing antialiasing = Antialiasing::regions;
    // With regions: rays per sample where features meet, and with one sample where a mesh ends or has an edge; 4 or 16, [4, 64], rounded
    // up to an even square. Of more than four the rest go where the four or those beside them differ. With points every sample is one ray.
    int rays = 16;
    // Everything in one run of the shader, as an engine does it: all rays where features meet, and none for the mesh's own edges. Otherwise
    // the rays of `rays` are runs of their own, which suits a CPU better: OSMesa ends a shader after 65535 turns of its loops.
    bool one_run = false;
    std::array<float, 3> background = {0.93f, 0.93f, 0.93f};  // sRGB
    Backend backend = Backend::osmesa;
};

// Fails with unavailable (no context of that backend, with its reason; a GPU too small), invalid_argument (an
// option out of range), limit_exceeded (an asset without triangles). Cost: on OSMesa some 0.3 to 2 us per ray
// on two cores, with shadows, and 3 to 8 s to build a program the first time (Mesa keeps it: half a second from then on).
Result<RgbaImage> render_asset(const Asset& asset, const RenderOptions& options = {});

// What a pixel that shows a pattern fetches for one sample: texels in the mean. Cells are the turns of the outer loop, lists and elements
// those of the inner one (an element takes three or more); others are styles, profiles, materials and functions.
struct FetchCounts {
    double pixels = 0.0;
    double cells = 0.0, elements = 0.0, lists = 0.0, others = 0.0;
    double all() const { return cells + elements + lists + others; }
};

// Draws one sample of each pixel in one run of the shader, and counts. Fails as render_asset does.
Result<FetchCounts> count_fetches(const Asset& asset, const RenderOptions& options = {});

struct TopOptions {
    int material = -1;  // index into Asset::materials; -1: the first with a detail
    int samples = 1;    // per texel side, [1, 16]: each texel is the mean of samples x samples points
    Backend backend = Backend::osmesa;
};

// The whole tile from straight above, as the shader draws it, in the map's scale (1 = object surface, 0 =
// `depth` below). Fails as render_asset does, and with invalid_input when no material has a detail.
Result<Image> render_top(const Asset& asset, int width, int height, const TopOptions& options = {});

// A ray as the decoder follows it: it passes the object surface at `origin` (metres) and moves `slope` metres
// over the plane per metre that it falls.
struct PatternRay {
    float origin[2];
    float slope[2];
};

struct ShadedHit {
    float drop;             // metres below the object surface
    std::uint32_t element;  // texel of the element; 0xffffffff on the ground
    int facet;              // as DecodedHit::facet
    float normal[3];
};

// What the shader meets along each ray: one pixel of a float target per ray. `residual`: its normals are those to be
// shaded, with the slopes of this picture, scaled as `detail` says.
Result<std::vector<ShadedHit>> shade_rays(const PackedTextures& textures, const PathDetail& detail,
                                          std::span<const PatternRay> rays,
                                          Backend backend = Backend::osmesa, const RgbaImage& residual = {});

// Vendor, renderer and version of the backend's context, for reports.
Result<std::string> describe_backend(Backend backend);

}  // namespace burin
