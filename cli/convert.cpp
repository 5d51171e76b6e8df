// burin convert: a height map to a glb that carries it as paths with cross-sections.
#include <algorithm>
#include <cmath>
#include <string>

#include <burin/convert.hpp>
#include <burin/image_io.hpp>
#include <burin/model.hpp>

#include "asset_file.hpp"
#include "command.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "report.hpp"

namespace burin::cli {
namespace {

bool ends_with_glb(const std::string& path) {
    if (path.size() < 4) return false;
    std::string suffix = path.substr(path.size() - 4);
    for (char& letter : suffix) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return suffix == ".glb";
}

// Extent of the map in metres: as --size says; else the natural one of the model's material; else 1 m wide.
Result<Vec2> choose_size(const Arguments& arguments, const Image& map, const MaterialTarget* target) {
    const double aspect = static_cast<double>(map.height) / map.width;
    if (!arguments.given("--size") && target) {
        // The mean of both directions, so that texels stay square.
        const double width = std::sqrt(target->metres_per_uv.x * target->metres_per_uv.y / aspect);
        return Vec2{width, width * aspect};
    }
    const auto sides = arguments.numbers("--size");
    const Vec2 fitting{sides[0], sides[0] * aspect};
    if (sides.size() < 2) return fitting;
    // Square texels: a stretched map would have grooves of one width along u and of another along v.
    if (std::abs(sides[1] / fitting.y - 1.0) > 0.01)
        return Error{ErrorCode::invalid_argument,
                     "--size '" + arguments.text("--size") + "' would stretch the map of " + std::to_string(map.width) +
                         "x" + std::to_string(map.height) + " texels; " + number_text(fitting.x) + "x" +
                         number_text(fitting.y) + " m works"};
    return Vec2{sides[0], sides[1]};
}

ConvertOptions convert_options(const Arguments& arguments, Vec2 size) {
    ConvertOptions options;
    options.vectorize.size = size;
    options.vectorize.depth = arguments.number("--depth");
    options.vectorize.tolerance = arguments.number("--max-error");
    options.grid.cell_size = arguments.number("--cell-size");
    options.attach.material = arguments.text("--material");
    const std::string wrap = arguments.text("--wrap");
    if (wrap == "repeat") options.vectorize.wrap = WrapChoice::repeat;
    if (wrap == "clamp") options.vectorize.wrap = WrapChoice::clamp;
    options.threads = arguments.integer("--threads");
    return options;
}

std::int64_t count_of(std::size_t count) { return static_cast<std::int64_t>(count); }

void add_counts(Report& report, const ConvertStats& stats) {
    report.add({"paths", "paths", std::int64_t{stats.paths}, ""});
    report.add_group("elements", "elements",
                     {{"lines", "lines", std::int64_t{stats.lines}, ""},
                      {"quadratics", "quadratics", std::int64_t{stats.quadratics}, ""}});
    report.add({"profiles", "profiles", std::int64_t{stats.profiles}, ""});
    report.add({"cells", "cells", std::int64_t{stats.cells}, ""});
    report.add_group("bytes", "bytes",
                     {{"grid_texture", "grid texture", count_of(stats.grid_bytes), bytes_text(stats.grid_bytes)},
                      {"data_texture", "data texture", count_of(stats.data_bytes), bytes_text(stats.data_bytes)},
                      {"file", "file", count_of(stats.file_bytes), bytes_text(stats.file_bytes)}});
}

struct Reason {
    const char* name;      // for JSON
    const char* sentence;  // for people
};

// Why the paths were not refined.
Reason reason_of(Unrefined unrefined) {
    switch (unrefined) {
        case Unrefined::no: break;
        case Unrefined::not_asked: return {"not_asked", "it was not asked for"};
        case Unrefined::no_paths: return {"no_paths", "there is no path"};
        case Unrefined::not_path_like: return {"not_path_like", "the map is not path-like"};
        case Unrefined::too_much_work: return {"too_much_work", "wide profiles on long paths would be too much work"};
        case Unrefined::no_gain: return {"no_gain", "refined paths explain no more of the map"};
    }
    return {"", ""};
}

Report describe(const Arguments& arguments, const HeightMap& map, const Converted& converted) {
    const ConvertStats& stats = converted.stats;
    Report report;
    report.add({"output", "output", arguments.text("--output"), ""});
    report.add_group("map", "map",
                     {{"width", "width", std::int64_t{map.image.width}, ""},
                      {"height", "height", std::int64_t{map.image.height}, ""},
                      {"format", "format", map.format, ""},
                      {"bits", "bits", std::int64_t{map.bit_depth}, ""},
                      {"channel", "channel", map.channel, ""}});
    add_counts(report, stats);
    report.add({"explained", "explained", stats.explained, explained_text(stats.explained)});
    report.add({"rms", "RMS error", stats.rms, percent_text(stats.rms, 3) + " of range"});
    report.add({"p999", "99.9th percentile", stats.p999, percent_text(stats.p999, 3) + " of range"});
    report.add({"path_length_texels", "", stats.path_length_texels, ""});
    report.add({"traced_explained", "", stats.traced_explained, ""});
    report.add({"path_like", "", stats.path_like, ""});
    report.add({"repeat", "", stats.repeat, ""});
    const bool refined = stats.unrefined == Unrefined::no;
    report.add({"refined", "", refined, ""});
    if (!refined) report.add({"refined_because", "", std::string(reason_of(stats.unrefined).name), ""});
    report.add({"noise", "", stats.noise, ""});
    report.add({"tolerance_texels", "", stats.tolerance, ""});
    report.add({"dropped_paths", "", std::int64_t{stats.dropped_paths}, ""});
    std::vector<Field> seconds;
    for (const auto& [stage, spent] : stats.seconds) seconds.push_back({stage, stage, spent, number_text(spent)});
    report.add_group("seconds", "seconds", std::move(seconds));
    Rows notes{"notes", "notes", {}};
    for (const std::string& note : map.notes) notes.rows.push_back({{"note", "note", note, ""}});
    const auto note = [&](const std::string& text) { notes.rows.push_back({{"note", "note", text, ""}}); };
    // Paths that were given up count with what they explained: that number is why they were.
    const double share = stats.paths == 0 ? stats.traced_explained : stats.explained;
    if (map.constant)
        note("the map is constant: it holds no path, and the surface is flat");
    else if (!stats.path_like)
        note("the map is not path-like: the paths explain " + number_text(std::max(share, 0.0)) +
             " of its detail; the fallback maps carry the rest");
    if (stats.dropped_paths > 0)
        note(std::to_string(stats.dropped_paths) + " traced paths could not be joined and were left out");
    if (!refined) note("not refined: " + std::string(reason_of(stats.unrefined).sentence));
    report.add_rows(std::move(notes));
    return report;
}

}  // namespace

ExitCode run_convert(const Arguments& arguments) {
    const std::string output = arguments.text("--output");
    if (!ends_with_glb(output))
        return fail(arguments, ExitCode::usage, "--output '" + output + "' does not end in .glb, the one format written");
    if (const Status other = check_not_an_input(output, {arguments.file, arguments.text("--model")}); !other)
        return fail(arguments, ExitCode::usage, other.error().message);
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

    ProgressLine line(arguments);
    const auto progress = [&](std::string_view stage, double fraction) {
        line.update(stage, fraction);
        return true;
    };
    const auto converted = convert_map(*map, *model, convert_options(arguments, *size), progress);
    if (!converted) return fail(arguments, code_for_input(converted.error()), converted.error().message);
    line.finish();
    const Report report = describe(arguments, *map, *converted);
    if (const Status written = write_file(output, converted->glb); !written)
        return fail(arguments, code_for_output(written.error()), written.error().message);
    return print_or_remove(arguments, report, output);
}

}  // namespace burin::cli
