// The commands of burin and the codes they end with.
//
// Only this folder knows terminals, prints, and ends the program. A command is one source file with one function; the
// table `kCommands` in main.cpp is the only list of them.
#pragma once

#include <functional>
#include <string>

#include <burin/result.hpp>

namespace burin::cli {

class Arguments;

// What the program ends with. README lists the same table, and tests/cli proves each code.
enum class ExitCode : int {
    done = 0,         // done; the answer is yes
    no = 1,           // the answer is no: invalid file, error above --max-rms
    usage = 2,        // unknown command or option, value out of its range, missing argument
    input = 3,        // an input cannot be read, is damaged, or is not for this command
    output = 4,       // the file or standard output could not be written; no part of the file is left behind
    unavailable = 5,  // needs what this machine or build lacks: an OpenGL context, memory
    bug = 70,         // burin broke its own contract
};

struct Command {
    const char* name;
    const char* positional;  // how --help names the file the command reads
    const char* summary;     // one line, what the command does
    ExitCode (*run)(const Arguments&);
    std::string (*more_help)() = nullptr;  // text of --help after the options
    const char* instead = "";  // an option that may stand in the file's place
};

ExitCode run_convert(const Arguments& arguments);
ExitCode run_vectorize(const Arguments& arguments);
ExitCode run_pack(const Arguments& arguments);
ExitCode run_generate(const Arguments& arguments);
ExitCode run_build(const Arguments& arguments);
ExitCode run_render(const Arguments& arguments);
ExitCode run_check(const Arguments& arguments);
ExitCode run_info(const Arguments& arguments);
ExitCode run_mesh(const Arguments& arguments);
ExitCode run_validate(const Arguments& arguments);

// The kinds of patterns that run_generate knows, with their parameters.
std::string generate_help();

// The code for an error met while reading or working on an input, and while writing an output.
ExitCode code_for_input(const Error& error);
ExitCode code_for_output(const Error& error);

// Prints `burin <command>: error: <message>` as one line on stderr, and returns `code`.
ExitCode fail(const Arguments& arguments, ExitCode code, const std::string& message);

// Runs a command's work; the one place that catches. An exception that nothing expected ends with ExitCode::bug, want of
// memory with ExitCode::unavailable, and an output stream that cannot be written with ExitCode::output.
ExitCode guard(const Arguments& arguments, const std::function<ExitCode()>& work);

}  // namespace burin::cli
