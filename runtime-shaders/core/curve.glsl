// Nearest point of a quadratic's carrier: the arc, continued by the tangent lines at its ends.

struct BurinFoot {
    float offset;     // signed distance b along the normal
    float parameter;  // of the curve, [0, 1]
    vec2 normal;
};

vec2 burin_normal_of(vec2 tangent) {
    return vec2(-tangent.y, tangent.x);
}

// One root of c.x + c.y s + c.z s^2 + c.w s^3, from a start that is already near: float cancels in the closed form
// when the arc is nearly straight, three steps of Newton bring the digits back.
float burin_polish_root(vec4 c, float s) {
    for (int i = 0; i < 3; ++i) {
        float value = c.x + s * (c.y + s * (c.z + s * c.w));
        float slope = c.y + s * (2.0f * c.z + s * 3.0f * c.w);
        s = abs(slope) > 1.0e-20f ? s - clamp(value / slope, -0.5f, 0.5f) : s;
    }
    return clamp(s, 0.0f, 1.0f);
}

float burin_cube_root(float x) {
    return x == 0.0f ? 0.0f : sign(x) * pow(abs(x), 1.0f / 3.0f);
}

// The two stationary parameters that can be nearest. The third, between them, is a maximum of the distance.
vec2 burin_stationary(vec4 c) {
    float third = 1.0f / 3.0f;
    float k = c.z / c.w * third;
    float m = c.y / c.w * third - k * k;
    float n = k * (2.0f * k * k - c.y / c.w) + c.x / c.w;
    float d = n * n + 4.0f * m * m * m;
    if (d >= 0.0f) {
        float root = sqrt(d);
        float s = burin_cube_root((root - n) * 0.5f) + burin_cube_root((-root - n) * 0.5f) - k;
        return vec2(s, s);
    }
    float z = sqrt(-m);
    float angle = acos(clamp(n / (m * z * 2.0f), -1.0f, 1.0f)) * third;
    float u = cos(angle);
    float v = sin(angle) * 1.7320508f;
    return vec2((u + u) * z - k, (-v - u) * z - k);
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
    float aa = dot(a, a);
    float bb = dot(b, b);
    vec4 c = vec4(dot(d, a), 2.0f * aa + dot(d, b), 3.0f * dot(a, b), bb);
    vec2 start = vec2(0.0f, 0.0f);
    if (bb < 0.02f * aa) {
        // Nearly straight: the projection to the chord is a good start and the only root near the arc.
        start.x = clamp(dot(-d, e.p2 - e.p0) / max(e.extent * e.extent, 1.0e-20f), 0.0f, 1.0f);
        start.y = start.x;
    } else {
        start = clamp(burin_stationary(c), vec2(0.0f, 0.0f), vec2(1.0f, 1.0f));
    }
    float s = burin_polish_root(c, start.x);
    vec2 away = p - (e.p0 + s * (2.0f * a + s * b));
    if (start.y != start.x) {
        float other = burin_polish_root(c, start.y);
        vec2 other_away = p - (e.p0 + other * (2.0f * a + other * b));
        if (dot(other_away, other_away) < dot(away, away)) {
            s = other;
            away = other_away;
        }
    }
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
