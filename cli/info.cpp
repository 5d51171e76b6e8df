// burin info: what is inside an asset, or what a height map holds.
#include <algorithm>
#include <string>

#include <burin/image_io.hpp>
#include <burin/model.hpp>
#include <burin/pack.hpp>

#include "asset_file.hpp"
#include "command.hpp"
#include "options.hpp"
#include "report.hpp"

namespace burin::cli {
namespace {

std::int64_t count_of(std::size_t count) { return static_cast<std::int64_t>(count); }

std::string residual_text(const RgbaImage& residual) {
    if (residual.width == 0) return "none";
    return std::to_string(residual.width) + "x" + std::to_string(residual.height) + " RGBA8, " + bytes_text(residual.texels.size());
}

// What a material's pattern holds, as fields of the material's row.
void add_pattern(std::vector<Field>& row, const MaterialInfo& material, const UnpackedPattern& unpacked) {
    const PathDetail& detail = material.detail;
    const auto& elements = unpacked.pattern.elements;
    const auto quadratics = std::count_if(elements.begin(), elements.end(), [](const ResolvedElement& element) {
        return element.element.kind == ElementKind::quadratic;
    });
    const std::size_t grid_bytes = material.textures.grid.size() * 4, data_bytes = material.textures.data.size() * 4;
    row.push_back(group("extent", "extent",
                     {{"u", "u", detail.size_u, number_text(detail.size_u) + " m"},
                      {"v", "v", detail.size_v, number_text(detail.size_v) + " m"},
                      {"depth", "depth", detail.depth, number_text(detail.depth) + " m"},
                      {"base_offset", "base offset", detail.base_offset, number_text(detail.base_offset) + " m"},
                      {"wrap", "wrap", std::string(detail.repeat ? "repeat" : "clamp"), ""},
                      {"tex_coord", "uv set", std::int64_t{detail.tex_coord}, ""}}));
    row.push_back(group("elements", "elements",
                     {{"lines", "lines", count_of(elements.size()) - quadratics, ""},
                      {"quadratics", "quadratics", std::int64_t{quadratics}, ""},
                      {"profiles", "profiles", count_of(unpacked.pattern.profiles.size()), ""},
                      {"styles", "styles", count_of(unpacked.pattern.styles.size()), ""},
                      {"materials", "materials", count_of(unpacked.pattern.materials.size()), ""},
                      {"functions", "functions along paths", count_of(unpacked.pattern.functions.size()), ""}}));
    row.push_back(group("textures", "textures",
                     {{"grid_width", "", std::int64_t{detail.grid_width}, ""},
                      {"grid_height", "", std::int64_t{detail.grid_height}, ""},
                      {"data_width", "", std::int64_t{detail.data_width}, ""},
                      {"data_height", "", std::int64_t{detail.data_height}, ""},
                      {"residual_width", "", std::int64_t{material.residual.width}, ""},
                      {"residual_height", "", std::int64_t{material.residual.height}, ""},
                      {"grid_bytes", "grid", count_of(grid_bytes),
                       std::to_string(detail.grid_width) + "x" + std::to_string(detail.grid_height) + " RG32UI, " +
                           bytes_text(grid_bytes)},
                      {"data_bytes", "data", count_of(data_bytes),
                       std::to_string(detail.data_width) + "x" + std::to_string(detail.data_height) + " RGBA32UI, " +
                           bytes_text(data_bytes)},
                      {"residual_bytes", "residual", count_of(material.residual.texels.size()), residual_text(material.residual)}}));
}

ExitCode describe_asset(const Arguments& arguments) {
    auto file = read_asset_file(arguments.file);
    if (!file) return fail(arguments, code_for_input(file.error()), file.error().message);
    std::size_t triangles = 0;
    for (const Primitive& primitive : file->asset.primitives) triangles += primitive.indices.size() / 3;
    Report report;
    report.add({"file", "file", arguments.file, ""});
    report.add({"bytes", "bytes", count_of(file->bytes.size()), bytes_text(file->bytes.size())});
    report.add({"triangles", "triangles", count_of(triangles), ""});
    Rows materials{"materials", "materials", {}};
    for (const MaterialInfo& material : file->asset.materials) {
        auto& row = materials.rows.emplace_back(std::vector<Field>{
            {"name", "name", material.name, material.name.empty() ? "(unnamed)" : ""},
            {"pattern", "pattern", material.has_detail, material.has_detail ? "carries a pattern" : "no pattern"}});
        if (!material.has_detail) continue;
        auto unpacked = unpack_textures(material.textures, material.detail);
        if (!unpacked)
            return fail(arguments, ExitCode::input,
                        "material '" + material.name + "': " + unpacked.error().message);
        add_pattern(row, material, *unpacked);
    }
    report.add_rows(std::move(materials));
    return print_answer(arguments, report, ExitCode::done);
}

ExitCode describe_map(const Arguments& arguments) {
    const auto map = read_map(arguments.file, arguments);
    if (!map) return fail(arguments, code_for_input(map.error()), map.error().message);
    const auto [low, high] = std::minmax_element(map->image.texels.begin(), map->image.texels.end());
    Report report;
    report.add({"file", "file", arguments.file, ""});
    report.add({"format", "format", map->format, ""});
    report.add_group("texels", "texels",
                     {{"width", "width", std::int64_t{map->image.width}, ""},
                      {"height", "height", std::int64_t{map->image.height}, ""}});
    report.add_group("channel", "channel",
                     {{"read", "read", map->channel, ""},
                      {"of", "of", std::int64_t{map->channels}, ""},
                      {"bits", "bits", std::int64_t{map->bit_depth}, ""},
                      {"float", "float", map->is_float, ""},
                      {"lossy", "lossy", map->lossy, ""}});
    report.add_group("values", "values",
                     {{"lowest", "lowest", double{*low}, ""},
                      {"highest", "highest", double{*high}, ""},
                      {"source_low", "file's 0", double{map->source_low}, ""},
                      {"source_high", "file's 1", double{map->source_high}, ""},
                      {"constant", "constant", map->constant, ""}});
    Rows notes{"notes", "notes", {}};
    for (const std::string& note : map->notes) notes.rows.push_back({{"note", "note", note, ""}});
    report.add_rows(std::move(notes));
    return print_answer(arguments, report, ExitCode::done);
}

}  // namespace

ExitCode run_info(const Arguments& arguments) {
    const auto bytes = read_file(arguments.file, kMaxModelFileBytes);
    if (!bytes) return fail(arguments, ExitCode::input, bytes.error().message);
    return looks_like_gltf(*bytes) ? describe_asset(arguments) : describe_map(arguments);
}

}  // namespace burin::cli
