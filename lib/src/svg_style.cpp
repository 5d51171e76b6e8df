#include "svg_style.hpp"

#include <algorithm>
#include <cctype>

namespace burin::svg {
namespace {

struct PropertyName {
    const char* name;
    bool inherited;
};
// In the order of Property.
constexpr PropertyName kProperties[] = {
    {"clip-path", false}, {"color", true}, {"display", false}, {"fill", true}, {"fill-opacity", true}, {"fill-rule", true}, {"filter", false},
    {"marker", true}, {"marker-end", true}, {"marker-mid", true}, {"marker-start", true}, {"mask", false}, {"opacity", false},
    {"stroke", true}, {"stroke-dasharray", true}, {"stroke-dashoffset", true}, {"stroke-linecap", true}, {"stroke-linejoin", true},
    {"stroke-miterlimit", true}, {"stroke-opacity", true}, {"stroke-width", true}, {"visibility", true},
};
constexpr std::size_t kCount = static_cast<std::size_t>(Property::count);
static_assert(std::size(kProperties) == kCount);

// Index, or kCount for a property that nobody asks for.
std::size_t index_of(std::string_view name) {
    const auto found = std::lower_bound(std::begin(kProperties), std::end(kProperties), name,
                                        [](const PropertyName& a, std::string_view b) { return a.name < b; });
    return found != std::end(kProperties) && found->name == name ? static_cast<std::size_t>(found - std::begin(kProperties)) : kCount;
}

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || (c & 0x80) != 0; }

std::string without_comments(std::string_view css) {
    std::string out;
    for (std::size_t i = 0; i < css.size();) {
        if (css.substr(i, 2) == "/*") {
            const std::size_t end = css.find("*/", i + 2);
            i = end == std::string_view::npos ? css.size() : end + 2;
        } else {
            out += css[i++];
        }
    }
    return out;
}

// Behind the bracket that belongs to the one at `open`, or the end.
std::size_t behind_block(std::string_view css, std::size_t open) {
    int depth = 0;
    for (std::size_t i = open; i < css.size(); ++i) {
        depth += css[i] == '{' ? 1 : css[i] == '}' ? -1 : 0;
        if (depth == 0) return i + 1;
    }
    return css.size();
}

bool has_class(const pugi::xml_node& element, std::string_view name) {
    const std::string_view list = element.attribute("class").value();
    for (std::size_t at = list.find(name); at != std::string_view::npos; at = list.find(name, at + 1)) {
        const bool begins = at == 0 || is_blank(list[at - 1]);
        const std::size_t end = at + name.size();
        if (begins && (end == list.size() || is_blank(list[end]))) return true;
    }
    return false;
}

}  // namespace

std::vector<std::string> split_words(std::string_view text) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < text.size();) {
        while (i < text.size() && is_blank(text[i])) ++i;
        std::size_t end = i;
        while (end < text.size() && !is_blank(text[end])) ++end;
        if (end > i) words.emplace_back(text.substr(i, end - i));
        i = end;
    }
    return words;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string_view local_name(const char* name) {
    const std::string_view whole = name;
    const std::size_t colon = whole.find(':');
    return colon == std::string_view::npos ? whole : whole.substr(colon + 1);
}

bool StyleSheet::parse_selector(std::string_view text, Rule& rule) {
    bool child = false;
    for (std::size_t i = 0; i < text.size();) {
        if (is_blank(text[i])) {
            ++i;
        } else if (text[i] == '>') {
            if (rule.selector.empty() || child) return false;
            child = true;
            ++i;
        } else {
            Compound compound;
            compound.child = std::exchange(child, false);
            while (i < text.size() && !is_blank(text[i]) && text[i] != '>') {
                const char sign = text[i];
                if (sign == '*') {
                    ++i;
                    continue;
                }
                std::size_t from = sign == '.' || sign == '#' ? i + 1 : i, end = from;
                while (end < text.size() && is_name(text[end])) ++end;
                if (end == from) return false;
                const std::string name(text.substr(from, end - from));
                if (sign == '.') compound.classes.push_back(name), rule.specificity += 100;
                else if (sign == '#') compound.id = name, rule.specificity += 10000;
                else compound.type = name, rule.specificity += 1;
                i = end;
            }
            rule.selector.push_back(std::move(compound));
        }
    }
    return !rule.selector.empty() && !child;
}

StyleSheet::Declarations StyleSheet::parse_declarations(std::string_view text) {
    Declarations out;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(';'), text.size());
        const std::string_view one = text.substr(0, end);
        const std::size_t colon = one.find(':');
        if (colon != std::string_view::npos) out.emplace_back(trimmed(one.substr(0, colon)), trimmed(one.substr(colon + 1)));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return out;
}

void StyleSheet::add(std::string_view css) {
    const std::string clean = without_comments(css);
    std::string_view rest = clean;
    while (!(rest = trimmed(rest)).empty()) {
        const std::size_t open = rest.find('{'), semicolon = rest.find(';');
        if (rest.front() == '@') {
            passed_over_.emplace_back(rest.substr(0, std::min({open, semicolon, rest.find_first_of(" \t\n\r{;")})));
            const bool statement = semicolon < open;
            rest.remove_prefix(statement ? semicolon + 1 : open == std::string_view::npos ? rest.size() : behind_block(rest, open));
            continue;
        }
        if (open == std::string_view::npos) break;
        const std::size_t behind = behind_block(rest, open);
        declarations_.push_back(parse_declarations(rest.substr(open + 1, behind - open - (behind > open + 1 ? 2 : 1))));
        std::string_view list = rest.substr(0, open);
        while (!list.empty()) {
            const std::size_t comma = std::min(list.find(','), list.size());
            const std::string_view selector = trimmed(list.substr(0, comma));
            Rule rule;
            rule.order = rules_.size();
            rule.declarations = declarations_.size() - 1;
            if (parse_selector(selector, rule)) {
                const Compound& last = rule.selector.back();
                const std::string key = !last.id.empty()        ? "#" + last.id
                                        : !last.classes.empty() ? "." + last.classes.front()
                                        : !last.type.empty()    ? last.type
                                                                : "*";
                by_key_[key].push_back(rules_.size());
                rules_.push_back(std::move(rule));
            } else {
                passed_over_.emplace_back(selector);
            }
            list.remove_prefix(std::min(comma + 1, list.size()));
        }
        rest.remove_prefix(behind);
    }
}

bool StyleSheet::matches(const Rule& rule, const pugi::xml_node& element) {
    const auto fits = [](const Compound& compound, const pugi::xml_node& node) {
        if (!compound.type.empty() && local_name(node.name()) != compound.type) return false;
        if (!compound.id.empty() && compound.id != node.attribute("id").value()) return false;
        return std::all_of(compound.classes.begin(), compound.classes.end(), [&](const std::string& c) { return has_class(node, c); });
    };
    std::size_t i = rule.selector.size() - 1;
    if (!fits(rule.selector[i], element)) return false;
    // Nearest fitting ancestors first: enough for what drawing programs write.
    for (pugi::xml_node node = element; i > 0;) {
        const bool child = rule.selector[i].child;
        node = node.parent();
        if (!node) return false;
        if (fits(rule.selector[i - 1], node)) --i;
        else if (child) return false;
    }
    return true;
}

void StyleSheet::collect(const std::string& key, const pugi::xml_node& element, std::vector<const Rule*>& found) const {
    const auto list = by_key_.find(key);
    if (list == by_key_.end()) return;
    for (const std::size_t index : list->second)
        if (matches(rules_[index], element)) found.push_back(&rules_[index]);
}

Style StyleSheet::computed(const pugi::xml_node& element, const Style& parent) const {
    Style own;
    std::array<bool, kCount> important{};
    const auto set = [&](std::string_view name, std::string_view value) {
        const std::size_t i = index_of(name);
        if (i == kCount) return;
        const std::size_t mark = value.find('!');
        if (important[i] && mark == std::string_view::npos) return;
        important[i] = important[i] || mark != std::string_view::npos;
        own[Property(i)] = trimmed(value.substr(0, mark));
    };
    for (const pugi::xml_attribute& attribute : element.attributes()) set(attribute.name(), attribute.value());
    if (!rules_.empty()) {
        std::vector<const Rule*> found;
        if (const pugi::xml_attribute id = element.attribute("id")) collect(std::string("#") + id.value(), element, found);
        for (const std::string& name : split_words(element.attribute("class").value())) collect("." + name, element, found);
        collect(std::string(local_name(element.name())), element, found);
        collect("*", element, found);
        std::sort(found.begin(), found.end(), [](const Rule* a, const Rule* b) {
            return a->specificity != b->specificity ? a->specificity < b->specificity : a->order < b->order;
        });
        for (const Rule* rule : found)
            for (const auto& [name, value] : declarations_[rule->declarations]) set(name, value);
    }
    for (const auto& [name, value] : parse_declarations(element.attribute("style").value())) set(name, value);
    for (std::size_t i = 0; i < kCount; ++i) {
        std::string& value = own[Property(i)];
        if (value == "inherit" || (value.empty() && kProperties[i].inherited)) value = parent[Property(i)];
    }
    return own;
}

}  // namespace burin::svg
