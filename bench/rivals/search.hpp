// The fastest setting of a technique, and of burin, that reaches an error.
#pragma once

#include <string>
#include <vector>

#include "stage.hpp"

namespace burin::rivals {

// One thing that was drawn: for the tables, and for plots of error against time and bytes.
struct Tried {
    RivalSettings settings;
    Trial trial;
};

struct Found {
    bool reached = false;
    bool pruned = false;  // its least setting takes longer than what was found before
    Tried best;           // the fastest that reaches it; else the one of the least error
};

struct SearchLimits {
    int coarsest = 512, finest = 8192;  // texels per side
    double slowest = 1e9;               // milliseconds: what takes longer than this is not followed up
};

// Tries settings of one technique on a stage and remembers what they came to.
class Searcher {
  public:
    Searcher(Stage& stage, Technique technique, const SearchLimits& limits)
        : stage_(stage), technique_(technique), limits_(limits) {}
    void set_slowest(double milliseconds) { limits_.slowest = milliseconds; }

    // Starts from the best that the technique can do and gives up samples, steps and texels as far as the error allows. Finer maps than
    // 4096 are asked only where that falls short by less than what a map of twice the size gains.
    Found find(double decibels);
    const std::vector<Tried>& tried() const { return tried_; }

  private:
    Trial try_setting(const RivalSettings& settings);
    bool too_slow();
    RivalSettings best_quality(double wanted);
    RivalSettings better_of(const RivalSettings& a, const RivalSettings& b);
    bool holds(const RivalSettings& settings, double decibels) { return try_setting(settings).decibels >= decibels; }
    RivalSettings cheapest(RivalSettings settings, double decibels);

    Stage& stage_;
    Technique technique_;
    SearchLimits limits_;
    std::vector<Tried> tried_;
};

// A setting of burin's own renderer.
struct BurinTried {
    std::string name;
    Trial trial;
};
// All settings that the tables choose from, the default first.
Result<std::vector<BurinTried>> try_burin(Stage& stage);
std::function<void(RenderOptions&)> burin_setting(const std::string& name);

}  // namespace burin::rivals
