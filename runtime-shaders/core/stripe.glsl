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
    uint deep_shadows;   // places where shadows of the elements so far fall on whatever is lower than their ground
    uint deep_shadow;     // the same of the element at hand
    uint thrown;          // places of its shadow on the ground
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
        float beside = clamp(rail.middle, ends.x, ends.y);
        range = clamp(vec2(beside - room, beside + room), vec2(ends.x, ends.x), vec2(ends.y, ends.y));
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

// The one that is first, or last, is now the other, at the stretch's start or end.
void burin_take_start(BURIN_INOUT(BurinRail) rail, BurinRail other) {
    rail.from = other.from;
    rail.first = other.first;
    rail.at_first = other.at_first;
}

void burin_take_end(BURIN_INOUT(BurinRail) rail, BurinRail other) {
    rail.to = other.to;
    rail.last = other.last;
    rail.at_last = other.at_last;
}

BurinRail burin_rail(BurinElement e, BurinStyle style, BurinStretch stretch, BurinFootprint footprint, vec2 slope,
                     vec2 point) {
    BurinThrown thrown;
    thrown.point = point;
    thrown.shift = vec2(0.0f, 0.0f);
    thrown.below = 0.0f;
    return burin_thrown_rail(e, style, stretch, footprint, slope, thrown);
}

// A curve's rails are followed as far as the pixel is wide, each beside it or from its end on. Rails that run at different angles, many
// pixels apart, or begin at different places would leave the pixel out between them: so far are both drawn on at either end.
struct BurinBeyond {
    vec2 a;
    vec2 b;
};

BurinBeyond burin_beyond(vec2 a_from, vec2 a_to, vec2 b_from, vec2 b_to) {
    BurinBeyond beyond;
    vec2 along_a = a_to - a_from;
    vec2 along_b = b_to - b_from;
    along_a = along_a * (1.0f / max(length(along_a), 1.0e-20f));
    along_b = along_b * (1.0f / max(length(along_b), 1.0e-20f));
    float apart = 0.5f * length(a_from - b_from) * abs(burin_cross(along_a, along_b));
    vec2 centre = vec2(0.5f, 0.5f);
    float short_a = max(dot(centre - a_to, along_a), dot(a_from - centre, along_a));
    float short_b = max(dot(centre - b_to, along_b), dot(b_from - centre, along_b));
    float far = apart + max(max(short_a, short_b) + 1.5f, 0.0f);
    beyond.a = along_a * far;
    beyond.b = along_b * far;
    return beyond;
}

// Share of the pixel between two rails, from `from` to `to` of the way between them, each at the start and at the end.
// Where one of them is cut off by the stretch's end, both are followed to it.
float burin_strip_area(BurinRail a, BurinRail b, vec2 from, vec2 to) {
    vec2 p0 = mix(a.from, b.from, from.x);
    vec2 p1 = mix(a.from, b.from, to.x);
    vec2 q0 = mix(a.to, b.to, from.y);
    vec2 q1 = mix(a.to, b.to, to.y);
    bool start = a.at_first || b.at_first;
    bool end = a.at_last || b.at_last;
#if BURIN_CURVES != 0 || BURIN_FUNCTION_KINDS != 0
    BurinBeyond beyond = burin_beyond(p0, q0, p1, q1);
    if (!start) {
        p0 = p0 - beyond.a;
        p1 = p1 - beyond.b;
    }
    if (!end) {
        q0 = q0 + beyond.a;
        q1 = q1 + beyond.b;
    }
#endif
    float area = burin_edge_area(p0, q0) + burin_edge_area(q1, p1);
    if (start) {
        vec2 r0 = mix(a.first, b.first, from.x);
        vec2 r1 = mix(a.first, b.first, to.x);
        area = area + burin_edge_area(p1, r1) + burin_edge_area(r1, r0) + burin_edge_area(r0, p0);
    } else {
        area = area + burin_edge_area(p1, p0);
    }
    if (end) {
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
    BurinBeyond beyond = burin_beyond(a.from, a.to, b.from, b.to);
    return burin_quad_mask(start ? a.first : a.from - beyond.a, start ? b.first : b.from - beyond.b, end ? b.last : b.to + beyond.b,
                           end ? a.last : a.to + beyond.a);
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

// A shadow on the ground beside a profile: from `foot`, where that ground begins, on.
struct BurinCast {
    vec2 caster;   // points of the profile
    vec2 foot;
    float length;  // metres across the path; 0: none
};

// What the light passes over on its way across the profile: the part of each facet that it does not reach, counted from
// where it comes from, and the shadows on the ground.
struct BurinShade {
    float hidden[BURIN_MAX_PROFILE_POINTS];
    BurinCast behind;
    float order;  // +1: the light runs from left to right
    bool folded;  // the profile is no height field
#if BURIN_FOLDS != 0
    float until[BURIN_MAX_PROFILE_POINTS];  // then what lies behind may stand over a facet too: the light reaches it up to here
    BurinCast before;                       // and what leans towards the light, over the ground
#endif
};

// The part of a facet that the light reaches, counted along the eye's way: `same` as the light's, or the other one.
vec2 burin_lit_part(BurinShade shade, int facet, bool same) {
    vec2 lit = vec2(shade.hidden[facet], 1.0f);
#if BURIN_FOLDS != 0
    if (shade.folded) lit.y = shade.until[facet];
#endif
    return same ? lit : vec2(1.0f - lit.y, 1.0f - lit.x);
}

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

#if BURIN_FOLDS != 0

bool burin_is_folded(BurinStyle style) {
    float last = -2.0f;
    bool folded = false;
    for (int k = 0; k < BURIN_MAX_PROFILE_POINTS; ++k) {
        float b = burin_profile_point(style, k).x;
        folded = folded || b < last - 1.0e-5f;
        last = b;
        if (k + 1 >= style.count) break;
    }
    return folded;
}

// What an edge keeps off of the way from `last` to `next`: `from` and `to` are how far these lie beyond it, as seen along a line.
// An edge that comes earlier in the profile keeps off what lies before it, a later one what lies behind, unless the way runs above it:
// which of two sheets of a fold is on top, their points say.
vec2 burin_past_edge(float from, float to, vec2 last, vec2 next, vec2 edge, bool later) {
    float at = clamp(from / (from < to ? from - to : -1.0e-30f), 0.0f, 1.0f);
    if (edge.y >= mix(last.y, next.y, at)) return vec2(0.0f, 1.0f);
    return later ? vec2(0.0f, at) : vec2(at, 1.0f);
}

// Part of the way from point k - 1 to point k, in the order of `order`, that is free as seen along the bend's light.
vec2 burin_open_part(BurinStyle style, vec2 scales, float order, BurinBend bend, int k) {
    vec2 last = burin_shade_point(style, scales, order > 0.0f ? k - 1 : style.count - k);
    vec2 next = burin_shade_point(style, scales, order > 0.0f ? k : style.count - 1 - k);
    vec2 open = vec2(order * burin_clearance(bend, next, last) > 0.0f ? 0.0f : 1.0f, 1.0f);
    for (int j = 0; j < BURIN_MAX_PROFILE_POINTS; ++j) {
        vec2 edge = burin_shade_point(style, scales, order > 0.0f ? j : style.count - 1 - j);
        if (j != k - 1 && j != k) {
            float from = order * burin_clearance(bend, last, edge);
            float to = order * burin_clearance(bend, next, edge);
            vec2 past = burin_past_edge(from, to, last, next, edge, j > k);
            open = vec2(max(open.x, past.x), min(open.y, past.y));
        }
        if (j + 1 >= style.count) break;
    }
    return open;
}

// Of a profile that is no height field: every point may stand before or over every facet.
BurinShade burin_shade_folded(BurinStyle style, vec2 scales, BurinBend bend, bool shadows) {
    BurinShade shade;
    shade.order = bend.light.y < 0.0f ? -1.0f : 1.0f;
    shade.folded = true;
    bool left = shade.order > 0.0f;
    shade.before.length = 0.0f;
    shade.behind.length = 0.0f;
    shade.before.foot = burin_profile_point(style, left ? 0 : style.count - 1);
    shade.behind.foot = burin_profile_point(style, left ? style.count - 1 : 0);
    vec2 first = burin_shade_point(style, scales, left ? 0 : style.count - 1);
    vec2 end = burin_shade_point(style, scales, left ? style.count - 1 : 0);
    for (int k = 0; k < BURIN_MAX_PROFILE_POINTS; ++k) {
        vec2 code = burin_profile_point(style, left ? k : style.count - 1 - k);
        vec2 point = burin_shade_point(style, scales, left ? k : style.count - 1 - k);
        float over_first = shadows && point.y < first.y ? shade.order * burin_clearance(bend, first, point) : 0.0f;
        float over_end = shadows && point.y < end.y ? -shade.order * burin_clearance(bend, end, point) : 0.0f;
        if (over_first > shade.before.length) shade.before.caster = code;
        if (over_end > shade.behind.length) shade.behind.caster = code;
        shade.before.length = max(shade.before.length, over_first);
        shade.behind.length = max(shade.behind.length, over_end);
        vec2 lit = vec2(0.0f, 1.0f);
        if (shadows && k > 0) lit = burin_open_part(style, scales, shade.order, bend, k);
        int facet = left ? k - 1 : style.count - 1 - k;
        if (k > 0) {
            shade.hidden[facet] = lit.x;
            shade.until[facet] = lit.y;
        }
        if (k + 1 >= style.count) break;
    }
    return shade;
}

#endif

BurinShade burin_shade_profile(BurinStyle style, vec2 scales, BurinBend bend, bool shadows) {
    BurinShade shade;
    shade.order = bend.light.y < 0.0f ? -1.0f : 1.0f;
    shade.behind.length = 0.0f;
    shade.folded = false;
#if BURIN_FOLDS != 0
    shade.before.length = 0.0f;
    if (burin_is_folded(style)) return burin_shade_folded(style, scales, bend, shadows);
#endif
    vec2 last = vec2(0.0f, 0.0f);
    int rim = 0;  // of a straight path: the point that keeps most light off what follows
    for (int k = 0; k < BURIN_MAX_PROFILE_POINTS; ++k) {
        int i = shade.order > 0.0f ? k : style.count - 1 - k;
        vec2 point = burin_shade_point(style, scales, i);
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
                shade.behind.caster = burin_profile_point(style, shade.order > 0.0f ? j : style.count - 1 - j);
            }
            if (bend.curvature == 0.0f) break;
        }
        if (hidden < 1.0f) rim = k;
        if (k > 0) shade.hidden[shade.order > 0.0f ? k - 1 : i] = shadows ? hidden : 0.0f;
        if (k == style.count - 1) {
            shade.behind.length = shadows ? -least : 0.0f;
            shade.behind.foot = burin_profile_point(style, i);
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

// One facet, from the rail that the ray passes first. Of the way to the next one `seen` is hidden, and what lies beyond `until`; the
// light reaches the part `shone`.
void burin_add_facet(BurinElement e, BurinStyle style, BurinStretch stretch, float radius, BurinRail last, BurinRail next, vec2 seen, float until,
                     float order, vec2 shone, BURIN_INOUT(BurinRegion) region) {
    vec2 one = vec2(1.0f, 1.0f);
    float area = burin_strip_area(last, next, seen, one * until);
    if (area <= 0.0f) return;
    vec2 from = clamp(one * shone.x, seen, one * until);
    vec2 to = clamp(one * shone.y, seen, one * until);
    float lit = shone.x < shone.y ? burin_strip_area(last, next, from, to) : 0.0f;
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

// Adds a shadow on the ground beside the stripe, of which the first `covered` metres are hidden: from `near` on. Returns the places.
// `deep`: whatever is lower than that ground lies in the shadow too.
uint burin_add_cast(BurinElement e, BurinStyle style, BurinStretch stretch, BurinFootprint footprint, vec2 slope, vec2 light_slope,
                    BurinCast shadow, BurinRail near, float covered, bool deep, BURIN_INOUT(BurinRegion) region) {
    BurinRail rim = near;
    // First the shadow on whatever is lower than the ground, then that on the ground, as far as the profile does not hide it.
    for (int k = deep ? 0 : 1; k < (covered < shadow.length ? 2 : 1); ++k) {
        BurinThrown thrown;
        thrown.point = shadow.caster;
        thrown.below = (shadow.caster.y - shadow.foot.y) * stretch.scales.y * burin_map.depth;
        if (k == 0) thrown.below = burin_map.drop_range.y - style.level + shadow.caster.y * stretch.scales.y * burin_map.depth;
        thrown.shift = light_slope * thrown.below;
        rim = burin_thrown_rail(e, style, stretch, footprint, slope, thrown);
        if (k == 0) region.deep_shadow = region.deep_shadow | burin_strip_mask(near, rim);
    }
    if (covered >= shadow.length) return 0u;
    // Near one's end but not the other's, which the light has moved along the bend.
    if (e.curved && (near.at_first != rim.at_first || near.at_last != rim.at_last)) region.special = 0xffffu;
    float area = burin_strip_area(near, rim, vec2(0.0f, 0.0f), vec2(1.0f, 1.0f));
    region.color = region.color + (burin_shadow_color() - region.ground) * area;
    region.strip_area = region.strip_area + area;
    uint mask = burin_strip_mask(near, rim);
    region.thrown = region.thrown | mask;
    return mask;
}

// Adds the facets of one stretch; returns the places that they and their shadow cover.
uint burin_add_stripe(BurinElement e, BurinStyle style, BurinStretch stretch, BurinFootprint footprint, vec2 slope,
                      vec2 light_slope, bool shadows, BURIN_INOUT(BurinRegion) region) {
    BurinBend light = burin_bend(e, stretch, slope, light_slope);
#if BURIN_FOLDS != 0
    BurinBend eye = burin_bend(e, stretch, slope, slope);
#endif
    BurinShade shade = burin_shade_profile(style, stretch.scales, light, shadows);
    float order = dot(slope, stretch.normal) < 0.0f ? -1.0f : 1.0f;
    bool same = shade.order == order;
    BurinRail first = burin_rail(e, style, stretch, footprint, slope, burin_profile_point(style, order > 0.0f ? 0 : style.count - 1));
    BurinRail last = first;
    BurinRail front = first;
    BurinRail far = first;
    vec2 least = first.way * order;
    vec2 run = first.way * order;
    bool sunk = false;
    float highest = first.drop;
    for (int k = 1; k < BURIN_MAX_PROFILE_POINTS; ++k) {
        int i = order > 0.0f ? k : style.count - 1 - k;
        BurinRail next = burin_rail(e, style, stretch, footprint, slope, burin_profile_point(style, i));
        vec2 seen = vec2(burin_hidden(run.x, last.way.x * order, next.way.x * order),
                         burin_hidden(run.y, last.way.y * order, next.way.y * order));
        float until = 1.0f;
#if BURIN_FOLDS != 0
        if (shade.folded) {
            vec2 open = burin_open_part(style, stretch.scales, order, eye, k);
            seen = vec2(open.x, open.x);
            until = open.y;
        }
        if (next.way.x * order < least.x) burin_take_start(front, next);
        if (next.way.y * order < least.y) burin_take_end(front, next);
        least = min(least, next.way * order);
#endif
        vec2 shone = burin_lit_part(shade, order > 0.0f ? k - 1 : i, same);
        if (min(seen.x, seen.y) < until)
            burin_add_facet(e, style, stretch, footprint.radius, last, next, seen, until, order, shone, region);
        if (next.way.x * order > run.x) burin_take_start(far, next);
        if (next.way.y * order > run.y) burin_take_end(far, next);
        run = max(run, next.way * order);
        highest = min(highest, next.drop);
        sunk = sunk || next.drop - style.level > BURIN_FILM * burin_map.depth;
        last = next;
        if (k + 1 >= style.count) break;
    }
    // A step seen from above hides what lies on its lower side, as far as its foot would show.
    BurinRail nearest = front;
    if (last.way.x * order < nearest.way.x * order) burin_take_start(nearest, last);
    if (last.way.y * order < nearest.way.y * order) burin_take_end(nearest, last);
    uint mask = burin_strip_mask(nearest, far);
    vec2 whole = vec2(1.0f, 1.0f);
    float area = burin_strip_area(nearest, far, whole * 0.0f, whole);
    // What is taken away is taken from all that stands over it, and from its shadow.
    float over = style.level - burin_map.drop_range.x;
    bool taken = sunk && !style.stepped && over > BURIN_FILM * burin_map.depth;
    for (int k = taken ? 0 : 2; k < (shadows ? 2 : 1); ++k) {
        BurinThrown thrown;
        thrown.point = burin_profile_point(style, (k == 0 ? order : shade.order) > 0.0f ? style.count - 1 : 0);
        thrown.below = k == 0 ? -over : 0.0f;
        thrown.shift = light_slope * (k == 0 ? 0.0f : over);
        BurinRail end = burin_thrown_rail(e, style, stretch, footprint, slope, thrown);
        BurinRail start = front;
        if (k == 1 && !same) start = far;
        mask = mask | burin_strip_mask(start, end);
        area = max(area, burin_strip_area(start, end, whole * 0.0f, whole));
    }
    region.strip_area = region.strip_area + area;
#if BURIN_CURVES != 0
    // Light that comes past the profile farther along a bend may pass it from the other side.
    float along = light.light.x * (max(first.drop, last.drop) - highest) / length(burin_path_rate(e, stretch.middle));
    vec2 there = burin_path_rate(e, clamp(stretch.middle - along, 0.0f, 1.0f));
    if (shadows && e.curved && dot(light_slope, burin_normal_of(there)) * shade.order < 0.0f) region.special = 0xffffu;
#endif
    // Metres of the ground on either side, as the eye's ray comes to it, that the profile hides.
    float before = max(first.way.x * order - least.x, 0.0f);
    float behind = max(run.x - last.way.x * order, 0.0f);
    bool deep = burin_map.drop_range.y - style.level > 2.0f * BURIN_FILM * burin_map.depth;
    BurinRail lee = front;
    if (same) lee = far;
    if (shade.behind.length > 0.0f)
        mask = mask | burin_add_cast(e, style, stretch, footprint, slope, light_slope, shade.behind, lee, same ? behind : before, deep, region);
#if BURIN_FOLDS != 0
    BurinRail sunward = far;
    if (same) sunward = front;
    if (shade.before.length > 0.0f)
        mask = mask | burin_add_cast(e, style, stretch, footprint, slope, light_slope, shade.before, sunward, same ? before : behind, false, region);
#endif
    return mask;
}
