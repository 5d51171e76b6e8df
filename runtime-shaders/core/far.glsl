// The pattern from far away: stripes of a few classes, each as often as the prefilter says (cpp/prefilter.hpp). A class is
// looked at as one endless stripe.

#define BURIN_MAX_CLASSES 32

struct BurinClass {
    uint style;
    vec2 tangent;
    float height;  // scale
};

// What stripes show. Widths are metres over the plane along the ray's way, divided by the style's reach.
struct BurinFar {
    vec3 color;    // sum of width * (colour - colour of lit ground)
    float shown;   // width of the stripe as it shows
    float own;     // and as it stands on the ground
    float shadow;  // width of its shadow on the ground, as far as the stripe itself does not hide that
};

BurinFar burin_far_stripe(BurinClass kind, vec2 slope, vec2 light_slope, bool shadows, vec3 ground) {
    BurinStyle style = burin_style(kind.style);
    vec2 normal = burin_normal_of(kind.tangent);
    vec2 scales = vec2(1.0f, kind.height);
    BurinBend bend;
    bend.light = vec2(dot(light_slope, kind.tangent), dot(light_slope, normal));
    bend.slope = 0.0f;
    bend.curvature = 0.0f;
    BurinShade shade = burin_shade_profile(style, scales, bend, shadows);
    BurinBend eye = bend;
    eye.light = vec2(dot(slope, kind.tangent), dot(slope, normal));
    float lean = eye.light.y;
    float order = lean < 0.0f ? -1.0f : 1.0f;
    bool same = shade.order == order;
    BurinFar far;
    far.color = vec3(0.0f, 0.0f, 0.0f);
    far.shown = 0.0f;
    far.own = 0.0f;
    float run = -1.0e30f;
    float least = 1.0e30f;
    float first_way = 0.0f;
    vec2 last = vec2(0.0f, 0.0f);
    float last_way = 0.0f;
    for (int k = 0; k < BURIN_MAX_PROFILE_POINTS; ++k) {
        if (k >= style.count) break;
        int i = order > 0.0f ? k : style.count - 1 - k;
        vec2 point = burin_shade_point(style, scales, i);
        float way = order * (point.x - lean * point.y);
        vec2 seen = vec2(k > 0 ? burin_hidden(run, last_way, way) : 1.0f, 1.0f);
#if BURIN_FOLDS != 0
        if (shade.folded && k > 0) seen = burin_open_part(style, scales, order, eye, k);
#endif
        vec2 lit = k > 0 ? burin_lit_part(shade, order > 0.0f ? k - 1 : i, same) : vec2(0.0f, 1.0f);
        if (seen.x < seen.y) {
            vec2 across = (point - last) * order;
            vec3 n = vec3(normal * across.y, across.x);
            vec2 middle = (last + point) * 0.5f;
            BurinFacet facet;
            facet.normal = normalize(n);
            facet.material = style.material;
            facet.lit = max(min(lit.y, seen.y) - max(lit.x, seen.x), 0.0f) / (seen.y - seen.x);
            facet.drop = style.level + middle.y;
            facet.nook = burin_nook(style, scales, normal, vec2(middle.x / style.reach, -middle.y / (scales.y * burin_map.depth)));
            float wide = (seen.y - seen.x) * (way - last_way);
            far.color = far.color + (burin_facet_color(facet) - ground) * wide;
            far.shown = far.shown + wide;
        }
        far.own = far.own + (k > 0 ? order * (point.x - last.x) : 0.0f);
        run = max(run, way);
        least = min(least, way);
        if (k == 0) first_way = way;
        last = point;
        last_way = way;
    }
    far.color = far.color * (1.0f / style.reach);
    far.shown = far.shown / style.reach;
    far.own = far.own / style.reach;
    float before = first_way - least;
    float behind = run - last_way;
    far.shadow = max(shade.behind.length - (same ? behind : before), 0.0f) / style.reach;
#if BURIN_FOLDS != 0
    far.shadow = far.shadow + max(shade.before.length - (same ? before : behind), 0.0f) / style.reach;
#endif
    return far;
}

// Colour less that of lit ground, of all stripes: beside each other as long as there is ground left, the shadows on what they
// leave of it. A pattern drawn by hand or from a map seldom has stripes over each other before it is full.
vec3 burin_far_sum(BurinFar far, vec3 ground) {
    float seen = max(1.0f - max(far.shown, far.own), 0.0f);
    float shaded = min(far.shadow, seen);
    return far.color * ((1.0f - seen) / max(far.shown, 1.0e-4f)) + (burin_shadow_color() - ground) * shaded;
}
