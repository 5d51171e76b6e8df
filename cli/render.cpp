// burin render: a picture of an asset as its shader draws it, or its heights from straight above.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <burin/image_io.hpp>
#include <burin/model.hpp>
#include <burin/radiance.hpp>

#include <gl/render.hpp>
#include <reference/render.hpp>

#include "asset_file.hpp"
#include "command.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "report.hpp"

namespace burin::cli {
namespace {

// Suffix in lower case, with its dot; "" when there is none.
std::string suffix_of(const std::string& path) {
    const std::size_t dot = path.rfind('.');
    if (dot == std::string::npos || path.find('/', dot) != std::string::npos) return "";
    std::string suffix = path.substr(dot);
    for (char& letter : suffix) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    return suffix;
}

Status check_output(const std::string& output, bool top) {
    const std::string suffix = suffix_of(output);
    const bool heights = suffix == ".exr" || suffix == ".tif" || suffix == ".tiff";
    if (suffix == ".png" || (top && heights)) return Done{};
    return Error{ErrorCode::invalid_argument,
                 "--output '" + output + "' ends in neither of the suffixes that work: " +
                     (top ? ".exr, .tif, .png" : ".png (.exr and .tif with --top)")};
}

struct PictureSize {
    int width, height;
};

// As --size says; the height that it leaves out follows from `aspect`, height over width.
PictureSize picture_size(const Arguments& arguments, double aspect) {
    const auto sides = arguments.numbers("--size");
    const double height = sides.size() > 1 ? sides[1] : std::clamp(std::round(sides[0] * aspect), 1.0, 8192.0);
    return {static_cast<int>(sides[0]), static_cast<int>(height)};
}

std::array<double, 3> point_of(const Arguments& arguments, const std::string& name) {
    const auto numbers = arguments.numbers(name);
    return {numbers[0], numbers[1], numbers[2]};
}

// As --environment names it; options about one that is not there are a mistake.
Status read_environment(const Arguments& arguments, RenderOptions& options) {
    const std::string which = arguments.text("--environment");
    if (which == "none") {
        for (const char* other : {"--environment-rotation", "--environment-strength"})
            if (arguments.given(other))
                return Error{ErrorCode::invalid_argument, std::string(other) + " changes nothing with --environment none; room or a picture works"};
        return Done{};
    }
    Environment environment{nullptr, arguments.number("--environment-rotation"), arguments.number("--environment-strength")};
    if (which != "room") {
        auto map = read_radiance(which);
        if (!map) return map.error();
        environment.map = std::make_shared<const RadianceMap>(std::move(*map));
    }
    options.environment = std::move(environment);
    return Done{};
}

RenderOptions render_options(const Arguments& arguments) {
    RenderOptions options;
    const PictureSize size = picture_size(arguments, 0.75);
    options.width = size.width;
    options.height = size.height;
    options.camera.azimuth = arguments.number("--azimuth");
    options.camera.elevation = arguments.number("--elevation");
    options.camera.zoom = arguments.number("--zoom");
    options.camera.field_of_view = arguments.number("--fov");
    options.camera.orthographic = arguments.flag("--orthographic");
    if (arguments.given("--center")) {
        const auto center = arguments.numbers("--center");
        options.camera.center = Vec2{center[0], center[1]};
    }
    if (arguments.given("--eye")) options.camera.eye = point_of(arguments, "--eye");
    if (arguments.given("--target")) options.camera.target = point_of(arguments, "--target");
    const auto light = arguments.numbers("--light");
    options.light.azimuth = light[0];
    options.light.elevation = light[1];
    options.light.strength = arguments.number("--light-strength");
    options.shadows = !arguments.flag("--no-shadows");
    options.correct_depth = arguments.flag("--correct-depth");
    options.samples = arguments.integer("--samples");
    options.antialiasing = arguments.text("--antialiasing") == "points" ? Antialiasing::points : Antialiasing::regions;
    // A single ray shows no edge; areas do.
    if (options.antialiasing == Antialiasing::points && !arguments.given("--samples")) options.samples = 4;
    options.rays = arguments.integer("--rays");
    options.backend = backend_of(arguments);
    return options;
}

// What the shader is asked for says nothing to the renderer on the CPU, and the other way round.
Status check_backend(const Arguments& arguments) {
    if (arguments.text("--backend") != "reference") {
        for (const char* own : {"--threads", "--bounces", "--directions", "--passes"})
            if (arguments.given(own))
                return Error{ErrorCode::invalid_argument, std::string(own) + " changes nothing with --backend " + arguments.text("--backend") + "; reference works"};
        return Done{};
    }
    for (const char* other : {"--samples", "--antialiasing", "--rays", "--correct-depth", "--top"})
        if (arguments.given(other))
            return Error{ErrorCode::invalid_argument, std::string(other) + " is not for --backend reference, which takes one sample of exact areas; "
                                                      "osmesa or egl works"};
    return Done{};
}

// All drawers give the size, or why nothing could be drawn; `write` then writes the picture.
Result<PictureSize> draw_heights(const Arguments& arguments, const Asset& asset, Writer& write) {
    const auto material = find_patterned_material(asset, arguments.text("--material"));
    if (!material) return material.error();
    const PathDetail& detail = asset.materials[*material].detail;
    const PictureSize size = picture_size(arguments, detail.size_v / detail.size_u);
    TopOptions options;
    options.material = static_cast<int>(*material);
    // A height image has no edges to smooth: one sample unless asked for more.
    if (arguments.given("--samples"))
        options.samples = std::min(16, static_cast<int>(std::ceil(std::sqrt(arguments.number("--samples")))));
    options.backend = backend_of(arguments);
    const auto heights = render_top(asset, size.width, size.height, options);
    if (!heights) return heights.error();
    write = [heights = *heights](const std::string& path) { return write_height(path, heights); };
    return size;
}

// Middle of the box around the asset: where the camera looks unless told.
std::array<double, 3> middle_of(const Asset& asset) {
    std::array<double, 3> low, high;
    low.fill(HUGE_VAL);
    high.fill(-HUGE_VAL);
    for (const Primitive& primitive : asset.primitives)
        for (const std::uint32_t vertex : primitive.indices)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double place{primitive.positions[3 * vertex + axis]};
                low[axis] = std::min(low[axis], place);
                high[axis] = std::max(high[axis], place);
            }
    return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
}

// An eye at the very point it looks at sees in no direction. With --center the point lies on the surface, which only an
// eye on the surface could meet.
Status check_camera(const Camera& camera, const Asset& asset) {
    if (!camera.eye || camera.center) return Done{};
    const std::array<double, 3> target = camera.target ? *camera.target : middle_of(asset);
    const double distance =
        std::hypot((*camera.eye)[0] - target[0], (*camera.eye)[1] - target[1], (*camera.eye)[2] - target[2]);
    if (!(distance <= 1e-9)) return Done{};
    return Error{ErrorCode::invalid_argument,
                 std::string("--eye is the point the camera looks at, ") +
                     (camera.target ? "--target" : "the middle of the asset") + "; two different points work"};
}

// Camera and material are checked as for the shader.
Status check_view(const Arguments& arguments, const Asset& asset, const RenderOptions& options) {
    // A view shows every material; a name that no pattern has is a mistake all the same.
    if (arguments.given("--material"))
        if (const auto found = find_patterned_material(asset, arguments.text("--material")); !found) return found.error();
    return check_camera(options.camera, asset);
}

Result<PictureSize> draw_view(const Arguments& arguments, const Asset& asset, Writer& write) {
    RenderOptions options = render_options(arguments);
    if (const Status checked = check_view(arguments, asset, options); !checked) return checked.error();
    if (const Status read = read_environment(arguments, options); !read) return read.error();
    const auto picture = render_asset(asset, options);
    if (!picture) return picture.error();
    write = [picture = *picture](const std::string& path) { return write_png(path, picture); };
    return PictureSize{options.width, options.height};
}

// What the asset has and the renderer on the CPU does not show, so that nobody takes it for missing; "" when there is nothing.
std::string left_out_of(const Asset& asset) {
    bool textures = false, residual = false;
    for (const MaterialInfo& material : asset.materials) {
        for (const MaterialTexture* texture : {&material.base_color_texture, &material.metallic_roughness_texture, &material.occlusion_texture, &material.emissive_texture})
            textures = textures || texture->image;
        residual = residual || material.residual.width > 0;
    }
    return std::string(textures ? "textures of materials" : "") + (textures && residual ? ", " : "") + (residual ? "residual" : "");
}

bool has_glass(const Asset& asset) {
    return std::any_of(asset.materials.begin(), asset.materials.end(), [](const MaterialInfo& material) { return material.transmission > 0.0f; });
}

// Options about light that is not followed are a mistake.
Status check_ways(const Arguments& arguments, const Asset& asset) {
    if (arguments.given("--passes") && !has_glass(asset))
        return Error{ErrorCode::invalid_argument, "--passes changes nothing: no material of the asset has KHR_materials_transmission"};
    if (!arguments.given("--directions") || arguments.integer("--bounces") > 0 || arguments.text("--environment") != "none" || has_glass(asset)) return Done{};
    return Error{ErrorCode::invalid_argument, "--directions changes nothing without --bounces or --environment; --bounces 1 to 8 works"};
}

Result<PictureSize> draw_reference(const Arguments& arguments, const Asset& asset, std::optional<Field>& said, Writer& write) {
    reference::ReferenceOptions options;
    options.view = render_options(arguments);
    if (const Status checked = check_view(arguments, asset, options.view); !checked) return checked.error();
    if (const Status read = read_environment(arguments, options.view); !read) return read.error();
    options.threads = arguments.integer("--threads");
    options.bounces = arguments.integer("--bounces");
    options.directions = arguments.integer("--directions");
    options.passes = arguments.integer("--passes");
    if (const Status asked = check_ways(arguments, asset); !asked) return asked.error();
    ProgressLine line(arguments);
    options.progress = [&](double done) { line.update("render", done); };
    const auto picture = reference::render_reference(asset, options);
    if (!picture) return picture.error();
    line.finish();
    const auto count = [](long value) { return static_cast<std::int64_t>(value); };
    const std::string left_out = left_out_of(asset);
    std::vector<Field> fields{{"all", "all", count(picture->stats.footprints), ""},
                              {"by_line", "by line sampling", count(picture->stats.by_line), ""},
                              {"by_area", "by area sampling", count(picture->stats.by_area), ""},
                              {"left_out", "left out", left_out, left_out.empty() ? "nothing" : ""}};
    if (has_glass(asset)) fields.push_back({"cut_off", "cut off by --passes", picture->stats.cut_off, percent_text(picture->stats.cut_off)});
    said = group("footprints", "footprints", std::move(fields));
    write = [image = picture->image()](const std::string& path) { return write_png(path, image); };
    return PictureSize{options.view.width, options.view.height};
}

}  // namespace

Backend backend_of(const Arguments& arguments) {
    return arguments.text("--backend") == "egl" ? Backend::egl : Backend::osmesa;
}

void add_renderer(Report& report, const Arguments& arguments) {
    if (arguments.text("--backend") == "reference") {
        report.add({"renderer", "renderer", std::string{"reference, on the CPU"}, ""});
        return;
    }
    // The drawing went well, so that a backend that is not there now is no reason to fail.
    const auto text = describe_backend(backend_of(arguments));
    report.add({"renderer", "renderer", text ? *text : text.error().message, ""});
}

ExitCode run_render(const Arguments& arguments) {
    const bool top = arguments.flag("--top");
    if (const Status checked = check_output(arguments.text("--output"), top); !checked)
        return fail(arguments, ExitCode::usage, checked.error().message);
    const std::string output = arguments.text("--output");
    if (const Status other = check_outputs({{"--output", output, {}}}, {arguments.file}); !other)
        return fail(arguments, ExitCode::usage, other.error().message);
    if (const Status backend = check_backend(arguments); !backend) return fail(arguments, ExitCode::usage, backend.error().message);
    const auto file = read_asset_file(arguments.file, {.pictures = !top});
    if (!file) return fail(arguments, code_for_input(file.error()), file.error().message);
    Writer write;
    std::optional<Field> said;  // what the drawing itself has to say
    const auto size = top ? draw_heights(arguments, file->asset, write)
                          : arguments.text("--backend") == "reference" ? draw_reference(arguments, file->asset, said, write)
                                                                       : draw_view(arguments, file->asset, write);
    if (!size) return fail(arguments, code_for_input(size.error()), size.error().message);

    Report report;
    report.add({"output", "output", arguments.text("--output"), ""});
    report.add_group("pixels", "pixels",
                     {{"width", "width", std::int64_t{size->width}, ""},
                      {"height", "height", std::int64_t{size->height}, ""}});
    add_renderer(report, arguments);
    if (said) report.add(*said);
    return write_and_print(arguments, report, {{"--output", output, write}});
}

}  // namespace burin::cli
