// burin pack: a drawing of paths to a glb that carries it.
#include <string>

#include <burin/author.hpp>
#include <burin/image_io.hpp>

#include "asset_file.hpp"
#include "authored_file.hpp"
#include "command.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "pattern_file.hpp"
#include "report.hpp"
#include "stroke_file.hpp"

namespace burin::cli {
namespace {

Report describe(const Arguments& arguments, const Authored& authored, const PatternFile& file) {
    Report report;
    report.add({"output", "output", arguments.text("--output"), ""});
    add_authored(report, authored.stats, file.pattern);
    add_seconds(report, authored.stats.seconds);
    Rows notes{"notes", "notes", {}};
    for (const std::string& note : file.notes) notes.rows.push_back({{"note", "note", note, ""}});
    report.add_rows(std::move(notes));
    return report;
}

}  // namespace

ExitCode run_pack(const Arguments& arguments) {
    const std::string output = arguments.text("--output");
    if (!has_suffix(output, "glb"))
        return fail(arguments, ExitCode::usage, "--output '" + output + "' does not end in .glb, the one format written");
    const bool in_space = arguments.given("--paths-3d");
    const std::string input = in_space ? arguments.text("--paths-3d") : arguments.file;
    if (const Status other = check_outputs({{"--output", output, {}}}, {input, arguments.text("--model")}); !other)
        return fail(arguments, ExitCode::usage, other.error().message);
    if (const Status fitting = check_model_options(arguments); !fitting) return fail(arguments, ExitCode::usage, fitting.error().message);
    if (in_space && !arguments.given("--model"))
        return fail(arguments, ExitCode::usage, "--paths-3d needs --model, the object that the lines are drawn on");
    auto model = arguments.given("--model") ? read_model(arguments.text("--model")) : Result<Model>(make_plane({1.0, 1.0}));
    if (!model) return fail(arguments, code_for_input(model.error()), model.error().message);
    const auto file = in_space ? read_stroke_file(*model, arguments) : read_pattern_file(input, arguments);
    if (!file) return fail(arguments, code_for_input(file.error()), file.error().message);
    if (!arguments.given("--model")) model = make_plane(file->pattern.size);
    const auto authored = author_asset(file->pattern, *model, author_options(arguments));
    if (!authored) return fail(arguments, code_for_input(authored.error()), input + ": " + authored.error().message);
    return write_and_print(arguments, describe(arguments, *authored, *file),
                           {{"--output", output, [&](const std::string& path) { return write_file(path, authored->glb); }}});
}

}  // namespace burin::cli
