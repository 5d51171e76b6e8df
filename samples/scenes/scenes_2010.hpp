// Scenes after "real-time path-based detail" (2010).
#pragma once

#include "scenes.hpp"

namespace burin::scenes {

Scene make_sine_path();
Scene make_sunken_square();

}  // namespace burin::scenes
