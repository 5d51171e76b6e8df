// Nearest point of a quadratic's carrier: the arc, continued by the tangent lines at its ends.

struct BurinFoot {
    float offset;     // signed distance b along the normal
    float parameter;  // of the curve, [0, 1]
    vec2 normal;
};

vec2 burin_normal_of(vec2 tangent) {
    return vec2(-tangent.y, tangent.x);
}

float burin_cube_root(float x) {
    return x == 0.0f ? 0.0f : sign(x) * pow(abs(x), 1.0f / 3.0f);
}

// Of some places along the arc p0 + s (2 a + s b) the nearest to p0 - d: at most an eighth before or behind the foot, since the
// parameter runs slowest where the arc bends most.
float burin_near_foot(vec2 a, vec2 b, vec2 d) {
    float found = 0.5f;
    float least = 1.0e30f;
    for (int i = 0; i < 4; ++i) {
        float s = 0.25f * float(i) + 0.125f;
        vec2 away = d + s * (2.0f * a + s * b);
        float distance = dot(away, away);
        found = distance < least ? s : found;
        least = min(least, distance);
    }
    return found;
}

// The minimum of the distance near `s`, whose derivative is c.x + c.y s + c.z s^2 + c.w s^3.
float burin_polish_foot(vec4 c, float s) {
    for (int i = 0; i < 4; ++i) {
        float value = c.x + s * (c.y + s * (c.z + s * c.w));
        float slope = c.y + s * (2.0f * c.z + s * 3.0f * c.w);
        // Downhill even where the distance bends the other way.
        s = clamp(s - clamp(value / max(abs(slope), 1.0e-20f), -0.25f, 0.25f), 0.0f, 1.0f);
    }
    return s;
}

// Of the arc, 1 / metres: where its speed is least.
float burin_greatest_curvature(BurinElement e) {
    vec2 a = e.p1 - e.p0;
    vec2 b = e.p0 - 2.0f * e.p1 + e.p2;
    float s = clamp(-dot(a, b) / max(dot(b, b), 1.0e-24f), 0.0f, 1.0f);
    float speed = max(length(a + s * b), 1.0e-3f * e.extent);
    return 0.5f * abs(a.x * b.y - a.y * b.x) / max(speed * speed * speed, 1.0e-30f);
}

BurinFoot burin_curve_foot(BurinElement e, vec2 p) {
    vec2 a = e.p1 - e.p0;
    vec2 b = e.p0 - 2.0f * e.p1 + e.p2;
    vec2 d = e.p0 - p;
    vec4 c = vec4(dot(d, a), 2.0f * dot(a, a) + dot(d, b), 3.0f * dot(a, b), dot(b, b));
    float s = burin_polish_foot(c, burin_near_foot(a, b, d));
    vec2 away = p - (e.p0 + s * (2.0f * a + s * b));
    BurinFoot foot;
    foot.parameter = s;
    vec2 tangent = burin_direction(a + s * b, e.t0);
    foot.normal = burin_normal_of(tangent);
    foot.offset = dot(away, foot.normal);
    float nearest = dot(away, away) * 1.000001f;
    // Beyond an end the tangent line takes over where it is nearer than the arc.
    vec2 n0 = burin_normal_of(e.t0);
    float b0 = dot(p - e.p0, n0);
    if (dot(p - e.p0, e.t0) < 0.0f && b0 * b0 <= nearest) {
        nearest = b0 * b0;
        foot.offset = b0;
        foot.parameter = 0.0f;
        foot.normal = n0;
    }
    vec2 n2 = burin_normal_of(e.t2);
    float b2 = dot(p - e.p2, n2);
    if (dot(p - e.p2, e.t2) > 0.0f && b2 * b2 <= nearest) {
        foot.offset = b2;
        foot.parameter = 1.0f;
        foot.normal = n2;
    }
    return foot;
}
