// burin pack: a drawing of paths to a glb that carries it.
#include <string>

#include <burin/author.hpp>
#include <burin/image_io.hpp>

#include "asset_file.hpp"
#include "command.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "pattern_file.hpp"
#include "report.hpp"

namespace burin::cli {
namespace {

Report describe(const Arguments& arguments, const Authored& authored, const PatternFile& file) {
    const AuthorStats& stats = authored.stats;
    const auto bytes = [](const char* key, const char* label, std::size_t count) {
        return Field{key, label, static_cast<std::int64_t>(count), bytes_text(count)};
    };
    Report report;
    report.add({"output", "output", arguments.text("--output"), ""});
    report.add({"paths", "paths", std::int64_t{stats.paths}, ""});
    report.add_group("paths_by_kind", "  by kind",
                     {{"steps", "steps", std::int64_t{stats.steps}, ""},
                      {"grooves", "grooves", std::int64_t{stats.grooves}, ""},
                      {"ridges", "ridges", std::int64_t{stats.ridges}, ""}});
    report.add_group("elements", "elements",
                     {{"lines", "lines", std::int64_t{stats.lines}, ""}, {"quadratics", "quadratics", std::int64_t{stats.quadratics}, ""}});
    report.add({"profiles", "profiles", std::int64_t{stats.profiles}, ""});
    report.add({"cells", "cells", std::int64_t{stats.cells}, ""});
    report.add_group("bytes", "bytes",
                     {bytes("total", "textures", stats.grid_bytes + stats.data_bytes), bytes("grid_texture", "grid texture", stats.grid_bytes),
                      bytes("data_texture", "data texture", stats.data_bytes), bytes("file", "file", stats.file_bytes)});
    const Pattern& pattern = file.pattern;
    report.add_group("size", "size", {{"u", "u", pattern.size.x, number_text(pattern.size.x) + " m"}, {"v", "v", pattern.size.y, number_text(pattern.size.y) + " m"}});
    report.add({"depth", "depth", pattern.depth, number_text(pattern.depth) + " m"});
    std::vector<Field> seconds;
    for (const auto& [stage, spent] : stats.seconds) seconds.push_back({stage, stage, spent, number_text(spent)});
    report.add_group("seconds", "seconds", std::move(seconds));
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
    if (const Status other = check_outputs({{"--output", output, {}}}, {arguments.file, arguments.text("--model")}); !other)
        return fail(arguments, ExitCode::usage, other.error().message);
    if (arguments.given("--material") && !arguments.given("--model"))
        return fail(arguments, ExitCode::usage, "--material names a material of --model, which is not given");
    const auto file = read_pattern_file(arguments.file, arguments);
    if (!file) return fail(arguments, code_for_input(file.error()), file.error().message);
    const auto model = arguments.given("--model") ? read_model(arguments.text("--model")) : Result<Model>(make_plane(file->pattern.size));
    if (!model) return fail(arguments, code_for_input(model.error()), model.error().message);
    AuthorOptions options;
    options.grid.cell_size = arguments.number("--cell-size");
    options.attach.material = arguments.text("--material");
    options.threads = arguments.integer("--threads");
    const auto authored = author_asset(file->pattern, *model, options);
    if (!authored) return fail(arguments, code_for_input(authored.error()), arguments.file + ": " + authored.error().message);
    return write_and_print(arguments, describe(arguments, *authored, *file),
                           {{"--output", output, [&](const std::string& path) { return write_file(path, authored->glb); }}});
}

}  // namespace burin::cli
