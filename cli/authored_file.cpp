#include "authored_file.hpp"

#include "options.hpp"

namespace burin::cli {
namespace {

void add_kinds(Report& report, int paths, int steps, int grooves, int ridges) {
    report.add({"paths", "paths", std::int64_t{paths}, ""});
    report.add_group("paths_by_kind", "  by kind",
                     {{"steps", "steps", std::int64_t{steps}, ""},
                      {"grooves", "grooves", std::int64_t{grooves}, ""},
                      {"ridges", "ridges", std::int64_t{ridges}, ""}});
}

void add_extent(Report& report, const Pattern& pattern) {
    const auto metres = [](const char* key, double value) { return Field{key, key, value, number_text(value) + " m"}; };
    report.add_group("size", "size", {metres("u", pattern.size.x), metres("v", pattern.size.y)});
    report.add(metres("depth", pattern.depth));
}

}  // namespace

void add_paths(Report& report, const Pattern& pattern) {
    int count[3] = {0, 0, 0};
    for (const Path& path : pattern.paths) ++count[static_cast<std::size_t>(path_kind(pattern, path))];
    const auto of = [&](PathKind kind) { return count[static_cast<std::size_t>(kind)]; };
    add_kinds(report, static_cast<int>(pattern.paths.size()), of(PathKind::step), of(PathKind::groove), of(PathKind::ridge));
    add_extent(report, pattern);
}

void add_authored(Report& report, const AuthorStats& stats, const Pattern& pattern) {
    const auto bytes = [](const char* key, const char* label, std::size_t count) {
        return Field{key, label, static_cast<std::int64_t>(count), bytes_text(count)};
    };
    add_kinds(report, stats.paths, stats.steps, stats.grooves, stats.ridges);
    report.add_group("elements", "elements",
                     {{"lines", "lines", std::int64_t{stats.lines}, ""}, {"quadratics", "quadratics", std::int64_t{stats.quadratics}, ""}});
    report.add({"profiles", "profiles", std::int64_t{stats.profiles}, ""});
    report.add({"cells", "cells", std::int64_t{stats.cells}, ""});
    report.add_group("bytes", "bytes",
                     {bytes("total", "textures", stats.grid_bytes + stats.data_bytes), bytes("grid_texture", "grid texture", stats.grid_bytes),
                      bytes("data_texture", "data texture", stats.data_bytes), bytes("file", "file", stats.file_bytes)});
    add_extent(report, pattern);
}

void add_seconds(Report& report, const std::vector<std::pair<std::string, double>>& stages) {
    std::vector<Field> seconds;
    for (const auto& [stage, spent] : stages) seconds.push_back({stage, stage, spent, number_text(spent)});
    report.add_group("seconds", "seconds", std::move(seconds));
}

Status check_model_options(const Arguments& arguments) {
    if (arguments.given("--material") && !arguments.given("--model"))
        return Error{ErrorCode::invalid_argument, "--material names a material of --model, which is not given"};
    return Done{};
}

AuthorOptions author_options(const Arguments& arguments) {
    AuthorOptions options;
    options.grid.cell_size = arguments.number("--cell-size");
    options.attach = {arguments.text("--material"), arguments.integer("--tex-coord")};
    options.threads = arguments.integer("--threads");
    return options;
}

}  // namespace burin::cli
