// Wavefront OBJ, for the sources of this library only. What is read and what is passed over: model.hpp.
#pragma once

#include <cstdint>
#include <span>

#include "gltf_document.hpp"

namespace burin {

Result<ModelData> read_obj(std::span<const std::uint8_t> bytes);

}  // namespace burin
