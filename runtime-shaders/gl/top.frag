// Heights from straight above in the map's scale: 1 the object surface, 0 the deepest point.
uniform vec2 texel;    // metres per pixel
uniform vec2 first;    // pixel of the whole picture that this target begins with
uniform int samples;   // per side
layout(location = 0) out vec4 height;

void main() {
    float sum = 0.0;
    vec2 corner = first + floor(gl_FragCoord.xy);
    for (int k = 0; k < samples * samples; ++k) {
        vec2 within = (vec2(float(k % samples), float(k / samples)) + vec2(0.5)) / float(samples);
        BurinRay ray;
        ray.origin = (corner + within) * texel;
        ray.slope = vec2(0.0);
        sum += burin_trace(ray, 0.0, burin_map.depth).t;
    }
    height = vec4(1.0 - sum / (burin_map.depth * float(samples * samples)));
}
