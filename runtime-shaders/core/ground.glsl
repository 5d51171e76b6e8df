// The ground: piecewise constant, it changes where a way over the plane crosses the path line of a step.

struct BurinStepLine {
    float at;  // where the way crosses it: 0 at its start, 1 at its end; 2 when none is crossed
    float level;  // drop of the ground beyond it
    BurinMark mark;
};

float burin_cross(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Parameters where a quadratic meets the line through `a` along `d`; 2 where there is none. Ends on different sides
// give exactly one, so that chains of elements are crossed without gap.
vec2 burin_curve_line(BurinElement e, vec2 a, vec2 d) {
    vec3 g = vec3(burin_cross(d, e.p0 - a), burin_cross(d, e.p1 - a), burin_cross(d, e.p2 - a));
    bool odd = (g.x > 0.0f) != (g.z > 0.0f);
    float qa = g.x - 2.0f * g.y + g.z;
    float qb = 2.0f * (g.y - g.x);
    float disc = qb * qb - 4.0f * qa * g.x;
    if (disc < 0.0f && !odd) return vec2(2.0f, 2.0f);
    float q = -0.5f * (qb + (qb < 0.0f ? -1.0f : 1.0f) * sqrt(max(disc, 0.0f)));
    vec2 roots = vec2(qa != 0.0f ? q / qa : 2.0f, q != 0.0f ? g.x / q : 2.0f);
    vec2 off = abs(roots - vec2(0.5f, 0.5f));
    if (odd) return vec2(clamp(off.x < off.y ? roots.x : roots.y, 0.0f, 1.0f), 2.0f);
    return vec2(off.x <= 0.5f ? roots.x : 2.0f, off.y <= 0.5f ? roots.y : 2.0f);
}

BurinStepLine burin_no_step_line(BurinCell cell, bool want_last) {
    BurinStepLine found;
    found.at = want_last ? -1.0f : 2.0f;
    found.level = cell.level;
    found.mark.element = BURIN_NO_ELEMENT;
    found.mark.part = BURIN_PART_MAIN;
    found.mark.facet = BURIN_FACET_STEP;
    found.mark.side = 0.0f;
    found.mark.wall = vec2(0.0f, 0.0f);
    return found;
}

// Notes where the way a-b crosses one step, where that is farther than what was found (want_last), or nearer and beyond `after`.
void burin_note_step(BurinElement e, BurinStyle style, uint reference, vec2 a, vec2 b, float after, bool want_last,
                     BURIN_INOUT(BurinStepLine) found) {
    vec2 d = b - a;
    vec2 roots = vec2(2.0f, 2.0f);
    vec2 chord_normal = burin_normal_of(e.t0);
    float fa = dot(a - e.p0, chord_normal);
    float fb = dot(b - e.p0, chord_normal);
    bool odd = (burin_cross(d, e.p0 - a) > 0.0f) != (burin_cross(d, e.p2 - a) > 0.0f);
    if (e.curved) roots = burin_curve_line(e, a, d);
    else if (odd && (fa > 0.0f) != (fb > 0.0f)) roots.x = 0.0f;
    for (int k = 0; k < 2; ++k) {
        float s = k == 0 ? roots.x : roots.y;
        vec2 normal = chord_normal;
        float at = fa / (fa - fb);
        bool meets = s <= 1.0f;
        if (e.curved) {
            vec2 p = (1.0f - s) * (1.0f - s) * e.p0 + 2.0f * s * (1.0f - s) * e.p1 + s * s * e.p2;
            at = dot(p - a, d) / dot(d, d);
            normal = burin_normal_of((1.0f - s) * (e.p1 - e.p0) + s * (e.p2 - e.p1));
            meets = meets && at >= 0.0f && at <= 1.0f;
        }
        if (meets && (want_last ? at > found.at : (at > after && at < found.at))) {
            bool to_right = dot(d, normal) > 0.0f;
            found.at = at;
            found.level = to_right ? style.right_level : style.level;
            found.mark.element = reference;
            found.mark.side = to_right ? 1.0f : -1.0f;
            found.mark.wall = burin_direction(normal, vec2(1.0f, 0.0f));
        }
        if (!e.curved) break;
    }
}

// Of the step lines that the way a-b crosses: the first beyond `after`, or, with want_last, the last of all.
BurinStepLine burin_step_line(BurinCell cell, BurinRay ray, vec2 centre, vec2 a, vec2 b, float after, bool want_last) {
    BurinStepLine found = burin_no_step_line(cell, want_last);
    uvec4 texel = uvec4(0u, 0u, 0u, 0u);
    for (int i = 0; i < BURIN_MAX_REFS_PER_CELL; ++i) {
        if (i < cell.count) {
            uint reference = burin_listed(cell, i, texel);
            BurinElement e = burin_element(reference, ray.origin, centre);
            BurinStyle style = burin_style(e.style);
            if (style.stepped) burin_note_step(e, style, reference, a, b, after, want_last, found);
        }
        if (i + 1 >= cell.count) break;
    }
    return found;
}
