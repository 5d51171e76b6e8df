// Straight pieces of rays.

// Fall per metre over the plane of a chord that rises or runs level.
#define BURIN_LEAST_FALL 0.02f
// The same beyond a crease.
#define BURIN_LEAST_CREASED_FALL 1.0e-3f
// Part of a chord by which the next one overlaps it, so that nothing is missed between them.
#define BURIN_CHORD_OVERLAP 1.0e-3f

// A straight piece of a sight, falling from t0 to t1.
struct BurinChord {
    BurinRay ray;
    float t0;
    float t1;
};

// Between two places of pattern space; the one that rises, or runs level, falls by `least` per metre over the plane.
BurinChord burin_chord(vec3 upper, vec3 lower, bool outward, float least) {
    vec2 way = vec2(lower) - vec2(upper);
    float fall = max(max(lower.z - upper.z, length(way) * least), 1.0e-6f * burin_map.depth);
    BurinChord chord;
    chord.t0 = outward ? lower.z - fall : upper.z;
    chord.t1 = chord.t0 + fall;
    chord.ray.slope = way * (1.0f / fall);
    chord.ray.origin = vec2(upper) - chord.ray.slope * chord.t0;
    chord.t0 = max(chord.t0 - fall * BURIN_CHORD_OVERLAP, 0.0f);
    return chord;
}
