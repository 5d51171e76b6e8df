// The words of GLSL that core/*.glsl uses and C++ lacks. Include before the core text, inside no namespace.
//
// The core text is included into the body of a class: its functions become members, so that they reach
// burin_map and the two textures without a global.
#pragma once

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>

#define BURIN_OUT(type) type&
#define BURIN_INOUT(type) type&

namespace burin::glsl {
using namespace glm;
using uint = unsigned int;
}  // namespace burin::glsl
