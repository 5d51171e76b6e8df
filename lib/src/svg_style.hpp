// How an element of an SVG document is painted: presentation attributes, style sheets, style attributes, inheritance.
//
// Of CSS 2.1 what drawing programs write: selectors of types, classes, ids and `*`, joined by blanks or `>`, in lists; `!important`.
// Other selectors and at-rules are passed over and counted.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <pugixml.hpp>

namespace burin::svg {

enum class Property {
    clip_path, color, display, fill, fill_opacity, fill_rule, filter, marker, marker_end, marker_mid, marker_start, mask, opacity,
    stroke, stroke_dasharray, stroke_dashoffset, stroke_linecap, stroke_linejoin, stroke_miterlimit, stroke_opacity, stroke_width, visibility,
    count
};

// Text of each property; "" where nothing was said.
class Style {
  public:
    const std::string& operator[](Property p) const { return values_[static_cast<std::size_t>(p)]; }
    std::string& operator[](Property p) { return values_[static_cast<std::size_t>(p)]; }

  private:
    std::array<std::string, static_cast<std::size_t>(Property::count)> values_;
};

class StyleSheet {
  public:
    // Adds the rules of one <style> element, behind those there are.
    void add(std::string_view css);
    // The element's own style on top of its parent's.
    Style computed(const pugi::xml_node& element, const Style& parent) const;
    // Selectors and at-rules that were passed over.
    const std::vector<std::string>& passed_over() const { return passed_over_; }

  private:
    struct Compound {
        std::string type, id;  // "": any
        std::vector<std::string> classes;
        bool child = false;  // of the compound before it, not just below it
    };
    struct Rule {
        std::vector<Compound> selector;  // outermost first
        int specificity = 0;
        std::size_t order = 0;
        std::size_t declarations = 0;  // index
    };
    using Declarations = std::vector<std::pair<std::string, std::string>>;

    static bool parse_selector(std::string_view text, Rule& rule);
    static Declarations parse_declarations(std::string_view text);
    static bool matches(const Rule& rule, const pugi::xml_node& element);
    void collect(const std::string& key, const pugi::xml_node& element, std::vector<const Rule*>& found) const;

    std::vector<Rule> rules_;
    std::vector<Declarations> declarations_;
    // By what the innermost compound asks for: "#id", ".class", "type" or "*".
    std::unordered_map<std::string, std::vector<std::size_t>> by_key_;
    std::vector<std::string> passed_over_;
};

// Words between blanks.
std::vector<std::string> split_words(std::string_view text);
std::string_view trimmed(std::string_view text);
// A name without its namespace prefix.
std::string_view local_name(const char* name);

}  // namespace burin::svg
