// Scenes after "grooved surfaces" (2008).
#pragma once

#include "scenes.hpp"

namespace burin::scenes {

Scene make_parallel_grooves();
Scene make_crossing_scratches();
Scene make_grooved_sphere();
Scene make_vinyl();
Scene make_vinyl_three_profiles();
Scene make_vinyl_recorded();
Scene make_columns();
Scene make_house();

}  // namespace burin::scenes
