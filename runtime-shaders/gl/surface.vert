// Passes a mesh on in world space.
uniform mat4 world_to_clip;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 along_u;  // metres of the world per unit of u; zero: unknown
layout(location = 4) in vec3 along_v;
layout(location = 5) in vec3 duu;  // their changes, per unit of u and of v; zero: unknown
layout(location = 6) in vec3 duv;
layout(location = 7) in vec3 dvv;
layout(location = 8) in vec4 other_uvs;  // sets 0 and 1, where textures lie in another set than the pattern
layout(location = 9) in float chart;  // its number
out vec3 world_position;
out vec3 world_normal;
out vec2 pattern_uv;
out vec3 world_along_u;
out vec3 world_along_v;
out vec3 world_duu;
out vec3 world_duv;
out vec3 world_dvv;
out vec4 texture_uvs;
flat out float chart_number;

void main() {
    world_position = position;
    world_normal = normal;
    pattern_uv = uv;
    texture_uvs = other_uvs;
    world_along_u = along_u;
    world_along_v = along_v;
    world_duu = duu;
    world_duv = duv;
    world_dvv = dvv;
    chart_number = chart;
    gl_Position = world_to_clip * vec4(position, 1.0);
}
