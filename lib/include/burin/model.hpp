// The surface that a pattern is put on, and reading of finished assets.
//
//     .gltf .glb .obj --[read_model]--> Model --[write_glb + textures + extension + fallback]--> bytes of
//     OUT.glb bytes of OUT.glb --[read_asset]--> Asset --> render, check, info
//
// A Model keeps the whole glTF document as it was read, so that the output loses nothing of the input: nodes,
// names, cameras, animations, extras and extensions that burin does not know pass through. Buffers and images
// kept in other files are gathered into the one binary chunk of the output.
//
// Input is not trusted: every index, view, accessor, stride and URI is checked before use; a URI may neither
// leave the folder of the file nor name a scheme other than `data`; what the document calls required and
// burin does not know (compression, for instance) is refused by name.
//
// Conventions are those of glTF 2.0: right-handed, y up, metres, v down, front faces counter-clockwise. OBJ
// files have v up and are turned over on reading.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <burin/bake.hpp>
#include <burin/format/extension.hpp>
#include <burin/format/texels.hpp>
#include <burin/frames.hpp>
#include <burin/geometry.hpp>
#include <burin/residual.hpp>
#include <burin/result.hpp>

namespace burin {

// Limits of reading, each named in the message when it is exceeded.
inline constexpr std::uint64_t kMaxModelFileBytes = 1ull << 30;  // any one file of a model
inline constexpr std::uint64_t kMaxModelBytes = 2ull << 30;      // all buffers and images together
inline constexpr std::uint64_t kMaxModelVertices = 1ull << 26;   // after instancing by nodes
inline constexpr std::uint64_t kMaxModelIndices = 3ull << 26;
inline constexpr int kMaxModelJsonDepth = 128;

struct ModelData;  // the document, its buffers and images; private to the sources

// A checked glTF document, however it was stored. Cheap to copy; never changes.
class Model {
  public:
    explicit Model(std::shared_ptr<const ModelData> data) : data_(std::move(data)) {}
    const ModelData& data() const { return *data_; }

  private:
    std::shared_ptr<const ModelData> data_;
};

// Reads .gltf (buffers and images embedded or beside it), .glb and .obj; the content decides between glTF and
// glb, and text that is not JSON is read as OBJ. OBJ: v, vt, vn, f (polygons are triangulated by ear
// clipping, negative indices count from the end), usemtl becomes the name of a material; groups, smoothing,
// lines, free-form curves and mtllib are passed over. Normals that an OBJ lacks are computed from its faces.
// Fails with io_failed, invalid_input (what, where, which value), unsupported (a required extension, named; a
// glTF version other than 2), limit_exceeded. Cost: linear in the file's size.
Result<Model> read_model(const std::string& path);

// The same for bytes in memory; `base_folder` is where relative URIs start (empty: none are allowed).
Result<Model> read_model_bytes(std::span<const std::uint8_t> bytes, const std::string& base_folder);

// A rectangle of two triangles in the plane y = 0 with the normal +y, centred on the origin, size.x metres
// along +x (u) and size.y metres along +z (v); positions, normals, tangents, one uv set over [0, 1]; one
// material named "plane". Requires: both sides > 0 and finite.
Model make_plane(Vec2 size);

struct AttachOptions {
    // Name; empty: the only material that a triangle primitive uses. Triangles without a material count as
    // one named "default", which is made when the pattern goes onto it.
    std::string material;
    int tex_coord = 0;  // which uv set the pattern lies in, [0, 7]
};

// Where a pattern would go: to be asked before a long conversion.
struct MaterialTarget {
    std::size_t index = 0;  // in the document; one past its materials for a "default" that will be made
    std::string name;
    // Mean length in metres of one uv unit along u and along v, over the material's triangles, by area, at
    // the scale in which the default scene shows them: the natural `size` of a pattern that covers uv 0 to 1.
    Vec2 metres_per_uv{1.0, 1.0};
    std::size_t triangles = 0;
    bool replaces_normal_texture = false;  // the material has one of its own; see write_glb
    bool keeps_occlusion_texture = false;  // the material has one of its own, which stays
};

// Fails with invalid_input: no material of that name, several materials and no name (the message lists the
// names), a primitive of the material without the uv set or whose uv has no area.
Result<MaterialTarget> find_material(const Model& model, const AttachOptions& options = {});

// The document with the pattern on one material, as binary glTF 2.0 that stands alone.
// Adds: on primitives that are not flat the vertex attributes kFrameAttributes (frames.hpp), which tell how the surface
// bends and stretches, in the space of the mesh; where the uvs are cut, the table of borders over which rays go on and the attribute
// kChartAttribute (charts.hpp); two bufferViews with the textures (32-bit little-endian words, row-major), the extension
// BURIN_materials_path_detail on the material (listed in extensionsUsed only), and the fallback as PNG in the
// core material: normalTexture, and occlusionTexture unless the material has one. The residual, if there is one, becomes
// the extension's residualTexture, with a sampler that wraps like the pattern; where the fallback has no normal map, it is
// the core material's normalTexture too, and stored once. A normalTexture that the
// material had gives way to the fallback, which every viewer understands; what it was is kept under the
// material's extras as "burin_replaced_normal_texture", its texture and image stay in the file. A pattern
// that the material already carries is replaced with its fallback: what both occupied is used again or left
// out, as far as nothing else in the document refers to it and no index of anything else changes, so that
// attaching twice gives the bytes of attaching once. `detail` is taken as given, but its buffer views and
// residual are set here. Fails as find_material does, and with limit_exceeded when the result passes 4 GiB. Equal input gives
// equal bytes.
Result<std::vector<std::uint8_t>> write_glb(const Model& model, const PackedTextures& textures,
                                            const PathDetail& detail, const Fallback& fallback,
                                            const AttachOptions& options = {}, const Residual& residual = {});

// The document as it is, as binary glTF 2.0 that stands alone. Fails with limit_exceeded when the result passes 4 GiB. Equal input gives
// equal bytes.
Result<std::vector<std::uint8_t>> write_model(const Model& model);

// Triangles with the look of one material; no texture.
struct PlainMesh {
    std::string material;  // name; meshes of one name share the material, which looks like the first
    std::array<double, 4> base_color{0.8, 0.8, 0.8, 1.0};  // linear
    double metallic = 0.0, roughness = 0.5;
    std::vector<float> positions;  // three per vertex, metres
    std::vector<float> normals;    // three per vertex, unit length
    std::vector<std::uint32_t> indices;
};

// One node of that name with one primitive for each mesh. Requires: meshes not empty, each with at least one triangle.
Model make_model(const std::string& name, std::vector<PlainMesh> meshes);

// Triangles of one material, as the default scene shows them: node transforms applied, one entry for each
// node and primitive. Points and lines are left out; strips and fans are unrolled.
struct Primitive {
    std::vector<float> positions;  // three per vertex, metres, world space
    std::vector<float>
        normals;             // three per vertex, unit length; computed from the faces where the file has none
    std::vector<float> uvs;  // two per vertex, of the uv set of the material's pattern (set 0 without one);
                             // zero where the file has none
    std::vector<std::uint32_t> indices;  // three per triangle, each below the vertex count
    int material = 0;                    // index into Asset::materials
    std::vector<SurfaceFrame> frames{};  // one per vertex, world space; none where the file has none
    std::vector<float> charts{};         // number of each vertex' chart; none where the file has none
    float scale = 1.0f;                  // metres of the world per metre of the mesh: the node's, the mean of its axes
    bool mirrored = false;               // the node's transform turned the triangles over; they are wound anew
    // Four per vertex, the uv sets 0 and 1; none where all textures of the material lie in the set of `uvs`.
    std::vector<float> texture_uvs{};
};

// A texture of glTF's own, as a renderer needs it. Filters and wraps are glTF's numbers, which are OpenGL's.
struct MaterialTexture {
    std::shared_ptr<const RgbaImage> image;  // shared by all that show it; null: there is none
    int tex_coord = 0;                       // 0, 1, or the set of the material's pattern
    // KHR_texture_transform: (u, v) of the vertices becomes (a u + b v + c, d u + e v + f); here a to f.
    std::array<float, 6> transform{1, 0, 0, 0, 1, 0};
    int minification = 9987, magnification = 9729;  // without a sampler: linear with mipmaps
    int wrap_u = 10497, wrap_v = 10497;             // REPEAT; or 33071 CLAMP_TO_EDGE, 33648 MIRRORED_REPEAT
};

struct MaterialInfo {
    std::string name;
    float base_color[4] = {1, 1, 1, 1};  // linear
    float metallic = 1.0f;
    float roughness = 1.0f;
    float emissive[3] = {0, 0, 0};  // linear
    // Glass: the factors of KHR_materials_transmission, KHR_materials_ior and KHR_materials_volume; their textures are not read.
    float transmission = 0.0f;                 // part of what is neither metal nor mirrored that goes through, [0, 1]
    float ior = 1.5f;                          // index of refraction, at least 1
    float thickness = 0.0f;                    // metres of the mesh; 0: a thin sheet, else the mesh bounds a body
    float attenuation_color[3] = {1, 1, 1};    // what is left of white after attenuation_distance metres in the body
    float attenuation_distance = HUGE_VALF;
    // Textures, where pictures were asked for. Colours of the first and the last are sRGB; roughness is the second's green,
    // metallic its blue, occlusion the third's red. Occlusion that burin baked from the pattern, for viewers that do not draw it,
    // is left out.
    MaterialTexture base_color_texture, metallic_roughness_texture, occlusion_texture, emissive_texture;
    float occlusion_strength = 1.0f;
    bool double_sided = false;
    bool has_detail = false;  // then the two below hold
    PathDetail detail;
    PackedTextures textures;
    std::vector<std::uint32_t> charts;  // the table of detail.charts; empty: there is none
    RgbaImage residual;      // what the residualTexture shows; width 0: there is none
};

struct Asset {
    std::vector<Primitive> primitives;
    std::vector<MaterialInfo>
        materials;  // those of the document; then glTF's default, when a primitive has none
};

struct AssetOptions {
    bool pictures = false;  // decode the images of the materials' own textures too, for drawing
};

// Largest image of a material's texture that is read.
inline constexpr std::uint64_t kMaxPictureTexels = 1u << 28;

// Reads glTF or glb. The textures are checked for what reading needs: views, sizes, section lengths; whether
// their content keeps every rule of the format is validate_glb's business, and unpack_textures is safe on any
// content. A residual is decoded. Fails as read_model does, and with invalid_input when an extension object does not parse
// or its residual cannot be read. With pictures: also when a texture's image is missing or damaged, and with unsupported when it is
// neither PNG nor JPEG or lies in a uv set that is neither 0, 1 nor the pattern's. Images that no material shows are not decoded.
Result<Asset> read_asset(std::span<const std::uint8_t> bytes, const std::string& base_folder = {}, const AssetOptions& options = {});

}  // namespace burin
