// A glTF document made from plain triangles, for the sources of this library only.
#pragma once

#include <string>
#include <vector>

#include <burin/model.hpp>

#include "gltf_document.hpp"

namespace burin {

struct MeshPart : PlainMesh {
    std::vector<float> tangents;  // 4 per vertex, or empty
    std::vector<float> uvs;       // 2 per vertex, or empty
};

// One node, one mesh, one primitive per part, one buffer. Requires: parts not empty, each with at least one
// triangle.
ModelData make_document(const std::string& name, const std::vector<MeshPart>& parts);

}  // namespace burin
