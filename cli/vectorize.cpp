// burin vectorize: the paths that convert would find in a height map, as a drawing to be edited by hand.
#include <string>

#include <burin/convert.hpp>
#include <burin/image_io.hpp>
#include <burin/pattern_json.hpp>
#include <burin/svg.hpp>

#include "asset_file.hpp"
#include "command.hpp"
#include "found_paths.hpp"
#include "options.hpp"
#include "report.hpp"

namespace burin::cli {

ExitCode run_vectorize(const Arguments& arguments) {
    auto outputs = name_outputs(arguments, "svg|json", {arguments.file});
    if (!outputs) return fail(arguments, ExitCode::usage, outputs.error().message);
    const auto map = read_map(arguments.file, arguments);
    if (!map) return fail(arguments, code_for_input(map.error()), map.error().message);
    const auto size = choose_size(arguments, map->image, nullptr);
    if (!size) return fail(arguments, code_for_input(size.error()), size.error().message);

    ProgressLine line(arguments);
    const auto progress = [&](std::string_view stage, double fraction) {
        line.update(stage, fraction);
        return true;
    };
    const auto found = find_pattern(*map, search_options(arguments, *size), progress);
    if (!found) return fail(arguments, code_for_input(found.error()), found.error().message);
    line.finish();
    const bool json = has_suffix(arguments.text("--output"), "json");
    const std::string text = json ? write_pattern_json(found->pattern) : write_svg(found->pattern);
    Report report = describe_found(arguments, *map, *found, text.size());
    outputs->front().write = [&](const std::string& path) {
        return write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    };
    if (const Status drawn = draw_found(arguments, *map, *found, report, *outputs); !drawn)
        return fail(arguments, code_for_input(drawn.error()), drawn.error().message);
    return write_and_print(arguments, report, *outputs);
}

}  // namespace burin::cli
