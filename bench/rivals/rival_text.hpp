// The rivals' shader files as strings (runtime-shaders/embed.cmake).
#pragma once

namespace burin::gl::shader_text {

extern const char rival_vert[], rival_frag[], geometry_vert[], geometry_frag[];

}  // namespace burin::gl::shader_text
