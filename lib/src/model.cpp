#include <burin/model.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <filesystem>

#include <burin/image_io.hpp>

#include "gltf_document.hpp"
#include "mesh_document.hpp"
#include "obj.hpp"

namespace burin {
namespace {

// glb by its magic; JSON by its first character; the rest is taken for OBJ.
bool looks_like_gltf(std::span<const std::uint8_t> bytes) {
    if (bytes.size() >= 4 && bytes[0] == 'g' && bytes[1] == 'l' && bytes[2] == 'T' && bytes[3] == 'F')
        return true;
    std::size_t at = bytes.size() >= 3 && bytes[0] == 0xef && bytes[1] == 0xbb && bytes[2] == 0xbf ? 3 : 0;
    while (at < bytes.size() &&
           (bytes[at] == ' ' || bytes[at] == '\t' || bytes[at] == '\r' || bytes[at] == '\n'))
        ++at;
    return at < bytes.size() && bytes[at] == '{';
}

Result<Model> checked(Result<ModelData> data) {
    if (!data.ok()) return data.error();
    if (Status status = check_document(*data); !status.ok()) return status.error();
    return Model(std::make_shared<const ModelData>(std::move(*data)));
}

}  // namespace

Result<Model> read_model_bytes(std::span<const std::uint8_t> bytes, const std::string& base_folder) {
    if (bytes.empty()) return Error{ErrorCode::invalid_input, "the file is empty"};
    if (looks_like_gltf(bytes)) return checked(load_document(bytes, base_folder));
    return checked(read_obj(bytes));
}

Result<Model> read_model(const std::string& path) {
    Result<std::vector<std::uint8_t>> bytes = read_file(path, kMaxModelFileBytes);
    if (!bytes.ok()) return bytes.error();
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    Result<Model> model = read_model_bytes(*bytes, folder.empty() ? "." : folder.string());
    if (!model.ok())
        return Error{model.error().code, "cannot read model '" + path + "': " + model.error().message};
    return model;
}

Model make_plane(Vec2 size) {
    assert(size.x > 0.0 && size.y > 0.0 && std::isfinite(size.x) && std::isfinite(size.y));
    const auto x = static_cast<float>(size.x / 2.0), z = static_cast<float>(size.y / 2.0);
    MeshPart part;
    part.material = "plane";
    part.positions = {-x, 0, -z, x, 0, -z, -x, 0, z, x, 0, z};
    part.normals = {0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0};
    // Red of a normal map points along +u = +x, green against v: cross(normal, tangent) * w = -z, so w = 1.
    part.tangents = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    part.uvs = {0, 0, 1, 0, 0, 1, 1, 1};
    part.indices = {0, 2, 1, 1, 2, 3};
    ModelData data = make_document("plane", {part});
    assert(check_document(data).ok());
    return Model(std::make_shared<const ModelData>(std::move(data)));
}

Model make_model(const std::string& name, std::vector<PlainMesh> meshes) {
    std::vector<MeshPart> parts;
    for (PlainMesh& mesh : meshes) parts.push_back({std::move(mesh), {}, {}});
    ModelData data = make_document(name, parts);
    assert(check_document(data).ok());
    return Model(std::make_shared<const ModelData>(std::move(data)));
}

}  // namespace burin
