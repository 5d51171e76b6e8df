// The work of `convert` and `pack` without files to write: one pattern on one material of a model. `build` does it for each pattern of a
// recipe, by the same arguments.
#pragma once

#include <optional>

#include <burin/author.hpp>
#include <burin/convert.hpp>
#include <burin/heightmap.hpp>
#include <burin/model.hpp>
#include <burin/result.hpp>

#include "pattern_file.hpp"

namespace burin::cli {

class Arguments;

// The model of --model; null without one: the pattern then lies on a rectangle of its size.
// Fails with invalid_argument when --material is given without it, and as read_model does.
using OptionalModel = std::optional<Model>;
Result<OptionalModel> read_optional_model(const Arguments& arguments);

struct ConvertedMap {
    HeightMap map;
    Converted converted;
};
// Of a height map, by the arguments of `convert`. Fails as the stages do; a wrong material is found before the long work.
Result<ConvertedMap> convert_file(const Arguments& arguments, const OptionalModel& model);

struct PackedDrawing {
    PatternFile file;
    Authored authored;
};
// Of a drawing, by the arguments of `pack`. Fails likewise.
Result<PackedDrawing> pack_file(const Arguments& arguments, const OptionalModel& model);

}  // namespace burin::cli
