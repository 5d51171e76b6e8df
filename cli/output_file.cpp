#include "output_file.hpp"

#include <filesystem>
#include <system_error>

#include "options.hpp"
#include "report.hpp"

namespace burin::cli {
namespace {

void remove_all(const std::vector<OutputFile>& outputs, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        std::error_code error;
        if (std::filesystem::is_regular_file(outputs[i].path, error)) std::filesystem::remove(outputs[i].path, error);
    }
}

}  // namespace

Status check_outputs(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs) {
    for (const OutputFile& output : outputs)
        for (const std::string& input : inputs) {
            // An error, such as a file that is not there, means that they are not the same.
            std::error_code error;
            if (!output.path.empty() && !input.empty() && std::filesystem::equivalent(output.path, input, error) && !error)
                return Error{ErrorCode::invalid_argument, output.option + " '" + output.path + "' is the file '" + input +
                                                              "' that is read, and would replace it; another name works"};
        }
    return Done{};
}

bool has_suffix(const std::string& path, const std::string& suffixes) {
    std::string suffix = std::filesystem::path(path).extension().string();
    for (char& letter : suffix) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return suffix.size() > 1 && ("|" + suffixes + "|").find("|" + suffix.substr(1) + "|") != std::string::npos;
}

ExitCode write_and_print(const Arguments& arguments, const Report& report, const std::vector<OutputFile>& outputs) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        if (outputs[i].path.empty()) continue;
        const Status written = outputs[i].write(outputs[i].path);
        if (written) continue;
        remove_all(outputs, i);
        return fail(arguments, code_for_output(written.error()), written.error().message);
    }
    const ExitCode code = print_answer(arguments, report, ExitCode::done);
    if (code != ExitCode::done) remove_all(outputs, outputs.size());
    return code;
}

}  // namespace burin::cli
