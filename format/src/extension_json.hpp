// Reading of the extension object with numbered findings; shared by parse_extension and the validator.
#pragma once

#include <nlohmann/json.hpp>

#include <burin/format/extension.hpp>

#include "report.hpp"

namespace burin {

// Fills `detail`; returns whether no error was found. Pointers are relative to the extension object.
bool read_extension(const nlohmann::json& extension, PathDetail& detail, Reporter& reporter);

// Value of a JSON integer (also written as 3.0) within [low, high].
bool read_integer(const nlohmann::json& value, std::int64_t low, std::int64_t high, std::int64_t& out);

}  // namespace burin
