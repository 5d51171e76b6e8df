#include "stroke_file.hpp"

#include <burin/strokes.hpp>

#include "options.hpp"

namespace burin::cli {

Result<PatternFile> read_stroke_file(const Model& model, const Arguments& arguments) {
    const std::string path = arguments.text("--paths-3d");
    const auto strokes = read_strokes(path);
    if (!strokes) return strokes.error();
    StrokeOptions options;
    if (const Status meant = mean_strokes(arguments.text("--stroke"), options); !meant)
        return Error{meant.error().code, "--stroke " + meant.error().message};
    options.attach.material = arguments.text("--material");
    options.max_distance = arguments.number("--max-distance");
    if (arguments.given("--tolerance")) options.tolerance = arguments.number("--tolerance");
    auto made = project_strokes(model, *strokes, options);
    if (!made) return Error{made.error().code, path + ": " + made.error().message};
    return PatternFile{std::move(made->pattern), {}, std::move(made->notes)};
}

}  // namespace burin::cli
