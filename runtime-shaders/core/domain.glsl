// Where an element acts along the ray: the table of end-kinds as stretches of the ray, each with one formula for b'.
//
// An element is cut into parts: the main part over its carrier, and up to two parts beyond each end (round, bevel and
// hip). Every border of a part is a line over the plane, so that a part is one interval of the ray.

#define BURIN_PART_MAIN 0
#define BURIN_PART_START 1   // beyond the start
#define BURIN_PART_START_FLANK 2  // beyond the start of a curve with a hip, where |b| > a
#define BURIN_PART_END 3
#define BURIN_PART_END_FLANK 4
#define BURIN_PARTS 5

// One end of an element, turned so that `inward` leads into it.
struct BurinEnd {
    vec2 vertex;
    vec2 inward;
    vec2 normal;  // of the path, which keeps its direction
    uint priority;
    uint shape;
    vec2 clip;  // direction of the clip line
};

// (cos, sin) of an angle in [0, pi] to some 1e-7, by their series around pi / 2. Every listed element asks twice, and drivers
// spend several times as much on angles of any size.
vec2 burin_unit(float angle) {
    float y = angle - 1.57079633f;
    float z = y * y;
    float sine = y * (1.0f - z * (1.0f / 6.0f - z * (1.0f / 120.0f - z * (1.0f / 5040.0f - z * (1.0f / 362880.0f - z * (1.0f / 39916800.0f))))));
    float cosine = 1.0f - z * (0.5f - z * (1.0f / 24.0f - z * (1.0f / 720.0f - z * (1.0f / 40320.0f - z * (1.0f / 3628800.0f -
                   z * (1.0f / 479001600.0f))))));
    return vec2(-sine, cosine);
}

BurinEnd burin_end(BurinElement e, bool at_start) {
    BurinEnd end;
    end.vertex = at_start ? e.p0 : e.p2;
    end.inward = at_start ? e.t0 : -e.t2;
    end.normal = burin_normal_of(at_start ? e.t0 : e.t2);
    uint kind = at_start ? e.kind0 : e.kind2;
    end.priority = kind & 3u;
    end.shape = kind >> 2;
    float angle = at_start ? e.clip0 : e.clip2;
    end.clip = vec2(1.0f, 0.0f);
    if (end.priority != BURIN_PRIORITY_NONE) end.clip = burin_unit(angle);
    return end;
}

// Whether both sides of the profile run to the clip line: a smooth joint, or an end on another path's line.
bool burin_clips_both(BurinEnd end) {
    return end.priority == BURIN_PRIORITY_BOTH && (end.shape == BURIN_END_CLIP || end.shape == BURIN_END_TEE);
}

// A stretch of the ray that no end cuts yet.
BurinPiece burin_whole(BurinElement e, float lo, float hi) {
    BurinPiece piece;
    piece.lo = lo;
    piece.hi = hi;
    piece.lo_wall = vec2(0.0f, 0.0f);
    piece.hi_wall = vec2(0.0f, 0.0f);
    piece.kind = BURIN_PIECE_LINEAR;
    piece.side = 0.0f;
    piece.anchor = e.p0;
    piece.gradient = vec2(0.0f, 0.0f);
    piece.width = 1.0f;
    piece.height = 1.0f;
    piece.fixed_scale = true;
    return piece;
}

// Keeps where (p - anchor) . gradient >= 0, with an overlap; the gradient has about length 1. Domains that adjoin share the
// anchor, so that only what is calculated from it and from the ray is rounded.
BurinPiece burin_clip(BurinPiece piece, BurinRay ray, vec2 anchor, vec2 gradient) {
    float rate = dot(gradient, ray.slope);
    float farthest = abs(anchor.x) + abs(anchor.y) + (abs(ray.slope.x) + abs(ray.slope.y)) * piece.hi;
    float value = BURIN_OVERLAP * farthest - dot(gradient, anchor);
    if (rate == 0.0f) {
        if (value < 0.0f) piece.hi = piece.lo - 1.0f;
        return piece;
    }
    float t = -value / rate;
    if (rate > 0.0f) {
        if (t > piece.lo) {
            piece.lo = t;
            piece.lo_wall = gradient;
        }
    } else if (t < piece.hi) {
        piece.hi = t;
        piece.hi_wall = gradient;
    }
    return piece;
}

// Normal of the clip line that leads to the element's side. A clip line along the tangent itself acts as a = 0.
vec2 burin_clip_normal(BurinEnd end) {
    vec2 across = burin_normal_of(end.clip);
    float lead = dot(across, end.inward);
    return abs(lead) < 1.0e-4f ? end.inward : (lead < 0.0f ? -across : across);
}

bool burin_own_sector(BurinEnd end, float side) {
    return end.priority == (side < 0.0f ? BURIN_PRIORITY_LEFT : BURIN_PRIORITY_RIGHT);
}

// What a smooth joint, or an end on another path's line, leaves of the stretch, on both sides of the element.
BurinPiece burin_clip_both(BurinPiece piece, BurinRay ray, BurinEnd end, float slack) {
    if (!burin_clips_both(end)) return piece;
    vec2 across = burin_clip_normal(end);
    return burin_clip(piece, ray, end.vertex - across * slack, across);
}

// Borders that an end sets to the main part, and to the parts beyond the other end.
BurinPiece burin_clip_main(BurinPiece piece, BurinRay ray, BurinEnd end, float side, bool curved,
                            float slack) {
    if (burin_clips_both(end)) return burin_clip_both(piece, ray, end, slack);
    bool both = end.priority == BURIN_PRIORITY_BOTH;
    bool own = burin_own_sector(end, side);
    if (own) piece = burin_clip(piece, ray, end.vertex, burin_clip_normal(end));
    if (own && end.shape == BURIN_CORNER_MITRE) return piece;
    // A hip beyond a line goes on as b' = b while |b| >= a.
    vec2 border = end.inward;
    if (both && end.shape == BURIN_END_HIP && !curved) border = end.inward + side * end.normal;
    return burin_clip(piece, ray, end.vertex, border);
}

// The part beyond an end that has one (burin_has_beyond).
BurinPiece burin_clip_beyond(BurinPiece piece, BurinRay ray, BurinEnd end, float side, bool flank) {
    bool both = end.priority == BURIN_PRIORITY_BOTH;
    bool own = burin_own_sector(end, side);
    bool hip = both && end.shape == BURIN_END_HIP;
    bool round_end = both && end.shape == BURIN_END_ROUND;
    bool joined = own && end.shape != BURIN_CORNER_MITRE;
    piece = burin_clip(piece, ray, end.vertex, -end.inward);
    piece = burin_clip(piece, ray, end.vertex, side * end.normal);
    piece.kind = BURIN_PIECE_LINEAR;
    piece.anchor = end.vertex;
    piece.gradient = end.normal;
    if (joined) piece = burin_clip(piece, ray, end.vertex, burin_clip_normal(end));
    if (hip) {
        vec2 border = end.inward + side * end.normal;
        piece = burin_clip(piece, ray, end.vertex, flank ? border : -border);
        if (!flank) piece.gradient = -side * end.inward;
    } else if (round_end || end.shape == BURIN_CORNER_ROUND) {
        piece.kind = BURIN_PIECE_RADIAL;
    } else {
        vec2 middle = dot(end.clip, end.normal) < 0.0f ? -end.clip : end.clip;
        piece.gradient = middle * (1.0f / max(dot(middle, end.normal), 1.0e-3f));
    }
    return piece;
}

// Whether an end does the same to both sides of the element along the whole stretch: it clips both, or leaves them alone.
bool burin_ends_alike(BurinPiece piece, BurinRay ray, BurinEnd end) {
    if (burin_clips_both(end)) return true;
    vec2 a = ray.slope * piece.lo - end.vertex;
    vec2 b = ray.slope * piece.hi - end.vertex;
    if (min(dot(a, end.inward), dot(b, end.inward)) < 0.0f) return false;
    bool clipped = end.priority == BURIN_PRIORITY_LEFT || end.priority == BURIN_PRIORITY_RIGHT;
    vec2 across = burin_clip_normal(end);
    return !clipped || min(dot(a, across), dot(b, across)) >= 0.0f;
}

// Whether an end has a part beyond it on `side`; asked before the part is worked out.
bool burin_has_beyond(BurinEnd end, float side, bool curved, bool flank) {
    bool both = end.priority == BURIN_PRIORITY_BOTH;
    if (flank) return both && end.shape == BURIN_END_HIP && curved;
    if (both) return !burin_clips_both(end);
    return burin_own_sector(end, side) && end.shape != BURIN_CORNER_MITRE;
}

// Bit 2 * part + (0: left, 1: right) of every part that the element has on the sides asked for.
uint burin_parts_of(BurinEnd start, BurinEnd end, bool left, bool right, bool curved) {
    uint parts = 0u;
    for (int k = 0; k < 2; ++k) {
        if (!(k == 0 ? left : right)) continue;
        float side = k == 0 ? -1.0f : 1.0f;
        uint found = 1u << uint(2 * BURIN_PART_MAIN);
        if (burin_has_beyond(start, side, curved, false)) found = found | (1u << uint(2 * BURIN_PART_START));
        if (burin_has_beyond(start, side, curved, true)) found = found | (1u << uint(2 * BURIN_PART_START_FLANK));
        if (burin_has_beyond(end, side, curved, false)) found = found | (1u << uint(2 * BURIN_PART_END));
        if (burin_has_beyond(end, side, curved, true)) found = found | (1u << uint(2 * BURIN_PART_END_FLANK));
        parts = parts | (found << uint(k));
    }
    return parts;
}

// Requires: some bit is set.
int burin_lowest_bit(uint bits) {
    // A power of two is exact in float, and its exponent says which.
    return int(floatBitsToUint(float(bits & (~bits + 1u))) >> 23) - 127;
}

// The stretch of `whole` where part `part` acts on `side` (-1 or +1).
BurinPiece burin_part(BurinElement e, BurinEnd start, BurinEnd end, BurinRay ray, BurinPiece whole, int part,
                      float side) {
    BurinPiece piece = whole;
    piece.side = side;
    piece.width = 1.0f;
    piece.height = 1.0f;
    if (part == BURIN_PART_MAIN) {
        piece = burin_clip_main(piece, ray, start, side, e.curved, e.slack);
        piece = burin_clip_main(piece, ray, end, side, e.curved, e.slack);
        if (!e.curved) piece = burin_clip(piece, ray, e.p0, side * start.normal);
    } else if (part == BURIN_PART_START || part == BURIN_PART_START_FLANK) {
        piece = burin_clip_beyond(piece, ray, start, side, part == BURIN_PART_START_FLANK);
        piece = burin_clip_main(piece, ray, end, side, e.curved, e.slack);
    } else {
        piece = burin_clip_beyond(piece, ray, end, side, part == BURIN_PART_END_FLANK);
        piece = burin_clip_main(piece, ray, start, side, e.curved, e.slack);
    }
    return piece;
}

// The formula of a part, whatever stretch of the ray it is asked on.
BurinPiece burin_formula(BurinElement e, BurinPiece piece, int part) {
    piece.fixed_scale = part != BURIN_PART_MAIN || !e.scaled;
    bool at_end = part == BURIN_PART_END || part == BURIN_PART_END_FLANK;
    piece.width = max(at_end ? e.scales.y : e.scales.x, 1.0e-3f);
    piece.height = max(at_end ? e.scales.w : e.scales.z, 1.0e-3f);
    if (e.waved) {
        vec2 scale = burin_scales(e, at_end ? 1.0f : 0.0f).scale;
        piece.width = max(scale.x, 1.0e-3f);
        piece.height = max(scale.y, 1.0e-3f);
    }
    if (part == BURIN_PART_MAIN) {
        piece.kind = e.curved ? BURIN_PIECE_CURVE : BURIN_PIECE_LINEAR;
        piece.anchor = e.p0;
        piece.gradient = burin_normal_of(e.t0);
    }
    return piece;
}

// Section point of the ray at drop t, and the gradients that its normal needs.
struct BurinSection {
    vec2 q;
    vec2 gradient;  // of b' over the plane
    float width;
    float height;
    vec2 tangent;      // along the path
    vec2 scale_rates;  // of width and height per metre along the path
};

// Whether the ray's section of a piece is straight.
bool burin_is_straight(BurinPiece piece) {
    return BURIN_BENDS == 0 || (piece.kind == BURIN_PIECE_LINEAR && piece.fixed_scale);
}

BurinSection burin_section(BurinElement e, BurinStyle style, BurinPiece piece, BurinRay ray, float t) {
    vec2 p = ray.slope * t;
    BurinSection s;
    s.width = piece.width;
    s.height = piece.height;
    s.tangent = e.t0;
    s.scale_rates = vec2(0.0f, 0.0f);
    s.gradient = piece.gradient;
    float b = dot(piece.gradient, p - piece.anchor);
    float along = 0.0f;
    float speed = e.extent;  // metres of the plane along the path per parameter
#if BURIN_BENDS != 0
    if (piece.kind == BURIN_PIECE_RADIAL) {
        b = piece.side * length(p - piece.anchor);
        s.gradient = burin_direction(p - piece.anchor, e.t0) * piece.side;
#if BURIN_CURVES != 0
    } else if (piece.kind == BURIN_PIECE_CURVE) {
        BurinFoot foot = burin_curve_foot(e, p);
        b = foot.offset;
        s.gradient = foot.normal;
        s.tangent = vec2(foot.normal.y, -foot.normal.x);
        along = foot.parameter;
        vec2 edge = mix(e.p1 - e.p0, e.p2 - e.p1, along) * 2.0f;
        vec2 bend = (e.p0 - 2.0f * e.p1 + e.p2) * 2.0f;
        // Beside the path the parameter runs slower or faster, as on arcs around its centre of curvature.
        speed = length(edge) - foot.offset * dot(bend, foot.normal) / max(length(edge), 1.0e-12f);
#endif
    } else if (!piece.fixed_scale) {
        along = dot(p - e.p0, e.t0) / max(e.extent, 1.0e-9f);
    }
    if (!piece.fixed_scale) {
        float clamped = clamp(along, 0.0f, 1.0f);
        BurinScales scales = burin_scales(e, clamped);
        s.width = max(scales.scale.x, 1.0e-3f);
        s.height = max(scales.scale.y, 1.0e-3f);
        if (along == clamped) s.scale_rates = scales.rate * (1.0f / max(speed, 1.0e-9f));
    }
#endif
    s.q = vec2(b / (s.width * style.reach), (style.level - t) / (s.height * burin_map.depth));
    return s;
}
