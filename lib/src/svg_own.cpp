#include "svg_own.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "resolve_curve.hpp"

namespace burin::svg {
namespace {

using Data = std::map<std::string, std::string>;

Error refuse(const std::string& place, const std::string& name, const std::string& value, const std::string& what) {
    return {ErrorCode::invalid_input, place + ": data-burin-" + name + " '" + value + "' " + what};
}

// Reads attributes of one element; the first that is wrong is kept as the error.
class Attributes {
  public:
    Attributes(const Data& data, std::string place) : data_(data), place_(std::move(place)) {}

    std::string text(const std::string& name, const std::string& usual) const {
        const auto found = data_.find(name);
        return found == data_.end() ? usual : found->second;
    }
    std::vector<double> numbers(const std::string& name) {
        const auto numbers = parse_numbers(text(name, ""));
        if (!numbers) fail(name, "is no list of numbers");
        return numbers.value_or(std::vector<double>{});
    }
    double number(const std::string& name, double usual) {
        if (!data_.contains(name)) return usual;
        const std::vector<double> list = numbers(name);
        if (list.size() != 1) fail(name, "is no number");
        return list.size() == 1 ? list[0] : usual;
    }
    std::uint32_t index(const std::string& name, std::size_t count) {
        const double value = number(name, 0.0);
        if (value >= 0.0 && value < double(count) && value == std::floor(value)) return std::uint32_t(value);
        fail(name, "is no index below " + std::to_string(count));
        return 0;
    }
    template <typename Kind, std::size_t N>
    Kind choice(const std::string& name, const std::array<const char*, N>& names) {
        const std::string value = text(name, names[0]);
        for (std::size_t i = 0; i < N; ++i)
            if (value == names[i]) return static_cast<Kind>(i);
        std::string all;
        for (const char* one : names) all += (all.empty() ? "" : ", ") + std::string(one);
        fail(name, "is none of " + all);
        return static_cast<Kind>(0);
    }
    void fail(const std::string& name, const std::string& what) {
        if (status_) status_ = refuse(place_, name, text(name, ""), what);
    }
    const Status& status() const { return status_; }

  private:
    const Data& data_;
    std::string place_;
    Status status_ = Done{};
};

constexpr std::array<const char*, 2> kWraps = {"repeat", "clamp"};
constexpr std::array<const char*, 3> kJoins = {"mitre", "round", "bevel"};
constexpr std::array<const char*, 4> kCaps = {"hip", "butt", "round", "taper"};
constexpr std::array<const char*, 3> kFacets = {"automatic", "internal", "external"};

std::vector<Material> materials_of(Attributes& root) {
    std::vector<Material> materials;
    for (const std::string& word : split_words(root.text("materials", "none"))) {
        Material material;
        const auto numbers = parse_numbers(word);
        if (word != "none" && (!numbers || numbers->size() != 6)) root.fail("materials", "is no list of 'none' or six numbers joined by commas");
        if (word != "none" && numbers && numbers->size() == 6) {
            material.overrides = true;
            for (std::size_t i = 0; i < 4; ++i) material.base_color[i] = float((*numbers)[i]);
            material.metallic = float((*numbers)[4]), material.roughness = float((*numbers)[5]);
        }
        materials.push_back(material);
    }
    return materials;
}

Result<Profile> profile_of(const Data& data) {
    Attributes attributes(data, data.at("place"));
    Profile profile;
    const std::vector<double> points = attributes.numbers("points");
    if (points.size() < 4 || points.size() % 2 != 0) attributes.fail("points", "is no list of two or more pairs");
    for (std::size_t i = 0; i + 1 < points.size(); i += 2) profile.points.push_back({points[i], points[i + 1]});
    for (const std::string& word : split_words(attributes.text("facets", ""))) {
        const auto known = std::find(kFacets.begin(), kFacets.end(), word);
        if (known == kFacets.end()) attributes.fail("facets", "has a word that is none of automatic, internal, external");
        else profile.facets.push_back(static_cast<FacetClass>(known - kFacets.begin()));
    }
    if (!attributes.status()) return attributes.status().error();
    return profile;
}

std::uint32_t add_perturbation(Attributes& attributes, Pattern& pattern) {
    const std::vector<std::string> words = split_words(attributes.text("perturbation", ""));
    if (words.empty()) return kNoPerturbation;
    std::vector<double> n;
    for (std::size_t i = 1; i < words.size(); ++i) {
        const auto number = parse_numbers(words[i]);
        if (!number || number->size() != 1) attributes.fail("perturbation", "has '" + words[i] + "', which is no number");
        else n.push_back((*number)[0]);
    }
    Perturbation p;
    if (words[0] == "sine" && n.size() == 4) {
        p.width = n[0], p.height = n[1], p.wavelength = n[2], p.phase = n[3];
    } else if (words[0] == "noise" && n.size() == 5) {
        p.kind = PerturbationKind::noise;
        p.width = n[0], p.height = n[1], p.wavelength = n[2], p.seed = std::uint32_t(n[3]), p.octaves = int(n[4]);
    } else if (words[0] == "polynomial" && n.size() == 8) {
        p.kind = PerturbationKind::polynomial;
        std::copy(n.begin(), n.begin() + 4, p.width_polynomial);
        std::copy(n.begin() + 4, n.end(), p.height_polynomial);
    } else {
        attributes.fail("perturbation", "is not 'sine' with 4 numbers, 'noise' with 5 or 'polynomial' with 8");
    }
    // Equal functions are one, as they were when the drawing was written.
    const auto same = [&](const Perturbation& q) {
        return q.kind == p.kind && q.width == p.width && q.height == p.height && q.wavelength == p.wavelength && q.phase == p.phase && q.seed == p.seed &&
               q.octaves == p.octaves && std::equal(q.width_polynomial, q.width_polynomial + 4, p.width_polynomial) &&
               std::equal(q.height_polynomial, q.height_polynomial + 4, p.height_polynomial);
    };
    const auto found = std::find_if(pattern.perturbations.begin(), pattern.perturbations.end(), same);
    const auto index = std::uint32_t(found - pattern.perturbations.begin());
    if (found == pattern.perturbations.end()) pattern.perturbations.push_back(p);
    return index;
}

// Scales as written, a pair for each element; or, where elements were added or removed, the same course over the length.
void set_scales(std::vector<Element>& elements, const std::vector<double>& pairs, double Element::*at_start, double Element::*at_end) {
    if (pairs.empty()) return;
    if (pairs.size() == 2 * elements.size()) {
        for (std::size_t i = 0; i < elements.size(); ++i) elements[i].*at_start = pairs[2 * i], elements[i].*at_end = pairs[2 * i + 1];
        return;
    }
    std::vector<double> along{0.0};
    for (const Element& e : elements) along.push_back(along.back() + curve::arc_length(e));
    const auto at = [&](double share) {
        const double place = std::clamp(share, 0.0, 1.0) * double(pairs.size() / 2);
        const std::size_t i = std::min(std::size_t(place), pairs.size() / 2 - 1);
        return pairs[2 * i] + (pairs[2 * i + 1] - pairs[2 * i]) * (place - double(i));
    };
    for (std::size_t i = 0; i < elements.size(); ++i) elements[i].*at_start = at(along[i] / along.back()), elements[i].*at_end = at(along[i + 1] / along.back());
}

// The same line from its other end, so that right and left of a mirrored path are where they were.
void turn_round(Path& path) {
    std::reverse(path.elements.begin(), path.elements.end());
    for (Element& e : path.elements) std::swap(e.p0, e.p2), std::swap(e.width0, e.width1), std::swap(e.height0, e.height1);
    std::swap(path.start_cap, path.end_cap);
}

}  // namespace

bool is_own(const Document& document, const Shape& shape) { return document.own && shape.names->data.contains("profile"); }

Result<Pattern> read_own_root(const Document& document) {
    Attributes root(document.root_data, "svg");
    Pattern pattern;
    pattern.size = document.size;
    pattern.depth = root.number("depth", pattern.depth);
    pattern.base_offset = root.number("base-offset", 0.0);
    pattern.wrap = root.choice<Wrap>("wrap", kWraps);
    pattern.outer_level = root.number("outer-level", 0.0);
    pattern.materials = materials_of(root);
    if (root.number("version", 1.0) != 1.0) root.fail("version", "is not 1, the one that is read");
    if (!root.status()) return root.status().error();
    for (const Data& data : document.profiles) {
        auto profile = profile_of(data);
        if (!profile) return profile.error();
        pattern.profiles.push_back(std::move(*profile));
    }
    return pattern;
}

Status add_own_paths(const Shape& shape, Pattern& pattern, Notes& notes) {
    Attributes attributes(shape.names->data, shape.place);
    Path base;
    base.profile = attributes.index("profile", pattern.profiles.size());
    base.material = attributes.index("material", pattern.materials.size());
    base.level = attributes.number("level", 0.0);
    base.join = attributes.choice<JoinKind>("join", kJoins);
    base.start_cap = attributes.choice<CapKind>("start-cap", kCaps);
    base.end_cap = attributes.choice<CapKind>("end-cap", kCaps);
    base.perturbation = add_perturbation(attributes, pattern);
    const std::vector<double> widths = attributes.numbers("widths"), heights = attributes.numbers("heights");
    if (widths.size() % 2 != 0) attributes.fail("widths", "is no list of pairs");
    if (heights.size() % 2 != 0) attributes.fail("heights", "is no list of pairs");
    const bool closed = attributes.text("closed", "no") == "yes";
    if (!attributes.status()) return attributes.status();
    const Affine& moved = shape.to_pattern;
    const double scale = moved.identity() ? 1.0 : scale_of(moved);
    for (const Subpath& subpath : shape.outline) {
        if (subpath.elements.empty()) continue;
        Path path = base;
        path.elements = subpath.elements;
        // An open path that comes back to its start is written with Z too; a line by Z is the user's.
        path.closed = subpath.closing_line || closed;
        set_scales(path.elements, widths, &Element::width0, &Element::width1);
        set_scales(path.elements, heights, &Element::height0, &Element::height1);
        const auto differs = [&](const std::vector<double>& pairs) { return !pairs.empty() && pairs.size() != 2 * path.elements.size(); };
        if (differs(widths) || differs(heights)) notes.add("nodes were added or removed: widths and heights are spread along the path", shape.place);
        if (scale != 1.0)
            for (Element& e : path.elements) e.width0 *= scale, e.width1 *= scale;
        if (moved.determinant() < 0.0) turn_round(path);
        pattern.paths.push_back(std::move(path));
    }
    return Done{};
}

}  // namespace burin::svg
