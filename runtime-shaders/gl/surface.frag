// A material with path detail: the view ray goes into pattern space, the decoder finds what the pixel shows, and that is
// shaded and shadowed. Without detail the mesh itself is shaded.
uniform vec3 eye;           // of a perspective camera
uniform vec3 view;          // direction of an orthographic one; zero for perspective
uniform int has_detail;
uniform int shadows;
uniform int side;           // rays per side of the pixel: even, 2 to 8
uniform int cells;          // of the pixel, per side, one for each ray of all its samples
uniform vec2 first_cell;    // of this sample
uniform vec2 ray_shift;     // of FILTER_RAYS: by how much it lies beside the middle at grazing angles, in pixels
uniform int across;         // of FILTER_RAYS: texels that the target has on each side of a pixel, one for each of its rays
uniform vec2 pixel_part;    // width and height of what is filtered, in texels of the target: below 1 where several pictures are averaged
layout(location = 0) out vec4 color;

vec2 light_slope;   // metres that the light moves over the plane per metre of fall
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

// What was met, as it is shaded but for shadows.
BurinFacet facet_of(BurinRay ray, BurinFound found) {
    BurinHit hit = found.hit;
    BurinSurface surface = burin_surface(hit);
    rest_slopes = fetch_residual(hit.ray.origin + hit.ray.slope * hit.t, uv_along_x, uv_along_y);
    look_slope = hit.ray.slope;
    look_origin = found.sheet.moved ? hit.ray.origin : found.place - look_slope * hit.t;
    BurinFacet facet;
    facet.normal = surface.normal;
    facet.material = surface.material;
    facet.lit = 1.0;
    facet.drop = hit.t;
    facet.nook = surface.nook;
    if (found.sheet.moved) {
        // Light and eye are those of the chart that the ray entered.
        facet.normal = burin_off_sheet(found.sheet, burin_add_slopes(facet.normal, rest_slopes));
        rest_slopes = vec2(0.0);
    }
    stand_at(found.place - bend_start, found.drop);
    along_look = false;
    return facet;
}

// The way to the light from what was met, from `before` on.
BurinSight way_to_light(BurinRay ray, BurinFound found, float before) {
    BurinRay shadow;
    shadow.slope = light_slope;
    // In the tile that was met, where numbers are small.
    vec2 place = found.sheet.moved ? found.place : found.hit.ray.origin + found.hit.ray.slope * found.drop;
    shadow.origin = place - light_slope * found.drop;
    return burin_light_sight(bend, shadow, before, found, bend_start, ray.origin, eye_direction, to_pattern * light);
}

// What one ray meets, shadow included; w: 0 where it leaves the object beside its outline. `way`: metres to there. The eye's way
// and the light's are two turns of a loop, since drivers copy the whole decoder to every place that calls it.
vec4 point_color(BurinRay ray, BURIN_OUT(float) way) {
    BurinSight sight = burin_eye_sight(bend, bend_start, ray, eye_direction, chart);
    BurinFacet facet;
    bool met = false;
    way = 0.0;
    for (int turn = 0; turn < 2; ++turn) {
        BurinFound found = burin_trace_sight(bend, bend_start, sight);
        if (turn == 1) {
            if (found.hit.met) facet.lit = 0.0;
            break;
        }
        met = found.hit.met;
        way = found.way;
        if (!met) break;
        facet = facet_of(ray, found);
        float before = found.drop - 4.0e-3 * burin_map.depth;
        if (shadows == 0 || !light_above || before <= 0.0) break;
        sight = way_to_light(ray, found, before);
    }
    return met ? vec4(burin_facet_color(facet), 1.0) : vec4(0.0);
}

// How far the rays of a pixel leave the middles of their cells: by 55 degrees not, by 76 half of what they might.
float shifted(vec2 slope) {
    return 0.5 * smoothstep(1.5, 4.0, length(slope));
}

#if PIXEL_FILTER != FILTER_RAYS

// What areas say of a pixel.
struct Areas {
    vec3 color;
    bool special;  // rays should be asked instead
};

Areas areas_of(BurinRay ray, vec2 along_x, vec2 along_y) {
    vec2 tile = floor(ray.origin / burin_map.size) * burin_map.size * float(burin_map.repeats);
    float level = burin_cell(burin_cell_at(ray.origin - tile)).level;
    vec2 place = ray.origin + ray.slope * level;
    bool shadowed = shadows != 0 && light_above;
    look_origin = ray.origin;
    look_slope = ray.slope;
    look_x = along_x;
    look_y = along_y;
    along_look = true;
    ground_paint = paint_of(0u, look_at(vec3(0.0, 0.0, 1.0), level));
    vec3 ground = ground_color(level, 1.0);
    BurinFootprint footprint = burin_footprint(along_x, along_y);
    BurinSpan span = burin_span(ray, footprint, light_slope, shadowed, level);
    burin_gather(span, ray, footprint, light_slope, shadowed);
    BurinRegion region = burin_region(ray, footprint, light_slope, shadowed, ground, span);
    Areas areas;
    areas.color = ground + region.color;
    // The eye's straight ray meets the true one half way down; the light's begins on it.
    bool bends = burin_bends(bend, ray.slope * 0.5) || (shadowed && burin_bends(bend, light_slope));
    // From a pixel that spans many features to one that spans too many: the prefilter takes over by degrees.
    float far = smoothstep(BURIN_LEAST_FULLNESS, BURIN_MOST_FULLNESS, region.fullness);
    if (far > 0.0)
        areas.color = mix(areas.color, ground + far_color(place, ray.slope, light_slope, shadowed, ground, uv_along_x, uv_along_y), far);
    areas.special = far < 1.0 && (region.special != 0u || bends || meets_border(ray, along_x, along_y));
    return areas;
}

#endif

// From the middle of a cell of `cells` to a side, in cells.
float shift_of(int line, int cells) {
    return cells < LEAST_MOVED_SIDE ? 0.0 : (float(MOVED_TURN(line, cells)) + 0.5) / float(cells) - 0.5;
}

#if PIXEL_FILTER == FILTER_REGIONS

// Mean colour of side x side rays; w: 0 where all of them leave the object.
vec4 rays_color(BurinRay ray, vec2 along_x, vec2 along_y) {
    vec4 met = vec4(0.0);
    look_x = along_x / float(side);
    look_y = along_y / float(side);
    for (int k = 0; k < 64; ++k) {
        vec2 own = vec2(float(k % side), float(k / side));
        vec2 cell = first_cell + own;
        vec2 shift = vec2(shift_of(int(cell.y + 0.5), cells), shift_of(int(cell.x + 0.5), cells)) * shifted(ray.slope);
        vec2 at = (own + 0.5 + shift) / float(side) - 0.5;
        BurinRay sample_ray = ray;
        sample_ray.origin = ray.origin + along_x * at.x + along_y * at.y;
        float way;
        met += point_color(sample_ray, way);
        if (k + 1 >= side * side) break;
    }
    return vec4(met.rgb / max(met.w, 1.0), met.w);
}

#endif

// Colour of the pixel, from the ray through its middle; w: 0 where nothing is met. `mark`: 1 where it wants rays instead, 2 where a few
// of them would not do even if they agree.
vec4 pixel_color(BurinRay ray, BURIN_OUT(float) mark, BURIN_OUT(float) way) {
    mark = 0.0;
    way = -1.0;
    vec2 along_x = look_x;
    vec2 along_y = look_y;
#if PIXEL_FILTER == FILTER_RAYS
    vec2 at = ray_shift;
    ivec2 own = ivec2(gl_FragCoord.xy) % across;
    if (across > 1) at = vec2(shift_of(own.y, across), shift_of(own.x, across)) / float(across);
    at *= shifted(ray.slope);
    ray.origin += along_x * at.x + along_y * at.y;
    return point_color(ray, way);
#else
    BurinRay straight = ray;
    float drop = 0.0;
    vec4 shown = vec4(0.0, 0.0, 0.0, 1.0);
    mark = 1.0;
    // Beside the outline of a round surface nothing straight stands in for the ray.
    if (burin_straighten(bend, eye_direction, straight, drop)) {
        // Where the straight ray meets the true one.
        stand_at(straight.origin + straight.slope * drop - bend_start, drop);
        Areas said = areas_of(straight, along_x, along_y);
        shown.rgb = said.color;
        mark = said.special ? (burin_gathered.thin ? 2.0 : 1.0) : 0.0;
    }
#if PIXEL_FILTER == FILTER_REGIONS
    if (mark > 0.0) shown = rays_color(ray, along_x, along_y);
#endif
    return shown;
#endif
}

void main() {
    to_eye = dot(view, view) > 0.0 ? -view : normalize(eye - world_position);
    vec3 n = normalize(world_normal);
    uv_along_x = dFdx(pattern_uv) * pixel_part.x;
    uv_along_y = dFdy(pattern_uv) * pixel_part.y;
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
    bend = pattern_bend(frame, to_pattern, own);
    bend_start = pattern_uv * burin_map.size;
    chart = chart_key();
    eye_direction = to_pattern * -to_eye;
    BurinRay ray;
    ray.origin = bend_start;
    ray.slope = burin_slope_of(eye_direction);
    stand_at(vec2(0.0), 0.0);
    float mark;
    float way;
    vec4 found = pixel_color(ray, mark, way);
#ifdef BURIN_CORRECT_DEPTH
#if PIXEL_FILTER != FILTER_RAYS
    BurinFound middle = burin_trace_sight(bend, bend_start, burin_eye_sight(bend, bend_start, ray, eye_direction, chart));
    if (middle.hit.met) gl_FragDepth = depth_of(world_position - to_eye * middle.way);
#else
    if (found.w > 0.0) gl_FragDepth = depth_of(world_position - to_eye * way);
#endif
#endif
    if (found.w == 0.0) discard;
    color = vec4(found.rgb, mark);
#ifdef BURIN_COUNTED
    color = burin_fetched;
#endif
}
