#include "found_paths.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <burin/error_map.hpp>
#include <burin/html_report.hpp>
#include <burin/image_io.hpp>
#include <burin/reconstruct.hpp>

#include "options.hpp"

namespace burin::cli {
namespace {

std::int64_t count_of(std::size_t count) { return static_cast<std::int64_t>(count); }

// Both textures as uploaded and the residual as stored: what --max-bytes bounds.
std::size_t total_bytes(const ConvertStats& stats, const Residual* residual) {
    return stats.grid_bytes + stats.data_bytes + (residual ? residual->png.size() : 0);
}
const char* total_name(const Residual* residual) { return residual ? "textures and residual" : "textures"; }

std::string of_range(double share) { return percent_text(share, 3) + " of range"; }

void add_counts(Report& report, const ConvertStats& stats, std::size_t file_bytes, const Residual* residual) {
    report.add({"paths", "paths", std::int64_t{stats.paths}, ""});
    report.add_group("paths_by_kind", "  by kind",
                     {{"steps", "steps", std::int64_t{stats.steps}, ""},
                      {"grooves", "grooves", std::int64_t{stats.grooves}, ""},
                      {"ridges", "ridges", std::int64_t{stats.ridges}, ""}});
    report.add_group("elements", "elements",
                     {{"lines", "lines", std::int64_t{stats.lines}, ""},
                      {"quadratics", "quadratics", std::int64_t{stats.quadratics}, ""}});
    report.add({"profiles", "profiles", std::int64_t{stats.profiles}, ""});
    report.add({"cells", "cells", std::int64_t{stats.cells}, ""});
    const std::size_t total = total_bytes(stats, residual);
    std::vector<Field> bytes{{"total", total_name(residual), count_of(total), bytes_text(total)},
                             {"grid_texture", "grid texture", count_of(stats.grid_bytes), bytes_text(stats.grid_bytes)},
                             {"data_texture", "data texture", count_of(stats.data_bytes), bytes_text(stats.data_bytes)}};
    if (residual) {
        const std::size_t uploaded = residual->picture.texels.size(), stored = residual->png.size();
        bytes.push_back({"residual_file", "residual as PNG", count_of(stored), bytes_text(stored)});
        bytes.push_back({"residual_texture", "as uploaded", count_of(uploaded), bytes_text(uploaded)});
    }
    bytes.push_back({"file", "file", count_of(file_bytes), bytes_text(file_bytes)});
    report.add_group("bytes", "bytes", std::move(bytes));
}

std::string degrees_text(double degrees) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f degrees", degrees);
    return text;
}

// How far the normals are off that are drawn, and what stands in for what the paths leave.
void add_residual(Report& report, const Residual& residual) {
    report.add_group("normal_error", "normals off, RMS",
                     {{"paths_alone", "paths alone", residual.error_without, degrees_text(residual.error_without)},
                      {"with_residual", "with residual", residual.error, degrees_text(residual.error)}});
    const RgbaImage& picture = residual.picture;
    Field size = group("residual", "residual",
                       {{"width", "width", std::int64_t{picture.width}, ""},
                        {"height", "height", std::int64_t{picture.height}, ""},
                        {"scale", "scale", residual.scale, ""}});
    if (picture.width == 0) size.text = "none";
    report.add(std::move(size));
}

// What each class of paths explains, and what is left.
void add_certificate(Report& report, const ConvertStats& stats) {
    report.add({"explained", "explained", stats.explained, explained_text(stats.explained)});
    const ExplainedShares& shares = stats.shares;
    report.add_group("by_class", "  by class",
                     {{"steps", "steps", shares.steps, explained_text(shares.steps)},
                      {"lines", "lines on top", shares.lines, explained_text(shares.lines)},
                      {"left", "left", shares.left, number_text(shares.left)}});
    report.add({"rms", "RMS error", stats.rms, of_range(stats.rms)});
    report.add({"p999", "99.9th percentile", stats.p999, of_range(stats.p999)});
    report.add({"p999_without_smooth", "  smooth removed", stats.p999_without_smooth, of_range(stats.p999_without_smooth)});
    report.add({"max", "largest error", stats.max, of_range(stats.max)});
}

// The bounds that were asked for. One that is not kept is an error, so that these are.
void add_bounds(const Arguments& arguments, Report& report, const ConvertStats& stats, const Residual* residual) {
    std::vector<Field> bounds;
    if (arguments.given("--max-error")) {
        const double bound = arguments.number("--max-error") / 100.0;
        bounds.push_back({"max_error", "99.9th percentile", bound,
                          percent_text(stats.p999, 3) + " within " + percent_text(bound, 3)});
    }
    if (arguments.given("--max-bytes")) {
        const std::uint64_t bound = arguments.bytes("--max-bytes");
        bounds.push_back({"max_bytes", total_name(residual), static_cast<std::int64_t>(bound),
                          bytes_text(total_bytes(stats, residual)) + " within " + bytes_text(bound)});
    }
    if (!bounds.empty()) report.add_group("bounds", "bounds kept", std::move(bounds));
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

void add_method(Report& report, const ConvertStats& stats) {
    report.add({"path_length_texels", "", stats.path_length_texels, ""});
    report.add({"traced_explained", "", stats.traced_explained, ""});
    report.add({"path_like", "", stats.path_like, ""});
    report.add({"repeat", "", stats.repeat, ""});
    const bool refined = stats.unrefined == Unrefined::no;
    report.add({"refined", "", refined, ""});
    if (!refined) report.add({"refined_because", "", std::string(reason_of(stats.unrefined).name), ""});
    report.add({"halvings", "", std::int64_t{stats.halvings}, ""});
    report.add({"noise", "", stats.noise, ""});
    report.add({"tolerance_texels", "", stats.tolerance, ""});
    report.add({"dropped_paths", "", std::int64_t{stats.dropped_paths}, ""});
    std::vector<Field> seconds;
    for (const auto& [stage, spent] : stats.seconds) seconds.push_back({stage, stage, spent, number_text(spent)});
    report.add_group("seconds", "seconds", std::move(seconds));
}

// Where what the paths leave out is shown. Without a residual the core material's normal map is there.
const char* who_carries_the_rest(const Residual* residual) {
    if (residual == nullptr) return "the drawing leaves out the rest";
    return residual->picture.width > 0 ? "the residual normal map carries the rest"
                                       : "the core material's normal map carries the rest, and there is no residual";
}

Writer text_writer(std::string text) {
    return [text = std::move(text)](const std::string& path) {
        return write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    };
}

// A picture in colours, or the signed error itself.
Writer draw_error_map(const std::string& path, const Image& heights, const Image& map, double full) {
    if (has_suffix(path, "png"))
        return [picture = draw_error(heights, map, full)](const std::string& name) { return write_png(name, picture); };
    Image error = heights;
    for (std::size_t i = 0; i < error.texels.size(); ++i) error.texels[i] -= map.texels[i];
    return [error = std::move(error)](const std::string& name) { return write_height(name, error); };
}

}  // namespace

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

ConvertOptions search_options(const Arguments& arguments, Vec2 size) {
    ConvertOptions options;
    options.vectorize.size = size;
    options.vectorize.depth = arguments.number("--depth");
    options.vectorize.tolerance = arguments.number("--tolerance");
    const std::string wrap = arguments.text("--wrap");
    if (wrap == "repeat") options.vectorize.wrap = WrapChoice::repeat;
    if (wrap == "clamp") options.vectorize.wrap = WrapChoice::clamp;
    if (arguments.given("--max-error")) options.max_error = arguments.number("--max-error") / 100.0;
    if (arguments.given("--max-bytes")) options.max_texture_bytes = arguments.bytes("--max-bytes");
    options.threads = arguments.integer("--threads");
    return options;
}

Result<std::vector<OutputFile>> name_outputs(const Arguments& arguments, const std::string& suffixes,
                                             const std::vector<std::string>& inputs) {
    const auto refuse = [&](const char* option, const std::string& what) {
        return Error{ErrorCode::invalid_argument,
                     std::string(option) + " '" + arguments.text(option) + "' does not end in " + what};
    };
    const std::size_t bar = suffixes.find('|');
    if (!has_suffix(arguments.text("--output"), suffixes))
        return refuse("--output", "." + suffixes.substr(0, bar) +
                                      (bar == std::string::npos ? ", the one format written" : " or ." + suffixes.substr(bar + 1) + ", the formats written"));
    if (arguments.given("--error-map") && !has_suffix(arguments.text("--error-map"), "png|exr|tif|tiff"))
        return refuse("--error-map", ".png for a picture, or in .exr or .tif for numbers");
    if (arguments.given("--report") && !has_suffix(arguments.text("--report"), "html|htm"))
        return refuse("--report", ".html, the one format written");
    std::vector<OutputFile> outputs;
    for (const char* option : {"--output", "--error-map", "--report"})
        outputs.push_back({option, arguments.text(option), {}});
    if (const Status other = check_outputs(outputs, inputs); !other) return other.error();
    return outputs;
}

std::vector<std::string> notes_on(const HeightMap& map, const ConvertStats& stats, const Residual* residual) {
    std::vector<std::string> notes = map.notes;
    // Paths that were given up count with what they explained: that number is why they were.
    const double share = stats.paths == 0 ? stats.traced_explained : stats.explained;
    if (map.constant)
        notes.push_back("the map is constant: it holds no path, and the surface is flat");
    else if (!stats.path_like)
        notes.push_back("the map is not path-like: the paths explain " + number_text(std::max(share, 0.0)) +
                        " of its detail; " + who_carries_the_rest(residual));
    if (residual && residual->is_short)
        notes.push_back(residual->picture.width > 0 ? "a larger residual normal map does not fit within --max-bytes"
                                                    : "no residual normal map that helps fits within --max-bytes");
    if (stats.dropped_paths > 0)
        notes.push_back(std::to_string(stats.dropped_paths) + " traced paths could not be joined and were left out");
    if (stats.unrefined != Unrefined::no)
        notes.push_back("not refined: " + std::string(reason_of(stats.unrefined).sentence));
    return notes;
}

Report describe_found(const Arguments& arguments, const HeightMap& map, const FoundPattern& found,
                      std::size_t file_bytes, const Residual* residual) {
    const ConvertStats& stats = found.stats;
    Report report;
    report.add({"output", "output", arguments.text("--output"), ""});
    report.add_group("map", "map",
                     {{"width", "width", std::int64_t{map.image.width}, ""},
                      {"height", "height", std::int64_t{map.image.height}, ""},
                      {"format", "format", map.format, ""},
                      {"bits", "bits", std::int64_t{map.bit_depth}, ""},
                      {"channel", "channel", map.channel, ""}});
    add_counts(report, stats, file_bytes, residual);
    add_certificate(report, stats);
    if (residual) add_residual(report, *residual);
    add_bounds(arguments, report, stats, residual);
    add_method(report, stats);
    Rows notes{"notes", "notes", {}};
    for (const std::string& note : notes_on(map, stats, residual)) notes.rows.push_back({{"note", "note", note, ""}});
    report.add_rows(std::move(notes));
    return report;
}

Status draw_found(const Arguments& arguments, const HeightMap& map, const FoundPattern& found, Report& report,
                  std::vector<OutputFile>& outputs, const Residual* residual) {
    const bool error_map = arguments.given("--error-map"), page = arguments.given("--report");
    if (!error_map && !page) return Done{};
    const int threads = arguments.integer("--threads");
    const auto heights = reconstruct_heights(found.textures, found.detail, map.image.width, map.image.height,
                                             {.threads = threads});
    if (!heights) return heights.error();
    if (error_map) {
        const std::string path = arguments.text("--error-map");
        const double full = full_error(found.stats.p999);
        outputs[1].write = draw_error_map(path, *heights, map.image, full);
        report.add_group("error_map", "error map",
                         {{"output", "output", path, ""},
                          {"full", has_suffix(path, "png") ? "full colour at" : "", full, of_range(full)}});
    }
    if (page) {
        report.add({"report", "report", arguments.text("--report"), ""});
        const ReportText text{std::filesystem::path(arguments.file).filename().string(), arguments.line,
                              "burin " BURIN_VERSION, report.lines("seconds"), notes_on(map, found.stats, residual)};
        auto html = write_html_report(map, found, *heights, text, residual, threads);
        if (!html) return html.error();
        outputs[2].write = text_writer(std::move(*html));
    }
    return Done{};
}

}  // namespace burin::cli
