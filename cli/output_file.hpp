// What holds for every file that a command writes: it is none of the files that the command reads, and it is gone when
// the command fails after all.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <burin/result.hpp>

#include "command.hpp"

namespace burin::cli {

class Report;

using Writer = std::function<Status(const std::string& path)>;

struct OutputFile {
    std::string option;  // that names it
    std::string path;    // empty: not asked for
    Writer write;
};

// Fails with invalid_argument when an output is one of the files `inputs`, by whatever name: another path, a link. An
// empty name stands for none.
Status check_outputs(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs);

// The name ends in one of `suffixes` ("exr|tif"), in small letters or capital ones.
bool has_suffix(const std::string& path, const std::string& suffixes);

// The end of a command that writes files: writes them in order and prints its report. The program did not do what was asked
// when a file cannot be written, or when nobody can read the report, so that all of `outputs` are then removed and the code
// is ExitCode::output. What is no regular file, such as a device, stays.
ExitCode write_and_print(const Arguments& arguments, const Report& report, const std::vector<OutputFile>& outputs);

}  // namespace burin::cli
