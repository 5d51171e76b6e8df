#include "output_file.hpp"

#include <filesystem>
#include <system_error>

#include "options.hpp"
#include "report.hpp"

namespace burin::cli {
namespace {

// Whether two names stand for one file; also where it is still to be made.
bool same_file(const std::string& a, const std::string& b) {
    if (a.empty() || b.empty()) return false;
    // An error, such as a file that is not there, means that they are not the same.
    std::error_code error;
    if (std::filesystem::equivalent(a, b, error) && !error) return true;
    const auto whole_a = std::filesystem::weakly_canonical(a, error);
    if (error) return false;
    const auto whole_b = std::filesystem::weakly_canonical(b, error);
    return !error && whole_a == whole_b;
}

void remove_all(const std::vector<OutputFile>& outputs, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        std::error_code error;
        if (std::filesystem::is_regular_file(outputs[i].path, error)) std::filesystem::remove(outputs[i].path, error);
    }
}

}  // namespace

Status check_outputs(const std::vector<OutputFile>& outputs, std::initializer_list<std::string> inputs) {
    const auto refuse = [](const OutputFile& output, const std::string& what) {
        return Error{ErrorCode::invalid_argument, output.option + " '" + output.path + "' is the file " + what +
                                                      ", and would replace it; another name works"};
    };
    for (const OutputFile& output : outputs) {
        for (const std::string& input : inputs)
            if (same_file(output.path, input)) return refuse(output, "'" + input + "' that is read");
        for (const OutputFile& other : outputs)
            if (&other < &output && same_file(output.path, other.path)) return refuse(output, "of " + other.option);
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
