// The table itself. Defaults that a stage defines are taken from its options struct, so that they stand once.
#include <string>

#include <burin/svg.hpp>
#include <burin/vectorize.hpp>

#include <gl/render.hpp>
#include <reference/render.hpp>

#include "options.hpp"

namespace burin::cli {
namespace {

constexpr auto flag = OptionKind::flag;
constexpr auto text = OptionKind::text;
constexpr auto number = OptionKind::number;
constexpr auto integer = OptionKind::integer;
constexpr auto choice = OptionKind::choice;
constexpr auto either = OptionKind::choice_or_integer;
constexpr auto extent = OptionKind::extent;
constexpr auto pixels = OptionKind::pixels;
constexpr auto bytes = OptionKind::bytes;
constexpr auto numbers = OptionKind::numbers;

constexpr double kMostBytes = 1024.0 * 1024.0 * 1024.0;

std::string plain(double value) {
    std::string digits = std::to_string(value);
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
    return digits;
}

std::vector<OptionSpec> make_table() {
    const VectorizeOptions vectorize;
    const RenderOptions render;
    const SvgOptions svg;
    const reference::ReferenceOptions reference;
    const Environment environment;
    const std::string light = plain(render.light.azimuth) + "," + plain(render.light.elevation);
    const std::string depth = plain(vectorize.depth);
    const std::string tolerance = plain(vectorize.tolerance);
    return {
        // name, commands, kind, argument, unit, fallback, low, high, choices, required, help
        {"--output,-o", "convert", text, "OUT.glb", "", "", 0, 0, "", true, "the asset to write"},
        {"--output,-o", "render", text, "PICTURE", "", "", 0, 0, "", true,
         "the picture to write: .png; with --top also .exr or .tif"},
        {"--output,-o", "vectorize", text, "PATHS", "", "", 0, 0, "", true, "the drawing to write: .svg, or .json as pack reads it"},
        {"--output,-o", "pack", text, "OUT.glb", "", "", 0, 0, "", true, "the asset to write"},
        {"--output,-o", "generate", text, "OUT", "", "", 0, 0, "", true, "the asset to write, .glb, or the drawing, .svg, or the pattern, .json"},
        {"--output,-o", "build", text, "OUT.glb", "", "", 0, 0, "", false, "the asset to write, in place of the recipe's output"},
        {"--output,-o", "mesh", text, "MESH.glb", "", "", 0, 0, "", true, "the triangles to write"},
        {"--against", "check", text, "MAP", "", "", 0, 0, "", true, "the height map the asset was made from"},

        {"--set", "generate", text, "NAME=NUMBER,...", "", "", 0, 0, "", false, "parameters of the kind, as listed below, that differ from the usual ones"},
        {"--seed", "generate", integer, "NUMBER", "", "1", 0, 9007199254740992.0, "", false, "where chance starts; equal seeds give equal bytes"},
        {"--profile", "generate", text, "PROFILE", "", "", 0, 0, "", false,
         "cross-section by name, such as vee or 'flat(floor=0.4)' (docs/profiles.md); without it the usual one of the kind"},
        {"--mask", "generate", text, "PICTURE", "", "", 0, 0, "", false,
         "where the surface is worn: white as the density says, black not at all; for scratches, brushed and cracks"},
        {"--size", "generate", extent, "W[xH]", "m", "0.2", 1e-6, 1e6, "", false,
         "extent of the tile along u and v, as high as wide when H is left out; with --model that of a uv unit unless given"},
        {"--wrap", "generate", choice, "WHICH", "", "repeat", 0, 0, "repeat|clamp", false, "whether the pattern tiles"},
        {"--model", "convert pack generate", text, "FILE", "", "", 0, 0, "", false,
         "put the pattern on this glTF, glb or obj; without it, on a rectangle"},
        {"--material", "convert pack generate check mesh", text, "NAME", "", "", 0, 0, "", false,
         "which material, where the file has several"},
        {"--tex-coord", "convert pack generate", integer, "SET", "", "0", 0, 7, "", false, "uv set of the model that the pattern lies in"},
        {"--size", "convert vectorize", extent, "W[xH]", "m", "1", 1e-6, 1e6, "", false,
         "extent of the map along u and v; H follows from the map when left out"},
        {"--size", "pack", extent, "W[xH]", "m", "", 1e-6, 1e6, "", false,
         "extent of the drawing's page along u and v; as the drawing says when left out"},
        {"--depth", "convert vectorize", number, "METRES", "m", depth, 1e-9, 1e5, "", false,
         "height difference between white and black"},
        {"--polarity", "convert vectorize check info", choice, "WHICH", "", "height", 0, 0, "height|depth", false,
         "what white means: height, the surface; depth, the deepest point"},
        {"--channel", "convert vectorize check info", choice, "WHICH", "", "automatic", 0, 0,
         "automatic|red|green|blue|alpha|luminance", false, "which channel of the map holds the heights"},
        {"--wrap", "convert vectorize", choice, "WHICH", "", "automatic", 0, 0, "automatic|repeat|clamp", false,
         "whether the map tiles; automatic looks at its borders"},
        {"--tolerance", "convert vectorize", number, "TEXELS", "texels", tolerance, 0, 8, "", false,
         "farthest a curve may lie from the traced line; 0 chooses by the map's grain"},
        {"--tolerance", "pack", number, "METRES", "m", "", 1e-12, 1e5, "", false,
         "farthest a curve may lie from the drawing's; 5e-5 of the page's longer side when left out"},
        {"--wrap", "pack", choice, "WHICH", "", "", 0, 0, "repeat|clamp", false, "whether the pattern tiles; clamp, or as the file says"},
        {"--stroke", "pack", text, "MEANING", "", svg.stroke, 0, 0, "", false,
         "what strokes mean that nothing else is said of: groove, ridge or none, then a profile, a height and a width if wanted, such as 'ridge bead 0.4mm'"},
        {"--paths-3d", "pack", text, "LINES", "", "", 0, 0, "", false,
         "in place of a drawing: lines in space on --model, .obj, .gltf or .glb, laid onto its surface as --stroke says, with HEIGHT and "
         "WIDTH in metres of the model"},
        {"--max-distance", "pack", number, "METRES", "m", "0", 0, 1e6, "", false,
         "with --paths-3d: farthest that a point may lie from the surface, 0 for a twentieth of the model's size"},
        {"--fill", "pack", text, "MEANING", "", svg.fill, 0, 0, "", false,
         "what fills mean: sunken, plateau, ground or none, then a profile of the edge, a height and the edge's width if wanted"},
        {"--meaning", "pack", text, "NAME=MEANING;...", "", "", 0, 0, "", false,
         "what strokes or fills of a layer, class, id or colour mean, such as 'rivets=plateau bead 1mm; #ff0000=groove 2mm'"},
        {"--text", "pack", text, "WORDS", "", "", 0, 0, "", false, "engrave these words, with the meaning of other strokes; --font says in which letters"},
        {"--font", "pack", text, "FONT.svg", "", "", 0, 0, "", false, "single-stroke font of --text: an SVG font, such as those of Hershey Text"},
        {"--text-path", "pack", text, "ID", "", "", 0, 0, "", false,
         "id of the path that --text runs along, which is then not drawn; else across the middle of the page"},
        {"--text-size", "pack", number, "METRES", "m", "", 1e-9, 1e6, "", false, "size of --text, of an em; a tenth of the page's shorter side when left out"},
        {"--text-width", "pack", number, "METRES", "m", "", 1e-9, 1e6, "", false, "width of the strokes of --text; a twelfth of its size when left out"},
        {"--max-error", "convert vectorize", number, "PERCENT", "% of range", "", 1e-3, 100, "", false,
         "height error that 99.9 % of the texels keep; curves come closer until they do, or an error says what works"},
        {"--max-bytes", "convert", bytes, "BYTES", "bytes", "", 1, kMostBytes, "", false,
         "most that both textures take as uploaded and the residual as stored, K, M and G for KiB, MiB and GiB: paths are "
         "given up until they do, and the residual gets what is left"},
        {"--max-bytes", "vectorize", bytes, "BYTES", "bytes", "", 1, kMostBytes, "", false,
         "most that both textures of convert would take as uploaded, K, M and G for KiB, MiB and GiB: paths are given up until they do"},
        {"--cell-size", "convert pack generate", number, "METRES", "m", "0", 0, 1e6, "", false,
         "side of a grid cell; 0 chooses by a cost model"},
        {"--residual", "convert", either, "WHICH", "texels", "auto", 1, 16777216, "auto|none", false,
         "normal map of what the paths leave out: of a size by its content, none, or at most so many texels"},
        {"--report", "convert vectorize", text, "PAGE.html", "", "", 0, 0, "", false,
         "write a page to look at: map, error, paths, the worst places"},
        {"--error-map", "convert vectorize", text, "PICTURE", "", "", 0, 0, "", false,
         "write the height error: .png in colours, red too high and blue too low; .exr or .tif as numbers"},
        {"--threads", "convert vectorize pack build generate check", integer, "COUNT", "", "0", 0, 256, "", false,
         "threads to work with, 0 for all cores; the result does not depend on it"},

        {"--max-rms", "check", number, "PERCENT", "% of range", "", 0, 100, "", false,
         "end with 1 when the RMS height error is above this"},
        {"--with", "check", choice, "WHICH", "", "truth", 0, 0, "truth|shader", false,
         "who reconstructs the heights: the evaluator of the library, or the shader"},

        {"--tolerance", "mesh", number, "METRES", "m", "0", 0, 1e5, "", false,
         "how far bent paths may lie from the straight pieces that stand for them; 0 is a thousandth of a feature's width"},
        {"--tile", "mesh", flag, "", "", "", 0, 0, "", false,
         "one tile of the pattern, flat and with sides and a bottom, in place of the asset's body"},
        {"--base", "mesh", number, "METRES", "m", "0", 0, 1e5, "", false,
         "with --tile: how far the bottom lies below the deepest point; 0 is half of the depth"},
        {"--open", "mesh", flag, "", "", "", 0, 0, "", false, "with --tile: the surface alone, without sides and bottom"},
        {"--threads", "mesh", integer, "COUNT", "", "0", 0, 256, "", false,
         "threads to work with, 0 for all cores; the result does not depend on it"},

        {"--size", "render", pixels, "W[xH]", "px", plain(render.width), 1, 8192, "", false,
         "size of the picture; H follows when left out"},
        {"--top", "render", flag, "", "", "", 0, 0, "", false,
         "heights of the whole pattern from straight above, 1 the surface and 0 the deepest point"},
        {"--material", "render", text, "NAME", "", "", 0, 0, "", false,
         "whose heights --top draws, where the file has several; a view shows all"},
        {"--azimuth", "render", number, "DEGREES", "deg", plain(render.camera.azimuth), -360, 360, "", false,
         "where the camera stands around the asset, 0 in front"},
        {"--elevation", "render", number, "DEGREES", "deg", plain(render.camera.elevation), -90, 90, "", false,
         "how high the camera stands, 90 straight above"},
        {"--zoom", "render", number, "FACTOR", "", plain(render.camera.zoom), 0.01, 10000, "", false,
         "1 shows all of it, 8 an eighth of the width"},
        {"--center", "render", numbers, "U,V", "uv", "", -1000, 1000, "", false,
         "point of the pattern that the camera looks at"},
        {"--fov", "render", number, "DEGREES", "deg", plain(render.camera.field_of_view), 1, 120, "", false,
         "vertical angle of view"},
        {"--orthographic", "render", flag, "", "", "", 0, 0, "", false, "parallel lines of sight"},
        {"--eye", "render", numbers, "X,Y,Z", "m", "", -1e9, 1e9, "", false,
         "camera's place; replaces azimuth, elevation and zoom"},
        {"--target", "render", numbers, "X,Y,Z", "m", "", -1e9, 1e9, "", false, "point the camera looks at"},
        {"--light", "render", numbers, "AZIMUTH,ELEVATION", "deg", light, -360, 360, "", false,
         "direction the light comes from"},
        {"--light-strength", "render", number, "FACTOR", "", plain(render.light.strength), 0, 1000, "", false,
         "of the directional light; 0 leaves all to the environment"},
        {"--environment", "render", text, "WHICH", "", "none", 0, 0, "", false,
         "light from all around: none, a soft surround; room, a grey room; or an equirectangular picture, .hdr or .exr"},
        {"--environment-rotation", "render", number, "DEGREES", "deg", plain(environment.rotation), -360, 360, "", false,
         "turns the environment about the vertical, as azimuths grow"},
        {"--environment-strength", "render", number, "FACTOR", "", plain(environment.strength), 0, 1000, "", false,
         "makes the environment brighter or darker"},
        {"--no-shadows", "render", flag, "", "", "", 0, 0, "", false, "leave shadows out"},
        {"--correct-depth", "render", flag, "", "", "", 0, 0, "", false,
         "other meshes are hidden by the relief and not by the mesh that carries it"},
        {"--samples", "render", integer, "COUNT", "", plain(render.samples), 1, 256, "", false,
         "samples per pixel, rounded up to a square number (2 stays 2); with --antialiasing points four unless given"},
        {"--antialiasing", "render", choice, "WHICH", "", "regions", 0, 0, "regions|points", false,
         "filter features as areas, by rays where they meet; or by rays alone"},
        {"--rays", "render", integer, "COUNT", "", plain(render.rays), 4, 64, "", false,
         "rays per sample where features meet in a pixel"},
        {"--backend", "render", choice, "WHICH", "", "osmesa", 0, 0, "osmesa|egl|reference", false,
         "OpenGL by OSMesa, which needs no GPU, or by EGL; or the accurate renderer on the CPU, without OpenGL"},
        {"--backend", "check", choice, "WHICH", "", "osmesa", 0, 0, "osmesa|egl", false, "OpenGL by OSMesa, which needs no GPU, or by EGL"},
        {"--bounces", "render", integer, "COUNT", "", plain(reference.bounces), 0, 8, "", false,
         "with --backend reference: light by way of so many facets; grooves mirror and brighten themselves"},
        {"--directions", "render", integer, "COUNT", "", plain(reference.directions), 1, 1024, "", false,
         "with --bounces or --environment: directions followed from each facet that is no mirror"},
        {"--passes", "render", integer, "COUNT", "", plain(reference.passes), 2, 32, "", false,
         "with --backend reference: facets of glass that light passes or is mirrored by, one after the other"},
        {"--threads", "render", integer, "COUNT", "", "0", 0, 256, "", false,
         "threads of --backend reference, 0 for all cores; the picture does not depend on it"},

        {"--format", "convert vectorize pack build generate render check info validate mesh", choice, "WHICH", "", "text", 0, 0, "text|json", false,
         "how results are printed"},
        {"--quiet,-q", "convert vectorize pack build generate render check info validate mesh", flag, "", "", "", 0, 0, "", false,
         "no progress and no text; errors and json stay"},
    };
}

}  // namespace

const std::vector<OptionSpec>& option_table() {
    static const std::vector<OptionSpec> table = make_table();
    return table;
}

const std::vector<OptionConflict>& option_conflicts() {
    static const std::vector<OptionConflict> table = {
        {"render", "--azimuth --elevation --zoom --center --fov --orthographic --eye --target --light --light-strength --environment "
         "--environment-rotation --environment-strength --no-shadows --correct-depth",
         "--top",
         "heights have neither camera nor light; --size, --samples, --material and --backend go with --top, and without "
         "--top all of them do"},
        {"render", "--azimuth --elevation --zoom", "--eye",
         "the eye is the camera's place; --target, --center and --fov go with it"},
        {"mesh", "--base", "--open", "an open tile has no bottom; without --open it has"},
        {"pack", "--size --wrap --fill --meaning", "--paths-3d", "they belong to drawings; the model says how large uv is and whether it tiles"},
        {"render", "--center", "--target", "both name the point the camera looks at; one of them works"},
        {"render", "--fov", "--orthographic", "parallel lines of sight have no angle; --zoom works"},
    };
    return table;
}

}  // namespace burin::cli
