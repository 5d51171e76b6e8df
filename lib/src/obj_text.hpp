// Lines, words and numbers of Wavefront OBJ. For the sources of this library only.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace burin::obj_text {

// Takes one logical line off the text: a backslash at the end joins the next one. Counts those it joins.
inline std::string_view next_line(std::string_view& text, std::size_t& line_number) {
    std::size_t end = text.find('\n');
    while (end != std::string_view::npos && end > 0 && (text[end - 1] == '\\' || (end > 1 && text[end - 1] == '\r' && text[end - 2] == '\\'))) {
        ++line_number;
        end = text.find('\n', end + 1);
    }
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return line;
}

// Takes one word off the line; empty at its end.
inline std::string_view next_word(std::string_view& line) {
    constexpr std::string_view kBlank = " \t\r\n\\\f\v";
    const std::size_t begin = line.find_first_not_of(kBlank);
    if (begin == std::string_view::npos) return line = {};
    line.remove_prefix(begin);
    const std::string_view word = line.substr(0, line.find_first_of(kBlank));
    line.remove_prefix(word.size());
    return word;
}

// For messages.
inline std::string printable(std::string_view word) {
    std::string text(word.substr(0, 24));
    for (char& c : text)
        if (c < 0x20 || c > 0x7e) c = '?';
    return text;
}

// Beyond 1e30 products of coordinates would leave the range of float.
inline std::optional<double> obj_number(std::string_view word) {
    if (!word.empty() && word[0] == '+') word.remove_prefix(1);
    double value = 0.0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool tiny = problem == std::errc::result_out_of_range && std::abs(value) < 1.0;
    if ((problem != std::errc{} && !tiny) || end != word.data() + word.size() || !(std::abs(value) <= 1e30)) return std::nullopt;
    return value;
}

// One of the numbers of "7/3/1": from 1, or from the end when negative.
inline std::optional<std::uint32_t> obj_index(std::string_view text, std::size_t count) {
    std::int64_t value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{} || end != text.data() + text.size() || value == 0) return std::nullopt;
    if (value < 0) value += static_cast<std::int64_t>(count) + 1;
    if (value < 1 || value > static_cast<std::int64_t>(count)) return std::nullopt;
    return static_cast<std::uint32_t>(value - 1);
}

}  // namespace burin::obj_text
