// One ray per pixel: origin and slope in a float texture, what was met in two float targets.
uniform highp sampler2D rays;
layout(location = 0) out vec4 met;     // drop, element's texel in two halves, facet
layout(location = 1) out vec4 normal;  // z up; w: 1 when something was met

void main() {
    vec4 given = texelFetch(rays, ivec2(gl_FragCoord.xy), 0);
    BurinRay ray;
    ray.origin = given.xy;
    ray.slope = given.zw;
    BurinHit hit = burin_trace(ray, 0.0, burin_map.depth);
    BurinSurface surface = burin_surface(hit);
    // Floats hold 16 bits exactly.
    vec2 place = hit.ray.origin + hit.ray.slope * hit.t;
    vec3 shaded = burin_add_slopes(surface.normal, fetch_residual(place, vec2(0.0), vec2(0.0)));
    met = vec4(hit.t, float(hit.mark.element & 0xffffu), float(hit.mark.element >> 16), float(surface.facet));
    normal = vec4(shaded, hit.met ? 1.0 : 0.0);
}
