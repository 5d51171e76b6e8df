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

// Part of the way from point k - 1 to point k, in the order of `order`, that is free as seen along `lean`. A point keeps off what
// it passes in the way before or after it, if it lies higher: which of two sheets of a fold is on top, their points say.
vec2 burin_open_part(BurinStyle style, vec2 scales, float order, float lean, int k) {
    vec2 last = burin_shade_point(style, scales, order > 0.0f ? k - 1 : style.count - k);
    vec2 next = burin_shade_point(style, scales, order > 0.0f ? k : style.count - 1 - k);
    float from = order * (last.x - lean * last.y);
    float to = order * (next.x - lean * next.y);
    vec2 open = vec2(from, to);
    for (int j = 0; j < BURIN_MAX_PROFILE_POINTS; ++j) {
        vec2 point = burin_shade_point(style, scales, order > 0.0f ? j : style.count - 1 - j);
        float way = order * (point.x - lean * point.y);
        if (j < k && point.y < last.y) open.x = max(open.x, way);
        if (j >= k && point.y < next.y) open.y = min(open.y, way);
        if (j + 1 >= style.count) break;
    }
    float wide = to - from;
    return wide > 0.0f ? clamp((open - vec2(from, from)) * (1.0f / wide), 0.0f, 1.0f) : vec2(1.0f, 1.0f);
}

BurinFar burin_far_stripe(BurinClass kind, vec2 slope, vec2 light_slope, bool shadows, vec3 ground) {
    BurinStyle style = burin_style(kind.style);
    vec2 normal = burin_normal_of(kind.tangent);
    vec2 scales = vec2(1.0f, kind.height);
    BurinBend bend;
    bend.light = vec2(dot(light_slope, kind.tangent), dot(light_slope, normal));
    bend.slope = 0.0f;
    bend.curvature = 0.0f;
    BurinShade shade = burin_shade_profile(style, scales, bend, shadows);
    float lean = dot(slope, normal);
    float order = lean < 0.0f ? -1.0f : 1.0f;
    bool same = shade.order == order;
    BurinFar far;
    far.color = vec3(0.0f, 0.0f, 0.0f);
    far.shown = 0.0f;
    far.own = 0.0f;
    float run = -1.0e30f;
    vec2 last = vec2(0.0f, 0.0f);
    float last_way = 0.0f;
    for (int k = 0; k < BURIN_MAX_PROFILE_POINTS; ++k) {
        if (k >= style.count) break;
        int i = order > 0.0f ? k : style.count - 1 - k;
        vec2 point = burin_shade_point(style, scales, i);
        float way = order * (point.x - lean * point.y);
        vec2 seen = vec2(k > 0 ? burin_hidden(run, last_way, way) : 1.0f, 1.0f);
        float hidden = k > 0 ? shade.hidden[order > 0.0f ? k - 1 : i] : 0.0f;
        vec2 lit = vec2(same ? hidden : 0.0f, same ? 1.0f : 1.0f - hidden);
        if (shade.folded && k > 0) {
            seen = burin_open_part(style, scales, order, lean, k);
            if (shadows) lit = burin_open_part(style, scales, shade.order, bend.light.y, same ? k : style.count - k);
            if (shadows && !same) lit = vec2(1.0f, 1.0f) - vec2(lit.y, lit.x);
        }
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
        last = point;
        last_way = way;
    }
    far.color = far.color * (1.0f / style.reach);
    far.shown = far.shown / style.reach;
    far.own = far.own / style.reach;
    far.shadow = max(shade.beyond - (same ? max(run - last_way, 0.0f) : 0.0f), 0.0f) / style.reach;
    return far;
}

// Colour less that of lit ground, of all stripes. Where they stand they are beside each other; what they hide and shade of the
// rest falls wherever it happens to, on ground and stripes alike.
vec3 burin_far_sum(BurinFar far, vec3 ground) {
    float clear = max(1.0f - far.own, 1.0e-3f);
    float seen = max(clear - max(far.shown - far.own, 0.0f), 0.0f);
    float shaded = seen * (1.0f - exp(-far.shadow / clear));
    return far.color * ((1.0f - seen) / max(far.shown, 1.0e-4f)) + (burin_shadow_color() - ground) * shaded;
}
