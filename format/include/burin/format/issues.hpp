// Every finding of the validator: number, severity, one-line summary. A number never changes its meaning.
//
//   1xxx container (GLB and glTF JSON)   2xxx extension JSON and buffer views
//   3xxx grid texture                    4xxx data texture
// SPECIFICATION.md names the number at each MUST; tests/unit/validate_test.cpp has a file for each that
// breaks only it.
#pragma once

#include <span>
#include <string>

namespace burin {

enum class Severity { error, warning, information };  // a MUST, a SHOULD, a remark

// One finding on one file.
struct Issue {
    int number = 0;
    Severity severity = Severity::error;
    std::string message;  // what, which value, what would be right; one line
    std::string
        pointer;  // JSON pointer into the glTF, and "cell (3,4)" or "element at texel 12" inside a texture
};

// One row of the table of all issues.
struct IssueKind {
    int number;
    Severity severity;
    const char* summary;
};

// All kinds, in growing order of number.
std::span<const IssueKind> issue_kinds();
// The kind of that number; nullptr when there is none.
const IssueKind* find_issue_kind(int number);

}  // namespace burin
