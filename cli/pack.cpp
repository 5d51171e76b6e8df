// burin pack: a drawing of paths to a glb that carries it.
#include <charconv>
#include <string>
#include <string_view>

#include <burin/author.hpp>
#include <burin/image_io.hpp>

#include "authored_file.hpp"
#include "command.hpp"
#include "made_asset.hpp"
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

// Stages name a path by its number among all; who drew it looks for its line in the file.
std::string with_source(const PatternFile& file, const std::string& message) {
    constexpr std::string_view word = "path ";
    std::size_t index = 0;
    if (!message.starts_with(word)) return message;
    const auto [end, trouble] = std::from_chars(message.data() + word.size(), message.data() + message.size(), index);
    if (trouble != std::errc{} || index >= file.sources.size()) return message;
    const auto at = static_cast<std::size_t>(end - message.data());
    return message.substr(0, at) + " (" + file.sources[index] + ")" + message.substr(at);
}

}  // namespace

Result<PackedDrawing> pack_file(const Arguments& arguments, const OptionalModel& model) {
    const bool in_space = arguments.given("--paths-3d");
    if (in_space && !model) return Error{ErrorCode::invalid_argument, "--paths-3d needs --model, the object that the lines are drawn on"};
    auto file = in_space ? read_stroke_file(*model, arguments) : read_pattern_file(arguments.file, arguments);
    if (!file) return file.error();
    const AuthorOptions options = author_options(arguments);
    if (model)
        if (const auto target = find_material(*model, options.attach); !target) return target.error();
    auto authored = author_asset(file->pattern, model ? *model : make_plane(file->pattern.size), options);
    if (!authored) return Error{authored.error().code, (in_space ? arguments.text("--paths-3d") : arguments.file) + ": " + with_source(*file, authored.error().message)};
    return PackedDrawing{std::move(*file), std::move(*authored)};
}

ExitCode run_pack(const Arguments& arguments) {
    const std::string output = arguments.text("--output");
    if (!has_suffix(output, "glb"))
        return fail(arguments, ExitCode::usage, "--output '" + output + "' does not end in .glb, the one format written");
    const bool in_space = arguments.given("--paths-3d");
    const std::string input = in_space ? arguments.text("--paths-3d") : arguments.file;
    if (const Status other = check_outputs({{"--output", output, {}}}, {input, arguments.text("--model")}); !other)
        return fail(arguments, ExitCode::usage, other.error().message);
    const auto model = read_optional_model(arguments);
    if (!model) return fail(arguments, code_for_input(model.error()), model.error().message);
    const auto made = pack_file(arguments, *model);
    if (!made) return fail(arguments, code_for_input(made.error()), made.error().message);
    return write_and_print(arguments, describe(arguments, made->authored, made->file),
                           {{"--output", output, [&](const std::string& path) { return write_file(path, made->authored.glb); }}});
}

}  // namespace burin::cli
