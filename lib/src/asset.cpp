// Finished assets as triangles and textures, for drawing and checking.
#include <cmath>

#include "gltf_geometry.hpp"

namespace burin {
namespace {

using Vec3 = std::array<double, 3>;

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

Status read_charts(const ModelData& model, const std::string& where, MaterialInfo& info) {
    const ChartLayout& charts = info.detail.charts;
    if (charts.borders == 0) return Done{};
    const auto texels = static_cast<std::uint64_t>(charts.width) * static_cast<std::uint64_t>(charts.height);
    Result<std::vector<std::uint32_t>> words = read_words(model, charts.view, 4 * texels, where + ".charts");
    if (!words.ok()) return words.error();
    info.charts = std::move(*words);
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

Status read_residual(const ModelData& model, const std::string& where, MaterialInfo& info) {
    if (info.detail.residual_texture < 0) return Done{};
    constexpr std::uint64_t kMostTexels = 1u << 28;
    const std::string place = where + ".residualTexture";
    const Json& textures = array_of(model.document, "textures");
    const auto index = static_cast<std::size_t>(info.detail.residual_texture);
    if (index >= textures.size())
        return model_error(place + ": index is " + std::to_string(index) + ", there are " + std::to_string(textures.size()) +
                           " textures");
    auto bytes = image_bytes(model, unsigned_or(textures[index], "source", ~std::uint64_t{0}), place);
    if (!bytes) return bytes.error();
    auto picture = decode_picture(std::move(*bytes), kMostTexels);
    if (!picture) return Error{picture.error().code, place + ": " + picture.error().message};
    info.residual = std::move(*picture);
    return Done{};
}

Result<MaterialInfo> read_material(const ModelData& model, std::size_t index) {
    const Json& material = array_of(model.document, "materials")[index];
    MaterialInfo info;
    info.name = text_or(material, "name", "");
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

double determinant(const Matrix& m) {
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
           m[8] * (m[1] * m[6] - m[2] * m[5]);
}

// Cofactors of the upper 3 x 3 part: the inverse transpose times the determinant, right for normals even when
// the scale is not uniform, and defined when the matrix has no inverse.
std::array<double, 9> normal_matrix(const Matrix& m) {
    const auto c = [&](int i, int j) { return m[static_cast<std::size_t>(4 * j + i)]; };
    std::array<double, 9> n{};
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
            const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            n[static_cast<std::size_t>(3 * j + i)] = c(i1, j1) * c(i2, j2) - c(i1, j2) * c(i2, j1);
        }
    return n;
}

void transform_vertices(const Matrix& m, Primitive& primitive) {
    for (std::size_t i = 0; i + 2 < primitive.positions.size(); i += 3) {
        float* p = primitive.positions.data() + i;
        const Vec3 v{p[0], p[1], p[2]};
        for (std::size_t r = 0; r < 3; ++r)
            p[r] = static_cast<float>(m[r] * v[0] + m[4 + r] * v[1] + m[8 + r] * v[2] + m[12 + r]);
    }
    const std::array<double, 9> n = normal_matrix(m);
    const double sign = determinant(m) < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i + 2 < primitive.normals.size(); i += 3) {
        float* p = primitive.normals.data() + i;
        Vec3 v{};
        for (std::size_t r = 0; r < 3; ++r) v[r] = sign * (n[r] * p[0] + n[3 + r] * p[1] + n[6 + r] * p[2]);
        set_unit(v, p);
    }
    for (SurfaceFrame& frame : primitive.frames)
        for (std::array<float, 3>* vector : {&frame.du, &frame.dv, &frame.duu, &frame.duv, &frame.dvv}) {
            const Vec3 v{(*vector)[0], (*vector)[1], (*vector)[2]};
            for (std::size_t r = 0; r < 3; ++r)
                (*vector)[r] = static_cast<float>(m[r] * v[0] + m[4 + r] * v[1] + m[8 + r] * v[2]);
        }
    primitive.mirrored = sign < 0.0;
    // A mirror turns the faces over; their order keeps them counter-clockwise.
    if (sign < 0.0)
        for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
            std::swap(primitive.indices[i + 1], primitive.indices[i + 2]);
}

// The derivatives of the position, where a primitive brings all of them.
Status read_frames(const ModelData& model, const Json& item, Primitive& primitive) {
    const std::size_t count = primitive.positions.size() / 3;
    std::array<std::vector<float>, kFrameAttributes.size()> values;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const auto accessor = attribute_of(item, kFrameAttributes[k]);
        if (!accessor.has_value()) return Done{};
        if (accessor_kind(array_of(model.document, "accessors")[*accessor]).components != 3)
            return model_error(std::string(kFrameAttributes[k]) + " is not VEC3");
        values[k] = read_numbers(model, *accessor);
    }
    primitive.frames.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        SurfaceFrame& frame = primitive.frames[i];
        std::array<float, 3>* vectors[] = {&frame.du, &frame.dv, &frame.duu, &frame.duv, &frame.dvv};
        for (std::size_t k = 0; k < values.size(); ++k)
            *vectors[k] = {values[k][3 * i], values[k][3 * i + 1], values[k][3 * i + 2]};
    }
    return Done{};
}

Status read_chart_numbers(const ModelData& model, const Json& item, Primitive& primitive) {
    const auto accessor = attribute_of(item, kChartAttribute);
    if (!accessor.has_value()) return Done{};
    if (accessor_kind(array_of(model.document, "accessors")[*accessor]).components != 1)
        return model_error(std::string(kChartAttribute) + " is not SCALAR");
    primitive.charts = read_numbers(model, *accessor);
    return Done{};
}

class AssetReader {
  public:
    explicit AssetReader(const ModelData& model) : model_(model) {}

    Result<Asset> run() {
        const std::size_t materials = array_of(model_.document, "materials").size();
        for (std::size_t i = 0; i < materials; ++i) {
            Result<MaterialInfo> info = read_material(model_, i);
            if (!info.ok()) return Error{info.error().code, "glTF: " + info.error().message};
            asset_.materials.push_back(std::move(*info));
        }
        for (const PlacedMesh& placed : placed_meshes(model_))
            for (const Json& primitive : array_of(model_.document, "meshes")[placed.mesh]["primitives"]) {
                if (!is_triangles(primitive)) continue;
                if (Status status = add(primitive, placed.transform); !status.ok()) return status.error();
            }
        return std::move(asset_);
    }

  private:
    int material_of(const Json& primitive) {
        const std::size_t count = array_of(model_.document, "materials").size();
        if (primitive.contains("material")) return static_cast<int>(unsigned_or(primitive, "material", 0));
        if (asset_.materials.size() == count) asset_.materials.emplace_back();  // glTF's default
        return static_cast<int>(count);
    }

    Status add(const Json& item, const Matrix& transform) {
        const std::uint64_t count = vertex_count(model_, item);
        Primitive primitive;
        primitive.indices = triangle_indices(model_, item);
        vertices_ += count;
        indices_ += primitive.indices.size();
        if (vertices_ > kMaxModelVertices || indices_ > kMaxModelIndices)
            return Error{ErrorCode::limit_exceeded, "glTF: the scene has more than " +
                                                        std::to_string(kMaxModelVertices) + " vertices or " +
                                                        std::to_string(kMaxModelIndices) + " indices"};
        if (primitive.indices.empty()) return Done{};
        primitive.material = material_of(item);
        primitive.positions = read_numbers(model_, *attribute_of(item, "POSITION"));
        if (const auto normals = attribute_of(item, "NORMAL"); normals.has_value())
            primitive.normals = read_numbers(model_, *normals);
        else
            primitive.normals = normals_of_faces(primitive.positions, primitive.indices);
        const int set = asset_.materials[static_cast<std::size_t>(primitive.material)].detail.tex_coord;
        const auto uvs = attribute_of(item, "TEXCOORD_" + std::to_string(set));
        primitive.uvs = uvs.has_value() ? read_numbers(model_, *uvs) : std::vector<float>(2 * count, 0.0f);
        if (Status status = read_frames(model_, item, primitive); !status.ok()) return status.error();
        if (Status status = read_chart_numbers(model_, item, primitive); !status.ok()) return status.error();
        transform_vertices(transform, primitive);
        asset_.primitives.push_back(std::move(primitive));
        return Done{};
    }

    const ModelData& model_;
    Asset asset_;
    std::uint64_t vertices_ = 0, indices_ = 0;
};

}  // namespace

Result<Asset> read_asset(std::span<const std::uint8_t> bytes, const std::string& base_folder) {
    Result<ModelData> model = load_document(bytes, base_folder);
    if (!model.ok()) return model.error();
    if (Status status = check_document(*model); !status.ok()) return status.error();
    return AssetReader(*model).run();
}

}  // namespace burin
