// A scene through all stages into one file.
#pragma once

#include <cstdint>
#include <vector>

#include <burin/result.hpp>

#include "scenes/scenes.hpp"

namespace burin::scenes {

// Binary glTF with the pattern of every part on its material, a fallback baked from its heights, and the grain of eroded
// parts as a residual. Fails as the first stage that does, with the part's name.
Result<std::vector<std::uint8_t>> write_scene(const Scene& scene);

}  // namespace burin::scenes
