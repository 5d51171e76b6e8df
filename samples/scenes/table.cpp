#include "scenes.hpp"
#include "scenes_2008.hpp"
#include "scenes_2010.hpp"

namespace burin::scenes {

const std::vector<SceneEntry>& scene_table() {
    static const std::vector<SceneEntry> table = {
        {"sine_path", "2010 figure 8, top left", make_sine_path},
        {"sunken_square", "2010 figure 8, top right", make_sunken_square},
        {"parallel_grooves", "2008 figure 10, left", make_parallel_grooves},
        {"crossing_scratches", "2008 figure 10, right", make_crossing_scratches},
    };
    return table;
}

}  // namespace burin::scenes
