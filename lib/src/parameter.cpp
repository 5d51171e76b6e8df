#include <burin/parameter.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "text.hpp"

namespace burin {
namespace {

Error refuse(const std::string& owner, const std::string& what) { return {ErrorCode::invalid_argument, owner + ": " + what}; }

Status read_one(const std::string& owner, std::string_view text, ParameterValues& values) {
    const std::size_t equals = text.find('=');
    const std::string name(trimmed(text.substr(0, equals)));
    const std::string_view value = equals == std::string_view::npos ? std::string_view() : trimmed(text.substr(equals + 1));
    double number = 0.0;
    const auto [rest, error] = std::from_chars(value.data(), value.data() + value.size(), number);
    if (name.empty() || error != std::errc() || rest != value.data() + value.size() || !std::isfinite(number))
        return refuse(owner, std::string("'").append(text).append("' is not NAME=NUMBER"));
    if (!values.emplace(name, number).second) return refuse(owner, name + " is given twice; once works");
    return Done{};
}

Status check_value(const std::string& owner, const Parameter& parameter, double value) {
    const bool inside = value >= parameter.low && value <= parameter.high;
    if (inside && (!parameter.whole || value == std::floor(value))) return Done{};
    return refuse(owner, std::string(parameter.name).append(" ").append(parameter_text(value))
                             .append(inside ? " is not a whole number; " : " is out of its range; ").append(range_text(parameter)).append(" works"));
}

}  // namespace

std::string parameter_text(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 8).ptr};
}

std::string range_text(const Parameter& parameter) {
    std::string text = parameter_text(parameter.low).append(" to ").append(parameter_text(parameter.high));
    if (*parameter.unit) text.append(" ").append(parameter.unit);
    return parameter.whole ? text.append(", whole") : text;
}

Result<ParameterValues> parse_parameters(const std::string& owner, std::string_view text) {
    ParameterValues values;
    if (trimmed(text).empty()) return values;
    for (;;) {
        const std::size_t comma = text.find(',');
        if (const Status read = read_one(owner, text.substr(0, comma), values); !read) return read.error();
        if (comma == std::string_view::npos) return values;
        text = text.substr(comma + 1);
    }
}

Result<ParameterValues> complete_parameters(const std::string& owner, const std::vector<Parameter>& table, const ParameterValues& given) {
    ParameterValues values;
    std::string names;
    for (const Parameter& parameter : table) {
        values[parameter.name] = parameter.usual;
        names.append(names.empty() ? "" : ", ").append(parameter.name);
    }
    for (const auto& [name, value] : given) {
        const auto parameter = std::find_if(table.begin(), table.end(), [&name = name](const Parameter& p) { return name == p.name; });
        if (parameter == table.end())
            return refuse(owner, std::string("no parameter is called '").append(name).append("'; ")
                                     .append(names.empty() ? "there are none" : names.append(" work")));
        if (const Status status = check_value(owner, *parameter, value); !status) return status.error();
        values[name] = value;
    }
    return values;
}

}  // namespace burin
