// The shader files as strings, embedded when burin is built (embed.cmake), so that a program needs no file beside it.
#pragma once

namespace burin::gl::shader_text {

extern const char layout[], types[], fetch[], perturbation[], curve[], domain[], section[], ground[], trace[], surface[], residual[], facet[];
extern const char chord[], chart[], curvature[], curved[], footprint[], stripe[], region[], far[], far_fetch[], pixel_filter[], frame[], lamp[], material[], environment[], shade[];
extern const char bindings[], residual_fetch[], rays_frag[], top_frag[], surface_frag[], veil_frag[], screen_vert[], surface_vert[];

}  // namespace burin::gl::shader_text
