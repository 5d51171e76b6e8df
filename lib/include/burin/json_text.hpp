// JSON that people write: every value knows its line, and every complaint says file, line, place and value.
//
//     text --[parse_json_text]--> JsonValue --[JsonReader, JsonObject]--> numbers, texts, lists, or the first complaint
//
// A reader asks for what it expects and goes on with something harmless where it does not get it; the first complaint stays and is
// the error in the end. So nothing has to be checked after every value:
//
//     plate.json:12: paths[3].profile: "grove" is no profile; did you mean "groove"?
//
// Input is not trusted: size, nesting and number of values are bounded, and reading is linear in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <burin/geometry.hpp>
#include <burin/result.hpp>

namespace burin {

// Limits, each named in the message when it is exceeded.
inline constexpr std::uint64_t kMaxJsonTextBytes = 1ull << 28;
inline constexpr std::size_t kMaxJsonTextValues = 1ull << 24;
inline constexpr int kMaxJsonTextDepth = 64;

struct JsonMember;

struct JsonValue {
    using List = std::vector<JsonValue>;
    using Object = std::vector<JsonMember>;  // in the order of the text
    std::variant<std::monostate, bool, double, std::string, List, Object> data;
    std::uint32_t line = 1;  // where it ends; a list or an object: where it begins

    bool is_number() const { return std::holds_alternative<double>(data); }
    bool is_text() const { return std::holds_alternative<std::string>(data); }
    bool is_list() const { return std::holds_alternative<List>(data); }
    bool is_object() const { return std::holds_alternative<Object>(data); }
};

struct JsonMember {
    std::string name;
    JsonValue value;
};

// RFC 8259 in UTF-8. `file` begins the messages. Fails with invalid_input: where the text is damaged, by line and column, and what was
// expected there; with limit_exceeded for the limits above.
Result<JsonValue> parse_json_text(std::string_view text, const std::string& file);

// "groove" for "grove": the name that takes the fewest changes; none when all of them are far from it.
std::string nearest_name(const std::string& wrong, std::span<const std::string> names);

// What a number may be. Both ends are included, unless `above` excludes the lower one and `below` the upper one.
struct JsonRange {
    double low = -std::numeric_limits<double>::max(), high = std::numeric_limits<double>::max();
    bool above = false, below = false;
    bool contains(double number) const {
        return (above ? number > low : number >= low) && (below ? number < high : number <= high);
    }
};

// Reads values of one document and keeps the first complaint. The document must outlive it.
class JsonReader {
  public:
    JsonReader(const JsonValue& root, std::string file) : root_(root), file_(std::move(file)) {}

    // What is no such value, or out of its range, is refused; 0, "", no item or the first choice come back then.
    double number(const JsonValue& value, const JsonRange& range = {});
    int integer(const JsonValue& value, int low, int high);
    std::uint32_t whole(const JsonValue& value);  // of 32 bits
    bool boolean(const JsonValue& value);
    const std::string& text(const JsonValue& value);
    std::size_t choice(const JsonValue& value, std::span<const char* const> names);  // which of the names
    std::span<const JsonValue> list(const JsonValue& value, std::size_t least, std::size_t most);
    Vec2 pair(const JsonValue& value, const JsonRange& range = {});  // a list of two numbers

    // Complains: `what` follows file, line and place.
    void refuse(const JsonValue& value, const std::string& what, ErrorCode code = ErrorCode::invalid_input);
    // Complains of a value of the wrong kind, and names it.
    void expect(const JsonValue& value, const std::string& what_works);

    bool failed() const { return !error_.message.empty(); }
    const Error& error() const { return error_; }  // of no meaning unless failed()

    // "paths[3].profile"; empty for the document itself. Cost: that of a walk through the document.
    std::string place_of(const JsonValue& value) const;

  private:
    const JsonValue& root_;
    std::string file_;
    Error error_{ErrorCode::invalid_input, ""};
};

// The value as a message shows it: short, texts in quotes.
std::string shown(const JsonValue& value);

// The members of one object. Ask for all that there may be, then finish().
class JsonObject {
  public:
    // Complains of what is no object, and of a name that stands twice.
    JsonObject(JsonReader& reader, const JsonValue& value);

    const JsonValue* find(const char* name);  // null where it is missing
    const JsonValue* need(const char* name);  // finish() complains where it is missing
    // Complains of members that nobody asked for, except `note`, which is for people, and of needed ones that are missing.
    void finish();

  private:
    JsonReader& reader_;
    const JsonValue& value_;
    std::span<const JsonMember> members_;
    std::vector<std::string> asked_, missing_;
};

}  // namespace burin
