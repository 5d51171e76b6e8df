#include "asset_file.hpp"

#include <algorithm>
#include <string_view>

#include <burin/image_io.hpp>

#include "options.hpp"

namespace burin::cli {

bool looks_like_gltf(const std::vector<std::uint8_t>& bytes) {
    const std::string_view start(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 64));
    if (start.starts_with("glTF")) return true;
    const std::size_t first = start.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    return first != std::string_view::npos && start[first] == '{';
}

std::string folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? "./" : path.substr(0, slash + 1);
}

Result<AssetFile> read_asset_file(const std::string& path, const AssetOptions& options) {
    auto bytes = read_file(path, kMaxModelFileBytes);
    if (!bytes) return bytes.error();
    if (!looks_like_gltf(*bytes))
        return Error{ErrorCode::unsupported, "'" + path + "' is neither binary glTF nor glTF JSON"};
    auto asset = read_asset(*bytes, folder_of(path), options);
    if (!asset) return Error{asset.error().code, "'" + path + "': " + asset.error().message};
    return AssetFile{std::move(*bytes), std::move(*asset)};
}

Result<std::size_t> find_patterned_material(const Asset& asset, const std::string& name) {
    std::string names;
    std::size_t count = 0, found = asset.materials.size();
    for (std::size_t i = 0; i < asset.materials.size(); ++i) {
        const auto& material = asset.materials[i];
        if (!material.has_detail) continue;
        names += (names.empty() ? "'" : ", '") + material.name + "'";
        ++count;
        if (name.empty() || name == material.name) found = std::min(found, i);
    }
    if (count == 0) return Error{ErrorCode::invalid_input, "no material carries a pattern of burin"};
    if (name.empty() && count > 1)
        return Error{ErrorCode::invalid_input, "several materials carry a pattern; --material takes one of " + names};
    if (found == asset.materials.size())
        return Error{ErrorCode::invalid_input, "no material '" + name + "' carries a pattern; --material takes " + names};
    return found;
}

Result<HeightMap> read_map(const std::string& path, const Arguments& arguments) {
    HeightMapOptions options;
    options.polarity = arguments.text("--polarity") == "depth" ? Polarity::depth : Polarity::height;
    const std::string channel = arguments.text("--channel");
    if (channel == "red") options.channel = Channel::red;
    if (channel == "green") options.channel = Channel::green;
    if (channel == "blue") options.channel = Channel::blue;
    if (channel == "alpha") options.channel = Channel::alpha;
    if (channel == "luminance") options.channel = Channel::luminance;
    return read_height_map(path, options);
}

}  // namespace burin::cli
