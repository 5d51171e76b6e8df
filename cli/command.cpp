#include "command.hpp"

#include <cstdio>
#include <exception>
#include <new>

#include "options.hpp"

namespace burin::cli {

ExitCode code_for_input(const Error& error) {
    switch (error.code) {
        case ErrorCode::invalid_argument: return ExitCode::usage;
        case ErrorCode::unavailable: return ExitCode::unavailable;
        default: return ExitCode::input;
    }
}

ExitCode code_for_output(const Error& error) {
    return error.code == ErrorCode::io_failed ? ExitCode::output : code_for_input(error);
}

ExitCode fail(const Arguments& arguments, ExitCode code, const std::string& message) {
    const std::string space = arguments.command.empty() ? "" : " ";
    std::string line = "burin" + space + arguments.command + ": error: " + message;
    // One line whatever a file's name holds.
    for (char& letter : line)
        if (static_cast<unsigned char>(letter) < ' ') letter = ' ';
    line += '\n';
    std::fwrite(line.data(), 1, line.size(), stderr);
    return code;
}

ExitCode guard(const Arguments& arguments, const std::function<ExitCode()>& work) {
    try {
        ExitCode code = work();
        // A full disk or a closed pipe shows only when the buffer is written.
        if (std::fflush(stdout) != 0 && code == ExitCode::done)
            code = fail(arguments, ExitCode::output, "standard output cannot be written");
        return code;
    } catch (const std::bad_alloc&) {
        return fail(arguments, ExitCode::unavailable, "not enough memory for this input");
    } catch (const std::exception& exception) {
        return fail(arguments, ExitCode::bug, std::string("internal: ") + exception.what());
    }
}

}  // namespace burin::cli
