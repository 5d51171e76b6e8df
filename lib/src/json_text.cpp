#include <burin/json_text.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include <nlohmann/json.hpp>

namespace burin {
namespace {

// Where the parser has come to. A line ends with its line feed, which still belongs to it: the parser looks one character past a number.
struct TextPosition {
    std::uint32_t line = 1, column = 0;
    bool line_ended = false;

    void pass(char letter) {
        if (line_ended) ++line, column = 0;
        ++column;
        line_ended = letter == '\n';
    }
};

// The text's characters, counted as the parser takes them.
class CountingIterator {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, TextPosition* position) : at_(at), position_(position) {}
    reference operator*() const { return *at_; }
    CountingIterator& operator++() {
        position_->pass(*at_++);
        return *this;
    }
    bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
    bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

  private:
    const char* at_;
    TextPosition* position_;
};

std::string shortened(std::string text, std::size_t most) {
    if (text.size() <= most) return text;
    // No character is cut in two.
    while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xc0) == 0x80) --most;
    return text.substr(0, most) + "...";
}

// The parser's own sentence without its numbers: "[json.exception...] parse error at line 1, column 2: syntax error ...".
std::string sentence_of(const std::string& message) {
    const std::size_t colon = message.find(": "), bracket = message.find("] ");
    const std::size_t begin = colon != std::string::npos ? colon + 2 : bracket != std::string::npos ? bracket + 2 : 0;
    return shortened(message.substr(begin), 160);
}

// Builds the tree from the parser's events.
class TreeBuilder {
  public:
    TreeBuilder(JsonValue& root, const TextPosition& position, const std::string& file)
        : root_(root), position_(position), file_(file) {}

    bool null() { return put({}); }
    bool boolean(bool value) { return put({value, 0}); }
    bool number_integer(std::int64_t value) { return put({static_cast<double>(value), 0}); }
    bool number_unsigned(std::uint64_t value) { return put({static_cast<double>(value), 0}); }
    bool number_float(double value, const std::string&) { return put({value, 0}); }
    bool string(std::string& value) { return put({std::move(value), 0}); }
    bool binary(std::vector<std::uint8_t>&) { return false; }  // not in text
    bool key(std::string& name) {
        std::get<JsonValue::Object>(open_.back()->data).push_back({std::move(name), {}});
        return true;
    }
    bool start_object(std::size_t) { return open({JsonValue::Object{}, 0}); }
    bool start_array(std::size_t) { return open({JsonValue::List{}, 0}); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& trouble) {
        return refuse(ErrorCode::invalid_input, sentence_of(trouble.what()));
    }

    const Error& error() const { return error_; }

  private:
    bool refuse(ErrorCode code, const std::string& what) {
        error_ = {code, file_ + ":" + std::to_string(position_.line) + ":" + std::to_string(position_.column) + ": " + what};
        return false;
    }

    // Where the next value goes. What is open does not move meanwhile: only the last one of them grows.
    JsonValue& slot() {
        if (open_.empty()) return root_;
        if (auto* object = std::get_if<JsonValue::Object>(&open_.back()->data)) return object->back().value;
        return std::get<JsonValue::List>(open_.back()->data).emplace_back();
    }

    bool put(JsonValue value) {
        if (++count_ > kMaxJsonTextValues)
            return refuse(ErrorCode::limit_exceeded, "more than " + std::to_string(kMaxJsonTextValues) + " values; several smaller files work");
        value.line = position_.line;
        slot() = std::move(value);
        return true;
    }

    bool open(JsonValue value) {
        if (open_.size() >= static_cast<std::size_t>(kMaxJsonTextDepth))
            return refuse(ErrorCode::limit_exceeded, "nested deeper than " + std::to_string(kMaxJsonTextDepth) + " levels");
        if (++count_ > kMaxJsonTextValues) return put({});
        value.line = position_.line;
        JsonValue& place = slot();
        place = std::move(value);
        open_.push_back(&place);
        return true;
    }

    bool close() {
        open_.pop_back();
        return true;
    }

    JsonValue& root_;
    const TextPosition& position_;
    const std::string& file_;
    std::vector<JsonValue*> open_;
    std::size_t count_ = 0;
    Error error_;
};

std::string quoted(const std::string& text) {
    std::string inside = "\"";
    inside += shortened(text, 60);
    return inside += '"';
}

std::string number_words(double value) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string range_words(const JsonRange& range) {
    constexpr double any = std::numeric_limits<double>::max();
    const std::string low = number_words(range.low), high = number_words(range.high);
    if (range.high >= any) return range.above ? "more than " + low : low + " or more";
    return (range.above ? "above " + low + " up to " : low + " to ") + (range.below ? "below " : "") + high;
}

// Changes of one letter that make b of a, at most `most` + 1.
std::size_t distance(const std::string& a, const std::string& b, std::size_t most) {
    if (std::max(a.size(), b.size()) - std::min(a.size(), b.size()) > most) return most + 1;
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = std::exchange(row[j], std::min({changed, row[j] + 1, row[j - 1] + 1}));
        }
    }
    return row[b.size()];
}

std::string listed(std::span<const std::string> names) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    return shortened(all, 400);
}

bool plain_name(const std::string& name) {
    const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '$'; };
    return !name.empty() && name.size() <= 60 && std::all_of(name.begin(), name.end(), plain);
}

std::string step_to(const std::string& name, bool first) {
    if (!plain_name(name)) return std::string("[").append(quoted(name)).append("]");
    return first ? name : std::string(".").append(name);
}

bool find_place(const JsonValue& from, const JsonValue& wanted, std::string& place) {
    if (&from == &wanted) return true;
    const std::size_t size = place.size();
    const auto enter = [&](const JsonValue& inner, const std::string& step) {
        place += step;
        if (find_place(inner, wanted, place)) return true;
        place.resize(size);
        return false;
    };
    if (const auto* list = std::get_if<JsonValue::List>(&from.data)) {
        for (std::size_t i = 0; i < list->size(); ++i)
            if (enter((*list)[i], std::string("[").append(std::to_string(i)).append("]"))) return true;
    } else if (const auto* object = std::get_if<JsonValue::Object>(&from.data)) {
        for (const JsonMember& member : *object)
            if (enter(member.value, step_to(member.name, place.empty())))
                return true;
    }
    return false;
}

}  // namespace

Result<JsonValue> parse_json_text(std::string_view text, const std::string& file) {
    if (text.size() > kMaxJsonTextBytes)
        return Error{ErrorCode::limit_exceeded, file + ": " + std::to_string(text.size()) + " bytes of JSON, limit " +
                                                    std::to_string(kMaxJsonTextBytes)};
    JsonValue root;
    TextPosition position;
    TreeBuilder builder(root, position, file);
    const CountingIterator begin(text.data(), &position), end(text.data() + text.size(), &position);
    if (!nlohmann::json::sax_parse(begin, end, &builder)) return builder.error();
    return root;
}

std::string nearest_name(const std::string& wrong, std::span<const std::string> names) {
    std::string best;
    // A third of the letters may be wrong.
    std::size_t least = std::min<std::size_t>(wrong.size(), 60) / 3 + 2;
    for (const std::string& name : names)
        if (const std::size_t changes = distance(wrong, name, least - 1); changes < least) best = name, least = changes;
    return best;
}

std::string shown(const JsonValue& value) {
    if (const auto* flag = std::get_if<bool>(&value.data)) return *flag ? "true" : "false";
    if (const auto* number = std::get_if<double>(&value.data)) return number_words(*number);
    if (const auto* text = std::get_if<std::string>(&value.data)) return quoted(*text);
    if (const auto* list = std::get_if<JsonValue::List>(&value.data))
        return list->empty() ? "an empty list" : "a list of " + std::to_string(list->size());
    return value.is_object() ? "an object" : "null";
}

std::string JsonReader::place_of(const JsonValue& value) const {
    std::string place;
    find_place(root_, value, place);
    return place;
}

void JsonReader::refuse(const JsonValue& value, const std::string& what, ErrorCode code) {
    if (failed()) return;
    const std::string place = place_of(value);
    error_ = {code, file_ + ":" + std::to_string(value.line) + ": " + (place.empty() ? "" : place + ": ") + what};
}

void JsonReader::expect(const JsonValue& value, const std::string& what_works) {
    refuse(value, shown(value) + " does not work here; " + what_works + " does");
}

double JsonReader::number(const JsonValue& value, const JsonRange& range) {
    const double* number = std::get_if<double>(&value.data);
    if (number == nullptr) return expect(value, "a number"), 0.0;
    if (range.contains(*number)) return *number;
    refuse(value, shown(value) + " is out of its range; " + range_words(range) + " works");
    return 0.0;
}

int JsonReader::integer(const JsonValue& value, int low, int high) {
    const double number = this->number(value, {static_cast<double>(low), static_cast<double>(high)});
    if (number != std::floor(number)) return expect(value, "a whole number"), 0;
    return static_cast<int>(number);
}

std::uint32_t JsonReader::whole(const JsonValue& value) {
    const double number = this->number(value, {0.0, 4294967295.0});
    if (number != std::floor(number)) return expect(value, "a whole number"), 0;
    return static_cast<std::uint32_t>(number);
}

bool JsonReader::boolean(const JsonValue& value) {
    if (const bool* flag = std::get_if<bool>(&value.data)) return *flag;
    expect(value, "true or false");
    return false;
}

const std::string& JsonReader::text(const JsonValue& value) {
    static const std::string nothing;
    if (const auto* text = std::get_if<std::string>(&value.data)) return *text;
    expect(value, "a text in quotes");
    return nothing;
}

std::size_t JsonReader::choice(const JsonValue& value, std::span<const char* const> names) {
    const auto* text = std::get_if<std::string>(&value.data);
    for (std::size_t i = 0; i < names.size(); ++i)
        if (text != nullptr && *text == names[i]) return i;
    std::string all;
    for (std::size_t i = 0; i < names.size(); ++i) all += (i == 0 ? "\"" : i + 1 < names.size() ? ", \"" : " or \"") + std::string(names[i]) + "\"";
    expect(value, all);
    return 0;
}

std::span<const JsonValue> JsonReader::list(const JsonValue& value, std::size_t least, std::size_t most) {
    const auto* list = std::get_if<JsonValue::List>(&value.data);
    if (list != nullptr && list->size() >= least && list->size() <= most) return *list;
    const std::string count = least == most              ? std::to_string(least)
                              : most == std::size_t(-1) ? std::to_string(least) + " or more"
                                                         : std::to_string(least) + " to " + std::to_string(most);
    expect(value, least == 0 && most == std::size_t(-1) ? "a list" : "a list of " + count);
    return {};
}

Vec2 JsonReader::pair(const JsonValue& value, const JsonRange& range) {
    const auto two = list(value, 2, 2);
    if (two.empty()) return {};
    return {number(two[0], range), number(two[1], range)};
}

JsonObject::JsonObject(JsonReader& reader, const JsonValue& value) : reader_(reader), value_(value) {
    const auto* members = std::get_if<JsonValue::Object>(&value.data);
    if (members == nullptr) {
        reader.expect(value, "an object in braces");
        return;
    }
    members_ = *members;
    std::vector<const JsonMember*> sorted;
    for (const JsonMember& member : members_) sorted.push_back(&member);
    std::stable_sort(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return a->name < b->name; });
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return a->name == b->name; });
    if (twice != sorted.end()) reader.refuse((*(twice + 1))->value, "this name stands twice in its object, before on line " + std::to_string((*twice)->value.line));
}

const JsonValue* JsonObject::find(const char* name) {
    asked_.emplace_back(name);
    for (const JsonMember& member : members_)
        if (member.name == name) return &member.value;
    return nullptr;
}

const JsonValue* JsonObject::need(const char* name) {
    const JsonValue* found = find(name);
    if (found == nullptr) missing_.emplace_back(name);
    return found;
}

void JsonObject::finish() {
    if (reader_.failed()) return;
    for (const JsonMember& member : members_) {
        if (member.name == "note" || std::find(asked_.begin(), asked_.end(), member.name) != asked_.end()) continue;
        const std::string near = nearest_name(member.name, asked_);
        reader_.refuse(member.value, "there is no property of this name here; " + (near.empty() ? "" : "did you mean \"" + near + "\"? ") +
                                         "what works is " + listed(asked_));
    }
    for (const std::string& name : missing_) reader_.refuse(value_, "\"" + name + "\" is missing");
}

}  // namespace burin
