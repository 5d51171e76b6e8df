#include <burin/pattern_json.hpp>

#include <algorithm>
#include <array>

#include "pattern_json_internal.hpp"
#include "pattern_text.hpp"

namespace burin {
namespace pattern_json {
namespace {

constexpr std::array kUnits{Unit{"m", 1, 1}, Unit{"cm", 1, 100}, Unit{"mm", 1, 1e3}, Unit{"um", 1, 1e6}, Unit{"in", 254, 1e4}};

// Cubics and arcs stay within the larger side of the pattern, divided by this.
constexpr double kCurvesPerSide = 1e5;

Unit read_unit(JsonReader& json, const JsonValue& value) {
    std::array<const char*, kUnits.size()> names{};
    for (std::size_t i = 0; i < names.size(); ++i) names[i] = kUnits[i].name;
    return kUnits[json.choice(value, names)];
}

// One unit for all lengths, or one in the plane and one for heights.
void read_units(Reading& reading, const JsonValue* value) {
    if (value == nullptr) return;
    if (!value->is_object()) {
        reading.plane = reading.height = read_unit(reading.json, *value);
        return;
    }
    JsonObject units(reading.json, *value);
    if (const JsonValue* plane = units.need("plane")) reading.plane = read_unit(reading.json, *plane);
    if (const JsonValue* height = units.need("height")) reading.height = read_unit(reading.json, *height);
    units.finish();
}

void read_frame(Reading& reading, JsonObject& document) {
    Pattern& pattern = reading.pattern;
    JsonReader& json = reading.json;
    if (const JsonValue* schema = document.find("$schema")) json.text(*schema);
    read_units(reading, document.find("units"));
    if (const JsonValue* size = document.need("size"))
        pattern.size = size->is_number() ? Vec2{1, 1} * reading.along(*size, kPositive) : reading.plane.metres(json.pair(*size, kPositive));
    reading.tolerance = std::max(pattern.size.x, pattern.size.y) * reading.plane.divide / reading.plane.multiply / kCurvesPerSide;
    if (const JsonValue* tolerance = document.find("tolerance")) reading.tolerance = json.number(*tolerance, kPositive);
    if (const JsonValue* depth = document.need("depth")) pattern.depth = reading.height.metres(json.number(*depth, kPositive));
    if (const JsonValue* offset = document.find("base_offset")) pattern.base_offset = reading.height.metres(json.number(*offset, {.low = 0.0}));
    if (const JsonValue* wrap = document.find("wrap")) pattern.wrap = static_cast<Wrap>(json.choice(*wrap, kWrapNames));
    if (const JsonValue* level = document.find("outer_level")) pattern.outer_level = reading.up(*level);
}

}  // namespace
}  // namespace pattern_json

Result<Pattern> read_pattern_json(std::string_view text, const std::string& name, std::vector<std::string>* sources) {
    const auto root = parse_json_text(text, name);
    if (!root) return root.error();
    JsonReader json(*root, name);
    pattern_json::Reading reading{.json = json, .pattern = {}, .plane = pattern_json::kUnits[0], .height = pattern_json::kUnits[0]};
    JsonObject document(json, *root);
    pattern_json::read_frame(reading, document);
    pattern_json::read_entries(reading, document);
    const Vec2 once[] = {{0.0, 0.0}};
    pattern_json::read_paths(reading, document.find("paths"), reading.pattern.outer_level, once);
    pattern_json::read_regions(reading, document.find("regions"), reading.pattern.outer_level, once);
    document.finish();
    if (json.failed()) return json.error();
    if (sources != nullptr) *sources = std::move(reading.sources);
    return std::move(reading.pattern);
}

}  // namespace burin
