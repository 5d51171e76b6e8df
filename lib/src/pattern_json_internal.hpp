// Reading of a pattern in JSON, shared by its sources: what is known while a document is read, and the readers of its parts.
//
// Readers follow json_text.hpp: what is wrong is complained of to `Reading::json`, and something harmless is returned.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <burin/json_text.hpp>
#include <burin/path_data.hpp>
#include <burin/pattern.hpp>

namespace burin::pattern_json {

// Metres are number * multiply / divide, rounded once where one of both is 1: 5 mm are the double nearest to 0.005.
struct Unit {
    const char* name;
    double multiply, divide;
    double metres(double number) const { return number * multiply / divide; }
    Vec2 metres(Vec2 p) const { return {metres(p.x), metres(p.y)}; }
};

// Entries of a list of the document have a name or not, and an index; paths may hold such an entry in place of a reference.
struct Entries {
    const char* list;     // "profiles"
    std::size_t count = 0;  // that an index may name
    std::map<std::string, std::uint32_t> names;
    std::map<std::string, std::uint32_t> unlisted;  // by content: equal ones are stored once
};

struct Reading {
    JsonReader& json;
    Pattern pattern;
    Unit plane, height;
    Entries profiles{"profiles"}, materials{"materials"}, perturbations{"perturbations"};
    double tolerance = 0.0;    // of curves that are no quadratics, in the document's unit
    std::size_t elements = 0;  // so far
    std::vector<std::string> sources{};  // of the pattern's paths

    double along(const JsonValue& value, const JsonRange& range = {}) { return plane.metres(json.number(value, range)); }
    double up(const JsonValue& value) { return height.metres(json.number(value)); }
};

inline constexpr JsonRange kPositive{.low = 0.0, .above = true};

// Entries: pattern_json_entries.cpp.
void read_entries(Reading& reading, JsonObject& document);
std::uint32_t read_profile_reference(Reading& reading, const JsonValue& value);
std::uint32_t read_material_reference(Reading& reading, const JsonValue& value);
std::uint32_t read_perturbation_reference(Reading& reading, const JsonValue& value);
// Section of the edge of a region that lies `rise` metres above its surroundings; null: an upright wall.
std::uint32_t read_edge(Reading& reading, const JsonValue& region, const JsonValue* edge, double rise);

// Paths and regions: pattern_json_paths.cpp. `ground`: metres, the level around. `places`: metres, every copy's offset.
void read_paths(Reading& reading, const JsonValue* list, double ground, std::span<const Vec2> places);
void read_regions(Reading& reading, const JsonValue* list, double ground, std::span<const Vec2> places);

// The curves of one property, in metres: pattern_json_outline.cpp.
// Subpaths of path data, without those that draw nothing, or one of a list of points, closed when it ends where it starts. Complains
// when there is none.
std::vector<Subpath> read_curves(Reading& reading, const JsonValue& value);
// The subpaths closed, and turned so that what lies within (by the even-odd rule) is on their right.
void close_outline(Reading& reading, const JsonValue& value, std::vector<Subpath>& subpaths);

}  // namespace burin::pattern_json
