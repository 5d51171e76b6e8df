// Reading of drawings and pattern files that several commands share.
#pragma once

#include <string>
#include <vector>

#include <burin/pattern.hpp>
#include <burin/result.hpp>

namespace burin::cli {

class Arguments;

struct PatternFile {
    Pattern pattern;
    std::vector<std::string> sources;  // of each path, where the file tells: "line 12, path 'id'"
    std::vector<std::string> notes;  // what was left out or taken in another way, one sentence each
};

// Whether the file is a drawing or a pattern, and no height map: by its first letter, or by its suffix where it cannot be read.
bool looks_like_drawing(const std::string& path);

// By content: an SVG drawing or a pattern in JSON. Options say what the file leaves open. Fails as the readers do; the message
// begins with the file's name.
Result<PatternFile> read_pattern_file(const std::string& path, const Arguments& arguments);

}  // namespace burin::cli
