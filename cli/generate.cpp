// burin generate: a pattern by its kind, numbers and a seed.
#include <chrono>
#include <optional>
#include <string>

#include <burin/generate.hpp>
#include <burin/image_io.hpp>
#include <burin/pattern_json.hpp>
#include <burin/svg.hpp>

#include "asset_file.hpp"
#include "authored_file.hpp"
#include "command.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "report.hpp"

namespace burin::cli {
namespace {

// The formats written, by the end of the name.
constexpr const char* kDrawings = "svg|json";
constexpr const char* kAssets = "glb";

Status check_options(const Arguments& arguments) {
    const std::string output = arguments.text("--output");
    const auto refuse = [](const std::string& message) { return Error{ErrorCode::invalid_argument, message}; };
    if (!has_suffix(output, kDrawings) && !has_suffix(output, kAssets))
        return refuse("--output '" + output + "' ends in no format that is written; .glb, .svg and .json work");
    for (const char* name : {"--model", "--cell-size"})
        if (arguments.given(name) && !has_suffix(output, kAssets))
            return refuse(std::string(name) + " is for assets; --output '" + output + "' is a drawing");
    if (const Status fitting = check_model_options(arguments); !fitting) return fitting;
    return check_outputs({{"--output", output, {}}}, {arguments.text("--mask"), arguments.text("--model")});
}

// The tile is a uv unit of the model unless --size says otherwise, so that circles stay round.
Result<Vec2> tile_size(const Arguments& arguments, const Model* model) {
    if (model && !arguments.given("--size")) {
        const auto target = find_material(*model, author_options(arguments).attach);
        if (!target) return target.error();
        return target->metres_per_uv;
    }
    const auto sides = arguments.numbers("--size");
    return Vec2{sides.front(), sides.back()};
}

Result<Pattern> make_pattern(const Arguments& arguments, Vec2 size, const Image* mask) {
    auto parameters = parse_parameters("--set", arguments.text("--set"));
    if (!parameters) return parameters.error();
    GenerateSpec spec;
    spec.kind = arguments.file;
    spec.parameters = std::move(*parameters);
    spec.size = size;
    spec.wrap = arguments.text("--wrap") == "repeat" ? Wrap::repeat : Wrap::clamp;
    spec.seed = static_cast<std::uint64_t>(arguments.number("--seed"));
    spec.profile = arguments.text("--profile");
    spec.mask = mask;
    spec.threads = arguments.integer("--threads");
    return generate_pattern(spec);
}

Report begin_report(const Arguments& arguments) {
    Report report;
    report.add({"output", "output", arguments.text("--output"), ""});
    report.add({"kind", "kind", arguments.file, ""});
    return report;
}

ExitCode write_drawing(const Arguments& arguments, const Pattern& pattern, double spent) {
    Report report = begin_report(arguments);
    add_paths(report, pattern);
    add_seconds(report, {{"generate", spent}});
    return write_and_print(arguments, report, {{"--output", arguments.text("--output"), [&](const std::string& path) {
        const std::string text = has_suffix(path, "json") ? write_pattern_json(pattern) : write_svg(pattern);
        return write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    }}});
}

ExitCode write_asset(const Arguments& arguments, const Pattern& pattern, const Model* model, double spent) {
    const auto authored = author_asset(pattern, model ? *model : make_plane(pattern.size), author_options(arguments));
    if (!authored) return fail(arguments, code_for_input(authored.error()), arguments.file + ": " + authored.error().message);
    Report report = begin_report(arguments);
    add_authored(report, authored->stats, pattern);
    std::vector<std::pair<std::string, double>> stages = {{"generate", spent}};
    stages.insert(stages.end(), authored->stats.seconds.begin(), authored->stats.seconds.end());
    add_seconds(report, stages);
    return write_and_print(arguments, report, {{"--output", arguments.text("--output"), [&](const std::string& path) { return write_file(path, authored->glb); }}});
}

}  // namespace

ExitCode run_generate(const Arguments& arguments) {
    if (const Status fitting = check_options(arguments); !fitting) return fail(arguments, ExitCode::usage, fitting.error().message);
    std::optional<Model> model;
    if (arguments.given("--model")) {
        auto read = read_model(arguments.text("--model"));
        if (!read) return fail(arguments, code_for_input(read.error()), read.error().message);
        model = std::move(*read);
    }
    std::optional<HeightMap> mask;
    if (arguments.given("--mask")) {
        auto read = read_height_map(arguments.text("--mask"));
        if (!read) return fail(arguments, code_for_input(read.error()), read.error().message);
        mask = std::move(*read);
    }
    const auto size = tile_size(arguments, model ? &*model : nullptr);
    if (!size) return fail(arguments, code_for_input(size.error()), size.error().message);
    const auto begun = std::chrono::steady_clock::now();
    const auto pattern = make_pattern(arguments, *size, mask ? &mask->image : nullptr);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun;
    if (!pattern) return fail(arguments, code_for_input(pattern.error()), pattern.error().message);
    return has_suffix(arguments.text("--output"), kDrawings) ? write_drawing(arguments, *pattern, spent.count())
                                                             : write_asset(arguments, *pattern, model ? &*model : nullptr, spent.count());
}

std::string generate_help() {
    std::string text = "\nkinds, and their parameters for --set [range; usual]:\n";
    for (const GeneratorEntry& entry : generator_table()) {
        text += std::string("  ") + entry.name + ": " + entry.help + "; profile " + entry.profile + "\n";
        for (const Parameter& parameter : entry.parameters) {
            std::string left = std::string("      ") + parameter.name;
            left.resize(24, ' ');
            text += left + parameter.help + " [" + range_text(parameter) + "; " + parameter_text(parameter.usual) + "]\n";
        }
    }
    return text;
}

}  // namespace burin::cli
