#include "svg_meaning.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace burin::svg {
namespace {

struct KindName {
    const char* name;
    Kind kind;
};
constexpr KindName kKinds[] = {{"none", Kind::none},       {"ignore", Kind::none},     {"groove", Kind::groove}, {"grooves", Kind::groove},
                               {"ridge", Kind::ridge},     {"ridges", Kind::ridge},    {"plateau", Kind::plateau}, {"plateaus", Kind::plateau},
                               {"raised", Kind::plateau},  {"sunken", Kind::sunken},   {"ground", Kind::ground}};

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return out;
}

// Words between blanks and colons; brackets hold together what stands in them.
std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words(1);
    int depth = 0;
    for (const char c : text) {
        depth += c == '(' ? 1 : c == ')' ? -1 : 0;
        const bool between = depth <= 0 && (c == ':' || std::isspace(static_cast<unsigned char>(c)) != 0);
        if (!between) words.back() += c;
        else if (!words.back().empty()) words.emplace_back();
    }
    if (words.back().empty()) words.pop_back();
    return words;
}

Error refuse(std::string_view text, const std::string& what) {
    return {ErrorCode::invalid_argument, "'" + std::string(text) + "': " + what + "; a meaning is KIND [PROFILE] [HEIGHT [WIDTH]], such as 'groove vee 0.5mm', with KIND groove, ridge, plateau, sunken, ground or none"};
}

}  // namespace

std::optional<double> parse_metres(std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
    const std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
    struct Unit {
        const char* name;
        double metres;
    };
    constexpr Unit kUnits[] = {{"", 1.0}, {"m", 1.0}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"in", 0.0254}};
    for (const Unit& one : kUnits)
        if (unit == one.name) return value * one.metres;
    return std::nullopt;
}

std::string plain_color(std::string_view paint) {
    std::string color = lower(trimmed(paint));
    std::erase_if(color, [](unsigned char c) { return std::isspace(c) != 0; });
    if (color.size() == 4 && color[0] == '#') color = {'#', color[1], color[1], color[2], color[2], color[3], color[3]};
    for (const char* white : {"white", "rgb(255,255,255)", "rgb(100%,100%,100%)"})
        if (color == white) return "#ffffff";
    return color;
}

Result<Meaning> parse_meaning(std::string_view text) {
    const std::vector<std::string> words = words_of(text);
    Meaning meaning;
    if (words.empty()) return refuse(text, "nothing is said");
    const std::string kind = lower(words[0]);
    const auto known = std::find_if(std::begin(kKinds), std::end(kKinds), [&](const KindName& one) { return kind == one.name; });
    if (known == std::end(kKinds)) return refuse(text, "'" + words[0] + "' is no kind");
    meaning.kind = known->kind;
    int lengths = 0;
    for (std::size_t i = 1; i < words.size(); ++i) {
        if (const auto metres = parse_metres(words[i])) {
            if (!(*metres > 0.0)) return refuse(text, "'" + words[i] + "' is no length above 0");
            if (++lengths > 2) return refuse(text, "'" + words[i] + "' is one length too many");
            (lengths == 1 ? meaning.height : meaning.width) = *metres;
        } else {
            if (meaning.profile || lengths > 0) return refuse(text, "'" + words[i] + "' is no length, such as 0.5mm");
            auto profile = parse_profile(words[i]);
            if (!profile) return refuse(text, profile.error().message);
            meaning.profile = std::move(*profile);
        }
    }
    return meaning;
}

Result<Meanings> Meanings::read(const SvgOptions& options) {
    Meanings out;
    const auto stroke = parse_meaning(options.stroke), fill = parse_meaning(options.fill);
    if (!stroke) return stroke.error();
    if (!fill) return fill.error();
    if (!stroke->of_stroke()) return refuse(options.stroke, "strokes are groove, ridge or none");
    if (!fill->of_fill()) return refuse(options.fill, "fills are plateau, sunken, ground or none");
    out.stroke_ = *stroke, out.fill_ = *fill;
    for (const auto& [name, text] : options.rules) {
        const auto meaning = parse_meaning(text);
        if (!meaning) return meaning.error();
        out.rules_[name] = *meaning;
        out.rules_[plain_color(name)] = *meaning;
    }
    return out;
}

const Meaning* Meanings::rule(const std::string& name, bool fill) const {
    const auto found = name.empty() ? rules_.end() : rules_.find(name);
    return found != rules_.end() && (fill ? found->second.of_fill() : found->second.of_stroke()) ? &found->second : nullptr;
}

const Meaning* Meanings::named(const std::string& name, bool fill) {
    if (name.empty()) return nullptr;
    const auto [it, fresh] = named_.try_emplace(name);
    if (fresh) {
        const auto meaning = parse_meaning(name);
        if (meaning) it->second = *meaning;
        else if (const auto words = words_of(name); words.size() > 1 && parse_meaning(words[0])) misread_.push_back(meaning.error().message);
    }
    return it->second && (fill ? it->second->of_fill() : it->second->of_stroke()) ? &*it->second : nullptr;
}

Result<std::optional<Meaning>> Meanings::find(const Shape& shape, bool fill, const std::string& color) {
    if (const std::string* text = shape.names->find(fill ? "fill" : "stroke")) {
        const auto meaning = parse_meaning(*text);
        if (!meaning) return Error{ErrorCode::invalid_input, shape.place + ": data-burin-" + (fill ? "fill " : "stroke ") + meaning.error().message};
        if (!(fill ? meaning->of_fill() : meaning->of_stroke()))
            return Error{ErrorCode::invalid_input, shape.place + ": data-burin-" + (fill ? "fill '" : "stroke '") + *text + "' means nothing there: strokes are grooves and ridges, fills are plateaus, sunken or ground"};
        return std::optional(*meaning);
    }
    for (const Names* names = shape.names.get(); names != nullptr; names = names->outer.get()) {
        if (const Meaning* meaning = rule(names->id, fill)) return std::optional(*meaning);
        for (const std::string& one : names->classes)
            if (const Meaning* meaning = rule(one, fill)) return std::optional(*meaning);
        if (const Meaning* meaning = rule(names->layer, fill)) return std::optional(*meaning);
    }
    if (const Meaning* meaning = rule(color, fill)) return std::optional(*meaning);
    for (const Names* names = shape.names.get(); names != nullptr; names = names->outer.get()) {
        for (const std::string& one : names->classes)
            if (const Meaning* meaning = named(one, fill)) return std::optional(*meaning);
        // Illustrator names its layers by the id of the group.
        for (const std::string* one : {&names->layer, &names->id})
            if (const Meaning* meaning = named(*one, fill)) return std::optional(*meaning);
    }
    return std::optional<Meaning>{};
}

bool Meanings::said(const Shape& shape, bool fill, const std::string& color) {
    const auto found = find(shape, fill, color);
    return !found || found->has_value();
}

Result<Meaning> Meanings::of(const Shape& shape, bool fill, const std::string& color) {
    const auto found = find(shape, fill, color);
    if (!found) return found.error();
    return *found ? **found : fill ? fill_ : stroke_;
}

}  // namespace burin::svg
