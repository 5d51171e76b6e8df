// One stretch of an element as stripes on the pixel: its facets carried to the object surface along the ray, each with
// the share of the pixel that shows it and the share of that which is lit. [2010] 5.7 (region sampling), with the ends
// of the stretch taken into account.
//
// Needs from whoever shades: vec3 burin_facet_color(BurinFacet facet), and vec3 burin_shadow_color(), that of the
// pixel's ground where the light does not reach it.

// What the pixel has gathered. Colours are kept as differences to lit ground, so that ground needs no area of its own.
struct BurinRegion {
    vec3 color;    // sum of area * (colour - colour of lit ground)
    vec3 ground;   // colour of lit ground
    uint covered;  // places (burin_quad_mask) that a feature or its shadow covers
    uint special;  // places that stripes do not describe: two features over each other, ends
    bool bent;     // nor do they describe a feature that shows, nor would they in parts of the pixel
    uint deep_shadows;   // places where shadows of the elements so far fall on whatever is lower than their ground
    uint deep_shadow;     // the same of the element at hand
    float covered_area;  // sum of what the elements so far cover
    float strip_area;    // the same of the element at hand
    int elements;        // that show in the pixel
    float fullness;      // how much of what a pixel may span it does: from 1 on there is no answer
};

// The stretch. Parameters below 0 and above 1 lie on the tangents at the element's ends.
struct BurinStretch {
    float middle;  // parameter beside the pixel's centre, at the ground
    float room;    // metres along the path that a pixel spans
    vec2 limits;   // parameters where the stretch ends, on the path
    vec2 lean;     // and how much further for each metre of offset
    vec2 normal;   // of the path at the middle
    vec2 scales;   // width and height there
    bool near_first;  // the pixel may see the stretch's ends
    bool near_last;
};

// One profile point along the stretch, or the rim of a shadow.
struct BurinRail {
    vec2 from;     // pixel coordinates of the part beside the pixel: where on the object surface the ray to it passes
    vec2 to;
    vec2 first;    // and of the whole rail's ends, where it ends near the pixel; else the same two
    vec2 last;
    bool at_first;  // the part beside the pixel is cut off there
    bool at_last;
    vec2 way;      // metres across the path from the pixel's centre to there, at both ends
    float b;       // metres, and drop, at the middle
    float drop;
    float middle;  // parameter of the point of the rail that is nearest to the pixel's centre
};

// Width and height scale at a parameter.
vec2 burin_scales_at(BurinElement e, float s) {
    return max(burin_scales(e, clamp(s, 0.0f, 1.0f)).scale, vec2(1.0e-3f, 1.0e-3f));
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

// A point of a profile, and how far it is carried over the plane before it is looked at: nowhere, or along the light.
struct BurinThrown {
    vec2 point;
    vec2 shift;   // metres
    float below;  // drop to look at it less its own
};

// One end of a rail: pixel coordinates and way.
vec3 burin_rail_end(BurinElement e, BurinStyle style, BurinStretch stretch, BurinFootprint footprint, vec2 slope,
                    BurinThrown thrown, float s) {
    vec2 scales = burin_scales_at(e, s);
    float b = thrown.point.x * style.reach * scales.x;
    float drop = style.level - thrown.point.y * scales.y * burin_map.depth;
    vec2 plan = burin_path_at(e, s) + burin_normal_of(burin_direction(burin_path_rate(e, s), e.t0)) * b;
    vec2 at = burin_to_pixel(footprint, plan + thrown.shift - slope * (drop + thrown.below));
    return vec3(at, dot(plan + thrown.shift - slope * (drop + thrown.below), stretch.normal));
}

BurinRail burin_thrown_rail(BurinElement e, BurinStyle style, BurinStretch stretch, BurinFootprint footprint, vec2 slope,
                          BurinThrown thrown) {
    BurinRail rail;
    rail.b = thrown.point.x * style.reach * stretch.scales.x;
    rail.drop = style.level - thrown.point.y * stretch.scales.y * burin_map.depth;
    vec2 speeds = vec2(length(burin_path_rate(e, 0.0f)), length(burin_path_rate(e, 1.0f)));
    vec2 ends = stretch.limits + stretch.lean * (rail.b / speeds);
    ends.y = max(ends.x, ends.y);
    vec2 range = ends;
    rail.middle = burin_beside(e, slope * (rail.drop + thrown.below) - thrown.shift, stretch.middle);
#if BURIN_CURVES != 0 || BURIN_FUNCTION_KINDS != 0
    if (e.curved || e.waved) {
        // On the inner side of a bend the rail is shorter than the path.
        float room = 2.0f * stretch.room / length(burin_path_rate(e, rail.middle));
        range = clamp(vec2(rail.middle - room, rail.middle + room), vec2(ends.x, ends.x), vec2(ends.y, ends.y));
    }
#endif
    vec3 from = burin_rail_end(e, style, stretch, footprint, slope, thrown, range.x);
    vec3 to = burin_rail_end(e, style, stretch, footprint, slope, thrown, range.y);
    rail.middle = clamp(rail.middle, ends.x, ends.y);
    rail.from = vec2(from.x, from.y);
    rail.to = vec2(to.x, to.y);
    rail.way = vec2(from.z, to.z);
    rail.first = rail.from;
    rail.last = rail.to;
    rail.at_first = range.x <= ends.x;
    rail.at_last = range.y >= ends.y;
#if BURIN_CURVES != 0 || BURIN_FUNCTION_KINDS != 0
    if ((e.curved || e.waved) && stretch.near_first && !rail.at_first) {
        vec3 end = burin_rail_end(e, style, stretch, footprint, slope, thrown, ends.x);
        rail.first = vec2(end.x, end.y);
    }
    if ((e.curved || e.waved) && stretch.near_last && !rail.at_last) {
        vec3 end = burin_rail_end(e, style, stretch, footprint, slope, thrown, ends.y);
        rail.last = vec2(end.x, end.y);
    }
#endif
    return rail;
}

BurinRail burin_rail(BurinElement e, BurinStyle style, BurinStretch stretch, BurinFootprint footprint, vec2 slope,
                     vec2 point) {
    BurinThrown thrown;
    thrown.point = point;
    thrown.shift = vec2(0.0f, 0.0f);
    thrown.below = 0.0f;
    return burin_thrown_rail(e, style, stretch, footprint, slope, thrown);
}

// Share of the pixel between two rails, from `from` to `to` of the way between them, each at the start and at the end.
// Where one of them is cut off by the stretch's end, both are followed to it.
float burin_strip_area(BurinRail a, BurinRail b, vec2 from, vec2 to) {
    vec2 p0 = mix(a.from, b.from, from.x);
    vec2 p1 = mix(a.from, b.from, to.x);
    vec2 q0 = mix(a.to, b.to, from.y);
    vec2 q1 = mix(a.to, b.to, to.y);
    float area = burin_edge_area(p0, q0) + burin_edge_area(q1, p1);
    if (a.at_first || b.at_first) {
        vec2 r0 = mix(a.first, b.first, from.x);
        vec2 r1 = mix(a.first, b.first, to.x);
        area = area + burin_edge_area(p1, r1) + burin_edge_area(r1, r0) + burin_edge_area(r0, p0);
    } else {
        area = area + burin_edge_area(p1, p0);
    }
    if (a.at_last || b.at_last) {
        vec2 r0 = mix(a.last, b.last, from.y);
        vec2 r1 = mix(a.last, b.last, to.y);
        area = area + burin_edge_area(q0, r0) + burin_edge_area(r0, r1) + burin_edge_area(r1, q1);
    } else {
        area = area + burin_edge_area(q0, q1);
    }
    return abs(area);
}

uint burin_strip_mask(BurinRail a, BurinRail b) {
    bool start = a.at_first || b.at_first;
    bool end = a.at_last || b.at_last;
    return burin_quad_mask(start ? a.first : a.from, start ? b.first : b.from, end ? b.last : b.to, end ? a.last : a.to);
}

// Unit normal, z up, of the facet between two rails, the left one first, where it is nearest to the pixel's centre.
vec3 burin_facet_normal(BurinElement e, BurinStyle style, BurinRail left, BurinRail right) {
    float from = left.way.x + left.way.y;
    float to = right.way.x + right.way.y;
    float at = abs(to - from) > 0.0f ? clamp(from / (from - to), 0.0f, 1.0f) : 0.5f;
    vec2 rate = burin_path_rate(e, mix(left.middle, right.middle, at));
    vec2 normal = burin_normal_of(burin_direction(rate, e.t0));
    vec3 across = vec3(normal * (right.b - left.b), left.drop - right.drop);
    vec3 along = vec3(rate, 0.0f);
    if (e.scaled || e.waved) {
        float s = mix(left.middle, right.middle, at);
        vec2 scales = burin_scales_at(e, s);
        vec2 rates = burin_scales(e, s).rate / scales;
        along = along + vec3(normal * (mix(left.b, right.b, at) * rates.x), (style.level - mix(left.drop, right.drop, at)) * rates.y);
    }
    vec3 n = cross(along, across);
    return length(n) > 0.0f ? normalize(n) : vec3(0.0f, 0.0f, 1.0f);
}

// What the light passes over on its way across the profile: the part of each facet that it does not reach, counted from
// where it comes from, and the length of the shadow on the ground behind.
struct BurinShade {
    float hidden[BURIN_MAX_PROFILE_POINTS];
    vec2 caster;   // point that the shadow on the ground behind comes from
    vec2 last;     // point where that ground begins
    float beyond;  // metres across the path, of that shadow
    float order;  // +1: the light runs from left to right
    bool folded;  // the profile is no height field
};

// Part of the way from `last` to `next` that lies behind `run`.
float burin_hidden(float run, float last, float next) {
    return next > run ? clamp((run - last) / max(next - last, 1.0e-30f), 0.0f, 1.0f) : 1.0f;
}

// The path beside the pixel, as light and shadow see it.
struct BurinBend {
    vec2 light;       // metres that the light moves along and across the path per metre of fall
    float slope;      // metres that the ray moves along it
    float curvature;  // of the path, 1 / metres, positive where it turns to the side of its normal
};

BurinBend burin_bend(BurinElement e, BurinStretch stretch, vec2 slope, vec2 light_slope) {
    BurinBend bend;
    vec2 tangent = vec2(stretch.normal.y, -stretch.normal.x);
    bend.light = vec2(dot(light_slope, tangent), dot(light_slope, stretch.normal));
    bend.slope = dot(slope, tangent);
    vec2 rate = burin_path_rate(e, stretch.middle);
    bend.curvature = e.curved ? dot(2.0f * (e.p0 - 2.0f * e.p1 + e.p2), stretch.normal) / dot(rate, rate) : 0.0f;
    return bend;
}

// Offset less `rim`'s at which the light to `point` passes the height of `rim`; points are (b, drop less the level's). On
// a bend the ray has met the path elsewhere at the point's height, and the light comes from elsewhere once more.
float burin_clearance(BurinBend bend, vec2 point, vec2 rim) {
    float fall = point.y - rim.y;
    float across = bend.light.y - bend.curvature * bend.slope * point.y * bend.light.x;
    float along = bend.light.x * fall;
    float round_off = 0.5f * bend.curvature * along * along / max(1.0f - bend.curvature * point.x, 0.25f);
    return point.x - across * fall - round_off - rim.x;
}

vec2 burin_shade_point(BurinStyle style, vec2 scales, int i) {
    vec2 point = burin_profile_point(style, i);
    return vec2(point.x * style.reach * scales.x, -point.y * scales.y * burin_map.depth);
}

BurinShade burin_shade_profile(BurinStyle style, vec2 scales, BurinBend bend, bool shadows) {
    BurinShade shade;
    shade.order = bend.light.y < 0.0f ? -1.0f : 1.0f;
    shade.folded = false;
    shade.beyond = 0.0f;
    vec2 last = vec2(0.0f, 0.0f);
    int rim = 0;  // of a straight path: the point that keeps most light off what follows
    for (int k = 0; k < BURIN_MAX_PROFILE_POINTS; ++k) {
        int i = shade.order > 0.0f ? k : style.count - 1 - k;
        vec2 point = burin_shade_point(style, scales, i);
        if (k > 0 && shade.order * (point.x - last.x) < -1.0e-5f * style.reach) shade.folded = true;
        float hidden = 0.0f;
        float least = 0.0f;
        for (int n = 0; n < BURIN_MAX_PROFILE_POINTS; ++n) {
            int j = bend.curvature == 0.0f ? rim : n;
            if (j >= k) break;
            vec2 edge = burin_shade_point(style, scales, shade.order > 0.0f ? j : style.count - 1 - j);
            float from = shade.order * burin_clearance(bend, last, edge);
            float to = shade.order * burin_clearance(bend, point, edge);
            if (j == k - 1) from = 0.0f;
            hidden = max(hidden, to > 0.0f ? clamp(from / min(from - to, -1.0e-30f), 0.0f, 1.0f) : 1.0f);
            if (to < least) {
                least = to;
                shade.caster = burin_profile_point(style, shade.order > 0.0f ? j : style.count - 1 - j);
            }
            if (bend.curvature == 0.0f) break;
        }
        if (hidden < 1.0f) rim = k;
        if (k > 0) shade.hidden[shade.order > 0.0f ? k - 1 : i] = shadows ? hidden : 0.0f;
        if (k == style.count - 1) {
            shade.beyond = shadows ? -least : 0.0f;
            shade.last = burin_profile_point(style, i);
        }
        last = point;
        if (k + 1 >= style.count) break;
    }
    return shade;
}

// Where between two rails, the left one first, the middle lies of what a pixel of that radius sees of the facet.
float burin_facet_middle(BurinRail left, BurinRail right, float radius) {
    float from = 0.5f * (left.way.x + left.way.y);
    float to = 0.5f * (right.way.x + right.way.y);
    float wide = abs(to - from);
    if (wide <= 1.0e-3f * radius) return 0.5f;
    float at = from / (from - to);
    return 0.5f * (clamp(at - radius / wide, 0.0f, 1.0f) + clamp(at + radius / wide, 0.0f, 1.0f));
}

// One facet, from the rail that the ray passes first: `seen` of the way to the next one is hidden, and the light misses the
// first `hidden` of it, counted along the light's way.
void burin_add_facet(BurinElement e, BurinStyle style, BurinStretch stretch, float radius, BurinRail last, BurinRail next, vec2 seen, float order,
                     float hidden, bool same, BURIN_INOUT(BurinRegion) region) {
    vec2 one = vec2(1.0f, 1.0f);
    float area = burin_strip_area(last, next, seen, one);
    if (area <= 0.0f) return;
    vec2 from = clamp(one * (same ? hidden : 0.0f), seen, one);
    vec2 to = clamp(one * (same ? 1.0f : 1.0f - hidden), seen, one);
    float lit = burin_strip_area(last, next, from, to);
    BurinRail left = last;
    BurinRail right = next;
    if (order < 0.0f) {
        left = next;
        right = last;
    }
    float middle = burin_facet_middle(left, right, radius);
    BurinFacet facet;
    facet.normal = burin_facet_normal(e, style, left, right);
    facet.material = style.material;
    facet.lit = min(lit / area, 1.0f);
    facet.drop = mix(left.drop, right.drop, middle);
    vec2 place = vec2(mix(left.b, right.b, middle) / style.reach, (style.level - facet.drop) / burin_map.depth) / stretch.scales;
    facet.nook = burin_nook(style, stretch.scales, stretch.normal, place);
    region.color = region.color + (burin_facet_color(facet) - region.ground) * area;
}

// Adds the facets of one stretch; returns the places that they and their shadow cover.
uint burin_add_stripe(BurinElement e, BurinStyle style, BurinStretch stretch, BurinFootprint footprint, vec2 slope,
                      vec2 light_slope, bool shadows, BURIN_INOUT(BurinRegion) region) {
    BurinShade shade = burin_shade_profile(style, stretch.scales, burin_bend(e, stretch, slope, light_slope), shadows);
    float order = dot(slope, stretch.normal) < 0.0f ? -1.0f : 1.0f;
    bool same = shade.order == order;
    BurinRail first = burin_rail(e, style, stretch, footprint, slope, burin_profile_point(style, order > 0.0f ? 0 : style.count - 1));
    BurinRail last = first;
    BurinRail far = first;
    vec2 run = first.way * order;
    for (int k = 1; k < BURIN_MAX_PROFILE_POINTS; ++k) {
        int i = order > 0.0f ? k : style.count - 1 - k;
        BurinRail next = burin_rail(e, style, stretch, footprint, slope, burin_profile_point(style, i));
        vec2 seen = vec2(burin_hidden(run.x, last.way.x * order, next.way.x * order),
                         burin_hidden(run.y, last.way.y * order, next.way.y * order));
        if (min(seen.x, seen.y) < 1.0f && !shade.folded)
            burin_add_facet(e, style, stretch, footprint.radius, last, next, seen, order, shade.hidden[order > 0.0f ? k - 1 : i], same, region);
        if (next.way.x * order > run.x) {
            far.from = next.from;
            far.first = next.first;
            far.at_first = next.at_first;
        }
        if (next.way.y * order > run.y) {
            far.to = next.to;
            far.last = next.last;
            far.at_last = next.at_last;
        }
        run = max(run, next.way * order);
        last = next;
        if (k + 1 >= style.count) break;
    }
    uint mask = burin_strip_mask(first, far);
    vec2 whole = vec2(1.0f, 1.0f);
    region.strip_area = region.strip_area + burin_strip_area(first, far, whole * 0.0f, whole);
    if (shade.folded) region.special = 0xffffu;
    if (shade.folded || shade.beyond <= 0.0f) return mask;
    BurinRail near = first;
    if (same) near = far;
    BurinRail rim = near;
    // First the shadow on whatever is lower than the ground, then that on the ground, as far as the profile does not hide it.
    float behind = same ? max(run.x - last.way.x * order, 0.0f) : 0.0f;
    bool deep = burin_map.drop_range.y - style.level > 2.0f * BURIN_FILM * burin_map.depth;
    for (int k = deep ? 0 : 1; k < (behind < shade.beyond ? 2 : 1); ++k) {
        BurinThrown thrown;
        thrown.point = shade.caster;
        thrown.below = (shade.caster.y - shade.last.y) * stretch.scales.y * burin_map.depth;
        if (k == 0) thrown.below = burin_map.drop_range.y - style.level + shade.caster.y * stretch.scales.y * burin_map.depth;
        thrown.shift = light_slope * thrown.below;
        rim = burin_thrown_rail(e, style, stretch, footprint, slope, thrown);
        if (k == 0) region.deep_shadow = region.deep_shadow | burin_strip_mask(near, rim);
    }
    if (behind >= shade.beyond) return mask;
    float area = burin_strip_area(near, rim, vec2(0.0f, 0.0f), vec2(1.0f, 1.0f));
    vec3 color = burin_shadow_color();
    region.color = region.color + (color - region.ground) * area;
    region.strip_area = region.strip_area + area;
    return mask | burin_strip_mask(near, rim);
}
