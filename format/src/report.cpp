#include "report.hpp"

#include <cassert>
#include <charconv>

namespace burin {

void Reporter::report(int number, std::string message, std::string_view place) {
    const IssueKind* kind = find_issue_kind(number);
    assert(kind != nullptr);
    if (kind->severity == Severity::error) ++errors_;
    if (++counts_[number] > max_per_number_) return;
    std::string pointer = prefix_;
    if (!pointer.empty() && !place.empty() && place.front() != '/') pointer += ' ';
    pointer += place;
    if (sink_) sink_(Issue{number, kind->severity, std::move(message), std::move(pointer)});
}

void Reporter::close() {
    for (const auto& [number, count] : counts_) {
        if (count <= max_per_number_ || !sink_) continue;
        sink_(Issue{9001,
                    Severity::information,
                    std::to_string(count - max_per_number_) + " further findings of number " +
                        std::to_string(number) + " are not listed",
                    {}});
    }
    counts_.clear();
}

std::string number_text(double value) {
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return std::string(text, end);
}

}  // namespace burin
