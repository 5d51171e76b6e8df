// Scales along an element: linear between its ends, times the factors of a function of the path's arc length.

struct BurinFactors {
    vec2 factor;  // of width and of height
    vec2 rate;    // of both, per argument
};

// Both values of a lattice point of octave `octave`, in [-1, 1].
vec2 burin_lattice(uvec4 head, uint octave, int point) {
    uint i = uint(point);
    if (head.w != 0u) i = i % (head.w << octave);
    uint bits = i + head.z * BURIN_NOISE_MIX_SEED + octave * BURIN_NOISE_MIX_OCTAVE;
    bits = (bits ^ (bits >> 16)) * BURIN_NOISE_MIX_A;
    bits = (bits ^ (bits >> 15)) * BURIN_NOISE_MIX_B;
    bits = bits ^ (bits >> 16);
    return vec2(float(bits & 0xffffu), float(bits >> 16)) * (1.0f / 32767.5f) - vec2(1.0f, 1.0f);
}

// Noise and its rate at turns + a, for width and height. What counts whole lattice points stays in integers.
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
        int point = int(cell) + (turns << k);
        vec2 from = burin_lattice(head, k, point);
        vec2 rise = burin_lattice(head, k, point + 1) - from;
        sum.factor += (from + rise * (t * t * (3.0f - 2.0f * t))) * (1.0f / frequency);
        sum.rate += rise * (6.0f * t * (1.0f - t));
        whole += 1.0f / frequency;
        frequency *= 2.0f;
    }
    sum.factor = sum.factor * (1.0f / max(whole, 1.0f));
    sum.rate = sum.rate * (1.0f / max(whole, 1.0f));
    return sum;
}

// Factors of the function at texel `function`, at the argument turns + a.
BurinFactors burin_factors(int function, int turns, float a) {
    uvec4 head = fetch_data(function);
    uint kind = head.x & 3u;
    BurinFactors found;
    if (kind == BURIN_FUNCTION_POLYNOMIAL) {
        uvec4 w = fetch_data(function + 1);
        uvec4 h = fetch_data(function + 2);
        vec2 c0 = vec2(uintBitsToFloat(w.x), uintBitsToFloat(h.x));
        vec2 c1 = vec2(uintBitsToFloat(w.y), uintBitsToFloat(h.y));
        vec2 c2 = vec2(uintBitsToFloat(w.z), uintBitsToFloat(h.z));
        vec2 c3 = vec2(uintBitsToFloat(w.w), uintBitsToFloat(h.w));
        float u = float(turns) + a;
        found.factor = c0 + u * (c1 + u * (c2 + u * c3));
        found.rate = c1 + u * (2.0f * c2 + u * 3.0f * c3);
        return found;
    }
    vec2 amplitude = vec2(burin_snorm16(head.y & 0xffffu), burin_snorm16(head.y >> 16));
    if (kind == BURIN_FUNCTION_NOISE) {
        found = burin_noise(head, turns, a);
    } else {
        float angle = 6.28318531f * (a - floor(a));
        found.factor = vec2(sin(angle), sin(angle));
        found.rate = vec2(cos(angle), cos(angle)) * 6.28318531f;
    }
    found.factor = vec2(1.0f, 1.0f) + amplitude * found.factor;
    found.rate = amplitude * found.rate;
    return found;
}

// How strongly the factors of a function bend: bounds their second derivative by the argument.
float burin_waviness(int function) {
    uvec4 head = fetch_data(function);
    uint kind = head.x & 3u;
    if (kind == BURIN_FUNCTION_POLYNOMIAL) {
        uvec4 w = fetch_data(function + 1);
        uvec4 h = fetch_data(function + 2);
        return max(2.0f * abs(uintBitsToFloat(w.z)) + 6.0f * abs(uintBitsToFloat(w.w)),
                   2.0f * abs(uintBitsToFloat(h.z)) + 6.0f * abs(uintBitsToFloat(h.w)));
    }
    float amplitude = max(abs(burin_snorm16(head.y & 0xffffu)), abs(burin_snorm16(head.y >> 16)));
    if (kind == BURIN_FUNCTION_SINE) return 39.5f * amplitude;
    // Each octave bends twice as much as the one before.
    float finest = float(1u << ((head.x >> 2) & 15u));
    return 12.0f * amplitude * (finest - 1.0f) / (2.0f - 2.0f / finest);
}

// Share of the argument that is behind the parameter s, and its rate: the integral of the parabola through the speeds
// at 0, 1/2 and 1.
vec2 burin_arc_share(BurinElement e, float s) {
    if (!e.curved) return vec2(s, 1.0f);
    float v0 = length(e.p1 - e.p0);
    float v1 = length(e.p2 - e.p0) * 0.5f;
    float v2 = length(e.p2 - e.p1);
    float whole = max((v0 + 4.0f * v1 + v2) * (1.0f / 6.0f), 1.0e-20f);
    float slope = 4.0f * v1 - 3.0f * v0 - v2;
    float bend = 2.0f * (v0 - 2.0f * v1 + v2);
    return vec2(s * (v0 + s * (0.5f * slope + s * bend * (1.0f / 3.0f))), v0 + s * (slope + s * bend)) * (1.0f / whole);
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
    if (e.function >= 0) {
        vec2 share = burin_arc_share(e, s);
        BurinFactors f = burin_factors(e.function, e.turns, e.argument.x + e.argument.y * share.x);
        found.rate = found.rate * f.factor + found.scale * f.rate * (e.argument.y * share.y);
        found.scale = found.scale * f.factor;
    }
    return found;
}

// A clip line that ends a feature on the path line of another one is turned by the rounding of its angle. The feature
// runs on by what that can amount to at the rim, or a sheet of solid would stand between the two.
float burin_clip_slack(BurinElement e, BurinStyle style) {
    float width = max(e.scales.x, e.scales.y);
    if (e.function >= 0) width = max(burin_scales(e, 0.0f).scale.x, burin_scales(e, 1.0f).scale.x);
    return BURIN_CLIP_ROUNDING * style.reach * width;
}

