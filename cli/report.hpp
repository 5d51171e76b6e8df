// What a command says: progress on stderr, results on stdout as text or JSON, from the same record.
//
// Text is for people: labels, units, aligned columns. JSON carries every value under its key, in SI units or as a
// number of bytes, and nothing else goes to stdout then. JSON.md lists the keys of every command; tests/cli compares.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <burin/result.hpp>

#include "command.hpp"

namespace burin::cli {

struct Field {
    std::string key;    // JSON name
    std::string label;  // text; empty: JSON only
    // Fields in a field are an object in JSON; text shows them on one line, each with its label.
    std::variant<std::int64_t, double, bool, std::string, std::vector<Field>> value;
    std::string text;  // how text shows the value; empty: as it is
};

inline Field group(std::string key, std::string label, std::vector<Field> fields) {
    return {std::move(key), std::move(label), std::move(fields), ""};
}

// A list of like things: one row each. Text shows a row's plain values in columns, and a line below for each field that
// holds fields.
struct Rows {
    std::string key;    // JSON name of the array
    std::string title;  // text above the rows
    std::vector<std::vector<Field>> rows;
};

class Report {
  public:
    void add(Field field) { fields_.push_back(std::move(field)); }
    void add_group(std::string key, std::string label, std::vector<Field> fields) {
        add(group(std::move(key), std::move(label), std::move(fields)));
    }
    void add_rows(Rows rows) { rows_.push_back(std::move(rows)); }

    // What text shows without rows, a label and a value each, and without the field whose key is `but`.
    std::vector<std::pair<std::string, std::string>> lines(const std::string& but) const;

    // Prints to stdout as --format asks, to the last byte; nothing when --quiet is given and the format is text.
    // Fails with io_failed when standard output does not take it: a full disk, a closed pipe.
    Status print(const Arguments& arguments) const;

  private:
    std::string as_text() const;
    std::string as_json() const;

    std::vector<Field> fields_;
    std::vector<Rows> rows_;
};

// The end of a command: prints its report and gives `answer`, or ExitCode::output when the report could not be printed.
ExitCode print_answer(const Arguments& arguments, const Report& report, ExitCode answer);

// One line per stage on stderr: name, share done, seconds. Silent unless stderr is a terminal, or when --quiet.
class ProgressLine {
  public:
    explicit ProgressLine(const Arguments& arguments);
    // Ends the line of a stage that was not finished, so that an error starts on a line of its own.
    ~ProgressLine();
    void update(std::string_view stage, double fraction);
    void finish();

  private:
    bool shown_ = false;
    std::string stage_;
    int percent_ = -1;
    std::chrono::steady_clock::time_point begun_;
};

// Text for people: 4 significant digits; bytes with KiB from 10 KiB on and MiB from 10 MiB on; a share as per cent.
std::string number_text(double value);
std::string bytes_text(std::uint64_t bytes);
std::string explained_text(double share);  // four decimals, rounded down: 1 is all of it and nothing less
std::string percent_text(double share, int digits = 2);

}  // namespace burin::cli
