// What commands that write authored patterns share: the report, and the model that carries them.
#pragma once

#include <string>
#include <vector>

#include <burin/author.hpp>
#include <burin/pattern.hpp>
#include <burin/result.hpp>

#include "report.hpp"

namespace burin::cli {

class Arguments;

// Adds what was packed: paths by kind, elements, bytes, extent.
void add_authored(Report& report, const AuthorStats& stats, const Pattern& pattern);

// Adds the pattern's paths by kind and its extent: what can be said of it before it is packed.
void add_paths(Report& report, const Pattern& pattern);

// Adds the time spent on each stage.
void add_seconds(Report& report, const std::vector<std::pair<std::string, double>>& stages);

// Fails with invalid_argument: --material without --model.
Status check_model_options(const Arguments& arguments);

// The stages' options as --cell-size, --material, --tex-coord and --threads ask for them.
AuthorOptions author_options(const Arguments& arguments);

}  // namespace burin::cli
