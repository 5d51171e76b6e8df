// A material with path detail: the view ray goes into pattern space, the decoder finds what the pixel shows, and that is
// shaded and shadowed. Without detail the mesh itself is shaded.
uniform vec3 eye;           // of a perspective camera
uniform vec3 view;          // direction of an orthographic one; zero for perspective
uniform int has_detail;
uniform int shadows;
uniform int side;           // rays per side of the pixel: even, 2 to 8
uniform int cells;          // of the pixel, per side, one for each ray of all its samples
uniform vec2 first_cell;    // of this sample
uniform vec2 ray_place;     // of FILTER_RAYS, within the pixel, -0.5 to 0.5
uniform vec2 ray_shift;     // and by how much it lies elsewhere at grazing angles
uniform vec2 pixel_part;    // width and height of what is filtered, in pixels: below 1 where several pictures are averaged
uniform highp sampler2D wanted;  // one texel per pixel, a bit per quarter: 0 where the picture needs no further sample
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

// A pixel, or a quarter of one.
struct Part {
    BurinRay ray;
    vec2 along_x;
    vec2 along_y;
};

// Part 0 is the whole, 1 to 4 its quarters.
Part part_of(BurinRay ray, vec2 along_x, vec2 along_y, int index) {
    Part part;
    part.ray = ray;
    part.along_x = along_x;
    part.along_y = along_y;
    if (index == 0) return part;
    part.along_x = along_x * 0.5;
    part.along_y = along_y * 0.5;
    part.ray.origin = ray.origin + part.along_x * (float((index - 1) % 2) - 0.5) + part.along_y * (float((index - 1) / 2) - 0.5);
    return part;
}

// What areas say of a part.
struct Areas {
    vec3 color;
    bool special;  // and that rays should be asked
    bool bent;     // wherever in the part
    bool far;      // it spans so many features that nothing else need be asked
};

// `whole`: of the pixel. `gather`: what lies around must be gathered first.
Areas areas_of(Part part, bool whole, bool gather) {
    vec2 tile = floor(part.ray.origin / burin_map.size) * burin_map.size * float(burin_map.repeats);
    float level = burin_cell(burin_cell_at(part.ray.origin - tile)).level;
    vec2 place = part.ray.origin + part.ray.slope * level;
    bool shadowed = shadows != 0 && light_above;
    look_origin = part.ray.origin;
    look_slope = part.ray.slope;
    look_x = part.along_x;
    look_y = part.along_y;
    along_look = true;
    ground_paint = paint_of(0u, look_at(vec3(0.0, 0.0, 1.0), level));
    vec3 ground = ground_color(level, 1.0);
    BurinFootprint footprint = burin_footprint(part.along_x, part.along_y);
    BurinSpan span = burin_span(part.ray, footprint, light_slope, shadowed, level);
    if (gather) burin_gather(span, part.ray, footprint, light_slope, shadowed);
    BurinRegion region = burin_region(part.ray, footprint, light_slope, shadowed, ground, span, whole);
    Areas areas;
    areas.color = ground + region.color;
    // The eye's straight ray meets the true one half way down; the light's begins on it.
    bool bends = burin_bends(bend, part.ray.slope * 0.5) || (shadowed && burin_bends(bend, light_slope));
    areas.bent = region.bent || bends;
    areas.special = region.special != 0u || bends || meets_border(part.ray, part.along_x, part.along_y);
    // From a pixel that spans many features to one that spans too many: the prefilter takes over by degrees.
    float far = smoothstep(0.4, 0.9, region.fullness);
    areas.far = far >= 1.0;
    if (far > 0.0)
        areas.color = mix(areas.color, ground + far_color(place, part.ray.slope, light_slope, shadowed, ground, uv_along_x, uv_along_y), far);
    return areas;
}

// Bits of the quarters that rays should be asked of, 1 << 1 to 1 << 4. The others add to `sum` and to the number of `parts`, the whole
// pixel as four. `drop`: where the straight ray meets the true one.
uint sum_areas(BurinRay straight, float drop, vec2 along_x, vec2 along_y, BURIN_INOUT(vec3) sum, BURIN_INOUT(float) parts) {
    uint special = 0u;
    stand_at(straight.origin + straight.slope * drop - bend_start, drop);
    bool gather = true;
    float asked = 0.0;
    for (int i = 0; i <= 4; ++i) {
        Areas said = areas_of(part_of(straight, along_x, along_y, i), i == 0, gather);
        gather = i == 0 ? !burin_gathered.complete : gather;
        // The whole pixel at once where its features do not meet; else its quarters, unless they cannot do better.
        bool done = i == 0 && (said.far || !said.special);
        if (i == 0 && !done && said.bent) break;
        if (i > 0 && said.special) {
            special = special | (1u << uint(i));
            asked += 1.0;
        }
        if (done || (i > 0 && !said.special)) {
            float share = done ? 4.0 : 1.0;
            sum += said.color * share;
            parts += share;
        }
        if (done || i == 4) break;
    }
    if (parts + asked == 4.0) return special;
    // Bent, or not looked at to the end: a driver may end loops that turn too often (OSMesa after 65535 turns).
    sum = vec3(0.0);
    parts = 0.0;
    return 30u;
}

#endif

#if PIXEL_FILTER == FILTER_REGIONS

// From the middle of a cell, in cells.
float shift_of(int line) {
    return cells < LEAST_MOVED_SIDE ? 0.0 : (float(MOVED_TURN(line, cells)) + 0.5) / float(cells) - 0.5;
}

// Adds the mean colours of the parts asked for, by count x count rays each: one loop over the rays of them all.
void sum_rays(BurinRay ray, vec2 along_x, vec2 along_y, uint asked, int count, BURIN_INOUT(vec3) sum, BURIN_INOUT(float) parts) {
    vec4 met = vec4(0.0);
    int k = 0;
    for (int n = 0; n < 64; ++n) {
        if (asked == 0u) break;
        int index = burin_lowest_bit(asked);
        Part part = part_of(ray, along_x, along_y, index);
        look_x = part.along_x / float(count);
        look_y = part.along_y / float(count);
        vec2 own = vec2(float(k % count), float(k / count));
        vec2 cell = first_cell + own;
        if (index > 0) cell += vec2(float((index - 1) % 2), float((index - 1) / 2)) * float(count);
        vec2 shift = vec2(shift_of(int(cell.y + 0.5)), shift_of(int(cell.x + 0.5))) * shifted(ray.slope);
        vec2 at = (own + 0.5 + shift) / float(count) - 0.5;
        BurinRay sample_ray = part.ray;
        sample_ray.origin = part.ray.origin + part.along_x * at.x + part.along_y * at.y;
        float way;
        met += point_color(sample_ray, way);
        ++k;
        if (k == count * count) {
            sum += met.rgb / max(met.w, 1.0);
            parts += met.w > 0.0 ? 1.0 : 0.0;
            met = vec4(0.0);
            k = 0;
            asked = asked & (asked - 1u);
        }
        if (asked == 0u) break;
    }
}

#endif

// Colour of the pixel, from the ray through its middle; w: 0 where nothing is met. `marks`: quarters that still want rays.
vec4 pixel_color(BurinRay ray, BURIN_OUT(int) marks, BURIN_OUT(float) way) {
    marks = 0;
    way = -1.0;
    vec2 along_x = look_x;
    vec2 along_y = look_y;
#if PIXEL_FILTER == FILTER_RAYS
    vec2 at = ray_place + ray_shift * shifted(ray.slope);
    ray.origin += along_x * at.x + along_y * at.y;
    return point_color(ray, way);
#else
    BurinRay straight = ray;
    float drop = 0.0;
    bool areas = burin_straighten(bend, eye_direction, straight, drop);
    vec3 sum = vec3(0.0);
    float parts = 0.0;
    uint special = 1u;
    // Beside the outline of a round surface nothing straight stands in for the ray.
    if (areas) special = sum_areas(straight, drop, along_x, along_y, sum, parts);
#if PIXEL_FILTER == FILTER_MARKED
    marks = areas ? int(special >> 1) : 15;
    return vec4(marks == 0 ? sum / parts : sum * 0.25, 1.0);
#else
    sum_rays(ray, along_x, along_y, special, areas ? max(side / 2, 1) : side, sum, parts);
    return vec4(sum / max(parts, 1.0), parts);
#endif
#endif
}

bool is_wanted() {
    int bits = int(texelFetch(wanted, ivec2(gl_FragCoord.xy), 0).x * 255.0 + 0.5);
    int quarter = (ray_place.x < 0.0 ? 0 : 1) + (ray_place.y < 0.0 ? 0 : 2);
    return ((bits >> quarter) & 1) != 0;
}

void main() {
    if (!is_wanted()) discard;
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
    int marks;
    float way;
    vec4 found = pixel_color(ray, marks, way);
#ifdef BURIN_CORRECT_DEPTH
#if PIXEL_FILTER != FILTER_RAYS
    BurinFound middle = burin_trace_sight(bend, bend_start, burin_eye_sight(bend, bend_start, ray, eye_direction, chart));
    if (middle.hit.met) gl_FragDepth = depth_of(world_position - to_eye * middle.way);
#else
    if (found.w > 0.0) gl_FragDepth = depth_of(world_position - to_eye * way);
#endif
#endif
    if (found.w == 0.0) discard;
    color = vec4(found.rgb, float(marks));
#ifdef BURIN_COUNTED
    color = burin_fetched;
#endif
}
