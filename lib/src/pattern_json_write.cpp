#include <burin/pattern_json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <span>

#include "pattern_json_text.hpp"
#include "pattern_text.hpp"

namespace burin {
namespace {

std::string quoted(const std::string& text) { return std::string("\"").append(text).append("\""); }

// One object, written in one line.
class Members {
  public:
    Members& add(const char* name, const std::string& text) {
        text_ += (text_.empty() ? "" : ", ") + quoted(name) + ": " + text;
        return *this;
    }
    Members& add_unusual(const char* name, const std::string& text, const std::string& usual) { return text == usual ? *this : add(name, text); }
    std::string text() const { return std::string("{").append(text_).append("}"); }

  private:
    std::string text_;
};

template <typename Items, typename Text>
std::string list(const Items& items, const Text& text) {
    std::string all;
    for (const auto& item : items) all += (all.empty() ? "" : ", ") + text(item);
    return std::string("[").append(all).append("]");
}

std::string pair_of(double a, double b) { return std::string("[").append(exact(a)).append(", ").append(exact(b)).append("]"); }

// A reader takes the digits for a double and rounds that to a float: not always the one whose shortest digits they are.
std::string exact_float(float value) {
    const std::string text = exact(value);
    double read = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), read);
    return static_cast<float>(read) == value ? text : exact(static_cast<double>(value));
}

std::string coefficients(std::span<const double> numbers) { return list(numbers, [](double c) { return exact(c); }); }

// Two scales for each element, at its ends; nothing when all are 1.
void add_scales(Members& members, const char* name, const Path& path, double Element::*start, double Element::*end) {
    const auto& elements = path.elements;
    const double first = elements.empty() ? 1.0 : elements.front().*start;
    const bool constant = std::all_of(elements.begin(), elements.end(), [&](const Element& e) { return e.*start == first && e.*end == first; });
    if (constant) members.add_unusual(name, exact(first), "1");
    else members.add(name, list(elements, [&](const Element& e) { return pair_of(e.*start, e.*end); }));
}

void add_caps(Members& members, const Path& path) {
    const std::string start = quoted(name_in(kCapNames, path.start_cap)), end = quoted(name_in(kCapNames, path.end_cap));
    if (start == end) members.add_unusual("caps", start, quoted(kCapNames[0]));
    else members.add("caps", list(std::array{start, end}, [](const std::string& name) { return name; }));
}

std::string path_text(const Pattern& pattern, const Path& path) {
    const auto& elements = path.elements;
    const bool returns = !elements.empty() && elements.front().p0 == elements.back().p2;
    Members members;
    members.add("profile", std::to_string(path.profile)).add_unusual("material", std::to_string(path.material), "0");
    members.add_unusual("level", exact(path.level), exact(pattern.outer_level));
    members.add_unusual("join", quoted(name_in(kJoinNames, path.join)), quoted(kJoinNames[0]));
    add_caps(members, path);
    add_scales(members, "width_scale", path, &Element::width0, &Element::width1);
    add_scales(members, "height_scale", path, &Element::height0, &Element::height1);
    if (path.perturbation != kNoPerturbation) members.add("perturbation", std::to_string(path.perturbation));
    // Modulo the tile, where path data has no word for it.
    if (path.closed && !returns) members.add("closed", "true");
    return members.add("d", quoted(path_data_of(elements, path.closed && returns))).text();
}

// A list of the document with an entry per line; nothing when it is empty.
template <typename Text>
std::string section(const char* name, std::size_t first, std::size_t count, const Text& text) {
    std::string all;
    for (std::size_t i = first; i < count; ++i) {
        all += i == first ? ",\n    " + quoted(name) + ": [\n        " : ",\n        ";
        all += text(i);
    }
    return all.empty() ? "" : all.append("\n    ]");
}

}  // namespace

namespace pattern_json {

std::string text_of(const Profile& profile) {
    Members members;
    members.add("points", list(profile.points, [](const ProfilePoint& p) { return pair_of(p.b, p.h); }));
    if (!profile.facets.empty()) members.add("facets", list(profile.facets, [](FacetClass f) { return quoted(name_in(kFacetNames, f)); }));
    return members.text();
}

std::string text_of(const Material& material) {
    Members members;
    if (material.overrides)
        members.add("base_color", list(material.base_color, exact_float))
            .add("metallic", exact_float(material.metallic))
            .add("roughness", exact_float(material.roughness));
    return members.text();
}

std::string text_of(const Perturbation& p) {
    Members members;
    members.add("kind", quoted(name_in(kPerturbationNames, p.kind)));
    if (p.kind == PerturbationKind::polynomial)
        return members.add("width", coefficients(p.width_polynomial)).add("height", coefficients(p.height_polynomial)).text();
    members.add("width", exact(p.width)).add("height", exact(p.height)).add("wavelength", exact(p.wavelength));
    if (p.kind == PerturbationKind::sine) members.add("phase", exact(p.phase));
    else members.add("seed", std::to_string(p.seed)).add("octaves", std::to_string(p.octaves));
    return members.text();
}

}  // namespace pattern_json

std::string write_pattern_json(const Pattern& pattern) {
    using pattern_json::text_of;
    Members frame;
    frame.add("size", pair_of(pattern.size.x, pattern.size.y)).add("depth", exact(pattern.depth)).add("base_offset", exact(pattern.base_offset));
    frame.add("wrap", quoted(name_in(kWrapNames, pattern.wrap))).add("outer_level", exact(pattern.outer_level));
    std::string text = frame.text();
    text.pop_back();
    // Each on a line of its own, as the lists are.
    return text.insert(1, "\n    ") +
           section("profiles", 0, pattern.profiles.size(), [&](std::size_t i) { return text_of(pattern.profiles[i]); }) +
           // Material 0 is the one of the glTF file and needs no words.
           section("materials", 1, pattern.materials.size(), [&](std::size_t i) { return text_of(pattern.materials[i]); }) +
           section("perturbations", 0, pattern.perturbations.size(), [&](std::size_t i) { return text_of(pattern.perturbations[i]); }) +
           section("paths", 0, pattern.paths.size(), [&](std::size_t i) { return path_text(pattern, pattern.paths[i]); }) + "\n}\n";
}

}  // namespace burin
