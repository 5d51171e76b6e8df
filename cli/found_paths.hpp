// What the commands share that look for paths in a map, `convert` and `vectorize`: options, what is written beside the main
// output, and the report.
#pragma once

#include <string>
#include <vector>

#include <burin/convert.hpp>

#include "command.hpp"
#include "output_file.hpp"
#include "report.hpp"

namespace burin::cli {

// Extent of the map in metres: as --size says; else the natural one of the model's material; else 1 m wide.
// Fails with invalid_argument when texels would not be square.
Result<Vec2> choose_size(const Arguments& arguments, const Image& map, const MaterialTarget* target);

// What the user asked of the search for paths; what only convert knows keeps its default.
ConvertOptions search_options(const Arguments& arguments, Vec2 size);

// The files to write, main one first, still without their writers. `suffixes`: one that the main output may end in, or two with | between.
// Fails with invalid_argument: a suffix that is not written, an output that is an input.
Result<std::vector<OutputFile>> name_outputs(const Arguments& arguments, const std::string& suffixes,
                                             const std::vector<std::string>& inputs);

// What was found and measured. `file_bytes`: size of the main output. `residual`: of a conversion.
Report describe_found(const Arguments& arguments, const HeightMap& map, const FoundPattern& found,
                      std::size_t file_bytes, const Residual* residual = nullptr);

// What a user should know, a sentence each.
std::vector<std::string> notes_on(const HeightMap& map, const ConvertStats& stats, const Residual* residual);

// Draws what --error-map and --report ask for into `outputs`, and adds what there is to say about it to `report`.
Status draw_found(const Arguments& arguments, const HeightMap& map, const FoundPattern& found, Report& report,
                  std::vector<OutputFile>& outputs, const Residual* residual = nullptr);

}  // namespace burin::cli
