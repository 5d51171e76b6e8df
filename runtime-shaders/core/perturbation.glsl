// Scales along an element: linear between its ends, times the factors of a function of the path's arc length.

struct BurinFactors {
    vec2 factor;  // of width and of height
    vec2 rate;    // of both, per argument
};

// Values of a lattice point of octave `octave` for width and for height, in [-1, 1]. Arguments of noise that repeats lie
// within one period.
vec2 burin_lattice(uvec4 head, uint octave, uint point) {
    uint period = head.w << octave;
    uint bits = period != 0u && point >= period ? point - period : point;
    bits = bits + head.z * BURIN_NOISE_MIX_SEED + octave * BURIN_NOISE_MIX_OCTAVE;
    bits = (bits ^ (bits >> 16)) * BURIN_NOISE_MIX_A;
    bits = (bits ^ (bits >> 15)) * BURIN_NOISE_MIX_B;
    bits = bits ^ (bits >> 16);
    return vec2(float(bits & 0xffffu), float(bits >> 16)) * (1.0f / 32767.5f) - vec2(1.0f, 1.0f);
}

// Noise and its rate at turns + a. What counts whole lattice points stays in integers.
BurinFactors burin_noise(uvec4 head, int turns, float a) {
    BurinFactors sum;
    sum.factor = vec2(0.0f, 0.0f);
    sum.rate = vec2(0.0f, 0.0f);
    uint octaves = (head.x >> 2) & 15u;
    float frequency = 1.0f;
    float whole = 0.0f;
    for (uint k = 0u; k < uint(BURIN_MAX_OCTAVES); ++k) {
        if (k >= octaves) break;
        float y = a * frequency + float(BURIN_NOISE_SHIFT) * float(k);
        float cell = floor(y);
        float t = y - cell;
        uint point = uint(int(cell) + (turns << k));
        vec2 from = burin_lattice(head, k, point);
        vec2 rise = burin_lattice(head, k, point + 1u) - from;
        sum.factor += (from + rise * (t * t * (3.0f - 2.0f * t))) * (1.0f / frequency);
        sum.rate += rise * (6.0f * t * (1.0f - t));
        whole += 1.0f / frequency;
        frequency *= 2.0f;
    }
    sum.factor = sum.factor * (1.0f / max(whole, 1.0f));
    sum.rate = sum.rate * (1.0f / max(whole, 1.0f));
    return sum;
}

vec2 burin_amplitudes(uvec4 head) {
    return vec2(burin_snorm16(head.y & 0xffffu), burin_snorm16(head.y >> 16));
}

// Factors of the element's function at the argument turns + a.
BurinFactors burin_factors(BurinElement e, float a) {
    uint kind = e.function.x & 3u;
    BurinFactors found;
    found.factor = vec2(0.0f, 0.0f);
    found.rate = vec2(0.0f, 0.0f);
#if (BURIN_FUNCTION_KINDS & 1) != 0
    if (kind == BURIN_FUNCTION_SINE) {
        float angle = 6.28318531f * (a - floor(a));
        found.factor = vec2(1.0f, 1.0f) * sin(angle);
        found.rate = vec2(6.28318531f, 6.28318531f) * cos(angle);
    }
#endif
#if (BURIN_FUNCTION_KINDS & 4) != 0
    if (kind == BURIN_FUNCTION_NOISE) found = burin_noise(e.function, e.turns, a);
#endif
    vec2 amplitude = burin_amplitudes(e.function);
    found.factor = vec2(1.0f, 1.0f) + amplitude * found.factor;
    found.rate = amplitude * found.rate;
#if (BURIN_FUNCTION_KINDS & 2) != 0
    if (kind == BURIN_FUNCTION_POLYNOMIAL) {
        vec4 w = e.width_terms;
        vec4 h = e.height_terms;
        float u = float(e.turns) + a;
        found.factor = vec2(w.x + u * (w.y + u * (w.z + u * w.w)), h.x + u * (h.y + u * (h.z + u * h.w)));
        found.rate = vec2(w.y + u * (2.0f * w.z + u * 3.0f * w.w), h.y + u * (2.0f * h.z + u * 3.0f * h.w));
    }
#endif
    return found;
}

// How strongly the factors of the element's function bend: bounds their second derivative by the argument.
float burin_waviness(BurinElement e) {
    uint kind = e.function.x & 3u;
    if (kind == BURIN_FUNCTION_POLYNOMIAL) {
        vec4 w = abs(e.width_terms);
        vec4 h = abs(e.height_terms);
        return max(2.0f * w.z + 6.0f * w.w, 2.0f * h.z + 6.0f * h.w);
    }
    vec2 amplitudes = abs(burin_amplitudes(e.function));
    float amplitude = max(amplitudes.x, amplitudes.y);
    if (kind == BURIN_FUNCTION_SINE) return 39.5f * amplitude;
    // Each octave bends twice as much as the one before.
    float finest = float(1u << ((e.function.x >> 2) & 15u));
    return 12.0f * amplitude * (finest - 1.0f) / (2.0f - 2.0f / finest);
}

// Integral of half the speed of a quadratic from 0 to s: Gauss's rule of three points.
float burin_run(vec2 edge, vec2 bend, float s) {
    return s * (5.0f * length(edge + bend * (s * 0.112701665f)) + 8.0f * length(edge + bend * (s * 0.5f)) +
                5.0f * length(edge + bend * (s * 0.887298335f)));
}

// Share of the argument that is behind the parameter s, and its rate.
vec2 burin_arc_share(BurinElement e, float s) {
    if (!e.curved) return vec2(s, 1.0f);
    vec2 edge = e.p1 - e.p0;
    vec2 bend = e.p0 - 2.0f * e.p1 + e.p2;
    return vec2(burin_run(edge, bend, s), 18.0f * length(edge + bend * s)) * (1.0f / max(burin_run(edge, bend, 1.0f), 1.0e-20f));
}

// Width and height scale at the parameter s of the element, and their rates per s.
struct BurinScales {
    vec2 scale;
    vec2 rate;
};

BurinScales burin_scales(BurinElement e, float s) {
    BurinScales found;
    found.scale = mix(vec2(e.scales.x, e.scales.z), vec2(e.scales.y, e.scales.w), s);
    found.rate = vec2(e.scales.y - e.scales.x, e.scales.w - e.scales.z);
#if BURIN_FUNCTION_KINDS != 0
    if (e.waved) {
        vec2 share = burin_arc_share(e, s);
        BurinFactors f = burin_factors(e, e.argument.x + e.argument.y * share.x);
        found.rate = found.rate * f.factor + found.scale * f.rate * (e.argument.y * share.y);
        found.scale = found.scale * f.factor;
    }
#endif
    return found;
}

// No width scale of the element is greater.
float burin_widest(BurinElement e) {
    float width = max(e.scales.x, e.scales.y);
    if (!e.waved) return width;
    if ((e.function.x & 3u) != BURIN_FUNCTION_POLYNOMIAL) return width * (1.0f + abs(burin_amplitudes(e.function).x));
    vec4 w = abs(e.width_terms);
    return width * min(w.x + w.y + w.z + w.w, 4.0f);
}

// A clip line that ends a feature on the path line of a step is turned by the rounding of its angle. The feature runs on by
// what that can amount to at the rim, or a sheet of solid would stand between the two; the ground's level ends it there.
float burin_clip_slack(BurinElement e, BurinStyle style) {
    float width = max(e.scales.x, e.scales.y);
    if (e.waved) width = max(burin_scales(e, 0.0f).scale.x, burin_scales(e, 1.0f).scale.x);
    return BURIN_CLIP_ROUNDING * style.reach * width;
}

