// The questions of this bench. Each prints one table in Markdown about every subject that it can be asked of.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "subject.hpp"
#include "truth_picture.hpp"

namespace burin::bench {

struct Settings {
    bool quick = false;    // fewer rays, smaller pictures, fewer frames: minutes instead of hours
    std::string scene;     // only this one; "": all
    std::string setting;   // of the renderer, where several are compared: only this one; "": all
    std::string pictures;  // folder for pictures and error maps; "": none are written
    std::string cache;     // folder of the truth's pictures; "": none are kept
    Backend backend = Backend::osmesa;
};

// Setting of the renderer that a table has a row or a column for.
struct Configuration {
    const char* name;
    std::function<void(RenderOptions&)> apply;
};
std::vector<Configuration> configurations(const Settings& settings);

// Head of a table: `fixed`, columns parted by bars, `texts` of text and then `numbers` of figures; then the `cells` of every setting.
void print_head(const Settings& settings, const std::string& fixed, int texts, int numbers, const std::vector<std::string>& cells);

// One view of a subject, as the truth has it and as the renderer gets it.
struct Picture {
    const Subject& subject;
    const PlaneView& view;
    const TruthPicture& truth;
    const Asset& asset;
};
// Prints a row for every standard view of every flat subject in which a feature is seen: its names, then what `print_cells` prints of each setting.
using PrintCells = std::function<void(const Picture&, const Configuration&, const RenderOptions&)>;
void print_picture_rows(const Settings& settings, const PrintCells& print_cells);

// How the renderer is to draw the view with this setting.
RenderOptions render_options(const Settings& settings, const Subject& subject, const PlaneView& view, const Configuration& configuration);

void ask_hits(const Settings& settings);
void ask_holes(const Settings& settings);
void ask_pictures(const Settings& settings);
void ask_memory(const Settings& settings);
void ask_flicker(const Settings& settings);
void ask_energy(const Settings& settings);
void ask_work(const Settings& settings);
void ask_features(const Settings& settings);
void ask_grid(const Settings& settings);
void ask_cost(const Settings& settings);
void ask_reference(const Settings& settings);
void ask_atrium(const Settings& settings);
void ask_tables(const Settings& settings);

// Calls visit for every flat subject that the settings name; says so where a stage refuses one.
void for_each_subject(const Settings& settings, const std::function<void(const Subject&)>& visit, bool flat_only = true);

}  // namespace burin::bench
