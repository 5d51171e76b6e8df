#include <burin/svg.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "pattern_text.hpp"

namespace burin {
namespace {

std::string pair_of(double a, double b) { return exact(a) + "," + exact(b); }

std::string attribute(const std::string& name, const std::string& value) { return " " + name + "=\"" + value + "\""; }

// Attributes that say what is usual are left out.
std::string unusual(const std::string& name, const std::string& value, const std::string& usual) {
    return value == usual ? "" : attribute("data-burin-" + name, value);
}

template <typename List>
std::string spaced(const List& list, const std::function<std::string(const typename List::value_type&)>& text) {
    std::string all;
    for (const auto& item : list) all += (all.empty() ? "" : " ") + text(item);
    return all;
}

std::string material_text(const Material& m) {
    if (!m.overrides) return "none";
    std::string text;
    for (const float c : m.base_color) text += exact(c) + ",";
    return text + exact(m.metallic) + "," + exact(m.roughness);
}

std::string header(const Pattern& pattern) {
    const auto millimetres = [](double metres) { return exact(metres * 1000.0) + "mm"; };
    const Vec2 size = pattern.size;
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
           "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
           "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"\n    " +
           attribute("width", millimetres(size.x)) + attribute("height", millimetres(size.y)) +
           attribute("viewBox", "0 0 " + exact(size.x) + " " + exact(size.y)) + "\n    " +
           attribute("data-burin-version", "1") + attribute("data-burin-size", pair_of(size.x, size.y)) +
           attribute("data-burin-depth", exact(pattern.depth)) +
           attribute("data-burin-base-offset", exact(pattern.base_offset)) +
           attribute("data-burin-wrap", name_in(kWrapNames, pattern.wrap)) +
           attribute("data-burin-outer-level", exact(pattern.outer_level)) +
           attribute("data-burin-materials", spaced(pattern.materials, material_text)) + ">\n";
}

// Appends a layer around what add_content() appends: a drawing of a million paths is too long to be copied.
template <typename Content>
void add_layer(std::string& svg, const std::string& label, const std::string& style, const Content& add_content) {
    svg += "  <g" + attribute("id", label) + attribute("inkscape:groupmode", "layer") + attribute("inkscape:label", label) +
           attribute("style", style) + ">\n";
    add_content();
    svg += "  </g>\n";
}

// The section as it would be cut out of the surface, up being up; at the page's origin.
std::string profile_element(const Profile& profile, std::size_t index) {
    const auto& points = profile.points;
    std::string drawn;
    for (const ProfilePoint& p : points) drawn += (drawn.empty() ? "M" : " L") + pair_of(p.b, 0.0 - p.h);
    const double width = points.back().b - points.front().b;
    return "    <path" + attribute("id", "profile-" + std::to_string(index)) +
           attribute("data-burin-points", spaced(points, [](const ProfilePoint& p) { return pair_of(p.b, p.h); })) +
           unusual("facets", spaced(profile.facets, [](const FacetClass& f) { return std::string(name_in(kFacetNames, f)); }), "") +
           attribute("stroke-width", exact(width / 100.0)) + attribute("d", drawn) + "/>\n";
}

// Two scales for each element, at its ends; none when all are 1.
std::string scales(const Path& path, double Element::*at_start, double Element::*at_end) {
    const bool plain = std::all_of(path.elements.begin(), path.elements.end(),
                                   [&](const Element& e) { return e.*at_start == 1.0 && e.*at_end == 1.0; });
    if (plain) return "";
    return spaced(path.elements, [&](const Element& e) { return pair_of(e.*at_start, e.*at_end); });
}

// Least width of a stroke: where a wall is vertical or hardly leans, enough to be seen when all of the page is. A width on the
// screen would do for any zoom, but in programs that do not know `vector-effect` it would be metres.
double hair_width(const Pattern& pattern) { return std::min(pattern.size.x, pattern.size.y) / 512.0; }

// The profile's width where the path is widest.
double path_width(const Pattern& pattern, const Path& path) {
    const auto& points = pattern.profiles[path.profile].points;
    double scale = 0.0;
    for (const Element& e : path.elements) scale = std::max({scale, e.width0, e.width1});
    return (points.back().b - points.front().b) * scale;
}

std::string stroke(const Pattern& pattern, const Path& path) {
    const double width = path_width(pattern, path), hair = hair_width(pattern);
    return attribute("stroke-width", exact(std::max(width, hair))) + (width < hair ? attribute("stroke-opacity", "1") : "");
}

Box control_box(const Path& path) {
    Box box;
    for (const Element& e : path.elements)
        for (const Vec2 p : {e.p0, e.kind == ElementKind::line ? e.p0 : e.p1, e.p2}) {
            box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
            box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
        }
    return box;
}

// How many tiles on a span may be shifted and still reach into the first one.
std::pair<int, int> shifts_onto(double low, double high, double size) {
    return {static_cast<int>(std::ceil(-high / size)), static_cast<int>(std::floor((size - low) / size))};
}

// Where a path of a repeating pattern leaves the page, it comes back in at the other side: shown by clones of it.
std::string clones(const Pattern& pattern, std::size_t index) {
    const Path& path = pattern.paths[index];
    if (pattern.wrap == Wrap::clamp || path.elements.empty()) return "";
    const Box box = control_box(path);
    const double half = 0.5 * std::max(path_width(pattern, path), hair_width(pattern));
    const auto [left, right] = shifts_onto(box.low.x - half, box.high.x + half, pattern.size.x);
    const auto [up, down] = shifts_onto(box.low.y - half, box.high.y + half, pattern.size.y);
    std::string all;
    for (int j = up; j <= down; ++j)
        for (int i = left; i <= right; ++i)
            if (i != 0 || j != 0)
                all += "    <use" + attribute("xlink:href", "#path-" + std::to_string(index)) + attribute("x", exact(i * pattern.size.x)) +
                       attribute("y", exact(j * pattern.size.y)) + "/>\n";
    return all;
}

// Kind and numbers of the perturbation; format/svg.md.
std::string perturbation_text(const Pattern& pattern, const Path& path) {
    if (path.perturbation == kNoPerturbation) return "";
    const Perturbation& p = pattern.perturbations[path.perturbation];
    std::vector<double> numbers{p.width, p.height, p.wavelength, p.phase};
    if (p.kind == PerturbationKind::noise) {
        numbers.back() = p.seed;
        numbers.push_back(p.octaves);
    } else if (p.kind == PerturbationKind::polynomial) {
        numbers.assign(std::begin(p.width_polynomial), std::end(p.width_polynomial));
        numbers.insert(numbers.end(), std::begin(p.height_polynomial), std::end(p.height_polynomial));
    }
    std::string text = name_in(kPerturbationNames, p.kind);
    for (const double number : numbers) text += ' ', text += exact(number);
    return text;
}

bool returns(const Path& path) { return !path.elements.empty() && path.elements.front().p0 == path.elements.back().p2; }

std::string path_element(const Pattern& pattern, std::size_t index) {
    const Path& path = pattern.paths[index];
    return "    <path" + attribute("id", "path-" + std::to_string(index)) +
           attribute("data-burin-profile", std::to_string(path.profile)) +
           attribute("data-burin-level", exact(path.level)) + unusual("material", std::to_string(path.material), "0") +
           unusual("closed", path.closed ? "yes" : "no", "no") + unusual("join", name_in(kJoinNames, path.join), "mitre") +
           unusual("start-cap", name_in(kCapNames, path.start_cap), "hip") + unusual("end-cap", name_in(kCapNames, path.end_cap), "hip") +
           unusual("widths", scales(path, &Element::width0, &Element::width1), "") +
           unusual("heights", scales(path, &Element::height0, &Element::height1), "") +
           unusual("perturbation", perturbation_text(pattern, path), "") +
           stroke(pattern, path) + attribute("d", path_data_of(path.elements, returns(path))) + "/>\n";
}

void add_paths(std::string& svg, const Pattern& pattern, PathKind kind, const char* label, const char* color) {
    add_layer(svg, label, std::string("fill:none;stroke:") + color + ";stroke-opacity:0.6;stroke-linejoin:miter", [&] {
        for (std::size_t i = 0; i < pattern.paths.size(); ++i)
            if (path_kind(pattern, pattern.paths[i]) == kind) svg += path_element(pattern, i) + clones(pattern, i);
    });
}

}  // namespace

std::string write_svg(const Pattern& pattern) {
    std::string svg = header(pattern);
    add_layer(svg, "profiles", "display:none;fill:none;stroke:#000000", [&] {
        for (std::size_t i = 0; i < pattern.profiles.size(); ++i) svg += profile_element(pattern.profiles[i], i);
    });
    add_paths(svg, pattern, PathKind::step, "steps", "#c2188f");
    add_paths(svg, pattern, PathKind::ridge, "ridges", "#e07b00");
    add_paths(svg, pattern, PathKind::groove, "grooves", "#0086b3");
    return svg += "</svg>\n";
}

}  // namespace burin
