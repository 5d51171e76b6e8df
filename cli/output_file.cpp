#include "output_file.hpp"

#include <filesystem>
#include <system_error>

#include "options.hpp"
#include "report.hpp"

namespace burin::cli {

Status check_not_an_input(const std::string& output, std::initializer_list<std::string> inputs) {
    for (const std::string& input : inputs) {
        // An error, such as a file that is not there, means that they are not the same.
        std::error_code error;
        if (!input.empty() && std::filesystem::equivalent(output, input, error) && !error)
            return Error{ErrorCode::invalid_argument, "--output '" + output + "' is the file '" + input +
                                                          "' that is read, and would replace it; another name works"};
    }
    return Done{};
}

ExitCode print_or_remove(const Arguments& arguments, const Report& report, const std::string& output) {
    const ExitCode code = print_answer(arguments, report, ExitCode::done);
    std::error_code error;
    if (code != ExitCode::done && std::filesystem::is_regular_file(output, error))
        std::filesystem::remove(output, error);
    return code;
}

}  // namespace burin::cli
