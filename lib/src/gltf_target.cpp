// Which material a pattern goes onto, and how large one uv unit is there.
#include <cmath>
#include <set>

#include "gltf_geometry.hpp"

namespace burin {
namespace {

using Vec3 = std::array<double, 3>;

Vec3 transformed(const Matrix& m, const float* p) {
    Vec3 out{};
    for (std::size_t r = 0; r < 3; ++r) out[r] = m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r];
    return out;
}

// A primitive without a material uses glTF's default, which counts as one more after the document's own.
std::size_t material_of(const ModelData& model, const Json& primitive) {
    return unsigned_or(primitive, "material", array_of(model.document, "materials").size());
}

std::string material_name(const ModelData& model, std::size_t index) {
    const Json& materials = array_of(model.document, "materials");
    return index < materials.size() ? text_or(materials[index], "name", "") : "default";
}

// Materials that triangles use, in the document's order.
std::set<std::size_t> used_materials(const ModelData& model) {
    std::set<std::size_t> used;
    for (const Json& mesh : array_of(model.document, "meshes"))
        for (const Json& primitive : mesh["primitives"])
            if (is_triangles(primitive)) used.insert(material_of(model, primitive));
    return used;
}

std::string quoted_names(const ModelData& model, const std::set<std::size_t>& materials) {
    std::string text;
    constexpr std::size_t kMostNames = 24;
    std::size_t shown = 0;
    for (const std::size_t i : materials) {
        if (shown++ == kMostNames) return text + ", ...";
        const std::string name = material_name(model, i);
        text += (text.empty() ? "" : ", ") +
                (name.empty() ? "(no name, number " + std::to_string(i) + ")" : "'" + name + "'");
    }
    return text;
}

Result<std::size_t> choose_material(const ModelData& model, const std::string& wanted) {
    const std::set<std::size_t> used = used_materials(model);
    if (used.empty()) return model_error("the model has no triangles that a pattern could go onto");
    if (wanted.empty()) {
        if (used.size() == 1) return *used.begin();
        return model_error("the model has " + std::to_string(used.size()) +
                           " materials: " + quoted_names(model, used) + "; name one of them");
    }
    std::set<std::size_t> found;
    for (const std::size_t i : used)
        if (material_name(model, i) == wanted) found.insert(i);
    if (found.size() == 1) return *found.begin();
    if (found.empty())
        return model_error("no triangle has a material named '" + wanted + "'; the model has " +
                           quoted_names(model, used));
    return model_error(std::to_string(found.size()) + " materials are named '" + wanted +
                       "'; give them different names");
}

// Sums over triangles, weighted by their area in space.
struct Scale {
    double area = 0.0, along_u = 0.0, along_v = 0.0;
};

// Derivatives of the position by u and by v are constant on a triangle.
void add_triangle(const std::array<Vec3, 3>& p, const std::array<Vec2, 3>& uv, Scale& scale) {
    const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0];
    const double det = cross(a, b);
    Vec3 e{}, f{}, du{}, dv{};
    for (std::size_t k = 0; k < 3; ++k) {
        e[k] = p[1][k] - p[0][k];
        f[k] = p[2][k] - p[0][k];
    }
    const double area =
        std::hypot(e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]) / 2;
    if (!(std::abs(det) > 1e-14) || !(area > 0.0)) return;
    for (std::size_t k = 0; k < 3; ++k) {
        du[k] = (e[k] * b.y - f[k] * a.y) / det;
        dv[k] = (f[k] * a.x - e[k] * b.x) / det;
    }
    scale.area += area;
    scale.along_u += area * std::hypot(du[0], du[1], du[2]);
    scale.along_v += area * std::hypot(dv[0], dv[1], dv[2]);
}

void add_primitive(const ModelData& model, const Json& primitive, std::size_t uv_accessor,
                   const Matrix& transform, Scale& scale, std::size_t& triangles) {
    const std::vector<float> positions = read_numbers(model, *attribute_of(primitive, "POSITION"));
    const std::vector<float> uvs = read_numbers(model, uv_accessor);
    const std::vector<std::uint32_t> indices = triangle_indices(model, primitive);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        std::array<Vec3, 3> p{};
        std::array<Vec2, 3> uv{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t v = indices[i + k];
            p[k] = transformed(transform, positions.data() + 3 * v);
            uv[k] = {uvs[2 * v], uvs[2 * v + 1]};
        }
        add_triangle(p, uv, scale);
        ++triangles;
    }
}

}  // namespace

Result<MaterialTarget> find_material(const Model& model, const AttachOptions& options) {
    const ModelData& data = model.data();
    if (options.tex_coord < 0 || options.tex_coord > 7)
        return Error{ErrorCode::invalid_argument,
                     "tex_coord is " + std::to_string(options.tex_coord) + ", it must be 0 to 7"};
    Result<std::size_t> chosen = choose_material(data, options.material);
    if (!chosen.ok()) return chosen.error();
    MaterialTarget target;
    target.index = *chosen;
    target.name = material_name(data, *chosen);
    if (const Json& materials = array_of(data.document, "materials"); *chosen < materials.size()) {
        target.replaces_normal_texture = materials[*chosen].contains("normalTexture");
        target.keeps_occlusion_texture = materials[*chosen].contains("occlusionTexture");
    }
    const std::string set = "TEXCOORD_" + std::to_string(options.tex_coord);
    Scale scale;
    std::vector<PlacedMesh> placed = placed_meshes(data);
    std::vector<bool> seen(array_of(data.document, "meshes").size(), false);
    for (const PlacedMesh& m : placed) seen[m.mesh] = true;
    const Matrix identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (std::size_t i = 0; i < seen.size(); ++i)
        if (!seen[i]) placed.push_back({i, identity});  // outside the scene, yet it has the material
    constexpr std::size_t kEnoughTriangles = 1u
                                             << 24;  // for a mean; instancing may multiply them without end
    for (const PlacedMesh& m : placed) {
        const Json& primitives = array_of(data.document, "meshes")[m.mesh]["primitives"];
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            const Json& primitive = primitives[i];
            if (!is_triangles(primitive) || material_of(data, primitive) != *chosen) continue;
            const auto uv = attribute_of(primitive, set);
            if (!uv.has_value())
                return model_error(place(data.document, "meshes", m.mesh) + ".primitives[" +
                                   std::to_string(i) + "] has the material '" + target.name +
                                   "' but no texture coordinates " + set +
                                   ", which a pattern needs; unwrap the model");
            if (target.triangles < kEnoughTriangles)
                add_primitive(data, primitive, *uv, m.transform, scale, target.triangles);
        }
    }
    if (!(scale.area > 0.0) || !std::isfinite(scale.along_u) || !std::isfinite(scale.along_v))
        return model_error("the texture coordinates " + set + " of the material '" + target.name +
                           "' have no area, so no pattern fits; unwrap the model");
    target.metres_per_uv = {scale.along_u / scale.area, scale.along_v / scale.area};
    return target;
}

}  // namespace burin
