#include "gltf_document.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <optional>

#include <burin/image_io.hpp>

namespace burin {
namespace {

constexpr std::uint64_t kMaxJsonBytes = 1ull << 28;
constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

std::uint32_t u32_at(std::span<const std::uint8_t> bytes, std::size_t at) {
    return bytes[at] | bytes[at + 1] << 8 | bytes[at + 2] << 16 |
           static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

struct Parts {
    std::span<const std::uint8_t> json;
    std::optional<std::span<const std::uint8_t>> binary;
};

Result<Parts> split_glb(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < 20)
        return model_error("glb: the file ends within its header, after " + std::to_string(bytes.size()) +
                           " bytes");
    if (u32_at(bytes, 4) != 2)
        return Error{ErrorCode::unsupported,
                     "glb: version " + std::to_string(u32_at(bytes, 4)) + " is not read, only 2"};
    const std::uint64_t length = u32_at(bytes, 8);
    if (length > bytes.size() || length < 20)
        return model_error("glb: the header says " + std::to_string(length) + " bytes, the file has " +
                           std::to_string(bytes.size()));
    Parts parts;
    std::uint64_t at = 12;
    for (int chunk = 0; at < length; ++chunk) {
        const std::string name = "glb: chunk " + std::to_string(chunk);
        if (length - at < 8) return model_error(name + " ends within its header");
        const std::uint64_t size = u32_at(bytes, at);
        const std::uint32_t type = u32_at(bytes, at + 4);
        if (size % 4 != 0)
            return model_error(name + " has " + std::to_string(size) + " bytes, no multiple of 4");
        if (size > length - at - 8)
            return model_error(name + " has " + std::to_string(size) + " bytes, more than the file");
        const auto data = bytes.subspan(at + 8, size);
        if ((chunk == 0) != (type == kJsonChunk))
            return model_error(name + " is not where it belongs: JSON comes first, once");
        if (chunk == 0) parts.json = data;
        if (type == kBinaryChunk && chunk != 1)
            return model_error(name + " is a binary chunk that is not the second");
        if (type == kBinaryChunk) parts.binary = data;
        at += 8 + size;
    }
    return parts;
}

// Nesting is bounded before parsing: writing a document walks it recursively.
Status check_depth(std::span<const std::uint8_t> text) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const std::uint8_t c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kMaxModelJsonDepth)
                return Error{ErrorCode::limit_exceeded, "glTF: the JSON is nested deeper than " +
                                                            std::to_string(kMaxModelJsonDepth) + " levels"};
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return Done{};
}

Result<Json> parse_json(std::span<const std::uint8_t> text) {
    if (text.size() > kMaxJsonBytes)
        return Error{ErrorCode::limit_exceeded, "glTF: " + std::to_string(text.size()) +
                                                    " bytes of JSON, limit " + std::to_string(kMaxJsonBytes)};
    if (Status status = check_depth(text); !status.ok()) return status.error();
    std::size_t line = 1;
    Json document;
    try {
        document = Json::parse(text.begin(), text.end());
    } catch (const Json::parse_error& problem) {
        const std::size_t stop = std::min<std::size_t>(problem.byte, text.size());
        line += static_cast<std::size_t>(
            std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(stop), '\n'));
        return model_error("glTF: the JSON is damaged at byte " + std::to_string(problem.byte) + ", line " +
                           std::to_string(line));
    } catch (const Json::exception&) {
        return model_error("glTF: the JSON holds a number that is out of range");
    }
    if (!document.is_object()) return model_error("glTF: the JSON is no object");
    return document;
}

Status check_version(const Json& document) {
    const Json* asset = find_member(document, "asset");
    if (asset == nullptr || !asset->is_object())
        return model_error("glTF: there is no asset object with a version");
    const std::string version = text_or(*asset, "version", "");
    if (version.empty()) return model_error("glTF: asset.version is missing");
    if (version.rfind("2.", 0) != 0 ||
        (asset->contains("minVersion") && text_or(*asset, "minVersion", "") != "2.0"))
        return Error{ErrorCode::unsupported, "glTF: version " + version + " is not read, only 2.0"};
    return Done{};
}

// Extensions that change neither where the geometry lies nor how buffers are coded.
bool is_harmless(const std::string& extension) {
    static constexpr std::array<std::string_view, 8> kKnown{
        "KHR_mesh_quantization", "KHR_texture_transform", "KHR_texture_basisu", "KHR_lights_punctual",
        "KHR_xmp_json_ld",       "EXT_texture_webp",      "EXT_texture_avif",   "MSFT_texture_dds"};
    return extension.rfind("KHR_materials_", 0) == 0 ||
           std::find(kKnown.begin(), kKnown.end(), extension) != kKnown.end();
}

Status check_extensions(const Json& document) {
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
        const Json* list = find_member(document, key);
        if (list == nullptr) continue;
        if (!list->is_array()) return model_error(std::string("glTF: ") + key + " is no array");
        for (const Json& name : *list) {
            if (!name.is_string())
                return model_error(std::string("glTF: ") + key + " holds something that is no name");
            if (std::strcmp(key, "extensionsRequired") == 0 && !is_harmless(name.get<std::string>()))
                return Error{ErrorCode::unsupported,
                             "glTF: the model requires the extension " + name.get<std::string>() +
                                 ", which is not supported; save the model without it"};
        }
    }
    return Done{};
}

// Every list that burin walks holds objects only.
Status check_lists(const Json& document) {
    for (const char* key : {"accessors", "animations", "buffers", "bufferViews", "cameras", "images",
                            "materials", "meshes", "nodes", "samplers", "scenes", "skins", "textures"}) {
        const Json* list = find_member(document, key);
        if (list == nullptr) continue;
        if (!list->is_array()) return model_error(std::string("glTF: ") + key + " is no array");
        for (std::size_t i = 0; i < list->size(); ++i) {
            const Json& item = (*list)[i];
            if (!item.is_object())
                return model_error(std::string("glTF: ") + key + "[" + std::to_string(i) + "] is no object");
            if (const Json* e = find_member(item, "extensions"); e != nullptr && !e->is_object())
                return model_error("glTF: " + place(document, key, i) + ": extensions is no object");
        }
    }
    if (const Json* e = find_member(document, "extensions"); e != nullptr) {
        if (!e->is_object()) return model_error("glTF: extensions is no object");
        for (const auto& [name, value] : e->items())
            if (!value.is_object()) return model_error("glTF: the extension " + name + " is no object");
    }
    return Done{};
}

// Bytes of a buffer's or image's URI. `left` is what may still be loaded.
Result<std::vector<std::uint8_t>> load_uri(const std::string& uri, const std::string& base_folder,
                                           std::uint64_t left) {
    if (uri.rfind("data:", 0) == 0) return decode_data_uri(uri);
    Result<std::string> path = resolve_uri(uri, base_folder);
    if (!path.ok()) return path.error();
    return read_file(*path, std::min(left, kMaxModelFileBytes));
}

class Loader {
  public:
    Loader(ModelData& model, const std::string& base_folder, const Parts& parts)
        : model_(model), base_folder_(base_folder), parts_(parts) {}

    Status buffers() {
        const Json& list = array_of(model_.document, "buffers");
        for (std::size_t i = 0; i < list.size(); ++i) {
            Result<std::vector<std::uint8_t>> bytes = buffer(list[i], i);
            if (!bytes.ok()) return placed("buffers", i, bytes.error());
            model_.buffers.push_back(std::move(*bytes));
        }
        return Done{};
    }

    Status images() {
        const Json& list = array_of(model_.document, "images");
        for (std::size_t i = 0; i < list.size(); ++i) {
            Result<EncodedImage> loaded = image(list[i]);
            if (!loaded.ok()) return placed("images", i, loaded.error());
            model_.images.push_back(std::move(*loaded));
        }
        return Done{};
    }

  private:
    Error placed(const char* array, std::size_t i, const Error& error) {
        return Error{error.code, "glTF: " + place(model_.document, array, i) + ": " + error.message};
    }

    Status count_bytes(std::uint64_t bytes) {
        total_ += bytes;
        if (total_ > kMaxModelBytes)
            return Error{ErrorCode::limit_exceeded,
                         "buffers and images pass " + std::to_string(kMaxModelBytes) + " bytes"};
        return Done{};
    }

    Result<std::vector<std::uint8_t>> buffer(const Json& item, std::size_t index) {
        const Json* size = find_member(item, "byteLength");
        if (size == nullptr || !size->is_number_unsigned() || size->get<std::uint64_t>() == 0)
            return model_error("byteLength is missing or no positive integer");
        const auto byte_length = size->get<std::uint64_t>();
        const Json* uri = find_member(item, "uri");
        if (uri != nullptr && !uri->is_string()) return model_error("the uri is no text");
        Result<std::vector<std::uint8_t>> bytes = model_error("no uri and no binary chunk hold its bytes");
        if (uri != nullptr) {
            bytes = load_uri(uri->get<std::string>(), base_folder_, kMaxModelBytes - total_);
        } else if (index == 0 && parts_.binary.has_value()) {
            // The chunk is padded to four bytes; more is a sign of damage.
            if (parts_.binary->size() > byte_length + 3)
                return model_error("byteLength is " + std::to_string(byte_length) +
                                   ", the binary chunk has " + std::to_string(parts_.binary->size()) +
                                   " bytes");
            bytes = std::vector<std::uint8_t>(parts_.binary->begin(), parts_.binary->end());
        }
        if (!bytes.ok()) return bytes.error();
        if (bytes->size() < byte_length)
            return model_error("byteLength is " + std::to_string(byte_length) + ", there are only " +
                               std::to_string(bytes->size()) + " bytes");
        bytes->resize(byte_length);
        if (Status status = count_bytes(byte_length); !status.ok()) return status.error();
        return bytes;
    }

    Result<EncodedImage> image(const Json& item) {
        EncodedImage result;
        const Json* uri = find_member(item, "uri");
        if (uri == nullptr) {
            if (!item.contains("bufferView")) return model_error("neither uri nor bufferView");
            return result;
        }
        if (!uri->is_string() || item.contains("bufferView"))
            return model_error("the uri is no text, or stands beside a bufferView");
        Result<std::vector<std::uint8_t>> bytes =
            load_uri(uri->get<std::string>(), base_folder_, kMaxModelBytes - total_);
        if (!bytes.ok()) return bytes.error();
        result.bytes = std::move(*bytes);
        result.mime_type = mime_type_of(result.bytes);
        if (result.mime_type.empty())
            return model_error("its bytes are no picture of a kind that glTF knows");
        if (Status status = count_bytes(result.bytes.size()); !status.ok()) return status.error();
        return result;
    }

    ModelData& model_;
    const std::string& base_folder_;
    const Parts& parts_;
    std::uint64_t total_ = 0;
};

int base64_value(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return -1;
}

Result<std::string> percent_decoded(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            text.push_back(uri[i]);
            continue;
        }
        const auto digit = [&](std::size_t at) {
            const char c = at < uri.size() ? uri[at] : 'x';
            return c >= '0' && c <= '9'                 ? c - '0'
                   : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 'a' + 10
                                                        : -1;
        };
        if (digit(i + 1) < 0 || digit(i + 2) < 0)
            return model_error("the uri '" + uri.substr(0, 80) + "' has a wrong % escape");
        text.push_back(static_cast<char>(digit(i + 1) * 16 + digit(i + 2)));
        i += 2;
    }
    return text;
}

}  // namespace

const Json* find_member(const Json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto at = object.find(key);
    return at == object.end() ? nullptr : &*at;
}

const Json& array_of(const Json& document, const char* key) {
    static const Json kEmpty = Json::array();
    const Json* list = find_member(document, key);
    return list != nullptr && list->is_array() ? *list : kEmpty;
}

std::uint64_t unsigned_or(const Json& object, const char* key, std::uint64_t fallback) {
    const Json* value = find_member(object, key);
    return value != nullptr && value->is_number_unsigned() ? value->get<std::uint64_t>() : fallback;
}

double number_or(const Json& object, const char* key, double fallback) {
    const Json* value = find_member(object, key);
    return value != nullptr && value->is_number() ? value->get<double>() : fallback;
}

std::string text_or(const Json& object, const char* key, const std::string& fallback) {
    const Json* value = find_member(object, key);
    return value != nullptr && value->is_string() ? value->get<std::string>() : fallback;
}

std::string place(const Json& document, const char* array, std::size_t index) {
    const std::string here = std::string(array) + "[" + std::to_string(index) + "]";
    const Json& list = array_of(document, array);
    const std::string name = index < list.size() ? text_or(list[index], "name", "") : "";
    return name.empty() ? here : here + " '" + name.substr(0, 80) + "'";
}

std::string mime_type_of(std::span<const std::uint8_t> bytes) {
    const auto at = [&](std::size_t from, std::string_view signature) {
        return bytes.size() >= from + signature.size() &&
               std::memcmp(bytes.data() + from, signature.data(), signature.size()) == 0;
    };
    if (at(0, "\x89PNG")) return "image/png";
    if (at(0, "\xff\xd8\xff")) return "image/jpeg";
    if (at(0, "\xabKTX 20")) return "image/ktx2";
    if (at(0, "RIFF") && at(8, "WEBP")) return "image/webp";
    if (at(4, "ftypavi")) return "image/avif";
    if (at(0, "DDS ")) return "image/vnd-ms.dds";
    return "";
}

Result<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    const std::string_view head = uri.substr(0, std::min(comma, uri.size()));
    constexpr std::string_view kMark = ";base64";
    if (comma == std::string_view::npos || head.size() < kMark.size() ||
        head.substr(head.size() - kMark.size()) != kMark)
        return model_error("the data uri is not coded in base64");
    std::string_view text = uri.substr(comma + 1);
    while (!text.empty() && text.back() == '=' && uri.size() - text.size() + 3 > comma) {
        const std::size_t padding = uri.substr(comma + 1).size() - text.size();
        if (padding == 2) return model_error("the data uri has too much padding");
        text.remove_suffix(1);
    }
    if (text.size() % 4 == 1) return model_error("the data uri is cut off");
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t window = 0;
    int bits = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const int value = base64_value(text[i]);
        if (value < 0)
            return model_error("the data uri holds a character that base64 does not know, at " +
                               std::to_string(i));
        window = window << 6 | static_cast<std::uint32_t>(value);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<std::uint8_t>(window >> bits));
    }
    return bytes;
}

Result<std::string> resolve_uri(const std::string& uri, const std::string& base_folder) {
    const std::string shown = "'" + uri.substr(0, 80) + "'";
    Result<std::string> decoded = percent_decoded(uri);
    if (!decoded.ok()) return decoded.error();
    const std::string& text = *decoded;
    const bool scheme = text.find(':') != std::string::npos;
    if (text.empty() || scheme || text.front() == '/' || text.find('\\') != std::string::npos ||
        text.find('\0') != std::string::npos)
        return model_error("the uri " + shown + " is not relative to the model's folder");
    if (base_folder.empty())
        return model_error("the uri " + shown + " names another file, which is not allowed here");
    namespace fs = std::filesystem;
    std::error_code problem;
    const fs::path base = fs::canonical(base_folder, problem);
    if (problem)
        return Error{ErrorCode::io_failed,
                     "cannot open the folder '" + base_folder + "': " + problem.message()};
    for (const fs::path& part : fs::path(text))
        if (part == "..") return model_error("the uri " + shown + " leaves the model's folder");
    // Links are followed here, so that one inside the folder cannot lead out of it.
    const fs::path file = fs::canonical(base / text, problem);
    if (problem) return Error{ErrorCode::io_failed, "cannot open " + shown + ": " + problem.message()};
    const auto [stop, end] = std::mismatch(base.begin(), base.end(), file.begin(), file.end());
    if (stop != base.end()) return model_error("the uri " + shown + " leaves the model's folder");
    return file.string();
}

Result<ModelData> load_document(std::span<const std::uint8_t> bytes, const std::string& base_folder) {
    Parts parts{bytes, std::nullopt};
    if (bytes.size() >= 4 && u32_at(bytes, 0) == kGlbMagic) {
        Result<Parts> split = split_glb(bytes);
        if (!split.ok()) return split.error();
        parts = *split;
    }
    if (parts.json.empty()) return model_error("glTF: the file is empty");
    Result<Json> document = parse_json(parts.json);
    if (!document.ok()) return document.error();
    ModelData model;
    model.document = std::move(*document);
    for (const auto check : {check_version, check_extensions, check_lists})
        if (Status status = check(model.document); !status.ok()) return status.error();
    Loader loader(model, base_folder, parts);
    if (Status status = loader.buffers(); !status.ok()) return status.error();
    if (Status status = loader.images(); !status.ok()) return status.error();
    return model;
}

}  // namespace burin
