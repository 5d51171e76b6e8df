#include "gltf_geometry.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace burin {
namespace {

constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

std::uint64_t component_at(const std::vector<std::uint8_t>& bytes, std::uint64_t at, int size) {
    std::uint64_t value = 0;
    for (int i = 0; i < size; ++i)
        value |= static_cast<std::uint64_t>(bytes[at + static_cast<std::uint64_t>(i)]) << (8 * i);
    return value;
}

float number_at(const std::vector<std::uint8_t>& bytes, std::uint64_t at, int type, bool normalized) {
    switch (type) {
        case 5120: {
            const auto v = static_cast<std::int8_t>(component_at(bytes, at, 1));
            return normalized ? std::max(static_cast<float>(v) / 127.0f, -1.0f) : static_cast<float>(v);
        }
        case 5121:
            return static_cast<float>(component_at(bytes, at, 1)) / (normalized ? 255.0f : 1.0f);
        case 5122: {
            const auto v = static_cast<std::int16_t>(component_at(bytes, at, 2));
            return normalized ? std::max(static_cast<float>(v) / 32767.0f, -1.0f) : static_cast<float>(v);
        }
        case 5123:
            return static_cast<float>(component_at(bytes, at, 2)) / (normalized ? 65535.0f : 1.0f);
        case 5125:
            return static_cast<float>(component_at(bytes, at, 4));
        default:
            return std::bit_cast<float>(static_cast<std::uint32_t>(component_at(bytes, at, 4)));
    }
}

// A bufferView as bytes with a place and a step.
struct View {
    const std::vector<std::uint8_t>* bytes = nullptr;
    std::uint64_t begin = 0;
    std::uint64_t stride = 0;  // 0: tightly packed
};

View view_of(const ModelData& model, const Json& user) {
    const Json& view = array_of(model.document, "bufferViews")[unsigned_or(user, "bufferView", 0)];
    return {&model.buffers[unsigned_or(view, "buffer", 0)],
            unsigned_or(view, "byteOffset", 0) + unsigned_or(user, "byteOffset", 0),
            unsigned_or(view, "byteStride", 0)};
}

// Calls take(element, component, place in bytes) for everything stored; element counts in the accessor.
template <typename Take>
void for_each_stored(const ModelData& model, const Json& accessor, Take take) {
    const AccessorKind kind = accessor_kind(accessor);
    const auto count = unsigned_or(accessor, "count", 0);
    const auto visit = [&](const View& view, std::uint64_t from, std::uint64_t element) {
        const std::uint64_t stride = view.stride != 0 ? view.stride : kind.element_bytes;
        for (int c = 0; c < kind.components; ++c)
            take(element, c, *view.bytes,
                 view.begin + from * stride + static_cast<std::uint64_t>(c * kind.component_bytes));
    };
    if (accessor.contains("bufferView")) {
        const View view = view_of(model, accessor);
        for (std::uint64_t i = 0; i < count; ++i) visit(view, i, i);
    }
    const Json* sparse = find_member(accessor, "sparse");
    if (sparse == nullptr) return;
    const Json& indices = *find_member(*sparse, "indices");
    const View at = view_of(model, indices), values = view_of(model, *find_member(*sparse, "values"));
    const int size =
        accessor_kind(Json{{"componentType", indices["componentType"]}, {"type", "SCALAR"}}).component_bytes;
    for (std::uint64_t i = 0; i < unsigned_or(*sparse, "count", 0); ++i)
        visit(values, i, component_at(*at.bytes, at.begin + i * static_cast<std::uint64_t>(size), size));
}

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix m{};
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t r = 0; r < 4; ++r)
            for (std::size_t k = 0; k < 4; ++k) m[4 * c + r] += a[4 * k + r] * b[4 * c + k];
    return m;
}

template <std::size_t N>
std::array<double, N> numbers_or(const Json& node, const char* key, std::array<double, N> fallback) {
    if (const Json* list = find_member(node, key); list != nullptr)
        for (std::size_t i = 0; i < N; ++i) fallback[i] = (*list)[i].get<double>();
    return fallback;
}

Matrix local_transform(const Json& node) {
    if (node.contains("matrix")) return numbers_or(node, "matrix", kIdentity);
    const auto t = numbers_or<3>(node, "translation", {0, 0, 0});
    const auto [x, y, z, w] = numbers_or<4>(node, "rotation", {0, 0, 0, 1});
    const auto s = numbers_or<3>(node, "scale", {1, 1, 1});
    return {(1 - 2 * (y * y + z * z)) * s[0],
            2 * (x * y + z * w) * s[0],
            2 * (x * z - y * w) * s[0],
            0,
            2 * (x * y - z * w) * s[1],
            (1 - 2 * (x * x + z * z)) * s[1],
            2 * (y * z + x * w) * s[1],
            0,
            2 * (x * z + y * w) * s[2],
            2 * (y * z - x * w) * s[2],
            (1 - 2 * (x * x + y * y)) * s[2],
            0,
            t[0],
            t[1],
            t[2],
            1};
}

std::vector<std::size_t> root_nodes(const Json& document) {
    std::vector<std::size_t> roots;
    const Json& scenes = array_of(document, "scenes");
    if (!scenes.empty()) {
        for (const Json& node : array_of(scenes[unsigned_or(document, "scene", 0)], "nodes"))
            roots.push_back(node.get<std::size_t>());
        return roots;
    }
    const Json& nodes = array_of(document, "nodes");
    std::vector<bool> is_child(nodes.size(), false);
    for (const Json& node : nodes)
        for (const Json& child : array_of(node, "children")) is_child[child.get<std::size_t>()] = true;
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (!is_child[i]) roots.push_back(i);
    return roots;
}

}  // namespace

AccessorKind accessor_kind(const Json& accessor) {
    AccessorKind kind;
    switch (unsigned_or(accessor, "componentType", 0)) {
        case 5120:
        case 5121:
            kind.component_bytes = 1;
            break;
        case 5122:
        case 5123:
            kind.component_bytes = 2;
            break;
        case 5125:
        case 5126:
            kind.component_bytes = 4;
            break;
        default:
            break;
    }
    const std::string type = text_or(accessor, "type", "");
    int columns = 1;
    if (type == "SCALAR") kind.components = 1;
    if (type.size() == 4 && (type.rfind("VEC", 0) == 0 || type.rfind("MAT", 0) == 0) && type[3] >= '2' &&
        type[3] <= '4') {
        const int n = type[3] - '0';
        columns = type[0] == 'M' ? n : 1;
        kind.components = n * columns;
    }
    // Columns of matrices start on multiples of four bytes.
    std::uint64_t column = static_cast<std::uint64_t>(kind.components / columns * kind.component_bytes);
    if (columns > 1) column = (column + 3) / 4 * 4;
    kind.element_bytes = column * static_cast<std::uint64_t>(columns);
    return kind;
}

std::vector<float> read_numbers(const ModelData& model, std::size_t index) {
    const Json& accessor = array_of(model.document, "accessors")[index];
    const AccessorKind kind = accessor_kind(accessor);
    const int type = static_cast<int>(unsigned_or(accessor, "componentType", 0));
    const Json* flag = find_member(accessor, "normalized");
    const bool normalized = flag != nullptr && flag->is_boolean() && flag->get<bool>();
    const auto components = static_cast<std::uint64_t>(kind.components);
    std::vector<float> values(unsigned_or(accessor, "count", 0) * components, 0.0f);
    for_each_stored(model, accessor,
                    [&](std::uint64_t i, int c, const std::vector<std::uint8_t>& bytes, std::uint64_t at) {
                        values[i * components + static_cast<std::uint64_t>(c)] =
                            number_at(bytes, at, type, normalized);
                    });
    return values;
}

std::vector<std::uint32_t> read_indices(const ModelData& model, std::size_t index) {
    const Json& accessor = array_of(model.document, "accessors")[index];
    const int size = accessor_kind(accessor).component_bytes;
    std::vector<std::uint32_t> values(unsigned_or(accessor, "count", 0), 0);
    for_each_stored(model, accessor,
                    [&](std::uint64_t i, int, const std::vector<std::uint8_t>& bytes, std::uint64_t at) {
                        values[i] = static_cast<std::uint32_t>(component_at(bytes, at, size));
                    });
    return values;
}

double determinant(const Matrix& m) {
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[4] * (m[1] * m[10] - m[2] * m[9]) +
           m[8] * (m[1] * m[6] - m[2] * m[5]);
}

double mean_scale(const Matrix& m) { return std::cbrt(std::abs(determinant(m))); }

std::vector<PlacedMesh> placed_meshes(const ModelData& model) {
    const Json& document = model.document;
    const Json& nodes = array_of(document, "nodes");
    std::vector<PlacedMesh> placed;
    if (nodes.empty()) {
        for (std::size_t i = 0; i < array_of(document, "meshes").size(); ++i)
            placed.push_back({i, kIdentity});
        return placed;
    }
    struct Visit {
        std::size_t node;
        Matrix parent;
    };
    std::vector<Visit> open;
    const std::vector<std::size_t> roots = root_nodes(document);
    for (auto at = roots.rbegin(); at != roots.rend(); ++at) open.push_back({*at, kIdentity});
    while (!open.empty()) {
        const Visit visit = open.back();
        open.pop_back();
        const Json& node = nodes[visit.node];
        const Matrix transform = product(visit.parent, local_transform(node));
        if (node.contains("mesh")) placed.push_back({unsigned_or(node, "mesh", 0), transform});
        const Json& children = array_of(node, "children");
        for (auto at = children.rbegin(); at != children.rend(); ++at)
            open.push_back({at->get<std::size_t>(), transform});
    }
    return placed;
}

std::optional<std::size_t> attribute_of(const Json& primitive, const std::string& name) {
    const Json* attributes = find_member(primitive, "attributes");
    const Json* value = attributes != nullptr ? find_member(*attributes, name.c_str()) : nullptr;
    if (value == nullptr) return std::nullopt;
    return value->get<std::size_t>();
}

bool is_triangles(const Json& primitive) { return unsigned_or(primitive, "mode", 4) >= 4; }

std::uint64_t vertex_count(const ModelData& model, const Json& primitive) {
    const auto position = attribute_of(primitive, "POSITION");
    assert(position.has_value());
    return unsigned_or(array_of(model.document, "accessors")[*position], "count", 0);
}

std::vector<std::uint32_t> triangle_indices(const ModelData& model, const Json& primitive) {
    const std::uint64_t mode = unsigned_or(primitive, "mode", 4);
    if (mode < 4) return {};
    std::vector<std::uint32_t> list;
    if (primitive.contains("indices")) {
        list = read_indices(model, unsigned_or(primitive, "indices", 0));
    } else {
        list.resize(vertex_count(model, primitive));
        for (std::size_t i = 0; i < list.size(); ++i) list[i] = static_cast<std::uint32_t>(i);
    }
    if (mode == 4) {
        list.resize(list.size() / 3 * 3);
        return list;
    }
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 2; i < list.size(); ++i) {
        // Every other triangle of a strip has two corners swapped, so that all face the same way.
        const std::size_t odd = mode == 5 ? i % 2 : 0;
        const std::uint32_t a = mode == 6 ? list[0] : list[i - 2];
        triangles.insert(triangles.end(), {a, list[i - 1 + odd], list[i - odd]});
    }
    return triangles;
}

void set_unit(std::array<double, 3> n, float* out) {
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 0.0) || !std::isfinite(length)) n = {0, 1, 0};
    const double scale = length > 0.0 && std::isfinite(length) ? 1.0 / length : 1.0;
    for (std::size_t k = 0; k < 3; ++k) out[k] = static_cast<float>(n[k] * scale);
}

std::vector<float> normals_of_faces(const std::vector<float>& p, const std::vector<std::uint32_t>& indices) {
    std::vector<double> sums(p.size(), 0.0);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::size_t a = 3 * std::size_t{indices[i]}, b = 3 * std::size_t{indices[i + 1]},
                          c = 3 * std::size_t{indices[i + 2]};
        std::array<double, 3> e{}, f{};
        for (std::size_t k = 0; k < 3; ++k) {
            e[k] = static_cast<double>(p[b + k]) - p[a + k];
            f[k] = static_cast<double>(p[c + k]) - p[a + k];
        }
        const std::array<double, 3> n{e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
        for (const std::size_t v : {a, b, c})
            for (std::size_t k = 0; k < 3; ++k) sums[v + k] += n[k];
    }
    std::vector<float> normals(p.size());
    for (std::size_t i = 0; i + 2 < p.size(); i += 3) set_unit({sums[i], sums[i + 1], sums[i + 2]}, normals.data() + i);
    return normals;
}

}  // namespace burin
