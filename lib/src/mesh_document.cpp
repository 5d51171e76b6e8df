#include "mesh_document.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

namespace burin {
namespace {

constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123;
constexpr int kVertexTarget = 34962, kIndexTarget = 34963;

class Builder {
  public:
    explicit Builder(ModelData& model) : document_(model.document), bytes_(model.buffers.emplace_back()) {}

    std::size_t floats(const std::vector<float>& values, int components) {
        const std::size_t begin = bytes_.size();
        for (const float v : values) append(std::bit_cast<std::uint32_t>(v), 4);
        static constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
        return accessor(begin, kVertexTarget, kFloat, values.size() / static_cast<std::size_t>(components),
                        kTypes[components]);
    }

    std::size_t indices(const std::vector<std::uint32_t>& values, std::size_t vertices) {
        const std::size_t begin = bytes_.size();
        // 65535 itself is glTF's mark of a restart.
        const int size = vertices <= 65535 ? 2 : 4;
        for (const std::uint32_t v : values) append(v, size);
        return accessor(begin, kIndexTarget, size == 2 ? kUnsignedShort : kUnsignedInt, values.size(),
                        "SCALAR");
    }

    // glTF asks for the bounds of positions.
    void bounds(std::size_t index, const std::vector<float>& positions) {
        float low[3], high[3];
        std::fill_n(low, 3, std::numeric_limits<float>::max());
        std::fill_n(high, 3, std::numeric_limits<float>::lowest());
        for (std::size_t i = 0; i < positions.size(); ++i) {
            low[i % 3] = std::min(low[i % 3], positions[i]);
            high[i % 3] = std::max(high[i % 3], positions[i]);
        }
        document_["accessors"][index]["min"] = low;
        document_["accessors"][index]["max"] = high;
    }

  private:
    void append(std::uint32_t value, int size) {
        for (int i = 0; i < size; ++i) bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }

    std::size_t accessor(std::size_t begin, int target, int component, std::size_t count, const char* type) {
        const std::size_t view = document_["bufferViews"].size();
        document_["bufferViews"].push_back({{"buffer", 0},
                                            {"byteOffset", begin},
                                            {"byteLength", bytes_.size() - begin},
                                            {"target", target}});
        bytes_.resize((bytes_.size() + 3) / 4 * 4, 0);
        document_["accessors"].push_back(
            {{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
        return document_["accessors"].size() - 1;
    }

    Json& document_;
    std::vector<std::uint8_t>& bytes_;
};

// Index of the material of that name, made when it is new.
std::size_t material_index(Json& document, const MeshPart& part) {
    Json& materials = document["materials"];
    for (std::size_t i = 0; i < materials.size(); ++i)
        if (materials[i]["name"] == part.material) return i;
    Json material = {{"name", part.material}};
    Json& look = material["pbrMetallicRoughness"];
    look["baseColorFactor"] = part.base_color;
    look["metallicFactor"] = part.metallic;
    look["roughnessFactor"] = part.roughness;
    materials.push_back(material);
    return materials.size() - 1;
}

}  // namespace

ModelData make_document(const std::string& name, const std::vector<MeshPart>& parts) {
    assert(!parts.empty());
    ModelData model;
    Json& document = model.document;
    document["asset"] = {{"version", "2.0"}, {"generator", "burin"}};
    document["scene"] = 0;
    document["scenes"][0]["nodes"] = Json::array({0});
    document["nodes"][0] = {{"mesh", 0}, {"name", name}};
    document["meshes"][0] = {{"name", name}, {"primitives", Json::array()}};
    for (const char* key : {"materials", "accessors", "bufferViews"}) document[key] = Json::array();
    Builder builder(model);
    for (const MeshPart& part : parts) {
        assert(!part.indices.empty());
        Json attributes;
        const std::size_t positions = builder.floats(part.positions, 3);
        builder.bounds(positions, part.positions);
        attributes["POSITION"] = positions;
        attributes["NORMAL"] = builder.floats(part.normals, 3);
        if (!part.tangents.empty()) attributes["TANGENT"] = builder.floats(part.tangents, 4);
        if (!part.uvs.empty()) attributes["TEXCOORD_0"] = builder.floats(part.uvs, 2);
        const std::size_t indices = builder.indices(part.indices, part.positions.size() / 3);
        document["meshes"][0]["primitives"].push_back(
            {{"attributes", attributes},
             {"indices", indices},
             {"material", material_index(document, part)}});
    }
    document["buffers"][0]["byteLength"] = model.buffers[0].size();
    // Numbers made here are signed; what is read from a file is unsigned, and the checks rely on it.
    document = Json::parse(document.dump());
    return model;
}

}  // namespace burin
