// A material with path detail: the view ray goes into pattern space, the decoder finds what the pixel shows, and that is
// shaded and shadowed. Without detail the mesh itself is shaded.
uniform vec3 eye;           // of a perspective camera
uniform vec3 view;          // direction of an orthographic one; zero for perspective
uniform int has_detail;
uniform int shadows;
uniform int pixel_filter;   // pixel_filter.h
uniform int side;           // rays per side of the pixel, 1 to 4
uniform vec2 ray_place;     // within the pixel, -0.5 to 0.5
uniform float pixel_part;   // side of what is filtered, in pixels: below 1 where several pictures are averaged
uniform highp sampler2D wanted;  // one texel per pixel: 0 where the picture needs no further sample
uniform int everywhere;          // 1: all pixels are drawn
layout(location = 0) out vec4 color;

vec2 uv_along_x;
vec2 uv_along_y;
vec2 light_slope;   // metres that the light moves over the plane per metre of fall
bool light_above;
int chart;
vec3 eye_direction;  // in the local frame, of unit length in space

// Normals and light are those at a place of the relief.
void stand_at(vec2 moved, float drop) {
    bend_moved = moved;
    bend_drop = drop;
    vec3 toward = to_pattern * light;
    if (bend.bent) {
        mat3 here = burin_bend_frame(bend, moved, drop);
        // Near a pole of the uvs the second order says nothing about so far a place.
        if (determinant(here) > 0.1) toward = inverse(here) * toward;
    }
    light_above = toward.z > 0.0;
    light_slope = burin_slope_of(-toward);
}

// Whether what the pixel shows, or what throws a shadow on it, may lie beyond a border of the chart.
bool meets_border(BurinRay ray, vec2 along_x, vec2 along_y) {
#if BURIN_CHARTS != 0
    vec2 reach = ray.slope * (0.5 * burin_map.depth);
    float light_reach = min(length(light_slope), BURIN_MOST_STRAIGHT) * burin_map.depth;
    return burin_near_border(chart, ray.origin + reach, length(reach) + 0.5 * (length(along_x) + length(along_y)) + light_reach);
#else
    return false;
#endif
}

// What one ray meets, shadow included; w: 0 where it leaves the object beside its outline.
vec4 point_color(BurinRay ray) {
    BurinFound found = burin_trace_sight(bend, bend_start, burin_eye_sight(bend, bend_start, ray, eye_direction, chart));
    BurinHit hit = found.hit;
    if (!hit.met) return vec4(0.0);
    BurinSurface surface = burin_surface(hit);
    rest_slopes = fetch_residual(hit.ray.origin + hit.ray.slope * hit.t, uv_along_x, uv_along_y);
    look_slope = hit.ray.slope;
    look_origin = found.sheet.moved ? hit.ray.origin : found.place - look_slope * hit.t;
    BurinRay met = hit.ray;
    if (found.sheet.moved) {
        surface.normal = normalize(transpose(found.sheet.turn) * surface.normal);
        rest_slopes = (transpose(found.sheet.turn) * vec3(rest_slopes, 0.0)).xy;
        met.slope = ray.slope;
        met.origin = found.place - ray.slope * found.drop;
    }
    stand_at(found.place - bend_start, found.drop);

    float lit = light_above ? 1.0 : 0.0;
    float before = found.drop - 4.0e-3 * burin_map.depth;
    if (shadows != 0 && light_above && before > 0.0) {
        BurinRay shadow;
        shadow.slope = light_slope;
        shadow.origin = met.origin + (met.slope - light_slope) * found.drop;
        BurinSight sight = burin_light_sight(bend, shadow, before, found, bend_start, ray.origin, eye_direction, to_pattern * light);
        if (burin_trace_sight(bend, bend_start, sight).hit.met) lit = 0.0;
    }
    BurinFacet facet;
    facet.normal = surface.normal;
    facet.material = surface.material;
    facet.lit = lit;
    facet.drop = hit.t;
    facet.nook = surface.nook;
    return vec4(burin_facet_color(facet), 1.0);
}

// Mean of side x side rays over a part of the pixel; along_x and along_y are that part's sides. w: part of them that meet
// something; the colour is the mean of those.
vec4 sampled_color(BurinRay ray, vec2 along_x, vec2 along_y, int side) {
    vec4 sum = vec4(0.0);
    look_x = along_x / float(side);
    look_y = along_y / float(side);
    for (int k = 0; k < 16; ++k) {
        if (k >= side * side) break;
        vec2 at = (vec2(float(k % side), float(k / side)) + 0.5) / float(side) - 0.5;
        BurinRay sample_ray = ray;
        sample_ray.origin = ray.origin + along_x * at.x + along_y * at.y;
        sum += point_color(sample_ray);
    }
    return vec4(sum.rgb / max(sum.w, 1.0), sum.w / float(side * side));
}

// The whole pixel at once where its features do not meet; else its quarters; and those where they do, by rays.
vec4 filtered_color(BurinRay ray, vec2 along_x, vec2 along_y) {
    vec3 sum = vec3(0.0);
    int marks = 0;
    for (int part = 0; part <= 4; ++part) {
        BurinRay part_ray = ray;
        vec2 x = along_x;
        vec2 y = along_y;
        if (part > 0) {
            x = along_x * 0.5;
            y = along_y * 0.5;
            part_ray.origin = ray.origin + x * (float((part - 1) % 2) - 0.5) + y * (float((part - 1) / 2) - 0.5);
        }
        ivec2 index = burin_cell_at(part_ray.origin - floor(part_ray.origin / burin_map.size) * burin_map.size * float(burin_map.repeats));
        float level = burin_cell(index).level;
        look_origin = part_ray.origin;
        look_slope = part_ray.slope;
        look_x = x;
        look_y = y;
        rest_slopes = fetch_residual(part_ray.origin + part_ray.slope * level, uv_along_x, uv_along_y);
        ground_paint = paint_of(0u, look_at(vec3(0.0, 0.0, 1.0), level));
        vec3 ground = ground_color(level, light_above ? 1.0 : 0.0);
        BurinRegion region = burin_region(part_ray, burin_footprint(x, y), light_slope, shadows != 0 && light_above, ground,
                                            level);
        // The eye's straight ray meets the true one half way down; the light's begins on it.
        bool bends = burin_bends(bend, ray.slope * 0.5) || (shadows != 0 && light_above && burin_bends(bend, light_slope));
        if (region.special == 0u && (bends || meets_border(part_ray, x, y))) region.special = 1u;
        vec3 found = ground + region.color;
        // From a pixel that spans many features to one that spans too many: the prefilter takes over by degrees.
        float far = smoothstep(0.4, 0.9, region.fullness);
        if (far > 0.0) {
            vec2 place = part_ray.origin + part_ray.slope * level;
            vec3 beyond = ground + far_color(place, ray.slope, light_slope, shadows != 0 && light_above, ground, uv_along_x, uv_along_y);
            if (far >= 1.0 && part == 0) return vec4(beyond, 0.0);
            found = mix(found, beyond, far);
        }
        if (part == 0) {
            if (region.special == 0u) return vec4(found, 0.0);
            continue;
        }
        if (region.special != 0u) {
            found = vec3(0.0);
            if (pixel_filter == FILTER_MARKED) marks += 1 << (part - 1);
            else found = sampled_color(part_ray, x, y, max(side / 2, 1)).rgb;
        }
        sum += found * 0.25;
    }
    return vec4(sum, float(marks));
}

bool is_wanted() {
    int bits = int(texelFetch(wanted, ivec2(gl_FragCoord.xy), 0).x * 255.0 + 0.5);
    if (pixel_filter != FILTER_QUARTERS) return everywhere != 0 || bits != 0;
    int quarter = (ray_place.x < 0.0 ? 0 : 1) + (ray_place.y < 0.0 ? 0 : 2);
    return ((bits >> quarter) & 1) != 0;
}

void main() {
    if (!is_wanted()) discard;
    to_eye = dot(view, view) > 0.0 ? -view : normalize(eye - world_position);
    vec3 n = normalize(world_normal);
    uv_along_x = dFdx(pattern_uv) * pixel_part;
    uv_along_y = dFdy(pattern_uv) * pixel_part;
    look_start = pattern_uv * burin_map.size;
    look_x = uv_along_x * burin_map.size;
    look_y = uv_along_y * burin_map.size;
    sets_by_pattern[0] = set_by_pattern(texture_uvs.xy);
    sets_by_pattern[1] = set_by_pattern(texture_uvs.zw);
    if (dot(n, to_eye) < 0.0 && !gl_FrontFacing) n = -n;
#ifdef BURIN_CORRECT_DEPTH
    gl_FragDepth = gl_FragCoord.z;
#endif
    bool own;
    mat3 frame = pattern_frame(n, own);
    float handed = determinant(frame);
    if (has_detail == 0 || abs(handed) <= 1.0e-12 || dot(n, to_eye) <= 1.0e-3) {
        color = vec4(mesh_color(n), 0.0);
        return;
    }
    to_pattern = inverse(frame);
    bend = pattern_bend(pattern_uv, frame, to_pattern, own);
    bend_start = pattern_uv * burin_map.size;
    chart = chart_key();
    eye_direction = to_pattern * -to_eye;
    BurinRay ray;
    ray.origin = bend_start;
    ray.slope = burin_slope_of(eye_direction);
    stand_at(vec2(0.0), 0.0);
#ifdef BURIN_CORRECT_DEPTH
    BurinFound middle = burin_trace_sight(bend, bend_start, burin_eye_sight(bend, bend_start, ray, eye_direction, chart));
    if (middle.hit.met) gl_FragDepth = depth_of(world_position - to_eye * middle.way);
#endif
    vec2 along_x = look_x;
    vec2 along_y = look_y;
    if (pixel_filter == FILTER_REGIONS || pixel_filter == FILTER_MARKED) {
        BurinRay straight = ray;
        float drop = 0.0;
        if (burin_straighten(bend, eye_direction, straight, drop)) {
            stand_at(straight.origin + straight.slope * drop - bend_start, drop);
            color = filtered_color(straight, along_x, along_y);
            return;
        }
        // Beside the outline of a round surface nothing straight stands in for the ray.
        if (pixel_filter == FILTER_MARKED) {
            color = vec4(0.0, 0.0, 0.0, 15.0);
            return;
        }
    }
    if (pixel_filter == FILTER_QUARTERS) ray.origin += along_x * ray_place.x + along_y * ray_place.y;
    vec4 seen = sampled_color(ray, along_x, along_y, pixel_filter == FILTER_QUARTERS ? 1 : side);
    if (seen.w == 0.0) discard;
    color = vec4(seen.rgb, 0.0);
}
