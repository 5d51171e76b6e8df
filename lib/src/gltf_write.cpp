// The document with the pattern, as one glb.
#include <algorithm>
#include <bit>
#include <cassert>
#include <iterator>
#include <optional>

#include <burin/charts.hpp>
#include <burin/image_io.hpp>

#include "asset_material.hpp"
#include "gltf_geometry.hpp"
#include "gltf_places.hpp"

namespace burin {
namespace {

constexpr const char* kReplacedNormalTexture = "burin_replaced_normal_texture";
constexpr const char* kNormalName = "path detail, normals";
constexpr const char* kResidualName = "path detail, residual";
// Views start on multiples of four bytes as glTF asks; the textures on sixteen, so that a mapped file can be
// uploaded as it lies.
constexpr std::size_t kAlignment = 4, kTextureAlignment = 16;
constexpr int kRepeat = 10497, kClampToEdge = 33071, kLinear = 9729, kLinearMipmapLinear = 9987;

void append_word(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

// A primitive's surface: what frames and charts are worked out from.
struct Surface {
    std::vector<float> positions, normals, uvs;
    std::vector<std::uint32_t> indices;
    SurfaceMesh mesh() const { return {positions, normals, uvs, indices}; }
};

Surface read_surface(const ModelData& model, const Json& primitive, int tex_coord) {
    Surface surface;
    surface.positions = read_numbers(model, *attribute_of(primitive, "POSITION"));
    std::string uv_name = "TEXCOORD_";
    uv_name += std::to_string(tex_coord);
    surface.uvs = read_numbers(model, *attribute_of(primitive, uv_name));
    surface.indices = triangle_indices(model, primitive);
    const auto given = attribute_of(primitive, "NORMAL");
    surface.normals = given ? read_numbers(model, *given) : normals_of_faces(surface.positions, surface.indices);
    return surface;
}

// A primitive with the material, in the document that is written.
struct Carrier {
    std::size_t mesh;
    Json* primitive;
    Surface surface;
};

class GlbWriter {
  public:
    explicit GlbWriter(const ModelData& model)
        : model_(model), document_(model.document), places_(document_) {}

    // All buffers one after the other, so that the first one, the binary chunk, holds everything.
    void merge_buffers() {
        std::vector<std::size_t> starts;
        for (const std::vector<std::uint8_t>& buffer : model_.buffers) {
            pad(kTextureAlignment);
            starts.push_back(binary_.size());
            binary_.insert(binary_.end(), buffer.begin(), buffer.end());
        }
        if (document_.contains("bufferViews"))
            for (Json& view : document_["bufferViews"]) {
                const std::size_t start = starts[unsigned_or(view, "buffer", 0)];
                view["buffer"] = 0;
                if (start > 0) view["byteOffset"] = start + unsigned_or(view, "byteOffset", 0);
            }
        merge_descriptions();
    }

    // Images that came by URI become views; those that lie in views stay.
    void embed_images() {
        for (std::size_t i = 0; i < model_.images.size(); ++i) {
            const EncodedImage& image = model_.images[i];
            if (image.bytes.empty()) continue;
            Json& item = document_["images"][i];
            // The file's name tells people what the picture is.
            const std::string uri = text_or(item, "uri", "");
            if (!item.contains("name") && uri.rfind("data:", 0) != 0)
                item["name"] = uri.substr(uri.find_last_of('/') + 1);
            item.erase("uri");
            item["bufferView"] = add_view(image.bytes, kAlignment);
            item["mimeType"] = image.mime_type;
        }
    }

    std::size_t add_words(const std::vector<std::uint32_t>& words, const char* name) {
        std::vector<std::uint8_t> bytes;
        bytes.reserve(words.size() * 4);
        for (const std::uint32_t word : words) append_word(bytes, word);
        const std::size_t view = add_view(bytes, kTextureAlignment);
        document_["bufferViews"][view]["name"] = name;
        return view;
    }

    // A texture of the core material; the sampler says how the pattern repeats.
    Result<std::size_t> add_texture(const RgbaImage& image, const char* name, std::size_t sampler) {
        Result<std::vector<std::uint8_t>> png = encode_png(image);
        if (!png.ok()) return png.error();
        return add_texture(*png, name, sampler);
    }

    std::size_t add_texture(const std::vector<std::uint8_t>& png, const char* name, std::size_t sampler) {
        // In this order a texture that is replaced gives its image and view to the new one.
        const std::size_t texture = places_.take("textures"), source = places_.take("images");
        const std::size_t view = add_view(png, kAlignment);
        document_["images"][source] = {{"bufferView", view}, {"mimeType", "image/png"}, {"name", name}};
        document_["textures"][texture] = {{"source", source}, {"sampler", sampler}, {"name", name}};
        return texture;
    }

    // One like it may be there already, and not be about to go.
    std::size_t add_sampler(bool repeat) {
        const int wrap = repeat ? kRepeat : kClampToEdge;
        const Json sampler{
            {"magFilter", kLinear}, {"minFilter", kLinearMipmapLinear}, {"wrapS", wrap}, {"wrapT", wrap}};
        const Json& samplers = array_of(document_, "samplers");
        const auto same = std::find(samplers.begin(), samplers.end(), sampler);
        if (same != samplers.end() && !places_.has_released("samplers"))
            return static_cast<std::size_t>(same - samplers.begin());
        const std::size_t index = places_.take("samplers");
        document_["samplers"][index] = sampler;
        return index;
    }

    // Takes the pattern and its fallback off a material; what they occupied is used again, or left out of the
    // file.
    void detach(std::size_t index);

    // Triangles without a material get one of their own when the pattern goes onto glTF's default.
    Json& material(std::size_t index, const std::string& name) {
        if (!document_.contains("materials")) document_["materials"] = Json::array();
        Json& materials = document_["materials"];
        if (index == materials.size()) {
            materials.push_back({{"name", name}});
            for (Json& mesh : document_["meshes"])
                for (Json& primitive : mesh["primitives"])
                    if (!primitive.contains("material") && is_triangles(primitive))
                        primitive["material"] = index;
        }
        return materials[index];
    }

    // All primitives of triangles with a material. Good as long as the document gets no further meshes.
    std::vector<Carrier> carriers_of(std::size_t material, int tex_coord);

    // Derivatives of the position, on those that are not flat.
    void add_frames(const std::vector<Carrier>& carriers);

    // Where their texture coordinates are cut: the table, whose description goes to `detail`, and chart numbers.
    Status add_charts(const std::vector<Carrier>& carriers, PathDetail& detail);

    void use_extension(const std::string& name) {
        Json& used = document_["extensionsUsed"];
        if (!used.is_array()) used = Json::array();
        if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
    }

    Result<std::vector<std::uint8_t>> finish() {
        places_.trim();
        if (binary_.empty()) return assemble({});
        cut_bytes(binary_, document_["bufferViews"], places_.dropped());
        document_["buffers"][0]["byteLength"] = binary_.size();
        pad(kAlignment);
        return assemble(binary_);
    }

  private:
    void pad(std::size_t alignment) {
        binary_.resize((binary_.size() + alignment - 1) / alignment * alignment, 0);
    }

    std::size_t add_view(const std::vector<std::uint8_t>& bytes, std::size_t alignment) {
        pad(alignment);
        const std::size_t begin = binary_.size();
        binary_.insert(binary_.end(), bytes.begin(), bytes.end());
        if (!document_.contains("buffers") || document_["buffers"].empty())
            document_["buffers"] = Json::array({Json::object()});
        const std::size_t view = places_.take("bufferViews");
        document_["bufferViews"][view] = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bytes.size()}};
        return view;
    }

    // One buffer remains; names and extras of the others move under its extras.
    void merge_descriptions() {
        if (model_.buffers.empty()) return;
        Json kept = document_["buffers"][0];
        kept.erase("uri");
        Json others = Json::array();
        for (std::size_t i = 1; i < model_.buffers.size(); ++i) {
            Json other = document_["buffers"][i];
            for (const char* key : {"uri", "byteLength"}) other.erase(key);
            if (!other.empty()) others.push_back(other);
        }
        if (!others.empty()) {
            if (kept.contains("extras") && !kept["extras"].is_object())
                kept["extras"] = {{"value", kept["extras"]}};
            kept["extras"]["burin_merged_buffers"] = others;
        }
        document_["buffers"] = Json::array({kept});
    }

    Result<std::vector<std::uint8_t>> assemble(const std::vector<std::uint8_t>& binary) const {
        std::string text = document_.dump(-1, ' ', false, Json::error_handler_t::replace);
        text.resize((text.size() + 3) / 4 * 4, ' ');
        const std::uint64_t total = 12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size());
        if (total > 0xffffffffull)
            return Error{ErrorCode::limit_exceeded,
                         "the result has " + std::to_string(total) + " bytes, glb holds 4 GiB"};
        std::vector<std::uint8_t> bytes;
        bytes.reserve(total);
        append_word(bytes, 0x46546c67);  // glTF
        append_word(bytes, 2);
        append_word(bytes, static_cast<std::uint32_t>(total));
        append_word(bytes, static_cast<std::uint32_t>(text.size()));
        append_word(bytes, 0x4e4f534a);  // JSON
        bytes.insert(bytes.end(), text.begin(), text.end());
        if (binary.empty()) return bytes;
        append_word(bytes, static_cast<std::uint32_t>(binary.size()));
        append_word(bytes, 0x004e4942);  // BIN
        bytes.insert(bytes.end(), binary.begin(), binary.end());
        return bytes;
    }

    // Takes our texture off the material, if it is ours; returns its place to be released.
    std::optional<std::uint64_t> take_off(Json& material, const char* slot, const char* name);

    // The extension's own texture, if burin wrote it.
    std::optional<std::uint64_t> take_off_residual(Json extension) {
        return take_off(extension, "residualTexture", kResidualName);
    }

    // Takes the derivatives and the chart numbers off the primitives of a material.
    void take_off_attributes(std::size_t material);

    // One attribute of a primitive, a float per vertex.
    void add_numbers(Json& primitive, const char* attribute, const std::vector<std::uint32_t>& values);

    const ModelData& model_;
    Json document_;
    Places places_;  // of document_
    std::vector<std::uint8_t> binary_;
};

std::optional<std::uint64_t> GlbWriter::take_off(Json& material, const char* slot, const char* name) {
    const Json* info = find_member(material, slot);
    const Json& textures = array_of(document_, "textures");
    const std::uint64_t texture = info ? unsigned_or(*info, "index", textures.size()) : textures.size();
    if (texture >= textures.size() || text_or(textures[texture], "name", "") != name) return std::nullopt;
    material.erase(slot);
    return texture;
}

// The normal texture that the model had before comes back from the extras.
void restore_normal_texture(Json& material, std::size_t texture_count) {
    if (!material.contains("extras") || !material["extras"].is_object()) return;
    Json& extras = material["extras"];
    const Json* replaced = find_member(extras, kReplacedNormalTexture);
    if (replaced == nullptr || unsigned_or(*replaced, "index", texture_count) >= texture_count) return;
    material["normalTexture"] = *replaced;
    extras.erase(kReplacedNormalTexture);
    if (extras.empty()) material.erase("extras");
}

void GlbWriter::detach(std::size_t index) {
    if (index >= array_of(document_, "materials").size()) return;
    Json& material = document_["materials"][index];
    const std::string extension_name(kPathDetailExtension);
    const Json* extensions = find_member(material, "extensions");
    const Json* found = extensions ? find_member(*extensions, extension_name.c_str()) : nullptr;
    if (found == nullptr) return;
    const Json extension = *found;
    material["extensions"].erase(extension_name);
    auto normal = take_off(material, "normalTexture", kNormalName);
    if (!normal) normal = take_off(material, "normalTexture", kResidualName);
    const auto occlusion = take_off(material, "occlusionTexture", kFallbackOcclusionName);
    if (normal) restore_normal_texture(material, array_of(document_, "textures").size());
    const auto residual = take_off_residual(extension);
    for (const auto& texture : {normal, occlusion, residual})
        if (texture) places_.release("textures", *texture);
    constexpr std::uint64_t kNone = ~std::uint64_t{0};
    for (const char* key : {"grid", "data", "charts"})
        if (const Json* texture = find_member(extension, key))
            places_.release("bufferViews", unsigned_or(*texture, "bufferView", kNone));
    take_off_attributes(index);
}

void GlbWriter::take_off_attributes(std::size_t material) {
    constexpr std::uint64_t kNone = ~std::uint64_t{0};
    for (Json& mesh : document_["meshes"])
        for (Json& primitive : mesh["primitives"]) {
            if (unsigned_or(primitive, "material", kNone) != material) continue;
            for (const char* name : {kFrameAttributes[0], kFrameAttributes[1], kFrameAttributes[2], kFrameAttributes[3],
                                     kFrameAttributes[4], kChartAttribute}) {
                const auto accessor = attribute_of(primitive, name);
                if (!accessor.has_value()) continue;
                primitive["attributes"].erase(name);
                places_.release("accessors", *accessor);
            }
        }
}

// Frames of a primitive, as floats in the order of its vertices and of kFrameAttributes; empty where it is flat.
std::vector<float> frames_of(const Surface& surface) {
    std::vector<float> values;
    for (const SurfaceFrame& frame : compute_frames(surface.mesh()))
        for (const std::array<float, 3>& v : {frame.du, frame.dv, frame.duu, frame.duv, frame.dvv})
            values.insert(values.end(), v.begin(), v.end());
    return values;
}

std::vector<Carrier> GlbWriter::carriers_of(std::size_t material, int tex_coord) {
    std::vector<Carrier> carriers;
    const Json& meshes = array_of(model_.document, "meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m)
        for (std::size_t p = 0; p < meshes[m]["primitives"].size(); ++p) {
            Json& primitive = document_["meshes"][m]["primitives"][p];
            if (is_triangles(primitive) && unsigned_or(primitive, "material", ~std::uint64_t{0}) == material)
                carriers.push_back({m, &primitive, read_surface(model_, meshes[m]["primitives"][p], tex_coord)});
        }
    return carriers;
}

void GlbWriter::add_frames(const std::vector<Carrier>& carriers) {
    constexpr std::size_t kStride = kFrameAttributes.size() * 12;
    constexpr int kFloat = 5126, kArrayBuffer = 34962;
    for (const Carrier& carrier : carriers) {
        const std::vector<float> values = frames_of(carrier.surface);
        if (values.empty()) continue;
        // Places first, so that those of a replaced pattern give their view back.
        std::array<std::size_t, kFrameAttributes.size()> accessors;
        for (std::size_t& accessor : accessors) accessor = places_.take("accessors");
        std::vector<std::uint8_t> bytes;
        bytes.reserve(values.size() * 4);
        for (const float value : values) append_word(bytes, std::bit_cast<std::uint32_t>(value));
        const std::size_t view = add_view(bytes, kAlignment);
        document_["bufferViews"][view].update(
            {{"byteStride", kStride}, {"target", kArrayBuffer}, {"name", "path detail, frames"}});
        for (std::size_t k = 0; k < accessors.size(); ++k) {
            document_["accessors"][accessors[k]] = {{"bufferView", view}, {"byteOffset", 12 * k}, {"componentType", kFloat},
                                                    {"count", bytes.size() / kStride}, {"type", "VEC3"}};
            (*carrier.primitive)["attributes"][kFrameAttributes[k]] = accessors[k];
        }
    }
}

// The least scale at which a node shows a mesh; drops are metres of the world.
double least_scale(const ModelData& model) {
    double least = 1e30;
    for (const PlacedMesh& placed : placed_meshes(model))
        if (const double scale = mean_scale(placed.transform); scale > 0.0) least = std::min(least, scale);
    return least < 1e30 ? least : 1.0;
}

void GlbWriter::add_numbers(Json& primitive, const char* attribute, const std::vector<std::uint32_t>& values) {
    constexpr int kFloat = 5126, kArrayBuffer = 34962;
    const std::size_t accessor = places_.take("accessors");
    std::vector<std::uint8_t> bytes;
    for (const std::uint32_t value : values) append_word(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
    const std::size_t view = add_view(bytes, kAlignment);
    document_["bufferViews"][view].update({{"target", kArrayBuffer}, {"name", "path detail, chart numbers"}});
    document_["accessors"][accessor] = {{"bufferView", view}, {"componentType", kFloat}, {"count", values.size()}, {"type", "SCALAR"}};
    primitive["attributes"][attribute] = accessor;
}

// Charts of each mesh's carriers, which follow each other, as one set.
ChartSet charts_of(const std::vector<Carrier>& carriers, const ChartOptions& options) {
    ChartSet all;
    for (std::size_t first = 0, next = 0; first < carriers.size(); first = next) {
        std::vector<SurfaceMesh> meshes;
        for (; next < carriers.size() && carriers[next].mesh == carriers[first].mesh; ++next)
            meshes.push_back(carriers[next].surface.mesh());
        ChartSet found = find_charts(meshes, options, all.count);
        all.count += found.count;
        all.needed = all.needed || found.needed;
        all.borders.insert(all.borders.end(), found.borders.begin(), found.borders.end());
        std::move(found.charts.begin(), found.charts.end(), std::back_inserter(all.charts));
    }
    return all;
}

Status GlbWriter::add_charts(const std::vector<Carrier>& carriers, PathDetail& detail) {
    const ChartSet set = charts_of(carriers, {{detail.size_u, detail.size_v}, detail.repeat});
    detail.charts = {};
    if (!set.needed) return Done{};
    if (set.borders.size() > BURIN_MAX_BORDERS)
        return Error{ErrorCode::limit_exceeded, "the texture coordinates are cut along " + std::to_string(set.borders.size() / 2) +
                                                    " edges of the mesh, at most " + std::to_string(BURIN_MAX_BORDERS / 2) +
                                                    " are supported; weld vertices that share position and uv"};
    ChartTable table = pack_charts(set.borders, detail.depth / least_scale(model_));
    if (table.layout.height > BURIN_MAX_TEXTURE_SIDE)
        return Error{ErrorCode::limit_exceeded, "the table of the edges along which the texture coordinates are cut takes " +
                                                    std::to_string(table.layout.height) + " rows of 4096 texels, at most 4096 are supported"};
    detail.charts = table.layout;
    detail.charts.view = static_cast<int>(add_words(table.words, "path detail, charts"));
    for (std::size_t i = 0; i < carriers.size(); ++i) add_numbers(*carriers[i].primitive, kChartAttribute, set.charts[i]);
    return Done{};
}

// Puts the fallback's normal map into the core material and keeps what stood there under the extras.
void set_normal_texture(Json& material, std::size_t texture, double scale, int tex_coord) {
    if (material.contains("normalTexture")) {
        Json& extras = material["extras"];
        if (!extras.is_null() && !extras.is_object()) extras = {{"value", extras}};
        extras[kReplacedNormalTexture] = material["normalTexture"];
    }
    material["normalTexture"] = {{"index", texture}};
    if (scale != 1.0) material["normalTexture"]["scale"] = scale;
    if (tex_coord != 0) material["normalTexture"]["texCoord"] = tex_coord;
}

Status add_fallback(GlbWriter& writer, Json& material, const Fallback& fallback, const PathDetail& detail) {
    if (fallback.normal.width > 0) {
        Result<std::size_t> normal = writer.add_texture(fallback.normal, kNormalName, writer.add_sampler(detail.repeat));
        if (!normal.ok()) return normal.error();
        set_normal_texture(material, *normal, 1.0, detail.tex_coord);
    } else if (detail.residual_texture >= 0) {
        set_normal_texture(material, static_cast<std::size_t>(detail.residual_texture), detail.residual_scale, detail.tex_coord);
    }
    if (fallback.occlusion.width == 0 || material.contains("occlusionTexture")) return Done{};
    Result<std::size_t> occlusion =
        writer.add_texture(fallback.occlusion, kFallbackOcclusionName, writer.add_sampler(detail.repeat));
    if (!occlusion.ok()) return occlusion.error();
    material["occlusionTexture"] = {{"index", *occlusion}};
    if (detail.tex_coord != 0) material["occlusionTexture"]["texCoord"] = detail.tex_coord;
    return Done{};
}

}  // namespace

Result<std::vector<std::uint8_t>> write_model(const Model& model) {
    GlbWriter writer(model.data());
    writer.merge_buffers();
    writer.embed_images();
    return writer.finish();
}

Result<std::vector<std::uint8_t>> write_glb(const Model& model, const PackedTextures& textures,
                                            const PathDetail& detail, const Fallback& fallback,
                                            const AttachOptions& options, const Residual& residual) {
    assert(textures.grid.size() == static_cast<std::size_t>(textures.grid_width) * textures.grid_height * 2);
    assert(textures.data.size() == static_cast<std::size_t>(textures.data_width) * textures.data_height * 4);
    Result<MaterialTarget> target = find_material(model, options);
    if (!target.ok()) return target.error();
    GlbWriter writer(model.data());
    writer.merge_buffers();
    writer.detach(target->index);
    writer.embed_images();
    PathDetail described = detail;
    described.tex_coord = options.tex_coord;
    described.grid_view = static_cast<int>(writer.add_words(textures.grid, "path detail, grid"));
    described.data_view = static_cast<int>(writer.add_words(textures.data, "path detail, data"));
    described.residual_texture = -1;
    if (residual.picture.width > 0) {
        described.residual_texture =
            static_cast<int>(writer.add_texture(residual.png, kResidualName, writer.add_sampler(detail.repeat)));
        described.residual_scale = residual.scale;
    }
    Json& material = writer.material(target->index, target->name);
    const std::vector<Carrier> carriers = writer.carriers_of(target->index, options.tex_coord);
    if (Status status = writer.add_charts(carriers, described); !status.ok()) return status.error();
    if (Status status = add_fallback(writer, material, fallback, described); !status.ok())
        return status.error();
    material["extensions"][std::string(kPathDetailExtension)] = Json::parse(write_extension(described));
    writer.use_extension(std::string(kPathDetailExtension));
    writer.add_frames(carriers);
    return writer.finish();
}

}  // namespace burin
