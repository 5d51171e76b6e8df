// Reading of inputs that several commands share.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <burin/heightmap.hpp>
#include <burin/model.hpp>
#include <burin/result.hpp>

#include <gl/render.hpp>

#include "report.hpp"

namespace burin::cli {

class Arguments;

// What the first bytes say: glTF (binary or JSON); anything else is left to the height map reader.
bool looks_like_gltf(const std::vector<std::uint8_t>& bytes);

// An asset file, with its bytes and the folder its URIs start from.
struct AssetFile {
    std::vector<std::uint8_t> bytes;
    Asset asset;
};
Result<AssetFile> read_asset_file(const std::string& path, const AssetOptions& options = {});

// Folder part of a path, with the slash; "./" when it has none.
std::string folder_of(const std::string& path);

// The one material with a pattern, or the one that --material names.
// Fails with invalid_input: no material has a pattern, several have one and none is named, none has that name.
Result<std::size_t> find_patterned_material(const Asset& asset, const std::string& name);

// The height map as --polarity and --channel ask for it.
Result<HeightMap> read_map(const std::string& path, const Arguments& arguments);

// What --backend names.
Backend backend_of(const Arguments& arguments);

// Vendor, renderer and version of that backend, as a line of the report.
void add_renderer(Report& report, const Arguments& arguments);

}  // namespace burin::cli
