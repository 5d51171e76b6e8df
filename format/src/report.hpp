// Collects findings: looks up the severity, counts errors, and keeps a damaged file from flooding the caller.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include <burin/format/validate.hpp>

namespace burin {

class Reporter {
  public:
    Reporter(const IssueSink& sink, std::size_t max_per_number)
        : sink_(sink), max_per_number_(max_per_number) {}
    Reporter(const Reporter&) = delete;
    Reporter& operator=(const Reporter&) = delete;

    // Text put before the place of every further issue.
    void set_prefix(std::string_view prefix) { prefix_ = prefix; }
    const std::string& prefix() const { return prefix_; }

    void report(int number, std::string message, std::string_view place = {});
    // Says for each number how many findings were left out.
    void close();

    std::size_t errors() const { return errors_; }

  private:
    const IssueSink& sink_;
    std::size_t max_per_number_;
    std::string prefix_;
    std::size_t errors_ = 0;
    std::map<int, std::size_t> counts_;
};

// Shortest decimal text that reads back as the same double.
std::string number_text(double value);

}  // namespace burin
