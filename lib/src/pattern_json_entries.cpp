// Profiles, materials and perturbations, in lists of the document or where they are used.
#include <algorithm>
#include <cmath>
#include <functional>

#include <layout.h>

#include <burin/profiles.hpp>

#include "pattern_json_internal.hpp"
#include "pattern_json_text.hpp"
#include "pattern_text.hpp"

namespace burin::pattern_json {
namespace {

// ---- one entry each; `object` has been asked for its name already

std::vector<FacetClass> read_facets(Reading& reading, const JsonValue* value, std::size_t count) {
    std::vector<FacetClass> facets;
    if (value == nullptr) return facets;
    for (const JsonValue& facet : reading.json.list(*value, count, count))
        facets.push_back(static_cast<FacetClass>(reading.json.choice(facet, kFacetNames)));
    return facets;
}

Profile read_section(Reading& reading, const JsonValue& points, JsonObject& object) {
    Profile profile;
    for (const JsonValue& point : reading.json.list(points, 2, BURIN_MAX_PROFILE_POINTS)) {
        const Vec2 p = reading.json.pair(point);
        profile.points.push_back({reading.plane.metres(p.x), reading.height.metres(p.y)});
    }
    profile.facets = read_facets(reading, object.find("facets"), std::max<std::size_t>(profile.points.size(), 1) - 1);
    return profile;
}

ProfileSpec read_shape(Reading& reading, const JsonValue& value) {
    const auto spec = parse_profile(reading.json.text(value));
    if (spec) return *spec;
    if (value.is_text()) reading.json.refuse(value, spec.error().message);
    return {};
}

// What the library makes of it, or its complaint.
Profile keep(Reading& reading, const JsonValue& value, const Result<Profile>& made) {
    if (made) return *made;
    reading.json.refuse(value, made.error().message);
    return {};
}

Profile read_profile(Reading& reading, const JsonValue& value, JsonObject& object) {
    const JsonValue* points = object.find("points");
    const JsonValue* shape = object.find("shape");
    const JsonValue* step = object.find("step");
    if ((points != nullptr) + (shape != nullptr) + (step != nullptr) != 1) {
        reading.json.refuse(value, "one of \"points\", \"shape\" and \"step\" says what the section is; no more and no less works");
        return {};
    }
    if (points != nullptr) return read_section(reading, *points, object);
    const JsonValue* width = object.need("width");
    const JsonValue* height = object.need("height");
    if (width == nullptr || height == nullptr) return {};
    const double metres = reading.along(*width, {.low = 0.0, .above = step == nullptr}), up = reading.up(*height);
    const ProfileSpec spec = read_shape(reading, step != nullptr ? *step : *shape);
    if (up == 0.0) reading.json.refuse(*height, "a height of 0 is no relief; above or below 0 works");
    if (reading.json.failed()) return {};
    return keep(reading, value, step != nullptr ? make_step_profile(spec, metres, up) : make_profile(spec, metres, up));
}

Material read_material(Reading& reading, const JsonValue&, JsonObject& object) {
    constexpr JsonRange share{0.0, 1.0};
    Material material;
    const auto take = [&](const char* name, float& into) {
        if (const JsonValue* value = object.find(name)) into = static_cast<float>(reading.json.number(*value, share)), material.overrides = true;
    };
    if (const JsonValue* color = object.find("base_color")) {
        const auto channels = reading.json.list(*color, 3, 4);
        for (std::size_t i = 0; i < channels.size(); ++i) material.base_color[i] = static_cast<float>(reading.json.number(channels[i], share));
        material.overrides = true;
    }
    take("metallic", material.metallic);
    take("roughness", material.roughness);
    return material;
}

void read_polynomial(Reading& reading, const JsonValue* value, double (&coefficients)[4]) {
    if (value == nullptr) return;
    const auto numbers = reading.json.list(*value, 1, 4);
    std::fill(std::begin(coefficients), std::end(coefficients), 0.0);
    for (std::size_t i = 0; i < numbers.size(); ++i) coefficients[i] = reading.json.number(numbers[i]);
}

Perturbation read_perturbation(Reading& reading, const JsonValue&, JsonObject& object) {
    constexpr JsonRange amplitude{-1.0, 1.0};
    JsonReader& json = reading.json;
    Perturbation p;
    const JsonValue* kind = object.need("kind");
    if (kind == nullptr) return p;
    p.kind = static_cast<PerturbationKind>(json.choice(*kind, kPerturbationNames));
    const JsonValue* width = object.find("width");
    const JsonValue* height = object.find("height");
    if (p.kind == PerturbationKind::polynomial) {
        read_polynomial(reading, width, p.width_polynomial);
        read_polynomial(reading, height, p.height_polynomial);
        return p;
    }
    if (width != nullptr) p.width = json.number(*width, amplitude);
    if (height != nullptr) p.height = json.number(*height, amplitude);
    if (const JsonValue* wavelength = object.need("wavelength")) p.wavelength = reading.along(*wavelength, kPositive);
    if (p.kind == PerturbationKind::sine) {
        if (const JsonValue* phase = object.find("phase")) p.phase = json.number(*phase);
        return p;
    }
    if (const JsonValue* seed = object.find("seed")) p.seed = json.whole(*seed);
    if (const JsonValue* octaves = object.find("octaves")) p.octaves = json.integer(*octaves, 1, BURIN_MAX_OCTAVES);
    return p;
}

// ---- lists and references

template <typename Item>
using EntryReader = Item (*)(Reading&, const JsonValue&, JsonObject&);

template <typename Item>
void read_list(Reading& reading, JsonObject& document, Entries& entries, std::vector<Item>& items, EntryReader<Item> read) {
    if (const JsonValue* list = document.find(entries.list)) {
        for (const JsonValue& value : reading.json.list(*list, 0, std::size_t(-1))) {
            JsonObject object(reading.json, value);
            const JsonValue* name = object.find("name");
            items.push_back(read(reading, value, object));
            object.finish();
            if (name != nullptr && !entries.names.emplace(reading.json.text(*name), items.size() - 1).second)
                reading.json.refuse(*name, shown(*name) + " names an entry before it in \"" + entries.list + "\"; another name works");
            if (reading.json.failed()) return;
        }
    }
    entries.count = items.size();
}

std::string unknown_name(const Entries& entries, const JsonValue& value, const std::string& name) {
    std::vector<std::string> names;
    for (const auto& [known, index] : entries.names) names.push_back(known);
    const std::string near = nearest_name(name, names), said = shown(value) + " is no name in \"" + entries.list + "\"";
    if (!near.empty()) return said + "; did you mean \"" + near + "\"?";
    if (names.empty()) return said + ", which has no names";
    std::string all;
    for (std::size_t i = 0; i < names.size() && i < 8; ++i) all += (i == 0 ? "" : ", ") + names[i];
    return said + ", which has " + all + (names.size() > 8 ? " and others" : "");
}

template <typename Item>
std::uint32_t share(Entries& entries, std::vector<Item>& items, const Item& item) {
    const auto [at, is_new] = entries.unlisted.emplace(text_of(item), items.size());
    if (is_new) items.push_back(item);
    return at->second;
}

template <typename Item>
std::uint32_t refer(Reading& reading, const JsonValue& value, Entries& entries, std::vector<Item>& items, EntryReader<Item> read) {
    JsonReader& json = reading.json;
    if (const auto* name = std::get_if<std::string>(&value.data)) {
        const auto found = entries.names.find(*name);
        if (found != entries.names.end()) return found->second;
        json.refuse(value, unknown_name(entries, value, *name));
    } else if (value.is_object()) {
        JsonObject object(json, value);
        if (const JsonValue* own_name = object.find("name")) json.text(*own_name);
        const Item item = read(reading, value, object);
        object.finish();
        return json.failed() ? 0 : share(entries, items, item);
    } else if (value.is_number() && entries.count > 0) {
        return static_cast<std::uint32_t>(json.integer(value, 0, static_cast<int>(entries.count) - 1));
    } else {
        json.expect(value, std::string("a name or an index of \"") + entries.list + "\", or an object as there,");
    }
    return 0;
}

}  // namespace

void read_entries(Reading& reading, JsonObject& document) {
    read_list<Profile>(reading, document, reading.profiles, reading.pattern.profiles, read_profile);
    read_list<Material>(reading, document, reading.materials, reading.pattern.materials, read_material);
    read_list<Perturbation>(reading, document, reading.perturbations, reading.pattern.perturbations, read_perturbation);
}

std::uint32_t read_profile_reference(Reading& reading, const JsonValue& value) {
    const auto* name = std::get_if<std::string>(&value.data);
    // The library's names are shapes without a size yet.
    if (name != nullptr && reading.profiles.names.count(*name) == 0 && parse_profile(*name))
        reading.json.refuse(value, shown(value) + " is a shape and no name in \"profiles\"; {\"shape\": " + shown(value) +
                                       ", \"width\": 2, \"height\": -1} works, with sizes of your own");
    return refer<Profile>(reading, value, reading.profiles, reading.pattern.profiles, read_profile);
}

std::uint32_t read_material_reference(Reading& reading, const JsonValue& value) {
    return refer<Material>(reading, value, reading.materials, reading.pattern.materials, read_material);
}

std::uint32_t read_perturbation_reference(Reading& reading, const JsonValue& value) {
    return refer<Perturbation>(reading, value, reading.perturbations, reading.pattern.perturbations, read_perturbation);
}

std::uint32_t read_edge(Reading& reading, const JsonValue& region, const JsonValue* edge, double rise) {
    JsonReader& json = reading.json;
    if (json.failed()) return 0;
    Profile profile;
    if (edge == nullptr || edge->is_number()) {
        const double width = edge == nullptr ? 0.0 : reading.along(*edge, {.low = 0.0});
        profile = keep(reading, edge == nullptr ? region : *edge, make_step_profile({}, width, rise));
    } else {
        JsonObject object(json, *edge);
        if (const JsonValue* points = object.find("points")) {
            profile = read_section(reading, *points, object);
            const double own = profile.points.empty() ? rise : profile.points.back().h - profile.points.front().h;
            if (std::abs(own - rise) > reading.pattern.depth / 4096.0)
                json.refuse(*points, "the section rises by " + exact(own) + " m from its first to its last point, and the region by " + exact(rise) + " m");
        } else {
            const JsonValue* shape = object.need("shape");
            const JsonValue* width = object.need("width");
            if (shape != nullptr && width != nullptr)
                profile = keep(reading, *edge, make_step_profile(read_shape(reading, *shape), reading.along(*width, {.low = 0.0}), rise));
        }
        object.finish();
    }
    return json.failed() ? 0 : share(reading.profiles, reading.pattern.profiles, profile);
}

}  // namespace burin::pattern_json
