// A glTF document made from plain triangles, for the sources of this library only.
#pragma once

#include <string>
#include <vector>

#include "gltf_document.hpp"

namespace burin {

struct MeshPart {
    std::string material;          // name; parts of one name share the material
    std::vector<float> positions;  // 3 per vertex
    std::vector<float> normals;    // 3 per vertex
    std::vector<float> tangents;   // 4 per vertex, or empty
    std::vector<float> uvs;        // 2 per vertex, or empty
    std::vector<std::uint32_t> indices;
};

// One node, one mesh, one primitive per part, one buffer. Requires: parts not empty, each with at least one
// triangle.
ModelData make_document(const std::string& name, const std::vector<MeshPart>& parts);

}  // namespace burin
