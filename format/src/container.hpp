// The file around the textures: GLB chunks, glTF JSON, buffers and buffer views, each checked before it is
// used.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include <burin/format/validate.hpp>

#include "report.hpp"

namespace burin {

struct Container {
    nlohmann::json document;                                 // an object
    std::optional<std::span<const std::uint8_t>> bin_chunk;  // of a GLB
};

// 1001-1008: splits a GLB, or takes the bytes as glTF JSON. Nothing when no document can be had.
std::optional<Container> read_container(std::span<const std::uint8_t> bytes, Reporter& reporter);

// Hands out buffer views; every buffer is loaded and reported on once.
class Buffers {
  public:
    Buffers(const Container& container, const ValidateOptions& options, Reporter& reporter)
        : container_(container), options_(options), reporter_(reporter) {}

    // Bytes of the view that holds a texture of `needed` bytes; reports 1009, 1010, 2016-2020 and gives
    // nothing when it cannot be read. `place` names the property that refers to the view.
    std::optional<std::span<const std::uint8_t>> view(int index, std::uint64_t needed,
                                                      const std::string& place);

  private:
    struct Buffer {
        bool loaded = false, ok = false;
        std::vector<std::uint8_t> owned;
        std::span<const std::uint8_t> bytes;
    };
    const Buffer& buffer(std::size_t index);
    bool load(std::size_t index, const nlohmann::json& json, Buffer& buffer);
    bool read_uri(std::size_t index, const nlohmann::json& json, Buffer& buffer);

    const Container& container_;
    const ValidateOptions& options_;
    Reporter& reporter_;
    std::vector<Buffer> buffers_;
};

// The array property `name` of an object; nullptr when it is absent or not an array (the latter is reported,
// 1010).
const nlohmann::json* find_array(const nlohmann::json& object, const char* name, Reporter& reporter);

// Bytes of base64 text; nothing when it holds another character or stops in the middle.
std::optional<std::vector<std::uint8_t>> decode_base64(std::string_view text);

}  // namespace burin
