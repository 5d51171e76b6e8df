// The shader files as strings, embedded when burin is built (embed.cmake), so that a program needs no file beside it.
#pragma once

namespace burin::gl::shader_text {

extern const char layout[], types[], fetch[], curve[], domain[], section[], ground[], trace[], curvature[], surface[];
extern const char bindings[], residual[], residual_fetch[], curved[], rays_frag[], top_frag[], surface_frag[], screen_vert[], surface_vert[];

}  // namespace burin::gl::shader_text
