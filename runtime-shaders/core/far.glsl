// The pattern from far away: stripes of a few classes, each as often as the prefilter says (cpp/prefilter.hpp). A class is
// looked at as one endless stripe.

#define BURIN_MAX_CLASSES 32

struct BurinClass {
    uint style;
    vec2 tangent;
    float height;  // scale
};

// Colour less that of lit ground, times the metres across that show it; divided by the style's reach.
vec3 burin_far_stripe(BurinClass kind, vec2 slope, vec2 light_slope, bool shadows, vec3 ground) {
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
    vec3 sum = vec3(0.0f, 0.0f, 0.0f);
    float run = -1.0e30f;
    vec2 last = vec2(0.0f, 0.0f);
    float last_way = 0.0f;
    for (int k = 0; k < BURIN_MAX_PROFILE_POINTS; ++k) {
        if (k >= style.count) break;
        int i = order > 0.0f ? k : style.count - 1 - k;
        vec2 point = burin_shade_point(style, scales, i);
        float way = order * (point.x - lean * point.y);
        float seen = k > 0 ? burin_hidden(run, last_way, way) : 1.0f;
        if (seen < 1.0f) {
            float hidden = shade.hidden[order > 0.0f ? k - 1 : i];
            float from = clamp(same ? hidden : 0.0f, seen, 1.0f);
            float to = clamp(same ? 1.0f : 1.0f - hidden, seen, 1.0f);
            vec2 across = (point - last) * order;
            vec3 n = vec3(normal * across.y, across.x);
            vec2 middle = (last + point) * 0.5f;
            BurinFacet facet;
            facet.normal = normalize(n);
            facet.material = style.material;
            facet.lit = max(to - from, 0.0f) / (1.0f - seen);
            facet.drop = style.level + middle.y;
            facet.nook = burin_nook(style, scales, normal, vec2(middle.x / style.reach, -middle.y / (scales.y * burin_map.depth)));
            sum = sum + (burin_facet_color(facet) - ground) * ((1.0f - seen) * (way - last_way));
        }
        run = max(run, way);
        last = point;
        last_way = way;
    }
    float shadow = shade.beyond - (same ? max(run - last_way, 0.0f) : 0.0f);
    if (shadow > 0.0f) sum = sum + (burin_shadow_color() - ground) * shadow;
    return sum * (1.0f / style.reach);
}
