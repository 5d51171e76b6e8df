// The pixel as a whole: [2010] 5.7. Every element that shows in it is cut to the stretch that can, and added as stripes;
// what is left is ground. Where two features lie over each other, and at ends that are no joints, the places of the pixel
// are named instead, for the caller to ask ray by ray.

// Radians that a path may turn, or waves that its width may run through, while a ray falls through its profile.
#define BURIN_MOST_BEND 0.35f
// Part of the pixel that may be drawn as if the features in it did not know of each other.
#define BURIN_LEAST_AREA 0.03f
#define BURIN_MAX_REGION_CELLS 64
// From this fullness of a pixel on the prefilter takes over by degrees, from the next on alone.
#define BURIN_LEAST_FULLNESS 0.4f
#define BURIN_MOST_FULLNESS 0.9f
#define BURIN_MAX_REGION_ELEMENTS 64

// A feature's part in one question.
struct BurinReachOf {
    float across;   // metres beside the path, at the ground, within which it can show in the pixel
    float along;    // metres along the path by which what shows can lie off the pixel's centre
    float spread;   // metres by which the ray moves between the ground and the highest or lowest facet
};

// Whether stripes describe the end: joints, corners with a mitre, and ends on another path's line.
bool burin_end_is_plain(BurinEnd end) {
    if (end.priority == BURIN_PRIORITY_BOTH) return burin_clips_both(end);
    return end.priority != BURIN_PRIORITY_NONE && end.shape == BURIN_CORNER_MITRE;
}

// Metres along the path per metre of offset at which the end's clip line lies.
float burin_end_lean(BurinEnd end, vec2 tangent) {
    if (!burin_end_is_plain(end)) return 0.0f;
    float across = burin_cross(end.clip, tangent);
    return abs(across) < 0.02f ? 0.0f : -burin_cross(end.clip, end.normal) / across;
}

// Whether the path goes on beyond the end as if there were none.
bool burin_end_is_smooth(BurinEnd end, float lean) {
    return end.priority == BURIN_PRIORITY_BOTH && end.shape == BURIN_END_CLIP && abs(lean) < 0.03f;
}

// Places around an end that stripes do not describe: caps and joins; and, where another feature begins there, what ray
// and light reach past the end though the profile alone would keep them off. `way` and `light_way`: metres that they move
// over the plane within the profile. `stands_out`: of its ground.
uint burin_end_mask(BurinEnd end, BurinFootprint footprint, vec2 place, float reach, float lean, vec2 way, vec2 light_way, bool stands_out) {
    if (burin_end_is_smooth(end, lean)) return 0u;
    bool plain = burin_end_is_plain(end);
    float seen = dot(way, end.inward);
    float lit = dot(light_way, end.inward);
    float tip = plain ? abs(lean) * reach : (end.priority == BURIN_PRIORITY_NONE ? 0.0f : reach);
    float back = max(max(seen, lit), 0.0f) + abs(seen) + (plain ? tip : 0.0f) + 1.0e-3f * reach;
    // Where nothing goes on beyond, the end of what stands out throws a shadow of its own; and so does the ridge of a corner,
    // with as many bends as the profile has.
    bool last = !plain || stands_out || (end.priority == BURIN_PRIORITY_BOTH && end.shape == BURIN_END_TEE);
    float ahead = abs(seen) + tip + (last ? max(-lit, 0.0f) : 0.0f) + 1.0e-3f * reach;
    vec2 side = end.normal * (reach + abs(dot(way, end.normal)) + (last ? abs(dot(light_way, end.normal)) : 0.0f));
    vec2 a = end.vertex - place + end.inward * back;
    vec2 b = end.vertex - place - end.inward * ahead;
    vec2 p = burin_to_pixel(footprint, a - side);
    vec2 q = burin_to_pixel(footprint, a + side);
    vec2 r = burin_to_pixel(footprint, b + side);
    vec2 s = burin_to_pixel(footprint, b - side);
    if (burin_quad_area(p, q, r, s) < BURIN_LEAST_AREA) return 0u;
    return burin_quad_mask(p, q, r, s);
}

// Where the element can show in the pixel; limits are empty where it cannot. `tips`: metres that its ends may reach on.
BurinStretch burin_stretch_of(BurinElement e, vec2 place, BurinReachOf reach, vec2 tips) {
    BurinStretch stretch;
    stretch.lean = vec2(0.0f, 0.0f);
    stretch.limits = vec2(1.0f, 0.0f);
    float offset = 0.0f;
    if (e.curved) {
        BurinFoot foot = burin_curve_foot(e, place);
        offset = foot.offset;
        stretch.middle = foot.parameter;
    } else {
        offset = dot(place - e.p0, burin_normal_of(e.t0));
        stretch.middle = dot(place - e.p0, e.t0) / max(e.extent, 1.0e-20f);
    }
    vec2 rate = burin_path_rate(e, stretch.middle);
    stretch.normal = burin_normal_of(burin_direction(rate, e.t0));
    stretch.scales = burin_scales_at(e, stretch.middle);
    if (abs(offset) > reach.across) return stretch;
    if (dot(place - e.p0, e.t0) < -reach.along - tips.x && stretch.middle <= 0.5f) return stretch;
    if (dot(place - e.p2, e.t2) > reach.along + tips.y && stretch.middle >= 0.5f) return stretch;
    float room = (reach.along + max(tips.x, tips.y)) / length(rate);
    stretch.limits = clamp(vec2(stretch.middle - 2.0f * room, stretch.middle + 2.0f * room), vec2(0.0f, 0.0f), vec2(1.0f, 1.0f));
    return stretch;
}

// Pieces on which the part of a curve that a pixel spans counts as straight.
int burin_piece_count(BurinElement e, vec2 limits, float radius) {
    if (e.waved) {
        // An eighth of a wave is nearly straight; what spans more of it than pieces tell apart is drawn in these.
        float waves = abs(e.argument.y) * min(4.0f * radius / max(e.extent, 1.0e-20f), limits.y - limits.x);
        return waves < 0.125f ? 1 : 8;
    }
    if (!e.curved) return 1;
    vec2 t0 = burin_direction(burin_path_rate(e, limits.x), e.t0);
    vec2 t1 = burin_direction(burin_path_rate(e, limits.y), e.t2);
    float turn = acos(clamp(dot(t0, t1), -1.0f, 1.0f));
    float way = length(burin_path_at(e, limits.y) - burin_path_at(e, limits.x));
    // Of the turn, what falls into the pixel.
    float within = turn * min(2.0f * radius / max(way, 1.0e-20f), 1.0f);
    return within < 0.1f ? 1 : clamp(int(ceil(turn * 6.0f)), 1, 8);
}

// An element that shows in the pixel, or throws a shadow into it.
struct BurinShown {
    BurinElement e;
    BurinStyle style;
    BurinStretch stretch;  // that shows
    vec2 lean;             // metres along the path per metre of offset at which its ends lie
    float wide;
    float spread;
    uint marks;  // places that its ends want rays for
    bool bent;   // stripes do not describe it
};

// Whether ray or light meet the feature elsewhere, or in another size, than stripes tell. `light_way`: metres that the light moves over
// the plane within the relief.
bool burin_is_bent(BurinShown shown, vec2 slope, vec2 light_slope, float light_way, float radius) {
    BurinElement e = shown.e;
    // A ray that runs along a bend for long meets it elsewhere than the stripes are.
    float curvature = abs(burin_bend(e, shown.stretch, slope, light_slope).curvature);
    float waves = e.waved ? abs(e.argument.y) * (shown.spread + radius) / max(e.extent, 1.0e-20f) : 0.0f;
    // And light that runs along a taper passes a profile of another size.
    float taper = max(abs(e.scales.y - e.scales.x), abs(e.scales.w - e.scales.z)) / max(e.extent, 1.0e-20f);
    float grown = taper * (shown.spread + light_way) / min(shown.stretch.scales.x, shown.stretch.scales.y);
#if BURIN_FOLDS != 0
    // Curves of a profile that overhangs hide more of each other than stripes tell, which shows from near.
    if (e.curved && shown.wide > 2.0f * radius && burin_is_folded(shown.style)) return true;
#endif
    // By how much it is off counts the less, the smaller the feature is in the pixel.
    float coarse = max(radius / shown.wide, 1.0f);
    return max(max(curvature * shown.spread, waves), grown) > BURIN_MOST_BEND * coarse * coarse;
}

// Whether the element shows.
bool burin_shows(BurinElement e, BurinRay ray, BurinFootprint footprint, vec2 light_slope, bool shadows,
                 BURIN_OUT(BurinShown) shown) {
    BurinStyle style = burin_style(e.style);
    float wide = style.reach * burin_widest(e);
    // Of the map: a cell that names the element need not be where it is highest, nor know what it cuts.
    float high = max(style.level - burin_map.drop_range.x, burin_map.drop_range.y - style.level);
    BurinReachOf reach;
    reach.spread = length(ray.slope) * high;
    bool stands_out = style.stepped || style.level - burin_map.drop_range.x > BURIN_FILM * burin_map.depth;
    float shadow = shadows && stands_out ? (burin_map.drop_range.y - burin_map.drop_range.x) * length(light_slope) : 0.0f;
    vec2 place = ray.slope * style.level;
    reach.along = footprint.radius + reach.spread + shadow;
    reach.across = wide + footprint.radius + reach.spread + shadow;
    BurinEnd start = burin_end(e, true);
    BurinEnd end = burin_end(e, false);
    vec2 lean = vec2(burin_end_lean(start, e.t0), burin_end_lean(end, e.t2));
    vec2 tips = abs(lean) * wide;
    if (!burin_end_is_plain(start)) tips.x = wide;
    if (!burin_end_is_plain(end)) tips.y = wide;
    // What light and ray reach past an end may lie lower than the element itself, and so farther away.
    float relief = burin_map.drop_range.y - burin_map.drop_range.x;
    vec2 way = ray.slope * relief;
    vec2 light_way = light_slope * (shadows ? relief : 0.0f);
    shown.marks = burin_end_mask(start, footprint, place, wide, lean.x, way, light_way, stands_out) |
                  burin_end_mask(end, footprint, place, wide, lean.y, way, light_way, stands_out);
    shown.e = e;
    shown.style = style;
    shown.stretch = burin_stretch_of(e, place, reach, tips);
    shown.stretch.room = footprint.radius;
    shown.lean = lean;
    shown.wide = wide;
    shown.spread = reach.spread;
    bool shows = shown.stretch.limits.y >= shown.stretch.limits.x;
    shown.bent = shows && burin_is_bent(shown, ray.slope, light_slope, length(light_way), footprint.radius);
    return shows;
}

// The cell of the map at a place of the plane of cells, which repeats.
BurinCell burin_wrapped_cell(vec2 index) {
    return burin_cell(ivec2(index - floor(index / vec2(burin_map.cells)) * vec2(burin_map.cells)));
}

vec2 burin_cell_centre(vec2 index) {
    return (index + vec2(0.5f, 0.5f)) / vec2(burin_map.cells);
}

#if BURIN_STEPS != 0
// Drop of the ground at a place of the plane; `place` is its metres from the ray's origin.
float burin_ground_at(BurinRay ray, vec2 place) {
    vec2 index = floor((ray.origin + place) / burin_map.size * vec2(burin_map.cells));
    vec2 centre = burin_cell_centre(index);
    return burin_step_line(burin_wrapped_cell(index), ray, centre, centre * burin_map.size - ray.origin, place, 0.0f, true).level;
}

// Whether the ray comes to ground at this drop, and not first to what it enters over.
bool burin_sees_ground(BurinRay ray, float drop) {
    float film = BURIN_FILM * burin_map.depth;
    if (abs(burin_ground_at(ray, ray.slope * drop) - drop) > film) return false;
    float above = burin_ground_at(ray, ray.slope * burin_map.drop_range.x);
    return above > drop - film || burin_ground_at(ray, ray.slope * above) > above + film;
}
#endif

void burin_add_shown(BurinShown shown, BurinRay ray, BurinFootprint footprint, vec2 light_slope, bool shadows,
                     BURIN_INOUT(BurinRegion) region) {
    BurinElement e = shown.e;
    BurinStretch stretch = shown.stretch;
    vec2 limits = stretch.limits;
    uint mask = 0u;
    region.deep_shadow = 0u;
    region.thrown = 0u;
    int pieces = burin_piece_count(e, limits, footprint.radius);
    float centre = stretch.middle;
    for (int i = 0; i < 8; ++i) {
        stretch.limits = vec2(mix(limits.x, limits.y, float(i) / float(pieces)),
                              mix(limits.x, limits.y, float(i + 1) / float(pieces)));
        stretch.lean = vec2(stretch.limits.x <= 0.0f ? shown.lean.x : 0.0f, stretch.limits.y >= 1.0f ? shown.lean.y : 0.0f);
        stretch.near_first = i > 0 || limits.x <= 0.0f;
        stretch.near_last = i < pieces - 1 || limits.y >= 1.0f;
        if (pieces > 1) {
            stretch.middle = clamp(centre, stretch.limits.x, stretch.limits.y);
            stretch.normal = burin_normal_of(burin_direction(burin_path_rate(e, stretch.middle), e.t0));
            stretch.scales = burin_scales_at(e, stretch.middle);
        }
        mask = mask | burin_add_stripe(e, shown.style, stretch, footprint, ray.slope, light_slope, shadows, region);
        if (i + 1 >= pieces) break;
    }
    // Features over each other; thin ones hardly are.
    float area = region.strip_area;
    region.strip_area = 0.0f;
    if (area * region.covered_area > BURIN_LEAST_AREA) region.special = region.special | (region.covered & mask);
    region.special = region.special | (region.covered & region.deep_shadow) | (region.deep_shadows & mask);
#if BURIN_STEPS != 0
    // The ground that the shadow is meant for may end before it does, or other ground hide it.
    float foot = dot(light_slope, stretch.normal) > 0.0f ? shown.style.right_level : shown.style.level;
    if (region.thrown != 0u && !burin_sees_ground(ray, foot)) region.special = region.special | region.thrown;
#endif
    region.covered = region.covered | mask;
    region.deep_shadows = region.deep_shadows | region.deep_shadow;
    region.covered_area = region.covered_area + area;
    if (area > 0.0f) ++region.elements;
}

// Corners of the box, in cells, that the pixel passes between the drops.
vec4 burin_region_box(BurinRay ray, BurinFootprint footprint, vec2 drops) {
    vec2 half_size = 0.5f * (abs(footprint.along_x) + abs(footprint.along_y));
    vec2 a = ray.origin + ray.slope * drops.x;
    vec2 b = ray.origin + ray.slope * drops.y;
    vec2 to_cells = vec2(burin_map.cells) / burin_map.size;
    vec2 low = (min(a, b) - half_size) * to_cells;
    vec2 high = (max(a, b) + half_size) * to_cells;
    return vec4(floor(low.x), floor(low.y), floor(high.x), floor(high.y));
}

float burin_cells_in(vec4 box) {
    return (box.z - box.x + 1.0f) * (box.w - box.y + 1.0f);
}

// The elements around a pixel, each once: cells share them.
struct BurinGathered {
    uint references[BURIN_MAX_REGION_ELEMENTS];
    vec2 images[BURIN_MAX_REGION_ELEMENTS];  // tiles by which each is moved
    vec2 homes[BURIN_MAX_REGION_ELEMENTS];   // cell that named it first, not wrapped
    int count;
    bool complete;
    bool thin;  // some of them so that a few rays may miss them
};
BurinGathered burin_gathered;

// The cells that a pixel spans.
struct BurinSpan {
    ivec2 low;
    ivec2 sides;
    float fullness;  // how much of what it may span the pixel does, on the object surface
    bool inside;     // of a map that does not repeat
    bool short_way;  // what lies under the pixel is not too much to look at
};

BurinSpan burin_span(BurinRay ray, BurinFootprint footprint, vec2 light_slope, bool shadows, float ground_drop) {
    vec4 box = burin_region_box(ray, footprint, burin_map.drop_range);
    BurinSpan span;
    span.fullness = burin_cells_in(burin_region_box(ray, footprint, vec2(ground_drop, ground_drop))) / float(BURIN_MAX_REGION_CELLS);
    span.short_way = burin_cells_in(box) <= float(BURIN_MAX_REGION_CELLS);
    // What rises above the ground throws shadows as far as this, where they fall on the lowest surface.
    bool stands_out = ground_drop - burin_map.drop_range.x > BURIN_FILM * burin_map.depth;
    vec2 thrown = light_slope * (shadows && stands_out ? burin_map.drop_range.y - burin_map.drop_range.x : 0.0f);
    thrown = thrown * vec2(burin_map.cells) / burin_map.size;
    vec4 wide = vec4(floor(box.x - max(thrown.x, 0.0f)), floor(box.y - max(thrown.y, 0.0f)),
                     floor(box.z - min(thrown.x, 0.0f)), floor(box.w - min(thrown.y, 0.0f)));
    vec2 last = vec2(burin_map.cells - ivec2(1, 1));
    span.inside = burin_map.repeats != 0 || (box.x >= 0.0f && box.y >= 0.0f && box.z <= last.x && box.w <= last.y);
    if (burin_map.repeats == 0) wide = vec4(max(wide.x, 0.0f), max(wide.y, 0.0f), min(wide.z, last.x), min(wide.w, last.y));
    if (burin_cells_in(wide) <= float(BURIN_MAX_REGION_CELLS)) box = wide;
    span.low = ivec2(int(box.x), int(box.y));
    span.sides = ivec2(int(box.z), int(box.w)) - span.low + ivec2(1, 1);
    return span;
}

// Whether the element comes so near that it may show, or want rays for its ends: a rough question, at a fraction of what
// burin_shows costs. `light_way`: metres that the light moves over the plane within the relief. `wide`: metres to either side at most.
bool burin_may_show(BurinElement e, BurinRay ray, float radius, float light_way, BURIN_OUT(float) wide) {
    wide = burin_style(e.style).reach * burin_widest(e);
    BurinEnd start = burin_end(e, true);
    BurinEnd end = burin_end(e, false);
    float lean = max(abs(burin_end_lean(start, e.t0)), abs(burin_end_lean(end, e.t2)));
    vec2 from = ray.slope * burin_map.drop_range.x;
    vec2 to = ray.slope * burin_map.drop_range.y;
    float room = 1.01f * wide + radius + length(to - from) + light_way;
    return !burin_passes_beyond(e, from, to, room + max(lean, 1.0f) * wide) && !burin_passes_beside(e, from, to, room);
}

// Gathers the elements of a cell that may show and are not known yet.
void burin_gather_cell(vec2 index, BurinRay ray, float radius, float light_way) {
    BurinCell cell = burin_wrapped_cell(index);
    uvec4 texel = uvec4(0u, 0u, 0u, 0u);
    for (int i = 0; i < BURIN_MAX_REFS_PER_CELL; ++i) {
        if (i >= cell.count || !burin_gathered.complete) break;
        uint reference = burin_listed(cell, i, texel);
        BurinElement e = burin_element(reference, ray.origin, burin_cell_centre(index));
        float wide;
        bool known = !burin_may_show(e, ray, radius, light_way, wide);
        burin_gathered.thin = burin_gathered.thin || (!known && wide < radius);
        for (int j = 0; j < BURIN_MAX_REGION_ELEMENTS; ++j) {
            if (known || j >= burin_gathered.count) break;
            known = burin_gathered.references[j] == reference && burin_gathered.images[j] == e.image;
        }
        burin_gathered.complete = known || burin_gathered.count < BURIN_MAX_REGION_ELEMENTS;
        if (!known && burin_gathered.complete) {
            burin_gathered.references[burin_gathered.count] = reference;
            burin_gathered.images[burin_gathered.count] = e.image;
            burin_gathered.homes[burin_gathered.count] = index;
            ++burin_gathered.count;
        }
        if (i + 1 >= cell.count) break;
    }
}

// Gathers for a pixel, before burin_region is asked about it.
void burin_gather(BurinSpan span, BurinRay ray, BurinFootprint footprint, vec2 light_slope, bool shadows) {
    float light_way = shadows ? length(light_slope) * (burin_map.drop_range.y - burin_map.drop_range.x) : 0.0f;
    burin_gathered.count = 0;
    burin_gathered.thin = false;
    burin_gathered.complete = span.short_way && span.inside;
    for (int k = 0; k < BURIN_MAX_REGION_CELLS; ++k) {
        if (!burin_gathered.complete) break;
        burin_gather_cell(vec2(span.low + ivec2(k % span.sides.x, k / span.sides.x)), ray, footprint.radius, light_way);
        if (k + 1 >= span.sides.x * span.sides.y) break;
    }
    burin_gathered.thin = burin_gathered.thin || !burin_gathered.complete;
}

BurinRegion burin_no_region(vec3 ground, float fullness) {
    BurinRegion region;
    region.color = vec3(0.0f, 0.0f, 0.0f);
    region.ground = ground;
    region.covered = 0u;
    region.special = 0u;
    region.deep_shadows = 0u;
    region.deep_shadow = 0u;
    region.thrown = 0u;
    region.covered_area = 0.0f;
    region.strip_area = 0.0f;
    region.elements = 0;
    region.fullness = fullness;
    return region;
}

// `ground` is the colour of lit ground. The ray passes the object surface at the pixel's centre. Where fullness is 1 or more the
// pixel spans too much to be looked through, and the rest says nothing. Asks what was gathered.
BurinRegion burin_region(BurinRay ray, BurinFootprint footprint, vec2 light_slope, bool shadows, vec3 ground, BurinSpan span) {
    BurinRegion region = burin_no_region(ground, span.fullness);
    if (span.fullness > 1.0f) return region;
    if (!burin_gathered.complete || !span.inside) {
        // Too many to tell apart: from near by rays, from far away by the prefilter.
        region.special = 0xffffu;
        if (span.inside && region.fullness > BURIN_LEAST_FULLNESS) region.fullness = 1.0f;
        return region;
    }
    // Where rays will be asked nothing more need be known, unless the prefilter might be asked instead.
    bool few = region.fullness <= BURIN_LEAST_FULLNESS && float(burin_gathered.count) <= BURIN_LEAST_FULLNESS * float(BURIN_MAX_REGION_ELEMENTS);
    bool given_up = false;
    BurinShown shown;
    int j = 0;
    for (int n = 0; n < BURIN_MAX_REGION_ELEMENTS; ++n) {
        bool shows = false;
        for (int k = 0; k < BURIN_MAX_REGION_ELEMENTS; ++k) {
            if (shows || j >= burin_gathered.count) break;
            uint reference = burin_gathered.references[j];
            vec2 home = burin_gathered.homes[j];
            BurinElement e = burin_element(reference, ray.origin, burin_cell_centre(home));
            shows = burin_shows(e, ray, footprint, light_slope, shadows, shown);
            region.special = region.special | shown.marks | (shown.bent ? 0xffffu : 0u);
            ++j;
            given_up = few && region.special != 0u;
            if (shows || given_up || j >= burin_gathered.count) break;
        }
        if (shows && !given_up) burin_add_shown(shown, ray, footprint, light_slope, shadows, region);
        given_up = few && region.special != 0u;
        if (given_up || j >= burin_gathered.count) break;
    }
    region.fullness = max(region.fullness, float(region.elements) / float(BURIN_MAX_REGION_ELEMENTS));
    // Where a map ends, its ground stands against the light that falls into a feature.
    vec2 light_way = abs(light_slope) * ((burin_map.drop_range.y - burin_map.drop_range.x) * (shadows ? 1.0f : 0.0f));
    vec2 lowest = ray.origin + ray.slope * burin_map.drop_range.y;
    vec2 room = min(min(ray.origin, lowest), burin_map.size - max(ray.origin, lowest)) - footprint.radius;
    bool at_border = burin_map.repeats == 0 && (room.x < light_way.x || room.y < light_way.y);
    if (at_border && region.covered_area > 0.0f) region.special = 0xffffu;
    return region;
}
