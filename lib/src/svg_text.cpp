#include "svg_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include <pugixml.hpp>

#include "resolve_curve.hpp"
#include "svg_style.hpp"

namespace burin::svg {
namespace {

struct Glyph {
    std::string data;
    double advance = 0.0;  // font units
};

// A <font> of SVG 1.1: units and glyphs, y up.
struct Font {
    double em = 1000.0;
    std::map<std::string, Glyph> glyphs;  // by the characters they stand for
    std::size_t longest = 1;              // bytes of the longest of those
};

pugi::xml_node find_font(const pugi::xml_node& node) {
    return node.find_node([](const pugi::xml_node& one) { return local_name(one.name()) == "font"; });
}

Result<Font> read_font(const std::string& text) {
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size(), pugi::parse_default | pugi::parse_ws_pcdata_single, pugi::encoding_utf8);
    if (!parsed) return Error{ErrorCode::invalid_input, std::string("the font is not well-formed XML: ") + parsed.description()};
    const pugi::xml_node font = find_font(document);
    if (!font) return Error{ErrorCode::invalid_input, "the font file has no font element; an SVG font works, such as those of Hershey Text"};
    Font out;
    const double advance = font.attribute("horiz-adv-x").as_double(500.0);
    out.em = font.child("font-face").attribute("units-per-em").as_double(out.em);
    if (!(out.em > 0.0)) return Error{ErrorCode::invalid_input, "the font has units-per-em " + std::to_string(out.em) + ", where a number above 0 is needed"};
    for (const pugi::xml_node& glyph : font.children("glyph")) {
        const std::string characters = glyph.attribute("unicode").value();
        if (characters.empty()) continue;
        out.glyphs.try_emplace(characters, Glyph{glyph.attribute("d").value(), glyph.attribute("horiz-adv-x").as_double(advance)});
        out.longest = std::max(out.longest, characters.size());
    }
    return out;
}

// Bytes of the character that begins here.
std::size_t character_at(const std::string& text, std::size_t at) {
    std::size_t end = at + 1;
    while (end < text.size() && (text[end] & 0xc0) == 0x80) ++end;
    return end - at;
}

Result<std::vector<const Glyph*>> spell(const std::string& words, const Font& font) {
    std::vector<const Glyph*> line;
    for (std::size_t at = 0; at < words.size();) {
        std::size_t bytes = std::min(font.longest, words.size() - at);
        auto found = font.glyphs.end();
        for (; bytes > 0 && (found = font.glyphs.find(words.substr(at, bytes))) == font.glyphs.end();) --bytes;
        if (found == font.glyphs.end())
            return Error{ErrorCode::invalid_input, "the font has no '" + words.substr(at, character_at(words, at)) + "', character " + std::to_string(at + 1) + " of '" + words + "'"};
        line.push_back(&found->second);
        at += bytes;
    }
    return line;
}

// Place and direction at an arc length of the guide.
class Guide {
  public:
    Guide(const std::vector<Subpath>& guide, Vec2 page) {
        for (const Subpath& subpath : guide) elements_.insert(elements_.end(), subpath.elements.begin(), subpath.elements.end());
        if (elements_.empty()) {
            Element level;
            level.p0 = {0.0, 0.5 * page.y}, level.p2 = {page.x, 0.5 * page.y};
            elements_.push_back(level);
        }
        for (const Element& e : elements_) ends_.push_back(length() + curve::arc_length(e));
    }
    double length() const { return ends_.empty() ? 0.0 : ends_.back(); }
    std::pair<Vec2, Vec2> at(double s) const {
        const std::size_t i = std::min(std::size_t(std::upper_bound(ends_.begin(), ends_.end(), s) - ends_.begin()), elements_.size() - 1);
        const double begin = i == 0 ? 0.0 : ends_[i - 1];
        double low = 0.0, high = 1.0;
        for (int k = 0; k < 40; ++k) {
            const double middle = 0.5 * (low + high);
            (begin + curve::arc_length(curve::part(elements_[i], 0.0, middle)) < s ? low : high) = middle;
        }
        return {curve::point(elements_[i], low), curve::tangent(elements_[i], low)};
    }

  private:
    std::vector<Element> elements_;
    std::vector<double> ends_;
};

}  // namespace

Result<std::vector<Subpath>> lay_text(const SvgText& text, const std::vector<Subpath>& guide_path, Vec2 page, double tolerance) {
    const auto font = read_font(text.font);
    if (!font) return font.error();
    const auto line = spell(text.words, *font);
    if (!line) return line.error();
    const Guide guide(guide_path, page);
    const double size = text.size > 0.0 ? text.size : 0.1 * std::min(page.x, page.y), scale = size / font->em;
    double whole = 0.0;
    for (const Glyph* glyph : *line) whole += glyph->advance * scale;
    if (whole > guide.length())
        return Error{ErrorCode::invalid_argument, "the text is " + std::to_string(whole) + " m long, and its line " + std::to_string(guide.length()) + " m; a size of " +
                                                      std::to_string(0.999 * size * guide.length() / whole) + " m fits"};
    std::vector<Subpath> out;
    double at = 0.5 * (guide.length() - whole);
    for (const Glyph* glyph : *line) {
        const double half = 0.5 * glyph->advance * scale;
        const auto [middle, along] = guide.at(at + half);
        // Glyphs have y up; the middle of the advance stands on the guide.
        const Affine place = Affine{along.x, along.y, -along.y, along.x, middle.x, middle.y} * Affine{scale, 0.0, 0.0, -scale, -half, 0.0};
        PathData data = parse_path_data(glyph->data, place, tolerance);
        if (!data.problem.empty()) return Error{ErrorCode::invalid_input, "a glyph of the font: " + data.problem};
        out.insert(out.end(), data.subpaths.begin(), data.subpaths.end());
        at += 2.0 * half;
    }
    return out;
}

}  // namespace burin::svg
