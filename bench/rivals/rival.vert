// Passes a mesh on in world space; with RIVAL_TRIANGLES as low as the map says.
uniform mat4 world_to_clip;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec3 along_u;
layout(location = 4) in vec3 along_v;
out vec3 world_position;
out vec3 world_normal;
out vec2 pattern_uv;
out vec3 world_along_u;
out vec3 world_along_v;
#ifdef RIVAL_TRIANGLES
uniform sampler2D heights;
uniform vec2 drops;        // metres below the object surface, of the highest place and of the lowest
uniform float grid_level;  // mip level as coarse as the vertices stand
out float drop;            // metres below the object surface
#endif

void main() {
    world_position = position;
    world_normal = normal;
    pattern_uv = uv;
    world_along_u = along_u;
    world_along_v = along_v;
#ifdef RIVAL_TRIANGLES
    drop = mix(drops.y, drops.x, textureLod(heights, uv, grid_level).r);
    world_position -= normal * drop;
#endif
    gl_Position = world_to_clip * vec4(world_position, 1.0);
}
