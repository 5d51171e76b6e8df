// What is shaded, and how much of the sky it sees.

// Define as 0 where the light comes from lamps alone: nobody asks what stands around a place then.
#ifndef BURIN_NOOKS
#define BURIN_NOOKS 1
#endif

// What stands around a place: the profile that it lies in, as an endless groove or ridge. Other features do not count.
struct BurinNook {
    vec2 across;   // unit, over the plane, where the offset grows
    vec2 horizon;  // slopes under which the profile hides the sky, towards less and towards more offset; 0 where it is open
};

struct BurinFacet {
    vec3 normal;  // pattern space, unit length, z up
    uint material;
    float lit;    // share of it that the light reaches
    float drop;   // of the place that stands for it, along the ray
    BurinNook nook;
};

// Part of the sky at a place with some normal, and of what that mirrors.
struct BurinSky {
    float open;   // share of the sky's light that falls in, by the cosine, were the sky even; level ground has 1
    vec3 bent;    // unit: where that light comes from in the mean
    float clear;  // share of the mirrored direction's surroundings that is sky
};

BurinNook burin_open_nook(vec2 across) {
    BurinNook nook;
    nook.across = across;
    nook.horizon = vec2(0.0f, 0.0f);
    return nook;
}

BurinFacet burin_level_facet(float drop, float lit) {
    BurinFacet facet;
    facet.normal = vec3(0.0f, 0.0f, 1.0f);
    facet.material = 0u;
    facet.lit = lit;
    facet.drop = drop;
    facet.nook = burin_open_nook(vec2(1.0f, 0.0f));
    return facet;
}

// `place` in the plane of the section, as profile points are; `scales` of width and height.
BurinNook burin_nook(BurinStyle style, vec2 scales, vec2 across, vec2 place) {
    BurinNook nook = burin_open_nook(across);
#if BURIN_NOOKS != 0
    vec2 metres = vec2(style.reach, burin_map.depth) * scales;
    for (int i = 0; i < BURIN_MAX_PROFILE_POINTS; ++i) {
        if (i >= style.count) break;
        vec2 way = (burin_profile_point(style, i) - place) * metres;
        if (abs(way.x) < 1.0e-4f * metres.x) continue;
        float slope = way.y / abs(way.x);
        if (way.x < 0.0f) nook.horizon.x = max(nook.horizon.x, slope);
        else nook.horizon.y = max(nook.horizon.y, slope);
    }
#endif
    return nook;
}

// Of a facet with unit normal n that mirrors the direction r, both in pattern space; `spread`: sine of half the angle that the
// mirror image is blurred over. An endless groove's sky is a wedge between two directions of the section; what falls in
// from an even wedge is a vector in closed form, a quarter turn of the difference of its borders, halved.
BurinSky burin_sky(BurinNook nook, vec3 n, vec3 r, float spread) {
    vec2 flat_n = vec2(dot(vec2(n), nook.across), n.z);
    float in_section = length(flat_n);
    flat_n = in_section > 1.0e-4f ? flat_n * (1.0f / in_section) : vec2(0.0f, 1.0f);
    vec2 right = vec2(flat_n.y, -flat_n.x);  // along the facet
    vec2 low = normalize(vec2(-1.0f, nook.horizon.x));
    vec2 high = normalize(vec2(1.0f, nook.horizon.y));
    if (dot(low, flat_n) < 0.0f) low = -right;
    if (dot(high, flat_n) < 0.0f) high = right;
    vec2 falls = vec2(low.y - high.y, high.x - low.x) * 0.5f;
    BurinSky sky;
    sky.open = clamp(dot(falls, flat_n), 0.0f, 1.0f);
    vec2 toward = length(falls) > 1.0e-4f ? normalize(falls) * in_section : flat_n * in_section;
    vec2 along = vec2(-nook.across.y, nook.across.x) * dot(vec2(n), vec2(-nook.across.y, nook.across.x));
    sky.bent = normalize(vec3(nook.across * toward.x + along, toward.y));
    // How far the mirrored direction stands off the facet's normal, against how far the sky reaches: sines.
    float seen = dot(vec2(dot(vec2(r), nook.across), r.z), right) / max(length(vec2(dot(vec2(r), nook.across), r.z)), 1.0e-6f);
    vec2 ends = vec2(-dot(low, right), dot(high, right));
    vec2 blur = vec2(spread, spread) * (vec2(1.0f, 1.0f) - ends) + vec2(1.0e-3f, 1.0e-3f);
    vec2 rims = ends + vec2(1.0e-3f, 1.0e-3f);
    sky.clear = (1.0f - smoothstep(rims.x - blur.x, rims.x + blur.x, -seen)) * (1.0f - smoothstep(rims.y - blur.y, rims.y + blur.y, seen));
    return sky;
}
