// Reading of lines in space onto a model.
#pragma once

#include <burin/model.hpp>

#include "pattern_file.hpp"

namespace burin::cli {

// The file of --paths-3d as a pattern for the model. Fails as read_strokes, mean_strokes and project_strokes do.
Result<PatternFile> read_stroke_file(const Model& model, const Arguments& arguments);

}  // namespace burin::cli
