// A pattern as JSON: to be written by hand or by programs, and to keep one without loss.
//
//     text of a .json --[read_pattern_json]--> Pattern --[write_pattern_json]--> text
//
// format/pattern.schema.json is the schema, with the meaning, unit and range of every property, and format/pattern.md explains it by
// example. What a pattern states in metres and indices, a file may state in a unit of its choice, with names, outlines of regions
// and profiles of the library (profiles.hpp); all of that is gone after reading.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <burin/pattern.hpp>
#include <burin/result.hpp>

namespace burin {

// Limits beyond those of json_text.hpp: what `at` may multiply a file to, and the subpaths of one outline.
inline constexpr std::size_t kMaxPatternJsonElements = 1ull << 22;
inline constexpr std::size_t kMaxOutlineSubpaths = 1024;

// `name`: of the file, begins every message. The order of paths is that of the text: `paths`, then each region's edge, paths and
// regions within.
// Fails with invalid_input (what is damaged, unknown, missing, twice there, out of its range or of the wrong kind) and limit_exceeded; the
// message names line, place and value, and says what would work. Whether the geometry can be resolved is not asked here.
// Cost: linear in the text and the elements; of one outline, quadratic in its subpaths.
// `sources`: unless null, where each path of the pattern comes from: "line 12", or "line 12, 'bolt'" where it has a name.
Result<Pattern> read_pattern_json(std::string_view text, const std::string& name, std::vector<std::string>* sources = nullptr);

// Every number has as many digits as make a reader's double the same, so that reading gives an equal pattern (but for the unused control
// points of lines, parameters that the kind of a perturbation does not use, and colours of materials without overrides).
// Requires: what read_pattern_json's result keeps: indices within the lists, finite numbers, elements of a path that follow each other,
// material 0 without overrides. Ensures: equal patterns give equal bytes, with the final newline. Cost: linear.
std::string write_pattern_json(const Pattern& pattern);

}  // namespace burin
