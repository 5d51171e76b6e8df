#include "scenes.hpp"
#include "scenes_2008.hpp"
#include "scenes_2010.hpp"

namespace burin::scenes {

const std::vector<SceneEntry>& scene_table() {
    static const std::vector<SceneEntry> table = {
        {"sine_path", "2010 figure 8, top left", make_sine_path},
        {"overhang", "2010 figure 8, top middle", make_overhang},
        {"sunken_square", "2010 figure 8, top right", make_sunken_square},
        {"tapered_cracks", "2010 figure 8, bottom left", make_tapered_cracks},
        {"letters", "2010 figure 8, bottom middle", make_letters},
        {"scratched_sphere", "2010 figure 8, bottom right", make_scratched_sphere},
        {"crossing", "2010 figure 5", make_crossing},
        {"crossing_protruding", "2010 figure 6", make_crossing_protruding},
        {"intersected_end", "2010 figure 7, left", make_intersected_end},
        {"isolated_end", "2010 figure 7, middle", make_isolated_end},
        {"corner", "2010 figure 7, right", make_corner},
        {"engraved_armour", "2010 figure 1", make_engraved_armour},
        {"carved_cube", "2010 section 4.1", make_carved_cube},
        {"carved_ball", "2010 section 4.1", make_carved_ball},
        {"atrium", "2010 figures 10 and 11", make_atrium},
        {"parallel_grooves", "2008 figure 10, left", make_parallel_grooves},
        {"crossing_scratches", "2008 figure 10, right", make_crossing_scratches},
        {"grooved_sphere", "2008 figure 11", make_grooved_sphere},
        {"vinyl", "2008 figure 12, top", make_vinyl},
        {"vinyl_three_profiles", "2008 figure 12, bottom", make_vinyl_three_profiles},
        {"vinyl_recorded", "2008 figure 12, bottom", make_vinyl_recorded},
        {"columns", "2008 figure 13", make_columns},
        {"house", "2008 figure 1", make_house},
    };
    return table;
}

const SceneEntry* find_scene(std::string_view name) {
    for (const SceneEntry& entry : scene_table())
        if (entry.name == name) return &entry;
    return nullptr;
}

}  // namespace burin::scenes
