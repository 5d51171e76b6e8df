#include "pattern_file.hpp"

#include <algorithm>
#include <fstream>
#include <string_view>

#include <burin/image_io.hpp>
#include <burin/json_text.hpp>
#include <burin/pattern_json.hpp>
#include <burin/svg.hpp>

#include "options.hpp"
#include "output_file.hpp"

namespace burin::cli {
namespace {

SvgOptions svg_options(const Arguments& arguments) {
    SvgOptions options;
    if (arguments.given("--size")) {
        const auto sides = arguments.numbers("--size");
        options.width = sides[0];
        if (sides.size() > 1) options.height = sides[1];
    }
    if (arguments.given("--tolerance")) options.tolerance = arguments.number("--tolerance");
    if (arguments.given("--wrap")) options.wrap = arguments.text("--wrap") == "repeat" ? Wrap::repeat : Wrap::clamp;
    options.stroke = arguments.text("--stroke");
    options.fill = arguments.text("--fill");
    options.threads = arguments.integer("--threads");
    return options;
}

// NAME=MEANING, more of them parted by semicolons.
Result<std::vector<std::pair<std::string, std::string>>> rules_of(const std::string& text) {
    std::vector<std::pair<std::string, std::string>> rules;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find(';', at), text.size());
        const std::string one = text.substr(at, end - at);
        const std::size_t equal = one.find('=');
        if (equal == std::string::npos || equal == 0)
            return Error{ErrorCode::invalid_argument, "--meaning '" + one + "' is not NAME=MEANING, such as 'Panel lines=groove vee 0.5mm'"};
        rules.emplace_back(one.substr(0, equal), one.substr(equal + 1));
        at = end + 1;
    }
    return rules;
}

Result<SvgText> text_of(const Arguments& arguments) {
    SvgText text;
    for (const char* option : {"--font", "--text-path", "--text-size", "--text-width"})
        if (arguments.given(option) && !arguments.given("--text"))
            return Error{ErrorCode::invalid_argument, std::string(option) + " says how --text is engraved, which is not given"};
    if (!arguments.given("--text")) return text;
    if (!arguments.given("--font")) return Error{ErrorCode::invalid_argument, "--text needs --font, an SVG font of single strokes"};
    const auto font = read_file(arguments.text("--font"), kMaxSvgBytes);
    if (!font) return font.error();
    text.words = arguments.text("--text");
    text.font.assign(font->begin(), font->end());
    text.path = arguments.text("--text-path");
    if (arguments.given("--text-size")) text.size = arguments.number("--text-size");
    if (arguments.given("--text-width")) text.width = arguments.number("--text-width");
    return text;
}

// By the first letter, past a byte order mark and spaces.
bool begins_with(std::string_view text, char letter) {
    const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
    return first != std::string_view::npos && text[first] == letter;
}

Result<PatternFile> read_drawing(std::string_view text, const std::string& path, const Arguments& arguments) {
    SvgOptions options = svg_options(arguments);
    auto rules = rules_of(arguments.text("--meaning"));
    if (!rules) return rules.error();
    options.rules = std::move(*rules);
    auto words = text_of(arguments);
    if (!words) return words.error();
    options.text = std::move(*words);
    auto drawing = read_svg(text, options);
    if (!drawing) return Error{drawing.error().code, path + ": " + drawing.error().message};
    return PatternFile{std::move(drawing->pattern), std::move(drawing->sources), std::move(drawing->notes)};
}

// A pattern in JSON says itself what the options of drawings say.
Result<PatternFile> read_json(std::string_view text, const std::string& path, const Arguments& arguments) {
    for (const char* option : {"--size", "--tolerance", "--wrap", "--stroke", "--fill", "--meaning", "--text", "--font", "--text-path",
                               "--text-size", "--text-width"})
        if (arguments.given(option))
            return Error{ErrorCode::invalid_argument, std::string(option) + " is for drawings in SVG; '" + path + "' is JSON and says it itself"};
    std::vector<std::string> sources;
    auto pattern = read_pattern_json(text, path, &sources);
    if (!pattern) return pattern.error();
    return PatternFile{std::move(*pattern), std::move(sources), {}};
}

}  // namespace

bool looks_like_drawing(const std::string& path) {
    if (has_suffix(path, "json|svg")) return true;
    std::ifstream file(path, std::ios::binary);
    char start[256];
    file.read(start, sizeof start);
    const std::string_view text(start, static_cast<std::size_t>(file.gcount()));
    return begins_with(text, '{') || begins_with(text, '<');
}

Result<PatternFile> read_pattern_file(const std::string& path, const Arguments& arguments) {
    const auto bytes = read_file(path, std::max<std::uint64_t>(kMaxSvgBytes, kMaxJsonTextBytes));
    if (!bytes) return bytes.error();
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    if (has_suffix(path, "json") || begins_with(text, '{')) return read_json(text, path, arguments);
    if (has_suffix(path, "svg") || text.find("<svg") != std::string_view::npos) return read_drawing(text, path, arguments);
    return Error{ErrorCode::unsupported, "'" + path + "' is no drawing that is known; an SVG file or a pattern in JSON works"};
}

}  // namespace burin::cli
