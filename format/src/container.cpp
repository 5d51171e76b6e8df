#include "container.hpp"

#include <array>
#include <limits>

#include "extension_json.hpp"

namespace burin {
namespace {

using nlohmann::json;
using Bytes = std::span<const std::uint8_t>;

constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kChunkJson = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kChunkBin = 0x004E4942;   // "BIN\0"

std::uint32_t word_at(Bytes bytes, std::size_t at) {
    return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
           static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

struct Chunks {
    Bytes json_text;
    std::optional<Bytes> bin;
};

// One chunk at `at`, which is moved behind it.
struct Chunk {
    std::uint32_t type;
    Bytes bytes;
};

std::optional<Chunk> read_chunk(Bytes bytes, std::size_t& at, Reporter& reporter) {
    const std::string place = "byte " + std::to_string(at);
    if (bytes.size() - at < 8) {
        reporter.report(
            1004, "a chunk header needs 8 bytes, " + std::to_string(bytes.size() - at) + " are left", place);
        return std::nullopt;
    }
    const std::uint32_t size = word_at(bytes, at);
    if (size > bytes.size() - at - 8) {
        reporter.report(1004,
                        "chunk of " + std::to_string(size) + " bytes, " +
                            std::to_string(bytes.size() - at - 8) + " are left",
                        place);
        return std::nullopt;
    }
    if (size % 4 != 0) {
        reporter.report(1005, "chunk of " + std::to_string(size) + " bytes, a multiple of 4 is needed",
                        place);
    }
    const Chunk chunk{word_at(bytes, at + 4), bytes.subspan(at + 8, size)};
    at += 8 + std::size_t{size};
    return chunk;
}

std::optional<Chunks> split_glb(Bytes bytes, Reporter& reporter) {
    if (bytes.size() < 12) {
        reporter.report(1001, "a GLB header needs 12 bytes, the file has " + std::to_string(bytes.size()));
        return std::nullopt;
    }
    if (word_at(bytes, 4) != 2) {
        reporter.report(1002, "GLB version is " + std::to_string(word_at(bytes, 4)) + ", 2 is needed");
        return std::nullopt;
    }
    if (word_at(bytes, 8) != bytes.size()) {
        reporter.report(1003, "GLB length is " + std::to_string(word_at(bytes, 8)) + ", the file has " +
                                  std::to_string(bytes.size()) + " bytes");
    }
    Chunks chunks;
    std::size_t at = 12;
    const std::optional<Chunk> first = read_chunk(bytes, at, reporter);
    if (!first) return std::nullopt;
    if (first->type != kChunkJson) {
        reporter.report(1006, "the first chunk is not JSON", "byte 12");
        return std::nullopt;
    }
    chunks.json_text = first->bytes;
    if (at < bytes.size()) {
        const std::optional<Chunk> second = read_chunk(bytes, at, reporter);
        if (second && second->type == kChunkBin) chunks.bin = second->bytes;
    }
    return chunks;
}

void check_asset(const json& document, Reporter& reporter) {
    const auto asset = document.find("asset");
    const bool ok = asset != document.end() && asset->is_object() && asset->contains("version") &&
                    (*asset)["version"].is_string() &&
                    (*asset)["version"].get_ref<const std::string&>().rfind("2.", 0) == 0;
    if (!ok) reporter.report(1008, "asset.version is not 2.x", "/asset/version");
}

std::optional<std::uint64_t> size_property(const json& object, const char* name, std::uint64_t fallback) {
    const auto found = object.find(name);
    if (found == object.end()) return fallback;
    std::int64_t value = 0;
    if (!read_integer(*found, 0, std::numeric_limits<std::int64_t>::max(), value)) return std::nullopt;
    return static_cast<std::uint64_t>(value);
}

}  // namespace

std::optional<Container> read_container(Bytes bytes, Reporter& reporter) {
    Container container;
    Bytes text = bytes;
    if (bytes.size() >= 4 && word_at(bytes, 0) == kMagic) {
        const std::optional<Chunks> chunks = split_glb(bytes, reporter);
        if (!chunks) return std::nullopt;
        text = chunks->json_text;
        container.bin_chunk = chunks->bin;
    } else if (bytes.empty() || bytes[0] == 0) {
        reporter.report(1001, "the file is neither GLB nor glTF JSON");
        return std::nullopt;
    }
    container.document = json::parse(text.begin(), text.end(), nullptr, false);
    if (container.document.is_discarded() || !container.document.is_object()) {
        reporter.report(1007, "the document is not a JSON object");
        return std::nullopt;
    }
    check_asset(container.document, reporter);
    return container;
}

const json* find_array(const json& object, const char* name, Reporter& reporter) {
    const auto found = object.find(name);
    if (found == object.end()) return nullptr;
    if (found->is_array()) return &*found;
    reporter.report(1010, std::string(name) + " is a " + found->type_name() + ", an array is needed",
                    std::string("/") + name);
    return nullptr;
}

std::optional<std::vector<std::uint8_t>> decode_base64(std::string_view text) {
    static constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> value{};
    value.fill(255);
    for (std::size_t i = 0; i < kDigits.size(); ++i) {
        value[static_cast<std::uint8_t>(kDigits[i])] = static_cast<std::uint8_t>(i);
    }
    while (!text.empty() && text.back() == '=') text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() * 3 / 4);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const std::uint8_t digit = value[static_cast<std::uint8_t>(c)];
        if (digit == 255) return std::nullopt;
        bits = bits << 6 | digit;
        count += 6;
        if (count >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (count -= 8)));
    }
    return bytes;
}

bool Buffers::read_uri(std::size_t index, const json& json, Buffer& buffer) {
    const std::string place = "/buffers/" + std::to_string(index);
    const auto uri = json.find("uri");
    if (uri == json.end()) {
        if (index != 0 || !container_.bin_chunk) {
            reporter_.report(1009, "the buffer has neither a URI nor a BIN chunk", place);
            return false;
        }
        buffer.bytes = *container_.bin_chunk;
        return true;
    }
    std::optional<std::vector<std::uint8_t>> bytes;
    if (uri->is_string()) {
        const std::string& text = uri->get_ref<const std::string&>();
        const std::size_t comma = text.find(";base64,");
        if (text.rfind("data:", 0) == 0) {
            if (comma != std::string::npos) bytes = decode_base64(std::string_view(text).substr(comma + 8));
        } else if (options_.read_resource) {
            bytes = options_.read_resource(text);
        }
    }
    if (!bytes) {
        reporter_.report(1009, "the buffer's URI cannot be read", place + "/uri");
        return false;
    }
    buffer.owned = std::move(*bytes);
    buffer.bytes = buffer.owned;
    return true;
}

bool Buffers::load(std::size_t index, const json& json, Buffer& buffer) {
    const std::string place = "/buffers/" + std::to_string(index);
    if (!json.is_object()) {
        reporter_.report(1010, "the buffer is not an object", place);
        return false;
    }
    if (!read_uri(index, json, buffer)) return false;
    const std::optional<std::uint64_t> length = size_property(json, "byteLength", 0);
    if (!length || *length == 0) {
        reporter_.report(1010, "byteLength is missing or not a number of bytes", place + "/byteLength");
        return false;
    }
    if (buffer.bytes.size() < *length) {
        reporter_.report(1011,
                         "byteLength is " + std::to_string(*length) + ", the buffer has " +
                             std::to_string(buffer.bytes.size()) + " bytes",
                         place + "/byteLength");
        return false;
    }
    buffer.bytes = buffer.bytes.first(static_cast<std::size_t>(*length));
    return true;
}

const Buffers::Buffer& Buffers::buffer(std::size_t index) {
    const json& all = container_.document.at("buffers");
    if (buffers_.empty()) buffers_.resize(all.size());
    Buffer& buffer = buffers_[index];
    if (!buffer.loaded) {
        buffer.loaded = true;
        buffer.ok = load(index, all[index], buffer);
    }
    return buffer;
}

std::optional<Bytes> Buffers::view(int index, std::uint64_t needed, const std::string& place) {
    const json* views = find_array(container_.document, "bufferViews", reporter_);
    const std::size_t count = views != nullptr ? views->size() : 0;
    if (index < 0 || static_cast<std::size_t>(index) >= count) {
        reporter_.report(2016, "bufferView is " + std::to_string(index) + " of " + std::to_string(count),
                         place);
        return std::nullopt;
    }
    const json& view = (*views)[static_cast<std::size_t>(index)];
    const std::string at = "/bufferViews/" + std::to_string(index);
    const auto number = [&view](const char* name, std::uint64_t fallback) {
        return size_property(view, name, fallback);
    };
    const json* buffers = find_array(container_.document, "buffers", reporter_);
    const std::optional<std::uint64_t> which = view.is_object() ? number("buffer", ~0ull) : std::nullopt;
    const std::optional<std::uint64_t> offset = view.is_object() ? number("byteOffset", 0) : std::nullopt;
    const std::optional<std::uint64_t> length = view.is_object() ? number("byteLength", 0) : std::nullopt;
    if (!which || !offset || !length || buffers == nullptr || *which >= buffers->size()) {
        reporter_.report(
            1010, "the buffer view is not an object with a valid buffer, byteOffset and byteLength", at);
        return std::nullopt;
    }
    if (view.contains("byteStride") || view.contains("target")) {
        reporter_.report(2019, "byteStride and target have no meaning for a texture's buffer view", at);
    }
    if (*offset % 4 != 0) {
        reporter_.report(2018, "byteOffset is " + std::to_string(*offset) + ", a multiple of 4 is needed",
                         at);
    }
    const Buffer& held = buffer(static_cast<std::size_t>(*which));
    if (!held.ok) return std::nullopt;
    if (*offset > held.bytes.size() || *length > held.bytes.size() - *offset) {
        reporter_.report(2020,
                         "the view ends at byte " + std::to_string(*offset) + " + " +
                             std::to_string(*length) + " of a buffer of " + std::to_string(held.bytes.size()),
                         at);
        return std::nullopt;
    }
    if (*length != needed) {
        reporter_.report(2017,
                         "byteLength is " + std::to_string(*length) + ", the texture takes " +
                             std::to_string(needed) + " bytes",
                         at);
        return std::nullopt;
    }
    return held.bytes.subspan(static_cast<std::size_t>(*offset), static_cast<std::size_t>(*length));
}

}  // namespace burin
