// burin convert: a height map to a glb that carries it as paths with cross-sections.
#include <optional>
#include <string>

#include <burin/convert.hpp>
#include <burin/image_io.hpp>
#include <burin/model.hpp>

#include "asset_file.hpp"
#include "authored_file.hpp"
#include "command.hpp"
#include "found_paths.hpp"
#include "made_asset.hpp"
#include "options.hpp"
#include "report.hpp"

namespace burin::cli {

Result<OptionalModel> read_optional_model(const Arguments& arguments) {
    if (const Status fitting = check_model_options(arguments); !fitting) return fitting.error();
    if (!arguments.given("--model")) return OptionalModel{};
    auto model = read_model(arguments.text("--model"));
    if (!model) return model.error();
    return OptionalModel{std::move(*model)};
}

Result<ConvertedMap> convert_file(const Arguments& arguments, const OptionalModel& model) {
    auto map = read_map(arguments.file, arguments);
    if (!map) return map.error();
    const AttachOptions attach{arguments.text("--material"), arguments.integer("--tex-coord")};
    // The model is looked at before the long work: a wrong name should not cost minutes.
    std::optional<MaterialTarget> target;
    if (model) {
        const auto found = find_material(*model, attach);
        if (!found) return found.error();
        target = *found;
    }
    const auto size = choose_size(arguments, map->image, target ? &*target : nullptr);
    if (!size) return size.error();

    ConvertOptions options = search_options(arguments, *size);
    options.grid.cell_size = arguments.number("--cell-size");
    options.attach = attach;
    const std::string residual = arguments.text("--residual");
    if (residual == "none") options.residual.most_texels = 0;
    else if (residual != "auto") options.residual.most_texels = static_cast<std::size_t>(arguments.integer("--residual"));
    ProgressLine line(arguments);
    const auto progress = [&](std::string_view stage, double fraction) {
        line.update(stage, fraction);
        return true;
    };
    auto converted = convert_map(*map, model ? *model : make_plane(*size), options, progress);
    if (!converted) return converted.error();
    line.finish();
    return ConvertedMap{std::move(*map), std::move(*converted)};
}

ExitCode run_convert(const Arguments& arguments) {
    auto outputs = name_outputs(arguments, "glb", {arguments.file, arguments.text("--model")});
    if (!outputs) return fail(arguments, ExitCode::usage, outputs.error().message);
    const auto model = read_optional_model(arguments);
    if (!model) return fail(arguments, code_for_input(model.error()), model.error().message);
    const auto made = convert_file(arguments, *model);
    if (!made) return fail(arguments, code_for_input(made.error()), made.error().message);
    const auto& [map, converted] = *made;
    Report report = describe_found(arguments, map, converted, converted.glb.size(), &converted.residual);
    outputs->front().write = [&](const std::string& path) { return write_file(path, made->converted.glb); };
    if (const Status drawn = draw_found(arguments, map, converted, report, *outputs, &converted.residual); !drawn)
        return fail(arguments, code_for_input(drawn.error()), drawn.error().message);
    return write_and_print(arguments, report, *outputs);
}

}  // namespace burin::cli
