// burin mesh: the surface of an asset as triangles.
#include <map>
#include <string>

#include <burin/image_io.hpp>
#include <burin/pack.hpp>
#include <mesh/body.hpp>

#include "asset_file.hpp"
#include "command.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "report.hpp"

namespace burin::cli {
namespace {

mesh::MeshOptions mesh_options(const Arguments& arguments) {
    mesh::MeshOptions options;
    options.tolerance = arguments.number("--tolerance");
    options.closed = arguments.flag("--tile") && !arguments.flag("--open");
    options.base = arguments.number("--base");
    options.threads = arguments.integer("--threads");
    return options;
}

Status check_options(const Arguments& arguments) {
    for (const char* own : {"--base", "--open", "--material"})
        if (arguments.given(own) && !arguments.flag("--tile"))
            return Error{ErrorCode::invalid_argument, std::string(own) + " is for one flat tile of a pattern; it works with --tile"};
    if (has_suffix(arguments.text("--output"), "glb")) return Done{};
    return Error{ErrorCode::invalid_argument, "--output '" + arguments.text("--output") + "' does not end in .glb, the one format that is written"};
}

// What a command has to say of all tiles together.
struct Made {
    std::vector<PlainMesh> meshes;
    double tolerance = 0.0;     // the largest
    std::size_t open_edges = 0;
};

PlainMesh look_of(const MaterialInfo& material, const Material* own) {
    PlainMesh out;
    out.material = material.name.empty() ? "default" : material.name;
    for (std::size_t i = 0; i < 4; ++i) out.base_color[i] = double{own ? own->base_color[i] : material.base_color[i]};
    out.metallic = double{own ? own->metallic : material.metallic};
    out.roughness = double{own ? own->roughness : material.roughness};
    return out;
}

// Parts what has a material of its own from the rest.
void add_looks(const mesh::BodyMesh& body, const MaterialInfo& material, const ResolvedPattern& pattern, std::vector<PlainMesh>& out) {
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::map<std::uint32_t, std::vector<std::size_t>> triangles;
    for (std::size_t t = 0; t < body.origins.size(); ++t) {
        const std::uint32_t element = body.origins[t].element;
        const std::uint32_t own = element < pattern.elements.size() ? pattern.styles[pattern.elements[element].style].material : kNone;
        triangles[own < pattern.materials.size() && pattern.materials[own].overrides ? own : kNone].push_back(t);
    }
    for (const auto& [own, list] : triangles) {
        PlainMesh& part = out.emplace_back(look_of(material, own == kNone ? nullptr : &pattern.materials[own]));
        if (own != kNone) part.material += " " + std::to_string(own);
        std::map<std::uint32_t, std::uint32_t> place;
        for (const std::size_t t : list)
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t v = body.indices[3 * t + i];
                const auto [it, fresh] = place.try_emplace(v, static_cast<std::uint32_t>(part.positions.size() / 3));
                part.indices.push_back(it->second);
                if (!fresh) continue;
                part.positions.insert(part.positions.end(), body.positions.begin() + 3 * v, body.positions.begin() + 3 * v + 3);
                part.normals.insert(part.normals.end(), body.normals.begin() + 3 * v, body.normals.begin() + 3 * v + 3);
            }
    }
}

PlainMesh plain_primitive(const Primitive& primitive, const MaterialInfo& material) {
    PlainMesh out = look_of(material, nullptr);
    out.positions = primitive.positions;
    out.normals = primitive.normals;
    out.indices = primitive.indices;
    return out;
}

struct Tile {
    ResolvedPattern pattern;
    mesh::TriangleMesh mesh;
};

Result<Tile> tile_of(const MaterialInfo& material, const mesh::MeshOptions& options, Made& made) {
    auto unpacked = unpack_textures(material.textures, material.detail);
    if (!unpacked) return Error{unpacked.error().code, "material '" + material.name + "': " + unpacked.error().message};
    auto tile = mesh::mesh_pattern(unpacked->pattern, unpacked->grid, options);
    if (!tile) return Error{tile.error().code, "material '" + material.name + "': " + tile.error().message};
    made.tolerance = std::max(made.tolerance, tile->tolerance);
    return Tile{std::move(unpacked->pattern), std::move(*tile)};
}

Result<Made> make_tile(const Arguments& arguments, const Asset& asset) {
    const auto index = find_patterned_material(asset, arguments.text("--material"));
    if (!index) return index.error();
    Made made;
    const auto tile = tile_of(asset.materials[*index], mesh_options(arguments), made);
    if (!tile) return tile.error();
    made.open_edges = mesh::count_open_edges(tile->mesh);
    add_looks(mesh::lay_flat(tile->mesh, tile->pattern.size), asset.materials[*index], tile->pattern, made.meshes);
    return made;
}

Result<Made> make_body(const Arguments& arguments, const Asset& asset, ProgressLine& line) {
    if (const auto any = find_patterned_material(asset, ""); !any && any.error().message.starts_with("no material")) return any.error();
    Made made;
    std::map<int, Tile> tiles;
    for (std::size_t i = 0; i < asset.primitives.size(); ++i) {
        line.update("mesh", static_cast<double>(i) / static_cast<double>(asset.primitives.size()));
        const Primitive& primitive = asset.primitives[i];
        const MaterialInfo& material = asset.materials[static_cast<std::size_t>(primitive.material)];
        if (!material.has_detail) {
            made.meshes.push_back(plain_primitive(primitive, material));
            continue;
        }
        if (!tiles.contains(primitive.material)) {
            auto tile = tile_of(material, mesh_options(arguments), made);
            if (!tile) return tile.error();
            tiles.emplace(primitive.material, std::move(*tile));
        }
        const Tile& tile = tiles.at(primitive.material);
        const auto body = mesh::mesh_body(tile.mesh, tile.pattern, primitive);
        if (!body) return body.error();
        add_looks(*body, material, tile.pattern, made.meshes);
    }
    std::erase_if(made.meshes, [](const PlainMesh& mesh) { return mesh.indices.empty(); });
    return made;
}

}  // namespace

ExitCode run_mesh(const Arguments& arguments) {
    const std::string output = arguments.text("--output");
    if (const Status checked = check_options(arguments); !checked) return fail(arguments, ExitCode::usage, checked.error().message);
    if (const Status other = check_outputs({{"--output", output, {}}}, {arguments.file}); !other)
        return fail(arguments, ExitCode::usage, other.error().message);
    const auto file = read_asset_file(arguments.file);
    if (!file) return fail(arguments, code_for_input(file.error()), file.error().message);
    ProgressLine line(arguments);
    auto made = arguments.flag("--tile") ? make_tile(arguments, file->asset) : make_body(arguments, file->asset, line);
    if (!made) return fail(arguments, code_for_input(made.error()), made.error().message);
    line.finish();
    std::size_t triangles = 0, vertices = 0;
    for (const PlainMesh& mesh : made->meshes) triangles += mesh.indices.size() / 3, vertices += mesh.positions.size() / 3;
    auto bytes = write_model(make_model("mesh", std::move(made->meshes)));
    if (!bytes) return fail(arguments, code_for_output(bytes.error()), bytes.error().message);

    Report report;
    report.add({"output", "output", output, ""});
    report.add({"triangles", "triangles", static_cast<std::int64_t>(triangles), ""});
    report.add({"vertices", "vertices", static_cast<std::int64_t>(vertices), ""});
    report.add({"bytes", "bytes", static_cast<std::int64_t>(bytes->size()), bytes_text(bytes->size())});
    report.add({"tolerance", "tolerance", made->tolerance, number_text(made->tolerance) + " m"});
    if (arguments.flag("--tile")) report.add({"open_edges", "open edges", static_cast<std::int64_t>(made->open_edges), ""});
    return write_and_print(arguments, report, {{"--output", output, [&](const std::string& path) { return write_file(path, *bytes); }}});
}

}  // namespace burin::cli
