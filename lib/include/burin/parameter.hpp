// Numbers with a name, a usual value and a range: what profiles and generators are set by.
//
//     "floor=0.4, slope=60" --[parse_parameters]--> values that differ --[complete_parameters]--> all values, checked
//
// Who has parameters lists them in one table; messages, help and documentation are made of it.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <burin/result.hpp>

namespace burin {

struct Parameter {
    const char* name;
    double usual, low, high;  // both ends included
    const char* help;         // one line, no full stop
    const char* unit = "";    // "" for shares and counts
    bool whole = false;       // a whole number
};

using ParameterValues = std::map<std::string, double>;

// Numbers joined by commas, each NAME=NUMBER; blanks around either do not matter, and empty text is no parameter.
// Fails with invalid_argument, the message beginning with `owner`: not of that form, not finite, given twice.
Result<ParameterValues> parse_parameters(const std::string& owner, std::string_view text);

// The usual values with those of `given` in their places. Fails with invalid_argument, the message beginning with `owner`: a name
// that the table does not have (the message lists those it has), a value out of its range or not whole.
Result<ParameterValues> complete_parameters(const std::string& owner, const std::vector<Parameter>& table, const ParameterValues& given);

// "0.4", "1e-05": as few digits as a reader needs.
std::string parameter_text(double value);

// "0 to 1", "2 to 8, whole", "0.1 to 90 deg".
std::string range_text(const Parameter& parameter);

}  // namespace burin
