// A material with path detail: the view ray goes into pattern space, the decoder finds what it meets, and that is
// shaded and shadowed. Without detail the mesh itself is shaded.
uniform vec3 eye;           // of a perspective camera
uniform vec3 view;          // direction of an orthographic one; zero for perspective
uniform vec3 light;         // towards the light, unit length
uniform float light_strength;
uniform float ambient;
uniform vec4 base_color;    // linear
uniform float metallic;
uniform float roughness;
uniform int has_detail;
uniform int shadows;
uniform highp sampler2D wanted;  // one texel per pixel: 0 where the picture needs no further sample
uniform int everywhere;          // 1: all pixels are drawn
in vec3 world_position;
in vec3 world_normal;
in vec2 pattern_uv;
in vec3 world_along_u;
in vec3 world_along_v;
layout(location = 0) out vec4 color;

// World directions of one unit of u and of v, from the derivatives of the triangle: exact on flat faces, and it jumps
// from face to face on round ones, where the mesh's own directions are better.
void derived_directions(BURIN_OUT(vec3) along_u, BURIN_OUT(vec3) along_v) {
    vec3 px = dFdx(world_position);
    vec3 py = dFdy(world_position);
    vec2 ux = dFdx(pattern_uv);
    vec2 uy = dFdy(pattern_uv);
    float area = ux.x * uy.y - ux.y * uy.x;
    area = abs(area) > 1.0e-30 ? area : 1.0e-30;
    along_u = (px * uy.y - py * ux.y) / area;
    along_v = (py * ux.x - px * uy.x) / area;
}

// Columns: world directions of one metre along x, y and z of pattern space. `own`: as the mesh brings them.
mat3 pattern_frame(vec3 n, BURIN_OUT(bool) own) {
    vec3 along_u;
    vec3 along_v;
    derived_directions(along_u, along_v);
    // Where mirrored faces meet, what the mesh brings cancels out.
    own = dot(world_along_u, along_u) > 0.5 * dot(along_u, along_u) &&
          dot(world_along_v, along_v) > 0.5 * dot(along_v, along_v);
    if (has_frames()) own = frames_hold(n, world_along_u, world_along_v, along_u, along_v);
    vec3 along_x = (own ? world_along_u : along_u) / burin_map.size.x;
    vec3 along_y = (own ? world_along_v : along_v) / burin_map.size.y;
    return mat3(along_x - n * dot(along_x, n), along_y - n * dot(along_y, n), n);
}

// Lambert and GGX with Smith's shadowing, for one light; colours linear.
vec3 shade(vec3 n, vec3 to_eye, vec3 albedo, float metal, float rough, float lit) {
    vec3 halfway = normalize(to_eye + light);
    float nl = max(dot(n, light), 0.0);
    float nv = max(dot(n, to_eye), 1.0e-3);
    float nh = max(dot(n, halfway), 0.0);
    float a = max(rough * rough, 2.0e-3);
    float a2 = a * a;
    float d = a2 / (3.14159265 * pow(nh * nh * (a2 - 1.0) + 1.0, 2.0));
    float visible = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2) + 1.0e-6);
    vec3 f0 = mix(vec3(0.04), albedo, metal);
    vec3 fresnel = f0 + (vec3(1.0) - f0) * pow(1.0 - max(dot(to_eye, halfway), 0.0), 5.0);
    vec3 diffuse = albedo * (1.0 - metal) / 3.14159265;
    vec3 direct = (diffuse * (vec3(1.0) - fresnel) + fresnel * (d * visible)) * (nl * lit * light_strength);
    // The sky is brighter than the ground; a metal mirrors what a matt surface gathers.
    float sky = 0.5 + 0.5 * n.y;
    vec3 around = mix(albedo * (1.0 - metal), fresnel * mix(1.0, 0.75, rough), mix(0.1, 1.0, metal));
    return direct + around * ambient * mix(0.35, 1.0, sky);
}

void main() {
    if (everywhere == 0 && texelFetch(wanted, ivec2(gl_FragCoord.xy), 0).x == 0.0) discard;
    vec3 to_eye = dot(view, view) > 0.0 ? -view : normalize(eye - world_position);
    vec3 n = normalize(world_normal);
    vec2 uv_along_x = dFdx(pattern_uv);
    vec2 uv_along_y = dFdy(pattern_uv);
    if (dot(n, to_eye) < 0.0 && !gl_FrontFacing) n = -n;
    vec3 albedo = base_color.rgb;
    float metal = metallic;
    float rough = roughness;
    float lit = 1.0;
    vec3 shading_normal = n;
#ifdef BURIN_CORRECT_DEPTH
    gl_FragDepth = gl_FragCoord.z;
#endif
    bool own;
    mat3 frame = pattern_frame(n, own);
    float handed = determinant(frame);
    if (has_detail != 0 && abs(handed) > 1.0e-12 && dot(n, to_eye) > 1.0e-3) {
        mat3 to_pattern = inverse(frame);
        BurinBend bend = pattern_bend(pattern_uv, frame, to_pattern, own);
        vec3 direction = to_pattern * -to_eye;
        BurinRay ray;
        ray.origin = pattern_uv * burin_map.size;
        ray.slope = burin_slope_of(direction);
        BurinSight sight = burin_eye_sight(bend, ray, direction);
        BurinFound found = burin_trace_sight(bend, ray.origin, sight);
        BurinHit hit = found.hit;
        if (!hit.met) discard;
#ifdef BURIN_CORRECT_DEPTH
        gl_FragDepth = depth_of(world_position - to_eye * found.way);
#endif
        BurinSurface surface = burin_surface(hit);
        vec2 place = hit.ray.origin + hit.ray.slope * hit.t;
        vec3 detailed = burin_add_slopes(surface.normal, fetch_residual(place, uv_along_x, uv_along_y));
        vec2 moved = found.place - ray.origin;
        shading_normal = normalize(transpose(to_pattern) * burin_bend_normal(bend, moved, hit.t, detailed));
        BurinMaterial material = burin_material(surface.material);
        if (material.overrides) {
            albedo = material.base_color.rgb;
            metal = material.metallic;
            rough = material.roughness;
        }
        vec3 toward = to_pattern * light;
        float rise = dot(burin_bend_normal(bend, moved, hit.t, vec3(0.0, 0.0, 1.0)), toward);
        if (shadows != 0 && dot(shading_normal, light) > 0.0 && rise > 0.0) {
            BurinRay shadow;
            shadow.slope = burin_slope_of(-toward);
            shadow.origin = hit.ray.origin + (hit.ray.slope - shadow.slope) * hit.t;
            float before = hit.t - 4.0e-3 * burin_map.depth;
            BurinSight lit_from = burin_light_sight(bend, shadow, before, found, sight, ray.origin, toward);
            if (before > 0.0 && burin_trace_sight(bend, ray.origin, lit_from).hit.met) lit = 0.0;
        }
        if (rise <= 0.0) lit = 0.0;
    }
    color = vec4(clamp(shade(shading_normal, to_eye, albedo, metal, rough, lit), 0.0, 1.0), 1.0);
}
