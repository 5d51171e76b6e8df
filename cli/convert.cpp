// burin convert: a height map to a glb that carries it as paths with cross-sections.
#include <string>

#include <burin/convert.hpp>
#include <burin/image_io.hpp>
#include <burin/model.hpp>

#include "asset_file.hpp"
#include "command.hpp"
#include "found_paths.hpp"
#include "options.hpp"
#include "report.hpp"

namespace burin::cli {

ExitCode run_convert(const Arguments& arguments) {
    auto outputs = name_outputs(arguments, "glb", {arguments.file, arguments.text("--model")});
    if (!outputs) return fail(arguments, ExitCode::usage, outputs.error().message);
    const auto map = read_map(arguments.file, arguments);
    if (!map) return fail(arguments, code_for_input(map.error()), map.error().message);

    // The model is looked at before the long work: a wrong name should not cost minutes.
    Result<Model> model = make_plane({1.0, 1.0});
    Result<MaterialTarget> target = MaterialTarget{};
    const bool on_model = arguments.given("--model");
    if (on_model) {
        model = read_model(arguments.text("--model"));
        if (!model) return fail(arguments, code_for_input(model.error()), model.error().message);
        target = find_material(*model, {arguments.text("--material")});
        if (!target) return fail(arguments, code_for_input(target.error()), target.error().message);
    } else if (arguments.given("--material")) {
        return fail(arguments, ExitCode::usage, "--material names a material of --model, which is not given");
    }
    const auto size = choose_size(arguments, map->image, on_model ? &*target : nullptr);
    if (!size) return fail(arguments, code_for_input(size.error()), size.error().message);
    if (!on_model) model = make_plane(*size);

    ConvertOptions options = search_options(arguments, *size);
    options.grid.cell_size = arguments.number("--cell-size");
    options.attach.material = arguments.text("--material");
    const std::string residual = arguments.text("--residual");
    if (residual == "none") options.residual.most_texels = 0;
    else if (residual != "auto") options.residual.most_texels = static_cast<std::size_t>(arguments.integer("--residual"));
    ProgressLine line(arguments);
    const auto progress = [&](std::string_view stage, double fraction) {
        line.update(stage, fraction);
        return true;
    };
    const auto converted = convert_map(*map, *model, options, progress);
    if (!converted) return fail(arguments, code_for_input(converted.error()), converted.error().message);
    line.finish();
    Report report = describe_found(arguments, *map, *converted, converted->glb.size(), &converted->residual);
    outputs->front().write = [&](const std::string& path) { return write_file(path, converted->glb); };
    if (const Status drawn = draw_found(arguments, *map, *converted, report, *outputs, &converted->residual); !drawn)
        return fail(arguments, code_for_input(drawn.error()), drawn.error().message);
    return write_and_print(arguments, report, *outputs);
}

}  // namespace burin::cli
