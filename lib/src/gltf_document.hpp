// A glTF document in memory and checked access to it, for the sources of this library only.
//
// Reading goes in three steps, each relying on the one before:
//   load_document    container, JSON, versions, required extensions, bytes of buffers and images
//   check_document   every index, view, accessor, primitive and node that burin follows
//   geometry         accessors to numbers, primitives to triangles
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <burin/model.hpp>
#include <burin/result.hpp>

namespace burin {

using Json = nlohmann::json;

struct EncodedImage {
    std::vector<std::uint8_t> bytes;  // as stored; empty: the image lies in a bufferView
    std::string mime_type;
};

struct ModelData {
    Json document;
    std::vector<std::vector<std::uint8_t>> buffers;  // one per buffer of the document, byteLength bytes each
    std::vector<EncodedImage> images;                // one per image of the document
};

// ---- JSON access: never throws, never asserts on a wrong type
// -------------------------------------------------

// Member of an object, or null pointer (also when `object` is none).
const Json* find_member(const Json& object, const char* key);
// Array of a top-level property; an empty one when absent.
const Json& array_of(const Json& document, const char* key);
// Unsigned integer member; `fallback` when absent or of wrong type. For documents that were checked.
std::uint64_t unsigned_or(const Json& object, const char* key, std::uint64_t fallback);
double number_or(const Json& object, const char* key, double fallback);
std::string text_or(const Json& object, const char* key, const std::string& fallback);
// "meshes[3]", with the name when there is one: "meshes[3] 'helmet'".
std::string place(const Json& document, const char* array, std::size_t index);

// ---- steps
// ----------------------------------------------------------------------------------------------------

// `base_folder` empty: relative URIs are refused.
Result<ModelData> load_document(std::span<const std::uint8_t> bytes, const std::string& base_folder);

Status check_document(const ModelData& model);

// Bytes of a data URI; fails with invalid_input when it is not valid base64.
Result<std::vector<std::uint8_t>> decode_data_uri(std::string_view uri);

// Path of a relative URI inside `base_folder`; refuses everything that leads elsewhere.
Result<std::string> resolve_uri(const std::string& uri, const std::string& base_folder);

// "image/png" and the like by the first bytes; empty when unknown.
std::string mime_type_of(std::span<const std::uint8_t> bytes);

inline Error model_error(const std::string& message) { return Error{ErrorCode::invalid_input, message}; }

}  // namespace burin
