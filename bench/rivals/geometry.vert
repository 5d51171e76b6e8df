// Triangles of the relief itself, a tile of them shifted to its place.
uniform mat4 world_to_clip;
uniform vec3 shift;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 paint;  // x: which
centroid out vec3 world_position;  // within the facet, or its neighbour would throw a shadow on what lies beyond the crease
flat out vec3 facet_normal;
flat out int facet_paint;

void main() {
    world_position = position + shift;
    facet_normal = normal;
    facet_paint = int(paint.x + 0.5);
    gl_Position = world_to_clip * vec4(world_position, 1.0);
}
