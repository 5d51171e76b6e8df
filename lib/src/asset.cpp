// Finished assets as triangles and textures, for drawing and checking.
#include <cmath>

#include "asset_material.hpp"
#include "gltf_geometry.hpp"

namespace burin {
namespace {

using Vec3 = std::array<double, 3>;

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
    primitive.scale = static_cast<float>(std::max(mean_scale(m), 1e-10));
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
    AssetReader(const ModelData& model, const AssetOptions& options) : model_(model), pictures_(model), options_(options) {}

    Result<Asset> run() {
        const std::size_t materials = array_of(model_.document, "materials").size();
        for (std::size_t i = 0; i < materials; ++i) {
            Result<MaterialInfo> info = read_material(model_, i);
            if (!info.ok()) return Error{info.error().code, "glTF: " + info.error().message};
            if (options_.pictures)
                if (Status status = read_material_textures(model_, i, pictures_, *info); !status.ok())
                    return Error{status.error().code, "glTF: " + status.error().message};
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
        if (wants_texture_uvs(asset_.materials[static_cast<std::size_t>(primitive.material)]))
            primitive.texture_uvs = read_texture_uvs(item, count);
        if (Status status = read_frames(model_, item, primitive); !status.ok()) return status.error();
        if (Status status = read_chart_numbers(model_, item, primitive); !status.ok()) return status.error();
        transform_vertices(transform, primitive);
        asset_.primitives.push_back(std::move(primitive));
        return Done{};
    }

    // Sets 0 and 1 side by side; zero where the file has none.
    std::vector<float> read_texture_uvs(const Json& item, std::uint64_t count) {
        std::vector<float> values(4 * count, 0.0f);
        for (std::size_t set = 0; set < 2; ++set) {
            const auto accessor = attribute_of(item, "TEXCOORD_" + std::to_string(set));
            if (!accessor.has_value()) continue;
            const std::vector<float> uvs = read_numbers(model_, *accessor);
            for (std::size_t i = 0; i < uvs.size(); ++i) values[4 * (i / 2) + 2 * set + i % 2] = uvs[i];
        }
        return values;
    }

    const ModelData& model_;
    PictureCache pictures_;
    AssetOptions options_;
    Asset asset_;
    std::uint64_t vertices_ = 0, indices_ = 0;
};

}  // namespace

Result<Asset> read_asset(std::span<const std::uint8_t> bytes, const std::string& base_folder, const AssetOptions& options) {
    Result<ModelData> model = load_document(bytes, base_folder);
    if (!model.ok()) return model.error();
    if (Status status = check_document(*model); !status.ok()) return status.error();
    return AssetReader(*model, options).run();
}

}  // namespace burin
