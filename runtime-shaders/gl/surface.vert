// Passes a mesh on in world space.
uniform mat4 world_to_clip;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 along_u;  // metres of the world per unit of u; zero: unknown
layout(location = 4) in vec3 along_v;
out vec3 world_position;
out vec3 world_normal;
out vec2 pattern_uv;
out vec3 world_along_u;
out vec3 world_along_v;

void main() {
    world_position = position;
    world_normal = normal;
    pattern_uv = uv;
    world_along_u = along_u;
    world_along_v = along_v;
    gl_Position = world_to_clip * vec4(position, 1.0);
}
