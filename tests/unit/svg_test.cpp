// The SVG as a reader sees it that knows format/svg.md and an XML parser, and nothing of burin's writer.
#include <burin/svg.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <pugixml.hpp>
#include <sstream>

#include "../property/random_pattern.hpp"
#include "pattern_equal.hpp"

namespace burin {
namespace {

using testing::expect_equal;

std::vector<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> words;
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

// One number of `a,b,c`; the whole of it must be read.
std::vector<double> numbers_of(const std::string& text) {
    std::vector<double> numbers;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, ',');) {
        char* end = nullptr;
        numbers.push_back(std::strtod(part.c_str(), &end));
        EXPECT_TRUE(!part.empty() && *end == '\0') << text;
    }
    return numbers;
}

Vec2 pair_of(const std::string& text) {
    const auto numbers = numbers_of(text);
    EXPECT_EQ(numbers.size(), 2u) << text;
    return numbers.size() == 2 ? Vec2{numbers[0], numbers[1]} : Vec2{};
}

std::string attribute(const pugi::xml_node& node, const std::string& name, const std::string& usual) {
    return node.attribute(("data-burin-" + name).c_str()).as_string(usual.c_str());
}

template <typename Kind>
Kind kind_of(const std::string& name, std::initializer_list<const char*> names) {
    std::uint8_t index = 0;
    for (const char* candidate : names) {
        if (name == candidate) return static_cast<Kind>(index);
        ++index;
    }
    ADD_FAILURE() << "'" << name << "' is not a word of the format";
    return Kind{};
}

std::vector<Element> read_data(const std::string& data) {
    std::vector<Element> elements;
    Vec2 at;
    const auto words = words_of(data);
    for (std::size_t i = 0; i < words.size(); ++i) {
        const char command = words[i][0];
        if (command == 'M') {
            EXPECT_EQ(i, 0u);
            at = pair_of(words[i].substr(1));
        } else if (command == 'L' || command == 'Q') {
            Element e;
            e.kind = command == 'L' ? ElementKind::line : ElementKind::quadratic;
            e.p0 = at;
            if (command == 'Q') e.p1 = pair_of(words[i++].substr(1));
            e.p2 = at = pair_of(command == 'L' ? words[i].substr(1) : words[i]);
            elements.push_back(e);
        } else {
            EXPECT_EQ(words[i], "Z");
            EXPECT_EQ(i + 1, words.size());
            EXPECT_TRUE(elements.front().p0 == elements.back().p2);
        }
    }
    return elements;
}

void read_scales(const std::string& text, double Element::*start, double Element::*end, std::vector<Element>& elements) {
    const auto words = words_of(text);
    if (words.empty()) return;
    ASSERT_EQ(words.size(), elements.size());
    for (std::size_t i = 0; i < words.size(); ++i) {
        const Vec2 scales = pair_of(words[i]);
        elements[i].*start = scales.x;
        elements[i].*end = scales.y;
    }
}

Path read_path(const pugi::xml_node& node) {
    Path path;
    path.elements = read_data(node.attribute("d").as_string());
    path.closed = attribute(node, "closed", "no") == "yes";
    path.profile = static_cast<std::uint32_t>(std::stoul(attribute(node, "profile", "")));
    path.material = static_cast<std::uint32_t>(std::stoul(attribute(node, "material", "0")));
    path.level = numbers_of(attribute(node, "level", "")).at(0);
    path.join = kind_of<JoinKind>(attribute(node, "join", "mitre"), {"mitre", "round", "bevel"});
    path.start_cap = kind_of<CapKind>(attribute(node, "start-cap", "hip"), {"hip", "butt", "round", "taper"});
    path.end_cap = kind_of<CapKind>(attribute(node, "end-cap", "hip"), {"hip", "butt", "round", "taper"});
    read_scales(attribute(node, "widths", ""), &Element::width0, &Element::width1, path.elements);
    read_scales(attribute(node, "heights", ""), &Element::height0, &Element::height1, path.elements);
    return path;
}

Profile read_profile(const pugi::xml_node& node) {
    Profile profile;
    for (const std::string& word : words_of(attribute(node, "points", ""))) {
        const Vec2 p = pair_of(word);
        profile.points.push_back({p.x, p.y});
    }
    for (const std::string& word : words_of(attribute(node, "facets", "")))
        profile.facets.push_back(kind_of<FacetClass>(word, {"automatic", "internal", "external"}));
    return profile;
}

Material read_material(const std::string& text) {
    Material m;
    if (text == "none") return m;
    const auto numbers = numbers_of(text);
    EXPECT_EQ(numbers.size(), 6u);
    m.overrides = true;
    for (std::size_t i = 0; i < 4; ++i) m.base_color[i] = static_cast<float>(numbers.at(i));
    m.metallic = static_cast<float>(numbers.at(4));
    m.roughness = static_cast<float>(numbers.at(5));
    return m;
}

// The entries "name-0", "name-1", ... of all layers, in order.
std::vector<pugi::xml_node> numbered(const pugi::xml_node& root, const std::string& name) {
    std::map<std::size_t, pugi::xml_node> found;
    for (const pugi::xml_node layer : root.children("g"))
        for (const pugi::xml_node node : layer.children("path")) {
            const std::string id = node.attribute("id").as_string();
            if (id.rfind(name + "-", 0) == 0) { EXPECT_TRUE(found.emplace(std::stoul(id.substr(name.size() + 1)), node).second); }
        }
    std::vector<pugi::xml_node> nodes;
    for (const auto& [index, node] : found) {
        EXPECT_EQ(index, nodes.size());
        nodes.push_back(node);
    }
    return nodes;
}

Pattern read_pattern(const pugi::xml_node& root) {
    Pattern pattern;
    pattern.size = pair_of(attribute(root, "size", ""));
    pattern.depth = numbers_of(attribute(root, "depth", "")).at(0);
    pattern.base_offset = numbers_of(attribute(root, "base-offset", "")).at(0);
    pattern.outer_level = numbers_of(attribute(root, "outer-level", "")).at(0);
    pattern.wrap = kind_of<Wrap>(attribute(root, "wrap", ""), {"repeat", "clamp"});
    pattern.materials.clear();
    for (const std::string& word : words_of(attribute(root, "materials", ""))) pattern.materials.push_back(read_material(word));
    for (const auto& node : numbered(root, "profile")) pattern.profiles.push_back(read_profile(node));
    for (const auto& node : numbered(root, "path")) pattern.paths.push_back(read_path(node));
    return pattern;
}

pugi::xml_node parse(const Pattern& pattern, pugi::xml_document& document) {
    const std::string text = write_svg(pattern);
    const auto parsed = document.load_buffer(text.data(), text.size());
    EXPECT_TRUE(parsed) << parsed.description();
    return document.child("svg");
}

TEST(Svg, GivesThePatternBackBitByBit) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        testing::RandomPatternOptions options;
        options.size = {1.0 / 3.0, 0.7};
        options.wrap = seed % 2 == 0 ? Wrap::repeat : Wrap::clamp;
        options.wrap_around = seed % 2 == 0;
        Pattern pattern = testing::random_pattern(seed, options);
        pattern.outer_level = 1e-300;  // as small as need be
        pattern.profiles[0].facets = {FacetClass::internal, FacetClass::external};
        SCOPED_TRACE("seed " + std::to_string(seed));
        pugi::xml_document document;
        expect_equal(pattern, read_pattern(parse(pattern, document)));
    }
}

// A groove and a ridge and a step, told apart by their profiles.
Pattern three_kinds() {
    Pattern pattern;
    pattern.size = {0.2, 0.1};
    pattern.wrap = Wrap::clamp;
    pattern.profiles = {{{{-0.001, 0}, {0, -0.002}, {0.002, 0}}, {}}, {{{-0.001, 0}, {0, 0.002}, {0.001, 0}}, {}},
                        {{{0, 0}, {0, -0.004}}, {}}};
    for (std::uint32_t profile = 0; profile < 3; ++profile) {
        Path path;
        Element e;
        e.p0 = {0.01, 0.02};
        e.p2 = {0.11, 0.03 * profile};
        e.width1 = profile == 0 ? 2.0 : 1.0;
        path.elements = {e};
        path.profile = profile;
        pattern.paths.push_back(path);
    }
    return pattern;
}

TEST(Svg, LayersAreNamedByKind) {
    pugi::xml_document document;
    const pugi::xml_node root = parse(three_kinds(), document);
    const std::pair<const char*, const char*> kinds[] = {{"grooves", "path-0"}, {"ridges", "path-1"}, {"steps", "path-2"}};
    for (const auto& [label, id] : kinds) {
        const pugi::xml_node layer = root.find_child_by_attribute("g", "inkscape:label", label);
        EXPECT_STREQ(layer.attribute("inkscape:groupmode").as_string(), "layer");
        EXPECT_STREQ(layer.child("path").attribute("id").as_string(), id);
        EXPECT_TRUE(layer.child("path").next_sibling().empty());
    }
}

TEST(Svg, IsDrawnInMetresAsWideAsTheProfile) {
    pugi::xml_document document;
    const pugi::xml_node root = parse(three_kinds(), document);
    EXPECT_STREQ(root.attribute("viewBox").as_string(), "0 0 0.2 0.1");
    EXPECT_STREQ(root.attribute("width").as_string(), "200mm");
    EXPECT_STREQ(root.attribute("height").as_string(), "100mm");
    const auto paths = numbered(root, "path");
    ASSERT_EQ(paths.size(), 3u);
    EXPECT_DOUBLE_EQ(paths[0].attribute("stroke-width").as_double(), 0.006);  // 0.003, twice as wide at the end
    EXPECT_DOUBLE_EQ(paths[1].attribute("stroke-width").as_double(), 0.002);
    // A vertical wall is seen all the same: two pixels of a page of a thousand, and no lighter than its colour.
    EXPECT_DOUBLE_EQ(paths[2].attribute("stroke-width").as_double(), 0.1 / 512);
    EXPECT_EQ(paths[2].attribute("stroke-opacity").as_double(0.6), 1.0);
    EXPECT_EQ(paths[0].attribute("stroke-opacity").as_double(0.6), 0.6);
    EXPECT_STREQ(paths[0].attribute("d").as_string(), "M0.01,0.02 L0.11,0");
}

TEST(Svg, ClosesOnlyWhatReturnsToItsStart) {
    Pattern pattern = three_kinds();
    Path& path = pattern.paths[0];
    Element back;
    back.kind = ElementKind::quadratic;
    back.p0 = path.elements[0].p2;
    back.p1 = {0.1, 0.1};
    back.p2 = path.elements[0].p0;
    path.elements.push_back(back);
    path.closed = true;
    pattern.paths[1].closed = true;  // over the border of the tile
    pugi::xml_document document;
    const auto paths = numbered(parse(pattern, document), "path");
    EXPECT_STREQ(paths[0].attribute("d").as_string(), "M0.01,0.02 L0.11,0 Q0.1,0.1 0.01,0.02 Z");
    EXPECT_STREQ(paths[1].attribute("d").as_string(), "M0.01,0.02 L0.11,0.03");
    EXPECT_STREQ(paths[1].attribute("data-burin-closed").as_string(), "yes");
}

TEST(Svg, ShowsOnThePageWhatLiesBesideIt) {
    Pattern pattern = three_kinds();
    pattern.wrap = Wrap::repeat;
    pattern.paths.resize(2);
    pattern.paths[0].elements[0].p0 = {-0.3, 0.05};  // the whole of it one and two tiles to the left
    pattern.paths[0].elements[0].p2 = {-0.1, 0.05};
    pattern.paths[1].elements[0].p0 = {0.05, 0.05};  // all of it on the page
    pattern.paths[1].elements[0].p2 = {0.1, 0.06};
    pugi::xml_document document;
    const pugi::xml_node root = parse(pattern, document);
    std::vector<std::string> shifts;
    for (const pugi::xml_node layer : root.children("g"))
        for (const pugi::xml_node clone : layer.children("use")) {
            EXPECT_STREQ(clone.attribute("xlink:href").as_string(), "#path-0");
            shifts.push_back(clone.attribute("x").as_string() + std::string(",") + clone.attribute("y").as_string());
        }
    EXPECT_EQ(shifts, (std::vector<std::string>{"0.2,0", "0.4,0"}));
    expect_equal(pattern, read_pattern(root));
}

TEST(Svg, PerturbationsAreNamedWithTheirNumbers) {
    Pattern pattern;
    pattern.profiles = {{{{-0.01, 0}, {0, -0.003}, {0.01, 0}}, {}}};
    Perturbation sine, noise, cubic;
    sine.width = 0.25, sine.height = -0.5, sine.wavelength = 0.125, sine.phase = 0.75;
    noise = sine;
    noise.kind = PerturbationKind::noise;
    noise.seed = 4294967295u, noise.octaves = 3;
    cubic.kind = PerturbationKind::polynomial;
    cubic.width_polynomial[1] = 0.5, cubic.height_polynomial[3] = -0.25;
    pattern.perturbations = {sine, noise, cubic};
    for (std::uint32_t i = 0; i < 4; ++i) {
        Path path;
        path.elements.resize(1);
        path.elements[0].p2 = {0.5, 0.25 * i};
        if (i < 3) path.perturbation = i;
        pattern.paths.push_back(path);
    }
    pugi::xml_document document;
    const auto paths = numbered(parse(pattern, document), "path");
    ASSERT_EQ(paths.size(), 4u);
    EXPECT_EQ(attribute(paths[0], "perturbation", ""), "sine 0.25 -0.5 0.125 0.75");
    EXPECT_EQ(attribute(paths[1], "perturbation", ""), "noise 0.25 -0.5 0.125 4294967295 3");
    EXPECT_EQ(attribute(paths[2], "perturbation", ""), "polynomial 1 0.5 0 0 1 0 0 -0.25");
    EXPECT_EQ(attribute(paths[3], "perturbation", "none"), "none");
}

TEST(Svg, AnEmptyPatternIsADrawing) {
    pugi::xml_document document;
    expect_equal(Pattern{}, read_pattern(parse(Pattern{}, document)));
}

}  // namespace
}  // namespace burin
