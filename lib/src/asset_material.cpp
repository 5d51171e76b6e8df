// Materials of finished assets: factors, textures and patterns.
#include "asset_material.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <burin/format/validate.hpp>

namespace burin {
namespace {

std::uint32_t word_at(const std::vector<std::uint8_t>& bytes, std::uint64_t at) {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i)
        value |= static_cast<std::uint32_t>(bytes[at + static_cast<std::uint64_t>(i)]) << (8 * i);
    return value;
}

// Words of a texture from its bufferView.
Result<std::vector<std::uint32_t>> read_words(const ModelData& model, int view_index, std::uint64_t words,
                                              const std::string& where) {
    const Json& views = array_of(model.document, "bufferViews");
    if (view_index < 0 || static_cast<std::size_t>(view_index) >= views.size())
        return model_error(where + ": bufferView is " + std::to_string(view_index) + ", there are " +
                           std::to_string(views.size()));
    const Json& view = views[static_cast<std::size_t>(view_index)];
    const std::uint64_t length = unsigned_or(view, "byteLength", 0);
    if (view.contains("byteStride")) return model_error(where + ": its bufferView has a byteStride");
    if (length < words * 4)
        return model_error(where + ": its bufferView has " + std::to_string(length) + " bytes, its texels " +
                           std::to_string(words * 4));
    const auto& bytes = model.buffers[unsigned_or(view, "buffer", 0)];
    const std::uint64_t begin = unsigned_or(view, "byteOffset", 0);
    std::vector<std::uint32_t> result(words);
    for (std::uint64_t i = 0; i < words; ++i) result[i] = word_at(bytes, begin + 4 * i);
    return result;
}

Status read_textures(const ModelData& model, const std::string& where, MaterialInfo& info) {
    PackedTextures& t = info.textures;
    t.grid_width = info.detail.grid_width;
    t.grid_height = info.detail.grid_height;
    t.data_width = info.detail.data_width;
    t.data_height = info.detail.data_height;
    t.sections = info.detail.sections;
    const auto texels = [](int w, int h) {
        return static_cast<std::uint64_t>(w) * static_cast<std::uint64_t>(h);
    };
    Result<std::vector<std::uint32_t>> grid =
        read_words(model, info.detail.grid_view, 2 * texels(t.grid_width, t.grid_height), where + ".grid");
    if (!grid.ok()) return grid.error();
    Result<std::vector<std::uint32_t>> data =
        read_words(model, info.detail.data_view, 4 * texels(t.data_width, t.data_height), where + ".data");
    if (!data.ok()) return data.error();
    t.grid = std::move(*grid);
    t.data = std::move(*data);
    return Done{};
}

// Bytes of an image, wherever they lie.
Result<std::vector<std::uint8_t>> image_bytes(const ModelData& model, std::uint64_t index, const std::string& where) {
    const Json& images = array_of(model.document, "images");
    if (index >= images.size()) return model_error(where + ": there is no image " + std::to_string(index));
    if (!model.images[index].bytes.empty()) return model.images[index].bytes;
    const Json& views = array_of(model.document, "bufferViews");
    const std::uint64_t place = unsigned_or(images[index], "bufferView", views.size());
    if (place >= views.size()) return model_error(where + ": its image has neither bytes nor a bufferView");
    const auto& buffer = model.buffers[unsigned_or(views[place], "buffer", 0)];
    const auto begin = buffer.begin() + static_cast<std::ptrdiff_t>(unsigned_or(views[place], "byteOffset", 0));
    return std::vector<std::uint8_t>(begin, begin + static_cast<std::ptrdiff_t>(unsigned_or(views[place], "byteLength", 0)));
}

Status read_charts(const ModelData& model, const std::string& where, MaterialInfo& info) {
    const ChartLayout& charts = info.detail.charts;
    if (charts.borders == 0) return Done{};
    const auto texels = static_cast<std::uint64_t>(charts.width) * static_cast<std::uint64_t>(charts.height);
    Result<std::vector<std::uint32_t>> words = read_words(model, charts.view, 4 * texels, where + ".charts");
    if (!words.ok()) return words.error();
    std::string finding;
    const bool right = validate_charts(charts, *words, [&](const Issue& issue) {
        if (finding.empty() && issue.severity == Severity::error) finding = issue.message;
    });
    if (!right) return model_error(where + ".charts: " + finding);
    info.charts = std::move(*words);
    return Done{};
}

Status read_residual(const ModelData& model, const std::string& where, MaterialInfo& info) {
    if (info.detail.residual_texture < 0) return Done{};
    const std::string place = where + ".residualTexture";
    const Json& textures = array_of(model.document, "textures");
    const auto index = static_cast<std::size_t>(info.detail.residual_texture);
    if (index >= textures.size())
        return model_error(place + ": index is " + std::to_string(index) + ", there are " + std::to_string(textures.size()) +
                           " textures");
    auto bytes = image_bytes(model, unsigned_or(textures[index], "source", ~std::uint64_t{0}), place);
    if (!bytes) return bytes.error();
    auto picture = decode_picture(std::move(*bytes), kMaxPictureTexels);
    if (!picture) return Error{picture.error().code, place + ": " + picture.error().message};
    info.residual = std::move(*picture);
    return Done{};
}

// Numbers of an object's array; what is there stays where there are none.
template <std::size_t N>
void read_array(const Json& object, const char* key, std::array<double, N>& values) {
    const Json& list = array_of(object, key);
    for (std::size_t i = 0; i < N && list.size() == N; ++i)
        if (list[i].is_number()) values[i] = list[i].get<double>();
}

// KHR_texture_transform: scale, then rotation, then offset.
void read_transform(const Json& info, MaterialTexture& texture) {
    const Json* extensions = find_member(info, "extensions");
    const Json* transform = extensions == nullptr ? nullptr : find_member(*extensions, "KHR_texture_transform");
    if (transform == nullptr) return;
    std::array<double, 2> offset{0, 0}, scale{1, 1};
    read_array(*transform, "offset", offset);
    read_array(*transform, "scale", scale);
    const double angle = number_or(*transform, "rotation", 0.0), c = std::cos(angle), s = std::sin(angle);
    const double values[6] = {c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1]};
    for (std::size_t i = 0; i < 6; ++i) texture.transform[i] = static_cast<float>(values[i]);
    texture.tex_coord = static_cast<int>(unsigned_or(*transform, "texCoord", static_cast<std::uint64_t>(texture.tex_coord)));
}

// The numbers that glTF allows; anything else counts as left out.
int sampler_code(const Json& sampler, const char* key, std::initializer_list<int> allowed, int fallback) {
    const auto value = static_cast<int>(unsigned_or(sampler, key, static_cast<std::uint64_t>(fallback)));
    return std::find(allowed.begin(), allowed.end(), value) != allowed.end() ? value : fallback;
}

void read_sampler(const Json& document, const Json& source, MaterialTexture& texture) {
    const Json& samplers = array_of(document, "samplers");
    const std::uint64_t index = unsigned_or(source, "sampler", samplers.size());
    if (index >= samplers.size()) return;
    const Json& sampler = samplers[index];
    texture.minification = sampler_code(sampler, "minFilter", {9728, 9729, 9984, 9985, 9986, 9987}, texture.minification);
    texture.magnification = sampler_code(sampler, "magFilter", {9728, 9729}, texture.magnification);
    texture.wrap_u = sampler_code(sampler, "wrapS", {33071, 33648, 10497}, texture.wrap_u);
    texture.wrap_v = sampler_code(sampler, "wrapT", {33071, 33648, 10497}, texture.wrap_v);
}

// The texture that `owner` names under `key`, if it does.
Status read_texture(const ModelData& model, const Json& owner, const char* key, int pattern_set, const std::string& where,
                    PictureCache& pictures, MaterialTexture& texture) {
    const Json* info = find_member(owner, key);
    if (info == nullptr) return Done{};
    const std::string place = where + "." + key;
    const Json& source = array_of(model.document, "textures")[unsigned_or(*info, "index", 0)];
    if (!source.contains("source"))
        return Error{ErrorCode::unsupported, place + ": its texture has no source, and no extension that would give it one is read"};
    texture.tex_coord = static_cast<int>(std::min<std::uint64_t>(unsigned_or(*info, "texCoord", 0), 255));
    read_transform(*info, texture);
    if (texture.tex_coord > 1 && texture.tex_coord != pattern_set)
        return Error{ErrorCode::unsupported, place + ": texCoord is " + std::to_string(texture.tex_coord) +
                                                 "; 0, 1 and that of the pattern work"};
    read_sampler(model.document, source, texture);
    auto picture = pictures.decode(unsigned_or(source, "source", 0), place);
    if (!picture) return picture.error();
    texture.image = std::move(*picture);
    return Done{};
}

// Values out of the range that the extensions state count as its nearer end.
void read_glass(const Json& extensions, MaterialInfo& info) {
    const auto number = [&](const char* extension, const char* key, double fallback) {
        const Json* object = find_member(extensions, extension);
        return object == nullptr ? fallback : number_or(*object, key, fallback);
    };
    info.transmission = static_cast<float>(std::clamp(number("KHR_materials_transmission", "transmissionFactor", 0.0), 0.0, 1.0));
    info.ior = static_cast<float>(std::clamp(number("KHR_materials_ior", "ior", 1.5), 1.0, 100.0));
    info.thickness = static_cast<float>(std::max(number("KHR_materials_volume", "thicknessFactor", 0.0), 0.0));
    const double distance = number("KHR_materials_volume", "attenuationDistance", 0.0);
    if (distance > 0.0) info.attenuation_distance = static_cast<float>(distance);
    const Json* volume = find_member(extensions, "KHR_materials_volume");
    if (volume == nullptr) return;
    std::array<double, 3> color{1, 1, 1};
    read_array(*volume, "attenuationColor", color);
    for (std::size_t i = 0; i < 3; ++i) info.attenuation_color[i] = static_cast<float>(std::clamp(color[i], 0.0, 1.0));
}

}  // namespace

Result<std::shared_ptr<const RgbaImage>> PictureCache::decode(std::uint64_t image, const std::string& where) {
    if (const auto known = decoded_.find(image); known != decoded_.end()) return known->second;
    auto bytes = image_bytes(model_, image, where);
    if (!bytes) return bytes.error();
    auto picture = decode_picture(std::move(*bytes), kMaxPictureTexels);
    if (!picture) return Error{picture.error().code, where + ": " + picture.error().message};
    return decoded_[image] = std::make_shared<const RgbaImage>(std::move(*picture));
}

Result<MaterialInfo> read_material(const ModelData& model, std::size_t index) {
    const Json& material = array_of(model.document, "materials")[index];
    MaterialInfo info;
    info.name = text_or(material, "name", "");
    const Json& glow = array_of(material, "emissiveFactor");
    for (std::size_t i = 0; i < 3 && glow.size() == 3; ++i)
        if (glow[i].is_number()) info.emissive[i] = glow[i].get<float>();
    const Json* sided = find_member(material, "doubleSided");
    info.double_sided = sided != nullptr && sided->is_boolean() && sided->get<bool>();
    if (const Json* pbr = find_member(material, "pbrMetallicRoughness"); pbr != nullptr) {
        info.metallic = static_cast<float>(number_or(*pbr, "metallicFactor", 1.0));
        info.roughness = static_cast<float>(number_or(*pbr, "roughnessFactor", 1.0));
        const Json& color = array_of(*pbr, "baseColorFactor");
        for (std::size_t i = 0; i < 4 && color.size() == 4; ++i)
            if (color[i].is_number()) info.base_color[i] = color[i].get<float>();
    }
    const Json* extensions = find_member(material, "extensions");
    if (extensions != nullptr) read_glass(*extensions, info);
    const Json* extension =
        extensions == nullptr ? nullptr : find_member(*extensions, std::string(kPathDetailExtension).c_str());
    if (extension == nullptr) return info;
    const std::string where =
        place(model.document, "materials", index) + "." + std::string(kPathDetailExtension);
    Result<PathDetail> detail =
        parse_extension(extension->dump(-1, ' ', false, Json::error_handler_t::replace));
    if (!detail.ok()) return Error{detail.error().code, where + ": " + detail.error().message};
    info.detail = *detail;
    info.has_detail = true;
    if (Status status = read_textures(model, where, info); !status.ok()) return status.error();
    if (Status status = read_charts(model, where, info); !status.ok()) return status.error();
    if (Status status = read_residual(model, where, info); !status.ok()) return status.error();
    return info;
}

Status read_material_textures(const ModelData& model, std::size_t index, PictureCache& pictures, MaterialInfo& info) {
    const Json& material = array_of(model.document, "materials")[index];
    const std::string where = place(model.document, "materials", index);
    const int set = info.detail.tex_coord;
    const auto read = [&](const Json& owner, const char* key, MaterialTexture& texture) {
        return read_texture(model, owner, key, set, where, pictures, texture);
    };
    if (const Json* pbr = find_member(material, "pbrMetallicRoughness"); pbr != nullptr) {
        if (Status status = read(*pbr, "baseColorTexture", info.base_color_texture); !status.ok()) return status;
        if (Status status = read(*pbr, "metallicRoughnessTexture", info.metallic_roughness_texture); !status.ok()) return status;
    }
    if (Status status = read(material, "emissiveTexture", info.emissive_texture); !status.ok()) return status;
    const Json* occlusion = find_member(material, "occlusionTexture");
    if (occlusion == nullptr) return Done{};
    const Json& texture = array_of(model.document, "textures")[unsigned_or(*occlusion, "index", 0)];
    if (info.has_detail && text_or(texture, "name", "") == kFallbackOcclusionName) return Done{};
    info.occlusion_strength = static_cast<float>(number_or(*occlusion, "strength", 1.0));
    return read(material, "occlusionTexture", info.occlusion_texture);
}

bool wants_texture_uvs(const MaterialInfo& info) {
    for (const MaterialTexture* texture :
         {&info.base_color_texture, &info.metallic_roughness_texture, &info.occlusion_texture, &info.emissive_texture})
        if (texture->image != nullptr && texture->tex_coord != info.detail.tex_coord) return true;
    return false;
}

}  // namespace burin
