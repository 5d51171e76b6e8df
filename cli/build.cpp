// burin build: several patterns on one model, as a recipe says.
#include <algorithm>
#include <string>
#include <vector>

#include <burin/image_io.hpp>

#include "command.hpp"
#include "found_paths.hpp"
#include "made_asset.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "recipe.hpp"
#include "report.hpp"

namespace burin::cli {
namespace {

// What the report says of one pattern, whoever made it.
struct Made {
    std::vector<std::uint8_t> glb;
    int paths = 0, lines = 0, quadratics = 0, profiles = 0, cells = 0;
    std::size_t bytes = 0;  // of the textures and the residual
    std::vector<std::string> notes;
};

Result<Made> make(const Arguments& arguments, const OptionalModel& model) {
    if (arguments.command == "pack") {
        auto packed = pack_file(arguments, model);
        if (!packed) return packed.error();
        const AuthorStats& stats = packed->authored.stats;
        return Made{std::move(packed->authored.glb), stats.paths, stats.lines, stats.quadratics, stats.profiles, stats.cells,
                    stats.grid_bytes + stats.data_bytes, std::move(packed->file.notes)};
    }
    auto done = convert_file(arguments, model);
    if (!done) return done.error();
    const ConvertStats& stats = done->converted.stats;
    const Residual& residual = done->converted.residual;
    return Made{std::move(done->converted.glb), stats.paths, stats.lines, stats.quadratics, stats.profiles, stats.cells,
                stats.grid_bytes + stats.data_bytes + residual.png.size(), notes_on(done->map, stats, &residual)};
}

// The file that the pattern comes from.
std::string source_of(const Arguments& arguments) {
    const bool in_space = arguments.command == "pack" && arguments.given("--paths-3d");
    return in_space ? arguments.text("--paths-3d") : arguments.file;
}

struct Built {
    std::vector<std::uint8_t> glb;
    std::vector<Made> patterns;  // without their bytes
    std::vector<std::string> materials;
};

// What a stage calls an argument comes from a file here.
Error at_place(const RecipePattern& pattern, const Error& error) {
    const ErrorCode code = error.code == ErrorCode::invalid_argument ? ErrorCode::invalid_input : error.code;
    return {code, pattern.place + ": " + error.message};
}

// Where every pattern goes: asked of the model before the long work. One material carries one pattern.
Result<std::vector<std::string>> find_materials(const Recipe& recipe, const OptionalModel& model) {
    std::vector<std::string> names;
    std::vector<std::size_t> taken;
    for (const RecipePattern& pattern : recipe.patterns) {
        if (!model) {
            names.emplace_back("plane");
            continue;
        }
        const auto target = find_material(*model, {pattern.arguments.text("--material"), pattern.arguments.integer("--tex-coord")});
        if (!target) return at_place(pattern, target.error());
        const auto before = std::find(taken.begin(), taken.end(), target->index);
        if (before != taken.end())
            return at_place(pattern, {ErrorCode::invalid_input, "material '" + target->name + "' carries the pattern of patterns[" +
                                                                    std::to_string(before - taken.begin()) + "] already; another material works"});
        taken.push_back(target->index);
        names.push_back(target->name);
    }
    return names;
}

Result<Built> build(const Recipe& recipe) {
    OptionalModel model;
    if (recipe.plane) model = make_plane(*recipe.plane);
    if (!recipe.model.empty()) {
        auto read = read_model(recipe.model);
        if (!read) return read.error();
        model = std::move(*read);
    }
    auto materials = find_materials(recipe, model);
    if (!materials) return materials.error();
    Built built{{}, {}, std::move(*materials)};
    for (const RecipePattern& pattern : recipe.patterns) {
        // The asset with the patterns before is the model of the next, as a command for each would have it.
        if (!built.glb.empty()) {
            auto next = read_model_bytes(built.glb, "");
            if (!next) return at_place(pattern, next.error());
            model = std::move(*next);
        }
        auto made = make(pattern.arguments, model);
        if (!made) return at_place(pattern, made.error());
        built.glb = std::move(made->glb);
        built.patterns.push_back(std::move(*made));
    }
    return built;
}

Report describe(const std::string& output, const Recipe& recipe, const Built& built) {
    Report report;
    report.add({"output", "output", output, ""});
    report.add({"model", "model", recipe.model, recipe.model.empty() ? "a rectangle" : recipe.model});
    report.add_group("bytes", "bytes", {{"file", "file", static_cast<std::int64_t>(built.glb.size()), bytes_text(built.glb.size())}});
    const auto count = [](const char* key, int number) { return Field{key, key, std::int64_t{number}, std::to_string(number) + " " + key}; };
    Rows rows{"patterns", "patterns", {}}, notes{"notes", "notes", {}};
    for (std::size_t i = 0; i < built.patterns.size(); ++i) {
        const Made& made = built.patterns[i];
        const Arguments& arguments = recipe.patterns[i].arguments;
        rows.rows.push_back({{"from", "from", source_of(arguments), ""}, {"command", "command", arguments.command, ""},
                             {"material", "material", built.materials[i], ""}, {"tex_coord", "uv set", std::int64_t{arguments.integer("--tex-coord")}, "uv set " + arguments.text("--tex-coord")},
                             count("paths", made.paths), count("lines", made.lines),
                             count("quadratics", made.quadratics), count("profiles", made.profiles),
                             count("cells", made.cells),
                             {"bytes", "textures and residual", static_cast<std::int64_t>(made.bytes), bytes_text(made.bytes)}});
        for (const std::string& note : made.notes) notes.rows.push_back({{"note", "note", "patterns[" + std::to_string(i) + "]: " + note, ""}});
    }
    report.add_rows(std::move(rows));
    report.add_rows(std::move(notes));
    return report;
}

// Every file that the recipe reads, itself too.
std::vector<std::string> inputs_of(const Arguments& arguments, const Recipe& recipe) {
    std::vector<std::string> inputs{arguments.file, recipe.model};
    for (const auto& [place, pattern] : recipe.patterns) {
        inputs.push_back(source_of(pattern));
        if (pattern.command == "pack") inputs.push_back(pattern.text("--font"));
    }
    return inputs;
}

}  // namespace

ExitCode run_build(const Arguments& arguments) {
    const auto recipe = read_recipe(arguments);
    if (!recipe) return fail(arguments, code_for_input(recipe.error()), recipe.error().message);
    const std::string output = arguments.given("--output") ? arguments.text("--output") : recipe->output;
    if (output.empty()) return fail(arguments, ExitCode::usage, "neither the recipe nor --output names a file to write");
    if (!has_suffix(output, "glb")) return fail(arguments, ExitCode::usage, "output '" + output + "' does not end in .glb, the one format written");
    if (const Status other = check_outputs({{"output", output, {}}}, inputs_of(arguments, *recipe)); !other)
        return fail(arguments, ExitCode::usage, other.error().message);
    const auto built = build(*recipe);
    if (!built) return fail(arguments, code_for_input(built.error()), built.error().message);
    return write_and_print(arguments, describe(output, *recipe, *built),
                           {{"output", output, [&](const std::string& path) { return write_file(path, built->glb); }}});
}

}  // namespace burin::cli
