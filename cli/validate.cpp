// burin validate: every finding on an asset, by number. 0 when no MUST is broken, 1 otherwise.
#include <string>
#include <vector>

#include <burin/format/validate.hpp>
#include <burin/image_io.hpp>
#include <burin/model.hpp>

#include "asset_file.hpp"
#include "command.hpp"
#include "options.hpp"
#include "report.hpp"

namespace burin::cli {
namespace {

const char* severity_name(Severity severity) {
    switch (severity) {
        case Severity::error: return "error";
        case Severity::warning: return "warning";
        case Severity::information: return "information";
    }
    return "";
}

// Files beside a .gltf. A URI that could leave the folder is not followed; the validator then reports it.
std::optional<std::vector<std::uint8_t>> read_beside(const std::string& folder, std::string_view uri) {
    const std::string name(uri);
    const bool leaves = name.empty() || name[0] == '/' || name.find("..") != std::string::npos ||
                        name.find_first_of(":\\%") != std::string::npos;
    if (leaves) return std::nullopt;
    auto bytes = read_file(folder + name, kMaxModelFileBytes);
    if (!bytes) return std::nullopt;
    return std::move(*bytes);
}

}  // namespace

ExitCode run_validate(const Arguments& arguments) {
    auto bytes = read_file(arguments.file, kMaxModelFileBytes);
    if (!bytes) return fail(arguments, ExitCode::input, bytes.error().message);

    std::int64_t counts[3] = {0, 0, 0};
    Rows findings{"findings", "", {}};
    ValidateOptions options;
    const std::string folder = folder_of(arguments.file);
    options.read_resource = [&](std::string_view uri) { return read_beside(folder, uri); };
    validate_glb(
        *bytes,
        [&](const Issue& issue) {
            ++counts[static_cast<int>(issue.severity)];
            findings.rows.push_back({{"number", "number", std::int64_t{issue.number}, ""},
                                     {"severity", "severity", std::string(severity_name(issue.severity)), ""},
                                     {"pointer", "at", issue.pointer, issue.pointer.empty() ? "(file)" : ""},
                                     {"message", "message", issue.message, ""}});
        },
        options);

    const bool valid = counts[0] == 0;
    Report report;
    report.add({"file", "file", arguments.file, ""});
    report.add({"valid", "valid", valid, ""});
    report.add({"errors", "errors", counts[0], ""});
    report.add({"warnings", "warnings", counts[1], ""});
    report.add({"remarks", "remarks", counts[2], ""});
    report.add_rows(std::move(findings));
    return print_answer(arguments, report, valid ? ExitCode::done : ExitCode::no);
}

}  // namespace burin::cli
