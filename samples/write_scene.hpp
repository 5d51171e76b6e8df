// A scene through all stages into one file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <burin/model.hpp>
#include <burin/result.hpp>

#include "scenes/scenes.hpp"

namespace burin::scenes {

struct SceneFile {
    std::vector<std::uint8_t> bytes;  // binary glTF
    std::size_t elements = 0;         // lines and curves of all parts, as stored
    std::size_t texture_bytes = 0;    // grid and data textures of all parts
};

// The pattern of every part on its material, a fallback baked from its heights, and the grain of eroded parts as a
// residual. Fails as the first stage that does, with the part's name.
Result<SceneFile> write_scene(const Scene& scene);

// The pattern of the first part on a material of another model, enlarged to what one uv unit measures there. `material`: as in
// AttachOptions.
Result<SceneFile> write_scene_on(const Scene& scene, const Model& model, const std::string& material = {});

}  // namespace burin::scenes
