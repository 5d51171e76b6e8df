// Paths and regions: the document's words to elements, scales and levels.
#include <algorithm>
#include <array>
#include <cmath>

#include <burin/pattern_json.hpp>

#include "pattern_json_internal.hpp"
#include "pattern_text.hpp"

namespace burin::pattern_json {
namespace {

constexpr JsonRange kScale{.low = 0.0, .high = 4.0, .below = true};

// About the arc length: between chord and control polygon.
double length_of(const Element& e) {
    const double chord = length(e.p2 - e.p0);
    if (e.kind == ElementKind::line) return chord;
    return (2.0 * chord + length(e.p1 - e.p0) + length(e.p2 - e.p1)) / 3.0;
}

// Scales at the ends of an element, as members to be set.
struct ScaleEnds {
    double Element::*start;
    double Element::*end;
};

// A scale at each node, and so at both elements that meet there.
void set_nodes(Path& path, ScaleEnds ends, const std::vector<double>& nodes) {
    for (std::size_t i = 0; i < path.elements.size(); ++i) path.elements[i].*ends.start = nodes[i], path.elements[i].*ends.end = nodes[i + 1];
}

// From `first` to `last`, in step with the length run through.
std::vector<double> ramp(const Path& path, double first, double last) {
    std::vector<double> lengths{0.0}, nodes;
    for (const Element& e : path.elements) lengths.push_back(lengths.back() + length_of(e));
    for (const double at : lengths) nodes.push_back(at <= 0.0 ? first : at >= lengths.back() ? last : first + (last - first) * (at / lengths.back()));
    return nodes;
}

void read_scale(Reading& reading, const JsonValue* value, Path& path, ScaleEnds ends) {
    if (value == nullptr) return;
    JsonReader& json = reading.json;
    const std::size_t count = path.elements.size();
    if (value->is_number()) return set_nodes(path, ends, std::vector<double>(count + 1, json.number(*value, kScale)));
    const auto list = json.list(*value, 1, std::size_t(-1));
    const bool pairs = !list.empty() && list.front().is_list();
    if (list.empty() || list.size() != (pairs ? count : count + 1)) {
        if (!pairs && list.size() == 2) return set_nodes(path, ends, ramp(path, json.number(list[0], kScale), json.number(list[1], kScale)));
        return json.refuse(*value, shown(*value) + " for " + std::to_string(count) + " elements; one number, [start, end], " + std::to_string(count + 1) +
                                       " numbers (one at each node) or " + std::to_string(count) + " pairs (one for each element) work");
    }
    if (pairs) {
        for (std::size_t i = 0; i < count; ++i) {
            const Vec2 both = json.pair(list[i], kScale);
            path.elements[i].*ends.start = both.x, path.elements[i].*ends.end = both.y;
        }
        return;
    }
    std::vector<double> nodes;
    for (const JsonValue& node : list) nodes.push_back(json.number(node, kScale));
    set_nodes(path, ends, nodes);
}

// Closed as the curve is, unless `closed` says otherwise; where it says so, a line leads back, if one is missing. In a pattern that
// repeats, the start of another tile is as good.
void read_closed(Reading& reading, const JsonValue* value, Path& path) {
    const Vec2 size = reading.pattern.size, start = path.elements.front().p0, end = path.elements.back().p2;
    if (value != nullptr) path.closed = reading.json.boolean(*value);
    if (!path.closed || start == end) return;
    Vec2 gap = end - start;
    if (reading.pattern.wrap == Wrap::repeat) gap = gap - Vec2{std::round(gap.x / size.x) * size.x, std::round(gap.y / size.y) * size.y};
    if (length(gap) > 1e-6 * std::max(size.x, size.y)) path.elements.push_back({ElementKind::line, end, lerp(end, start, 0.5), start});
}

void read_caps(Reading& reading, const JsonValue* value, Path& path) {
    if (value == nullptr) return;
    const auto cap = [&](const JsonValue& name) { return static_cast<CapKind>(reading.json.choice(name, kCapNames)); };
    if (!value->is_list()) {
        path.start_cap = path.end_cap = cap(*value);
        return;
    }
    const auto both = reading.json.list(*value, 2, 2);
    if (!both.empty()) path.start_cap = cap(both[0]), path.end_cap = cap(both[1]);
}

// What paths and regions have in common.
void read_look(Reading& reading, JsonObject& object, Path& path) {
    if (const JsonValue* name = object.find("name")) reading.json.text(*name);
    if (const JsonValue* material = object.find("material")) path.material = read_material_reference(reading, *material);
    if (const JsonValue* join = object.find("join")) path.join = static_cast<JoinKind>(reading.json.choice(*join, kJoinNames));
    if (const JsonValue* function = object.find("perturbation")) path.perturbation = read_perturbation_reference(reading, *function);
}

// Offsets in metres: those of a list, or of rows and columns.
std::vector<Vec2> read_offsets(Reading& reading, const JsonValue& value) {
    JsonReader& json = reading.json;
    std::vector<Vec2> offsets;
    if (value.is_list()) {
        for (const JsonValue& at : json.list(value, 1, kMaxPatternJsonElements)) offsets.push_back(reading.plane.metres(json.pair(at)));
        return offsets;
    }
    if (!value.is_object()) return json.expect(value, "a list of points, or an object with start, step and count,"), offsets;
    JsonObject object(json, value);
    const JsonValue* start = object.find("start");
    const JsonValue* step = object.need("step");
    const JsonValue* count = object.need("count");
    object.finish();
    if (json.failed()) return offsets;
    const Vec2 first = start != nullptr ? json.pair(*start) : Vec2{}, pitch = json.pair(*step);
    const auto counts = json.list(*count, 2, 2);
    const int columns = counts.empty() ? 0 : json.integer(counts[0], 1, 1024), rows = counts.empty() ? 0 : json.integer(counts[1], 1, 1024);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) offsets.push_back(reading.plane.metres(first + Vec2{pitch.x * i, pitch.y * j}));
    return offsets;
}

// Copies of copies, as far as the limit allows.
std::vector<Vec2> read_places(Reading& reading, const JsonValue* value, std::span<const Vec2> around) {
    std::vector<Vec2> places(around.begin(), around.end());
    if (value == nullptr || reading.json.failed()) return places;
    const std::vector<Vec2> offsets = read_offsets(reading, *value);
    if (offsets.size() * around.size() > kMaxPatternJsonElements) {
        reading.json.refuse(*value, std::to_string(offsets.size() * around.size()) + " copies, limit " + std::to_string(kMaxPatternJsonElements),
                            ErrorCode::limit_exceeded);
        return places;
    }
    places.clear();
    for (const Vec2 place : around)
        for (const Vec2 offset : offsets) places.push_back(place + offset);
    return places;
}

std::string source_of(const JsonValue& value) {
    std::string source = "line " + std::to_string(value.line);
    if (const auto* members = std::get_if<JsonValue::Object>(&value.data))
        for (const JsonMember& member : *members)
            if (member.name == "name" && member.value.is_text()) source += ", '" + std::get<std::string>(member.value.data) + "'";
    return source;
}

void add_copies(Reading& reading, const JsonValue& value, const Path& path, std::span<const Vec2> places) {
    if (reading.json.failed()) return;
    reading.elements += path.elements.size() * places.size();
    if (reading.elements > kMaxPatternJsonElements)
        return reading.json.refuse(value, std::to_string(reading.elements) + " elements up to here, limit " + std::to_string(kMaxPatternJsonElements),
                                   ErrorCode::limit_exceeded);
    reading.sources.insert(reading.sources.end(), places.size(), source_of(value));
    for (const Vec2 place : places) {
        Path& copy = reading.pattern.paths.emplace_back(path);
        for (Element& e : copy.elements) e.p0 = e.p0 + place, e.p1 = e.p1 + place, e.p2 = e.p2 + place;
    }
}

void read_path(Reading& reading, const JsonValue& value, double ground, std::span<const Vec2> around) {
    JsonReader& json = reading.json;
    JsonObject object(json, value);
    Path path;
    path.level = ground;
    read_look(reading, object, path);
    if (const JsonValue* profile = object.need("profile")) path.profile = read_profile_reference(reading, *profile);
    if (const JsonValue* level = object.find("level")) path.level = reading.up(*level);
    read_caps(reading, object.find("caps"), path);
    const JsonValue* data = object.find("d");
    const JsonValue* points = object.find("points");
    const JsonValue* widths = object.find("width_scale");
    const JsonValue* heights = object.find("height_scale");
    const JsonValue* closed = object.find("closed");
    const std::vector<Vec2> places = read_places(reading, object.find("at"), around);
    object.finish();
    if ((data != nullptr) == (points != nullptr)) json.refuse(value, "either \"d\" (path data) or \"points\" says where the path runs; one of them works");
    if (json.failed()) return;
    if (data != nullptr && !data->is_text()) return json.expect(*data, "path data as in SVG");
    if (points != nullptr && !points->is_list()) return json.expect(*points, "a list of points");
    for (Subpath& subpath : read_curves(reading, data != nullptr ? *data : *points)) {
        Path one = path;
        one.elements = std::move(subpath.elements);
        one.closed = subpath.closed;
        read_closed(reading, closed, one);
        read_scale(reading, widths, one, {&Element::width0, &Element::width1});
        read_scale(reading, heights, one, {&Element::height0, &Element::height1});
        add_copies(reading, value, one, places);
    }
}

void read_region(Reading& reading, const JsonValue& value, double ground, std::span<const Vec2> around) {
    JsonReader& json = reading.json;
    JsonObject object(json, value);
    Path edge;
    edge.closed = true;
    edge.level = ground;
    read_look(reading, object, edge);
    const JsonValue* outline = object.need("outline");
    const JsonValue* level = object.need("level");
    const JsonValue* section = object.find("edge");
    const JsonValue* paths = object.find("paths");
    const JsonValue* regions = object.find("regions");
    const std::vector<Vec2> places = read_places(reading, object.find("at"), around);
    object.finish();
    if (json.failed()) return;
    const double own = reading.up(*level);
    if (own == ground) json.refuse(*level, "the region is as high as the ground around it, so that it has no edge; another level works");
    edge.profile = read_edge(reading, value, section, own - ground);
    auto subpaths = read_curves(reading, *outline);
    if (!json.failed()) close_outline(reading, *outline, subpaths);
    for (Subpath& subpath : subpaths) {
        edge.elements = std::move(subpath.elements);
        add_copies(reading, value, edge, places);
    }
    read_paths(reading, paths, own, places);
    read_regions(reading, regions, own, places);
}

using ReadOne = void (*)(Reading&, const JsonValue&, double, std::span<const Vec2>);

void read_all(Reading& reading, const JsonValue* list, double ground, std::span<const Vec2> places, ReadOne read) {
    if (list == nullptr) return;
    for (const JsonValue& value : reading.json.list(*list, 0, std::size_t(-1))) {
        if (reading.json.failed()) return;
        read(reading, value, ground, places);
    }
}

}  // namespace

void read_paths(Reading& reading, const JsonValue* list, double ground, std::span<const Vec2> places) {
    read_all(reading, list, ground, places, read_path);
}

void read_regions(Reading& reading, const JsonValue* list, double ground, std::span<const Vec2> places) {
    read_all(reading, list, ground, places, read_region);
}

}  // namespace burin::pattern_json
