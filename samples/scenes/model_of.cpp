// A scene as binary glTF, read back as any other file would be.
#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "scenes.hpp"

namespace burin::scenes {
namespace {

std::string text(double number) {
    char digits[40];
    std::snprintf(digits, sizeof digits, "%.9g", number);
    return digits;
}

// Collects the binary chunk and the JSON that describes it.
class Writer {
  public:
    std::vector<std::uint8_t> bytes;
    std::string views, accessors, primitives, materials;

    void add(const Part& part) {
        const std::size_t positions = floats(part.mesh.positions, 3, true), normals = floats(part.mesh.normals, 3, false),
                          uvs = floats(part.mesh.uvs, 2, false), indices = add_indices(part.mesh.indices);
        join(primitives, "{\"attributes\":{\"POSITION\":" + std::to_string(positions) + ",\"NORMAL\":" +
                             std::to_string(normals) + ",\"TEXCOORD_0\":" + std::to_string(uvs) + "},\"indices\":" +
                             std::to_string(indices) + ",\"material\":" + std::to_string(materials_++) + "}");
        join(materials, "{\"name\":\"" + part.name + "\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[" +
                            text(double(part.color[0])) + "," + text(double(part.color[1])) + "," +
                            text(double(part.color[2])) + ",1],\"metallicFactor\":" + text(double(part.metallic)) +
                            ",\"roughnessFactor\":" + text(double(part.roughness)) + "}}");
    }

  private:
    static void join(std::string& list, const std::string& item) { list += (list.empty() ? "" : ",") + item; }

    void append(std::uint32_t word) {
        for (int shift = 0; shift < 32; shift += 8) bytes.push_back(std::uint8_t(word >> shift));
    }
    // One view with one accessor; its index.
    std::size_t describe(std::size_t begin, int target, const std::string& rest) {
        join(views, "{\"buffer\":0,\"byteOffset\":" + std::to_string(begin) + ",\"byteLength\":" +
                        std::to_string(bytes.size() - begin) + ",\"target\":" + std::to_string(target) + "}");
        join(accessors, "{\"bufferView\":" + std::to_string(count_) + "," + rest + "}");
        return count_++;
    }
    std::size_t floats(const std::vector<float>& values, std::size_t components, bool bounds) {
        const std::size_t begin = bytes.size();
        for (const float value : values) append(std::bit_cast<std::uint32_t>(value));
        std::string rest = "\"componentType\":5126,\"count\":" + std::to_string(values.size() / components) +
                           ",\"type\":\"VEC" + std::to_string(components) + "\"";
        if (bounds) rest += ",\"min\":" + extremes(values, -1.0f) + ",\"max\":" + extremes(values, 1.0f);
        return describe(begin, 34962, rest);
    }
    // Greatest (sign 1) or least (sign -1) of each component of positions.
    static std::string extremes(const std::vector<float>& values, float sign) {
        std::string list;
        for (std::size_t k = 0; k < 3; ++k) {
            float best = values[k];
            for (std::size_t i = k; i < values.size(); i += 3) best = sign * std::max(sign * best, sign * values[i]);
            join(list, text(double(best)));
        }
        return "[" + list + "]";
    }
    std::size_t add_indices(const std::vector<std::uint32_t>& values) {
        const std::size_t begin = bytes.size();
        for (const std::uint32_t value : values) append(value);
        return describe(begin, 34963, "\"componentType\":5125,\"count\":" + std::to_string(values.size()) +
                                          ",\"type\":\"SCALAR\"");
    }

    std::size_t count_ = 0;
    int materials_ = 0;
};

void append_word(std::vector<std::uint8_t>& to, std::uint32_t word) {
    for (int shift = 0; shift < 32; shift += 8) to.push_back(std::uint8_t(word >> shift));
}

std::vector<std::uint8_t> to_glb(const std::string& json, const std::vector<std::uint8_t>& bytes) {
    const std::string padded = json + std::string((4 - json.size() % 4) % 4, ' ');
    std::vector<std::uint8_t> glb;
    append_word(glb, 0x46546c67u);
    append_word(glb, 2);
    append_word(glb, std::uint32_t(12 + 8 + padded.size() + 8 + bytes.size()));
    append_word(glb, std::uint32_t(padded.size()));
    append_word(glb, 0x4e4f534au);
    glb.insert(glb.end(), padded.begin(), padded.end());
    append_word(glb, std::uint32_t(bytes.size()));
    append_word(glb, 0x004e4942u);
    glb.insert(glb.end(), bytes.begin(), bytes.end());
    return glb;
}

}  // namespace

MaterialInfo material_of(const Part& part) {
    MaterialInfo material;
    for (std::size_t i = 0; i < 3; ++i) material.base_color[i] = part.color[i];
    material.metallic = part.metallic;
    material.roughness = part.roughness;
    return material;
}

Model model_of(const Scene& scene) {
    Writer writer;
    for (const Part& part : scene.parts) writer.add(part);
    const std::string json = "{\"asset\":{\"version\":\"2.0\",\"generator\":\"burin samples\"},\"scene\":0,"
                             "\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[" +
                             writer.primitives + "]}],\"materials\":[" + writer.materials + "],\"accessors\":[" +
                             writer.accessors + "],\"bufferViews\":[" + writer.views + "],\"buffers\":[{\"byteLength\":" +
                             std::to_string(writer.bytes.size()) + "}]}";
    auto model = read_model_bytes(to_glb(json, writer.bytes), "");
    if (!model) {
        std::fprintf(stderr, "a scene's own mesh was refused: %s\n", model.error().message.c_str());
        std::abort();
    }
    return std::move(*model);
}

}  // namespace burin::scenes
