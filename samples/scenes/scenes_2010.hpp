// Scenes after "real-time path-based detail" (2010).
#pragma once

#include "scenes.hpp"

namespace burin::scenes {

Scene make_sine_path();
Scene make_overhang();
Scene make_sunken_square();
Scene make_tapered_cracks();
Scene make_letters();
Scene make_scratched_sphere();
Scene make_engraved_armour();
Scene make_carved_cube();
Scene make_carved_ball();
Scene make_atrium();

// Figures 5 to 7.
Scene make_crossing();
Scene make_crossing_protruding();
Scene make_intersected_end();
Scene make_isolated_end();
Scene make_corner();

}  // namespace burin::scenes
