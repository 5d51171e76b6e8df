// Results of the rivals' bench as tables and as lines for plots.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "../../tests/judge/judge.hpp"
#include "search.hpp"

namespace burin::rivals {

inline constexpr double kFixedDecibels = 30.0;  // of the second table
inline constexpr double kLeastDecibels = 34.0;  // where burin itself stays below, its ratio says nothing

// One technique on one view.
struct TechniqueResult {
    Technique technique = Technique::relief;
    Found equal, fixed, matched;  // at burin's own error, at the fixed one, and at ViewResult::matched_decibels
    MapBytes bytes;               // of the map that `matched` takes
    std::vector<Tried> tried;
};

struct BurinBytes {
    double stored = 0.0;  // the two textures of the format
    double drawn = 0.0;   // with the prefilter that the renderer makes of them
};
BurinBytes burin_bytes(const testing::PreparedPattern& prepared);

// Whether a pattern has neither ridges nor steps nor profiles that overhang.
bool holds_grooves_only(const ResolvedPattern& pattern);

struct ViewResult {
    std::string scene, view;
    bool grooves = true;
    BurinBytes bytes;
    std::vector<BurinTried> burin;  // the default first
    std::vector<TechniqueResult> techniques;
    double matched_decibels = 0.0;  // burin's own where some technique reaches it, else what the best of them reaches with ease

    bool is_reached() const { return best() != nullptr; }
    // The fastest technique that reaches burin's error; null where none does.
    const TechniqueResult* best() const;
    // The technique of the least error.
    const TechniqueResult* nearest() const;
    // The fastest technique at matched_decibels.
    const TechniqueResult& matched() const;
    // burin's fastest setting of at least so many decibels; null where none has. The default stands for itself at its own error.
    const BurinTried* burin_at(double decibels) const;
    // Time of the fastest technique over burin's, at matched_decibels; by burin's default where that is its own error.
    double time_ratio() const;
};

// Collects views; `lines` names a file, "" for none.
class Report {
  public:
    explicit Report(const std::string& lines);
    ~Report();
    void begin() const;
    // Prints the row of the first table.
    void add(const ViewResult& result, const Stage& stage);
    // The other tables and the summary.
    void end() const;

  private:
    void write_lines(const ViewResult& result, const Stage& stage) const;
    void print_techniques() const;
    void print_fixed() const;
    void print_summary() const;

    std::vector<ViewResult> results_;
    std::FILE* lines_ = nullptr;
};

}  // namespace burin::rivals
