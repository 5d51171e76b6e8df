// One stretch of an element as stripes on the pixel: its facets carried to the object surface along the ray, each with
// the share of the pixel that shows it and the share of that which is lit. [2010] 5.7 (region sampling), with the ends
// of the stretch taken into account.
//
// Needs from whoever shades: vec3 burin_facet_color(vec3 normal, uint material, float lit), the colour of a facet.

// What the pixel has gathered. Colours are kept as differences to lit ground, so that ground needs no area of its own.
struct BurinRegion {
    vec3 color;    // sum of area * (colour - colour of lit ground)
    vec3 ground;   // colour of lit ground
    uint covered;  // places (burin_quad_mask) that a feature or its shadow covers
    uint special;  // places that stripes do not describe: two features over each other, ends
};

// The stretch. Parameters below 0 and above 1 lie on the tangents at the element's ends.
struct BurinStretch {
    float middle;  // parameter beside the pixel's centre, at the ground
    float room;    // metres along the path that a pixel spans
    vec2 limits;   // parameters where the stretch ends, on the path
    vec2 lean;     // and how much further for each metre of offset
    vec2 normal;   // of the path at the middle
    vec2 scales;   // width and height there
};

// One profile point along the stretch.
struct BurinRail {
    vec2 from;    // pixel coordinates of its two ends: where on the object surface the ray to them passes
    vec2 to;
    vec2 way;     // metres across the path from there to the path, at both ends
    float b;      // metres, and drop, at the middle
    float drop;
    float middle;  // parameter of the point of the rail that is nearest to the pixel's centre
};

// Width and height scale at a parameter.
vec2 burin_scales_at(BurinElement e, float s) {
    float at = clamp(s, 0.0f, 1.0f);
    return vec2(max(mix(e.scales.x, e.scales.y, at), 1.0e-3f), max(mix(e.scales.z, e.scales.w, at), 1.0e-3f));
}

// Derivative of the path by its parameter, and the path itself.
vec2 burin_path_rate(BurinElement e, float s) {
    float at = clamp(s, 0.0f, 1.0f);
    vec2 rate = e.curved ? 2.0f * mix(e.p1 - e.p0, e.p2 - e.p1, at) : e.p2 - e.p0;
    return length(rate) > 1.0e-6f * e.extent ? rate : e.t0 * max(e.extent, 1.0e-20f);
}

vec2 burin_path_at(BurinElement e, float s) {
    if (!e.curved) return e.p0 + (e.p2 - e.p0) * s;
    float at = clamp(s, 0.0f, 1.0f);
    vec2 p = mix(mix(e.p0, e.p1, at), mix(e.p1, e.p2, at), at);
    return p + burin_path_rate(e, s) * (s - at);
}

// Parameter beside `place`, from one that is near.
float burin_beside(BurinElement e, vec2 place, float s) {
    for (int i = 0; i < (e.curved ? 2 : 1); ++i) {
        vec2 rate = burin_path_rate(e, s);
        s = s + dot(place - burin_path_at(e, s), rate) / dot(rate, rate);
    }
    return s;
}

// One end of a rail: pixel coordinates and way.
vec3 burin_rail_end(BurinElement e, BurinStyle style, BurinStretch stretch, BurinFootprint footprint, vec2 slope,
                    vec2 point, float s) {
    vec2 scales = burin_scales_at(e, s);
    float b = point.x * style.reach * scales.x;
    float drop = style.level - point.y * scales.y * burin_map.depth;
    vec2 plan = burin_path_at(e, s) + burin_normal_of(burin_direction(burin_path_rate(e, s), e.t0)) * b;
    vec2 at = burin_to_pixel(footprint, plan - slope * drop);
    return vec3(at, b - dot(slope, stretch.normal) * drop);
}

BurinRail burin_rail(BurinElement e, BurinStyle style, BurinStretch stretch, BurinFootprint footprint, vec2 slope,
                     vec2 point) {
    BurinRail rail;
    rail.b = point.x * style.reach * stretch.scales.x;
    rail.drop = style.level - point.y * stretch.scales.y * burin_map.depth;
    rail.middle = burin_beside(e, slope * rail.drop, stretch.middle);
    float speed = length(burin_path_rate(e, rail.middle));
    // On the inner side of a bend the rail is shorter than the path.
    float room = (e.curved ? 2.0f : 1.0f) * stretch.room / speed;
    vec2 ends = stretch.limits + stretch.lean * (rail.b / vec2(length(burin_path_rate(e, 0.0f)), length(burin_path_rate(e, 1.0f))));
    ends.y = max(ends.x, ends.y);
    vec3 from = burin_rail_end(e, style, stretch, footprint, slope, point, clamp(rail.middle - room, ends.x, ends.y));
    vec3 to = burin_rail_end(e, style, stretch, footprint, slope, point, clamp(rail.middle + room, ends.x, ends.y));
    rail.middle = clamp(rail.middle, ends.x, ends.y);
    rail.from = vec2(from.x, from.y);
    rail.to = vec2(to.x, to.y);
    rail.way = vec2(from.z, to.z);
    return rail;
}

// Unit normal, z up, of the facet between two rails, the left one first, where it is nearest to the pixel's centre.
vec3 burin_facet_normal(BurinElement e, BurinStyle style, BurinStretch stretch, BurinRail left, BurinRail right,
                        vec2 slope) {
    vec2 place = burin_path_at(e, stretch.middle);
    float centre = -dot(place, stretch.normal);
    float from = left.b - dot(slope, stretch.normal) * left.drop;
    float to = right.b - dot(slope, stretch.normal) * right.drop;
    float at = abs(to - from) > 0.0f ? clamp((centre - from) / (to - from), 0.0f, 1.0f) : 0.5f;
    vec2 rate = burin_path_rate(e, mix(left.middle, right.middle, at));
    vec2 normal = burin_normal_of(burin_direction(rate, e.t0));
    vec3 across = vec3(normal * (right.b - left.b), left.drop - right.drop);
    vec3 along = vec3(rate, 0.0f);
    if (e.scaled) {
        float s = mix(left.middle, right.middle, at);
        vec2 scales = burin_scales_at(e, s);
        vec2 rates = vec2(e.scales.y - e.scales.x, e.scales.w - e.scales.z) / scales;
        along = along + vec3(normal * (mix(left.b, right.b, at) * rates.x), (style.level - mix(left.drop, right.drop, at)) * rates.y);
    }
    vec3 n = cross(along, across);
    return length(n) > 0.0f ? normalize(n) : vec3(0.0f, 0.0f, 1.0f);
}

// What the light passes over on its way across the profile: the part of each facet that it does not reach, counted from
// where it comes from, and the length of the shadow on the ground behind.
struct BurinShade {
    float hidden[BURIN_MAX_PROFILE_POINTS];
    float beyond;
    float order;  // +1: the light runs from left to right
    bool folded;  // the profile is no height field
};

// Part of the way from `last` to `next` that lies behind `run`.
float burin_hidden(float run, float last, float next) {
    return next > run ? clamp((run - last) / max(next - last, 1.0e-30f), 0.0f, 1.0f) : 1.0f;
}

// `light` is what the light moves across per metre of fall.
BurinShade burin_shade_profile(BurinStyle style, vec2 scales, float light, bool shadows) {
    BurinShade shade;
    shade.order = light < 0.0f ? -1.0f : 1.0f;
    shade.folded = false;
    float run = -1.0e30f;
    vec2 last = vec2(0.0f, 0.0f);
    float last_way = 0.0f;
    for (int k = 0; k < BURIN_MAX_PROFILE_POINTS; ++k) {
        if (k >= style.count) break;
        int i = shade.order > 0.0f ? k : style.count - 1 - k;
        vec2 point = burin_profile_point(style, i);
        float drop = style.level - point.y * scales.y * burin_map.depth;
        float way = shade.order * (point.x * style.reach * scales.x - light * drop);
        if (k > 0) {
            if (shade.order * (point.x - last.x) < -1.0e-5f) shade.folded = true;
            shade.hidden[shade.order > 0.0f ? k - 1 : i] = shadows ? burin_hidden(run, last_way, way) : 0.0f;
        }
        run = max(run, way);
        last = point;
        last_way = way;
    }
    shade.beyond = shadows ? max(run - last_way, 0.0f) : 0.0f;
    return shade;
}

// One facet, from the rail that the ray passes first: `seen` of the way to the next one is hidden, and the light misses the
// first `hidden` of it, counted along the light's way.
void burin_add_facet(BurinElement e, BurinStyle style, BurinStretch stretch, BurinRail last, BurinRail next, vec2 seen,
                     float order, float hidden, bool same, vec2 slope, BURIN_INOUT(BurinRegion) region) {
    float area = burin_quad_area(mix(last.from, next.from, seen.x), next.from, next.to, mix(last.to, next.to, seen.y));
    if (area <= 0.0f) return;
    vec2 one = vec2(1.0f, 1.0f);
    vec2 from = clamp(one * (same ? hidden : 0.0f), seen, one);
    vec2 to = clamp(one * (same ? 1.0f : 1.0f - hidden), seen, one);
    float lit = burin_quad_area(mix(last.from, next.from, from.x), mix(last.from, next.from, to.x),
                                mix(last.to, next.to, to.y), mix(last.to, next.to, from.y));
    BurinRail left = last;
    BurinRail right = next;
    if (order < 0.0f) {
        left = next;
        right = last;
    }
    vec3 normal = burin_facet_normal(e, style, stretch, left, right, slope);
    vec3 color = burin_facet_color(normal, style.material, min(lit / area, 1.0f));
    region.color = region.color + (color - region.ground) * area;
}

// Adds the facets of one stretch; returns the places that they and their shadow cover.
uint burin_add_stripe(BurinElement e, BurinStyle style, BurinStretch stretch, BurinFootprint footprint, vec2 slope,
                      vec2 light_slope, bool shadows, BURIN_INOUT(BurinRegion) region) {
    BurinShade shade = burin_shade_profile(style, stretch.scales, dot(light_slope, stretch.normal), shadows);
    float order = dot(slope, stretch.normal) < 0.0f ? -1.0f : 1.0f;
    bool same = shade.order == order;
    vec2 run = vec2(-1.0e30f, -1.0e30f);
    BurinRail first = burin_rail(e, style, stretch, footprint, slope, burin_profile_point(style, order > 0.0f ? 0 : style.count - 1));
    BurinRail last = first;
    BurinRail far = first;
    for (int k = 0; k < BURIN_MAX_PROFILE_POINTS; ++k) {
        if (k >= style.count) break;
        int i = order > 0.0f ? k : style.count - 1 - k;
        BurinRail next = first;
        if (k > 0) {
            next = burin_rail(e, style, stretch, footprint, slope, burin_profile_point(style, i));
            vec2 seen = vec2(burin_hidden(run.x, last.way.x * order, next.way.x * order),
                             burin_hidden(run.y, last.way.y * order, next.way.y * order));
            if (min(seen.x, seen.y) < 1.0f && !shade.folded)
                burin_add_facet(e, style, stretch, last, next, seen, order, shade.hidden[order > 0.0f ? k - 1 : i], same, slope, region);
        }
        if (next.way.x * order > run.x) far.from = next.from;
        if (next.way.y * order > run.y) far.to = next.to;
        run = max(run, next.way * order);
        last = next;
    }
    if (shade.beyond > 0.0f && !shade.folded) {
        // Shadow on the ground behind the profile, as far as the profile does not hide it.
        vec2 across = burin_pixel_direction(footprint, stretch.normal * (shade.order * shade.beyond));
        float behind = same ? max(run.x - last.way.x * order, 0.0f) : 0.0f;
        BurinRail rim = last;
        if (!same) rim = first;
        if (behind < shade.beyond) {
            BurinRail near = far;
            if (!same) near = first;
            float area = burin_quad_area(near.from, rim.from + across, rim.to + across, near.to);
            vec3 color = burin_facet_color(vec3(0.0f, 0.0f, 1.0f), 0u, 0.0f);
            region.color = region.color + (color - region.ground) * area;
            rim.from = rim.from + across;
            rim.to = rim.to + across;
            if (same) far = rim;
            else first = rim;
        }
    }
    uint mask = burin_quad_mask(first.from, far.from, far.to, first.to);
    if (shade.folded) region.special = region.special | mask;
    return mask;
}
