// Passes a mesh on in world space.
uniform mat4 world_to_clip;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
out vec3 world_position;
out vec3 world_normal;
out vec2 pattern_uv;

void main() {
    world_position = position;
    world_normal = normal;
    pattern_uv = uv;
    gl_Position = world_to_clip * vec4(position, 1.0);
}
