// A facet in the lamp's light, its shadow from a depth map. With GEOMETRY_DEPTH that map itself. Stands behind gl/lamp.glsl.
centroid in vec3 world_position;
flat in vec3 facet_normal;
flat in int facet_paint;
uniform sampler2DShadow from_light;
uniform mat4 world_to_light;
uniform float shadow_lift;  // metres along the normal
uniform vec3 albedos[5];
uniform vec2 metal_rough[5];
uniform vec3 eye;
uniform vec4 window;        // x and z of the object surface that is there: low, high
layout(location = 0) out vec4 color;

void main() {
#ifdef GEOMETRY_DEPTH
    color = vec4(1.0);
#else
    to_eye = normalize(eye - world_position);
    // Of the relief that shows which lies behind the object surface, y = 0.
    vec2 entered = world_position.xz - to_eye.xz * (world_position.y / to_eye.y);
    if (any(lessThan(entered, window.xy)) || any(greaterThan(entered, window.zw))) discard;
    Paint paint = Paint(albedos[facet_paint], metal_rough[facet_paint].x, metal_rough[facet_paint].y, vec3(0.0), 1.0);
    vec4 place = world_to_light * vec4(world_position + facet_normal * shadow_lift, 1.0);
    float lit = dot(facet_normal, light) > 0.0 ? texture(from_light, place.xyz * 0.5 + 0.5) : 0.0;
    vec3 around = shade_surround(facet_normal, paint);
    color = vec4(mix(clamp(around, 0.0, 1.0), clamp(around + shade_lamp(facet_normal, paint), 0.0, 1.0), lit), 1.0);
#endif
}
