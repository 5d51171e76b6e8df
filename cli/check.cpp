// burin check: the height figures of an asset against the map it was made from. 1 when above --max-rms.
#include <string>

#include <burin/compare.hpp>
#include <burin/model.hpp>
#include <burin/rasterize.hpp>
#include <burin/reconstruct.hpp>

#include "asset_file.hpp"
#include "command.hpp"
#include "options.hpp"
#include "report.hpp"

namespace burin::cli {
namespace {

// The heights that the file's own textures stand for, at the map's size.
Result<Image> reconstruct(const Arguments& arguments, const Asset& asset, std::size_t material, const Image& map) {
    const MaterialInfo& info = asset.materials[material];
    if (arguments.text("--with") == "shader") {
        TopOptions options;
        options.material = static_cast<int>(material);
        options.samples = RasterizeOptions{}.samples;  // the same box filter as the evaluator's
        options.backend = backend_of(arguments);
        return render_top(asset, map.width, map.height, options);
    }
    return reconstruct_heights(info.textures, info.detail, map.width, map.height,
                               {.threads = arguments.integer("--threads")});
}

void add_heights(Report& report, const Comparison& figures) {
    const auto share = [&](const char* key, const char* label, double value) {
        report.add({key, label, value, percent_text(value, 3) + " of range"});
    };
    report.add({"explained", "explained", figures.explained, explained_text(figures.explained)});
    share("rms", "RMS error", figures.rms);
    share("rms_without_smooth", "  smooth removed", figures.rms_without_smooth);
    share("p999", "99.9th percentile", figures.p999);
    share("p999_without_smooth", "  smooth removed", figures.p999_without_smooth);
    share("max", "largest error", figures.max);
    share("mean_error", "mean error", figures.mean_error);
    report.add_group("worst_texel", "worst texel",
                     {{"x", "x", std::int64_t{figures.worst_x}, ""}, {"y", "y", std::int64_t{figures.worst_y}, ""}});
}

void add_edges(Report& report, const EdgeError& edges) {
    const bool any = edges.length > 0.0;
    // A field without label is for JSON alone.
    const auto field = [&](const char* key, const char* label, double value, const std::string& shown) {
        return Field{key, any ? label : "", value, shown};
    };
    const auto texels = [](double value) { return number_text(value) + " texels"; };
    report.add_group("edges", "edge position",
                     {field("rms", "RMS", edges.rms, texels(edges.rms)),
                      field("rms_found", "without lost", edges.rms_found, texels(edges.rms_found)),
                      field("p999", "99.9th percentile", edges.p999, texels(edges.p999)),
                      field("lost", "lost", edges.lost, percent_text(edges.lost)),
                      Field{"length", any ? "of" : "no strong edges,", edges.length, texels(edges.length)}});
}

}  // namespace

ExitCode run_check(const Arguments& arguments) {
    const auto file = read_asset_file(arguments.file);
    if (!file) return fail(arguments, code_for_input(file.error()), file.error().message);
    const auto material = find_patterned_material(file->asset, arguments.text("--material"));
    if (!material) return fail(arguments, code_for_input(material.error()), material.error().message);
    const auto map = read_map(arguments.text("--against"), arguments);
    if (!map) return fail(arguments, code_for_input(map.error()), map.error().message);
    const auto heights = reconstruct(arguments, file->asset, *material, map->image);
    if (!heights) return fail(arguments, code_for_input(heights.error()), heights.error().message);

    const PathDetail& detail = file->asset.materials[*material].detail;
    const Wrap wrap = detail.repeat ? Wrap::repeat : Wrap::clamp;
    const Comparison figures = compare_heights(*heights, map->image, wrap);
    // Percent of range on the command line, a share in the library.
    const bool bounded = arguments.given("--max-rms");
    const bool passed = !bounded || figures.rms * 100.0 <= arguments.number("--max-rms");

    Report report;
    report.add({"asset", "asset", arguments.file, ""});
    report.add({"map", "map", arguments.text("--against"), ""});
    report.add_group("texels", "texels",
                     {{"width", "width", std::int64_t{map->image.width}, ""},
                      {"height", "height", std::int64_t{map->image.height}, ""}});
    add_heights(report, figures);
    add_edges(report, compare_edges(*heights, map->image, wrap));
    if (arguments.text("--with") == "shader") add_renderer(report, arguments);
    if (bounded) report.add({"passed", "within --max-rms", passed, ""});
    return print_answer(arguments, report, passed ? ExitCode::done : ExitCode::no);
}

}  // namespace burin::cli
