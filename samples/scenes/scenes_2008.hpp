// Scenes after "grooved surfaces" (2008).
#pragma once

#include "scenes.hpp"

namespace burin::scenes {

Scene make_parallel_grooves();
Scene make_crossing_scratches();

}  // namespace burin::scenes
