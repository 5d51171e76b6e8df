// Materials of finished assets, for the sources of this library only.
#pragma once

#include <map>
#include <memory>
#include <string>

#include <burin/image_io.hpp>

#include "gltf_document.hpp"

namespace burin {

// Name of the texture that burin bakes occlusion into: what tells it from a material's own.
inline constexpr const char* kFallbackOcclusionName = "path detail, occlusion";

// Images of a document, each decoded once.
class PictureCache {
  public:
    explicit PictureCache(const ModelData& model) : model_(model) {}
    // Fails with invalid_input, unsupported or limit_exceeded; `where` begins the message.
    Result<std::shared_ptr<const RgbaImage>> decode(std::uint64_t image, const std::string& where);

  private:
    const ModelData& model_;
    std::map<std::uint64_t, std::shared_ptr<const RgbaImage>> decoded_;
};

// Factors, pattern and residual. Requires: check_document passed, here and below.
Result<MaterialInfo> read_material(const ModelData& model, std::size_t index);

// The textures of glTF's own.
Status read_material_textures(const ModelData& model, std::size_t index, PictureCache& pictures, MaterialInfo& info);

// Whether a texture lies in another uv set than the pattern.
bool wants_texture_uvs(const MaterialInfo& info);

}  // namespace burin
