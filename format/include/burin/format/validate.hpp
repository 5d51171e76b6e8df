// Validator: checks a file against every MUST and SHOULD of SPECIFICATION.md and reports all findings, not
// the first.
//
// Safe on any bytes: never follows an index it has not checked, never allocates more than a small multiple of
// the input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burin/format/extension.hpp>
#include <burin/format/issues.hpp>
#include <burin/format/texels.hpp>

namespace burin {

using IssueSink = std::function<void(const Issue&)>;

// Bytes behind a buffer's URI that is not a data URI; nothing when it cannot be had. The caller decides which
// paths are allowed: the validator hands over the URI as it stands.
using ResourceReader = std::function<std::optional<std::vector<std::uint8_t>>(std::string_view uri)>;

struct ValidateOptions {
    std::size_t max_issues_per_number = 20;  // further ones are counted in one closing remark, number 9001
    ResourceReader read_resource;            // absent: external buffers are reported as unreadable (1009)
};

// `bytes`: a GLB, or glTF JSON. Reports in the order of the file: container, JSON, then each material's
// textures. Cost: linear in the file's size.
void validate_glb(std::span<const std::uint8_t> bytes, const IssueSink& sink,
                  const ValidateOptions& options = {});

// The checks 2045 and 2046 of a chart table. Requires: a layout that parse_extension has read, and as many words as it says.
// Returns true when no error was found.
bool validate_charts(const ChartLayout& charts, const std::vector<std::uint32_t>& words, const IssueSink& sink);

// The 3xxx and 4xxx checks, and of the 2xxx those that concern sizes: `textures` as they are described by
// `detail`. `pointer` is put before every issue's place. Returns true when no error was found.
bool validate_textures(const PackedTextures& textures, const PathDetail& detail, const IssueSink& sink,
                       std::string_view pointer = {});

// Words of a texture from the little-endian bytes of a file. Requires: size is a multiple of 4.
std::vector<std::uint32_t> words_from_bytes(std::span<const std::uint8_t> bytes);
// The inverse: what goes into the bufferView.
std::vector<std::uint8_t> bytes_from_words(std::span<const std::uint32_t> words);

}  // namespace burin
