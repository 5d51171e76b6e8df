// What was met: normal, facet, material. Asked once for a hit, so that tracing carries nothing but names.

struct BurinSurface {
    vec3 normal;  // z up, unit length
    int facet;    // of the profile, or BURIN_FACET_GROUND, BURIN_FACET_WALL
    uint material;
    BurinNook nook;
};

// The upright facet on the path line of a step that the drop t lies on.
int burin_step_facet(BurinElement e, BurinStyle style, float t) {
    float h = (style.level - t) / (max(e.scales.z, 1.0e-3f) * burin_map.depth);
    vec2 last = burin_profile_point(style, 0);
    for (int i = 1; i < BURIN_MAX_PROFILE_POINTS; ++i) {
        if (i >= style.count) break;
        vec2 point = burin_profile_point(style, i);
        bool upright = abs(point.x) < 1.0e-3f && abs(last.x) < 1.0e-3f;
        if (upright && h >= min(point.y, last.y) - 1.0e-3f && h <= max(point.y, last.y) + 1.0e-3f) return i - 1;
        last = point;
    }
    return BURIN_FACET_WALL;
}

// The highest facet over an offset.
int burin_top_facet(BurinStyle style, float b) {
    int facet = 0;
    float highest = -1.0e30f;
    vec2 last = burin_profile_point(style, 0);
    for (int i = 1; i < BURIN_MAX_PROFILE_POINTS; ++i) {
        if (i >= style.count) break;
        vec2 point = burin_profile_point(style, i);
        float width = point.x - last.x;
        float part = abs(width) > 0.0f ? (b - last.x) / width : -1.0f;
        float height = mix(last.y, point.y, part);
        if (part >= 0.0f && part <= 1.0f && height > highest) {
            highest = height;
            facet = i - 1;
        }
        last = point;
    }
    return facet;
}

vec3 burin_wall_normal(vec2 wall, vec2 slope) {
    vec2 n = length(wall) > 0.0f ? wall : -slope;
    if (dot(n, slope) > 0.0f) n = -n;
    n = burin_direction(n, vec2(1.0f, 0.0f));
    return vec3(n.x, n.y, 0.0f);
}

// Nothing is known of what stands around an upright wall.
BurinSurface burin_wall(BurinSurface s, BurinHit hit) {
    s.normal = burin_wall_normal(hit.mark.wall, hit.ray.slope);
    s.nook = burin_open_nook(vec2(s.normal.x, s.normal.y));
    return s;
}

BurinSurface burin_surface(BurinHit hit) {
    BurinSurface s;
    s.facet = hit.mark.facet;
    s.material = 0u;
    s.normal = vec3(0.0f, 0.0f, 1.0f);
    s.nook = burin_open_nook(vec2(1.0f, 0.0f));
    if (hit.mark.element == BURIN_NO_ELEMENT) {
        if (s.facet == BURIN_FACET_WALL) s = burin_wall(s, hit);
        return s;
    }
    BurinElement e = burin_element(hit.mark.element, hit.ray.origin, hit.centre);
    BurinStyle style = burin_style(e.style);
    s.material = style.material;
    if (s.facet == BURIN_FACET_STEP) s.facet = burin_step_facet(e, style, hit.t);
    if (hit.mark.facet < 0 && hit.mark.facet != BURIN_FACET_TOP) return burin_wall(s, hit);
    BurinPiece piece = burin_whole(e, hit.t, hit.t);
    if (hit.mark.part != BURIN_PART_MAIN)
        piece = burin_part(e, burin_end(e, true), burin_end(e, false), hit.ray, piece, hit.mark.part, hit.mark.side);
    piece = burin_formula(e, piece, hit.mark.part);
    BurinSection section = burin_section(e, style, piece, hit.ray, hit.t);
    if (s.facet == BURIN_FACET_TOP) s.facet = burin_top_facet(style, section.q.x);
    vec2 edge = burin_profile_point(style, s.facet + 1) - burin_profile_point(style, s.facet);
    vec2 rates = section.scale_rates / vec2(section.width, section.height);
    vec2 along_b = section.gradient * (1.0f / (section.width * style.reach)) - section.tangent * (section.q.x * rates.x);
    vec2 along_h = section.tangent * (section.q.y * rates.y);
    vec2 n = along_h * -edge.x - along_b * edge.y;
    vec3 normal = vec3(n.x, n.y, edge.x / (section.height * burin_map.depth));
    s.normal = length(normal) > 0.0f ? normalize(normal) : vec3(0.0f, 0.0f, 1.0f);
    vec2 across = burin_direction(section.gradient, vec2(1.0f, 0.0f));
    s.nook = burin_nook(style, vec2(section.width, section.height), across, section.q);
    return s;
}
