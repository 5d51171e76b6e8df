// Metallic-roughness shading of what a ray has met: one directional light, and a soft surround or, with BURIN_ENVIRONMENT, an
// environment. Stands behind gl/lamp.glsl, gl/material.glsl and, with it, gl/environment.glsl.

// The pixel's own: set by main before anything is shaded.
mat3 to_pattern;     // world directions to pattern space
vec2 rest_slopes;    // of the residual, at what is shaded
vec2 uv_along_x;     // sides of what is filtered
vec2 uv_along_y;
bool light_above;    // the object surface faces the light; else nothing of it is lit
bool along_look;     // what is shaded lies on the straight ray of look_origin and look_slope, at its own drop

#ifdef BURIN_ENVIRONMENT
// A normal of pattern space in the world.
vec3 world_of(vec3 normal) {
    return normalize(transpose(to_pattern) * burin_bend_normal(bend, bend_moved, bend_drop, normal));
}

// The split sum, with what facets mirror more than once (C. Fdez-Aguera, A Multiple-Scattering Microfacet Model for Real-Time
// Image-based Lighting, 2019), so that white things lose nothing. What hides the sky is taken to be as bright as the place itself: of a
// matt one, light and colour make a geometric series.
vec3 shade_around(vec3 n, vec3 bent, vec3 mirrored, BurinSky sky, Paint paint) {
    vec3 f0 = mix(vec3(0.04), paint.albedo, paint.metal);
    vec2 share = mirrored_share(clamp(dot(n, to_eye), 0.0, 1.0), paint.rough);
    vec3 once = f0 * share.x + share.y;
    float rest = 1.0 - share.x - share.y;
    vec3 mean_f = f0 + (vec3(1.0) - f0) / 21.0;
    vec3 again = rest * once * mean_f / (vec3(1.0) - mean_f * rest);
    vec3 matt = paint.albedo * (1.0 - paint.metal) * (vec3(1.0) - once - again);
    float open = sky.open * paint.open;
    vec3 gathered = gathered_radiance(bent) * open / (vec3(1.0) - (1.0 - open) * paint.albedo);
    vec3 reflected = mix(paint.albedo * gathered, mirrored_radiance(mirrored, paint.rough) * mix(1.0, paint.open, paint.rough), sky.clear);
    return once * reflected + (again + matt) * gathered;
}
#endif

vec3 painted_color(BurinFacet facet, Paint paint) {
    if (along_look) {
        vec2 place = look_origin + look_slope * facet.drop;
        rest_slopes = fetch_residual(place, uv_along_x, uv_along_y);
        bend_moved = place - bend_start;
        bend_drop = facet.drop;
    }
    vec3 leaning = burin_add_slopes(facet.normal, rest_slopes);
    vec3 n = normalize(transpose(to_pattern) * burin_bend_normal(bend, bend_moved, bend_drop, leaning));
    vec3 color = paint.glow;
#ifdef BURIN_ENVIRONMENT
    vec3 mirrored = reflect(-to_eye, n);
    float blur = clamp(paint.rough * paint.rough, 0.01, 1.0);
    BurinSky sky = burin_sky(facet.nook, leaning, normalize(to_pattern * mirrored), blur);
    color += shade_around(n, world_of(sky.bent), mirrored, sky, paint);
#else
    color += shade_surround(n, paint);
#endif
    // What is too bright for the picture is as bright as it shows, before the lit part and the rest of a facet are mixed.
    vec3 lit = clamp(color + shade_lamp(n, paint), 0.0, 1.0);
    return mix(clamp(color, 0.0, 1.0), lit, light_above ? facet.lit : 0.0);
}

vec3 burin_facet_color(BurinFacet facet) {
    return painted_color(facet, paint_of(facet.material, look_at(facet.normal, facet.drop)));
}

// The ground of a pixel is looked up once.
Paint ground_paint;

vec3 ground_color(float drop, float lit) {
    return painted_color(burin_level_facet(drop, lit), ground_paint);
}

vec3 burin_shadow_color() {
    return ground_color(0.0, 0.0);
}

// Of a mesh without detail.
vec3 mesh_color(vec3 n) {
    Look look;
    look.place = look_start;
    look.along_x = look_x;
    look.along_y = look_y;
    Paint paint = paint_of(0u, look);
    vec3 color = shade_lamp(n, paint) + paint.glow;
#ifdef BURIN_ENVIRONMENT
    BurinSky sky;
    sky.open = 1.0;
    sky.clear = 1.0;
    color += shade_around(n, n, reflect(-to_eye, n), sky, paint);
#else
    color += shade_surround(n, paint);
#endif
    return clamp(color, 0.0, 1.0);
}
