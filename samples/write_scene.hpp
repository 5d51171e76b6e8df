// A scene through all stages into one file.
#pragma once

#include <cstdint>
#include <vector>

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

}  // namespace burin::scenes
