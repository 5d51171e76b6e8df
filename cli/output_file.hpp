// What holds for every file that a command writes: it is none of the files that the command reads, and it is gone when
// the command fails after all.
#pragma once

#include <initializer_list>
#include <string>

#include <burin/result.hpp>

#include "command.hpp"

namespace burin::cli {

class Report;

// Fails with invalid_argument when `output` is one of the files `inputs`, by whatever name: another path, a link. An
// empty name among the inputs stands for none.
Status check_not_an_input(const std::string& output, std::initializer_list<std::string> inputs);

// The end of a command that has written `output`: prints its report. The program did not do what was asked when nobody
// can read the report, so that `output` is then removed and the code is ExitCode::output. What is no regular file, such
// as a device, stays.
ExitCode print_or_remove(const Arguments& arguments, const Report& report, const std::string& output);

}  // namespace burin::cli
