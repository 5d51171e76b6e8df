// The ray against one profile: [2010] 5.3. In the plane of the section the ray's stretch is a segment qa-qb; crossing
// tests take the signs of the profile's points against the segment and of the segment's ends against the facet, so
// that neighbours agree on every shared point and nothing falls between. Curved stretches polish each crossing.
//
// A facet's outer side lies to the left of its direction (profiles run left to right). To cross it inwards enters what
// the element adds and leaves what it cuts. A cut is closed by a vertical ray upwards from each end of its run of facets.

// Height above every point of a profile.
#define BURIN_FAR_UP 1.0e4f

// What the passes over a cell's elements have found so far.
struct BurinPass {
    float from;      // drop at which the ray is known to be in air
    float add;       // first drop at or after `from` inside an addition, where smaller than `ground`
    float ground;    // first drop at or after `from` below the ground
    float level;     // drop of the ground
    float air;       // grows: everything between the probe and it is cut away
    bool want_adds;
    float reopen;    // no cut that was judged before `air` last grew contains a drop beyond `air` and before this one
    BurinMark add_mark;
    BurinMark air_mark;
};

struct BurinEvents {
    float add;  // next crossing of the add's border after `add_from`
    int add_facet;
    bool add_enters;
    bool add_tied;    // another crossing lies at the same place, so that their order says nothing
    bool add_odd;     // number of crossings after `add_from`
    bool add_at_end;  // whether the ray lies in the add where it reaches the ground or the stretch ends
    float cut;        // the same for the cut after `cut_from`
    int cut_facet;
    bool cut_leaves;
    bool cut_tied;
    bool cut_odd;
    bool cut_once;    // the stretch crosses the cut's border at most once after `cut_from`
    bool cut_at_end;  // whether the end of the stretch lies in the cut
};

// A stretch of the ray as the profile sees it: straight, round the vertex of an end, or else a parabola through three of its places,
// over scales that are one too, since a point that tapers to nothing is any number of widths away; it decides what is crossed.
// Where a crossing lies is then asked of the section itself.
struct BurinTrack {
    vec2 range;  // drops at its ends
    vec2 a;      // section points there
    vec2 b;
    vec2 from;   // scales of width and height at its ends
    vec2 to;
    vec2 bow;    // from the middle of the chord to the middle of the stretch, times the scales; and of these
    vec2 scale_bow;
    bool straight;
    float side;  // of a round one; 0 for others
    vec2 start;  // of a round one: from the vertex to its ends over the plane, in widths
    vec2 end;
};

BurinTrack burin_track(BurinStyle style, BurinPiece piece, BurinRay ray, vec2 range, BurinSection a, BurinSection middle, BurinSection b) {
    BurinTrack on;
    on.range = range;
    on.a = a.q;
    on.b = b.q;
    on.straight = burin_is_straight(piece);
    on.from = vec2(a.width, a.height);
    on.to = vec2(b.width, b.height);
    vec2 scales = vec2(middle.width, middle.height);
    on.bow = middle.q * scales - (a.q * on.from + b.q * on.to) * 0.5f;
    on.scale_bow = scales - (on.from + on.to) * 0.5f;
    on.side = 0.0f;
    on.start = vec2(0.0f, 0.0f);
    on.end = on.start;
#if BURIN_BENDS != 0
    float width = 1.0f / (piece.width * style.reach);
    on.side = piece.kind == BURIN_PIECE_RADIAL ? piece.side : 0.0f;
    on.start = (ray.slope * range.x - piece.anchor) * width;
    on.end = (ray.slope * range.y - piece.anchor) * width;
#endif
    return on;
}

// From `a` at share 0 to `b` at 1, by a parabola that stands `bow` off their chord in the middle.
vec2 burin_bowed(vec2 a, vec2 b, vec2 bow, float share) {
    return mix(a, b, share) + bow * (4.0f * share * (1.0f - share));
}

// Section point at `share` of the stretch, [0, 1].
vec2 burin_along(BurinTrack on, float share) {
    vec2 q = mix(on.a, on.b, share);
#if BURIN_BENDS != 0
    if (on.side != 0.0f) {
        q.x = on.side * length(mix(on.start, on.end, share));
    } else if (!on.straight) {
        vec2 scales = max(burin_bowed(on.from, on.to, on.scale_bow, share), vec2(1.0e-3f, 1.0e-3f));
        q = burin_bowed(on.a * on.from, on.b * on.to, on.bow, share) / scales;
    }
#endif
    return q;
}

// What lies between two shares of a stretch.
BurinTrack burin_track_part(BurinTrack on, float from, float to) {
    BurinTrack part = on;
    part.range = vec2(mix(on.range.x, on.range.y, from), mix(on.range.x, on.range.y, to));
    part.a = burin_along(on, from);
    part.b = burin_along(on, to);
    part.from = burin_bowed(on.from, on.to, on.scale_bow, from);
    part.to = burin_bowed(on.from, on.to, on.scale_bow, to);
    part.bow = on.bow * ((to - from) * (to - from));
    part.scale_bow = on.scale_bow * ((to - from) * (to - from));
    part.start = mix(on.start, on.end, from);
    part.end = mix(on.start, on.end, to);
    return part;
}

// Share at which the stretch crosses the line through `anchor` with normal `across` between two shares with the values `values`,
// of which one is positive and one is not.
float burin_crossing_share(BurinTrack on, vec2 shares, vec2 values, vec2 anchor, vec2 across) {
    float fa = values.x;
    float fb = values.y;
    float share = mix(shares.x, shares.y, fa / (fa - fb));
#if BURIN_BENDS != 0
    // Regula falsi with halving of the end that stays (Illinois).
    float sa = shares.x;
    float sb = shares.y;
    for (int i = 0; i < BURIN_MAX_FALSI; ++i) {
        if (on.straight) break;
        float f = dot(burin_along(on, share) - anchor, across);
        if ((f > 0.0f) == (fb > 0.0f)) {
            fa = fa * 0.5f;
        } else {
            sa = sb;
            fa = fb;
        }
        sb = share;
        fb = f;
        if (abs(fa - fb) < 1.0e-12f) break;
        float better = clamp(mix(sa, sb, fa / (fa - fb)), shares.x, shares.y);
        bool done = abs(better - share) < 1.0e-6f;
        share = better;
        if (done) break;
    }
#endif
    return share;
}

// Drop of that crossing, where the section itself has it.
float burin_crossing(BurinElement e, BurinStyle style, BurinPiece piece, BurinRay ray, BurinTrack on, vec2 shares, vec2 values,
                     vec2 anchor, vec2 across) {
    float share = burin_crossing_share(on, shares, values, anchor, across);
    float t = mix(on.range.x, on.range.y, share);
#if BURIN_BENDS != 0
    if (on.straight || on.side != 0.0f) return t;
    vec2 part = vec2(mix(on.range.x, on.range.y, shares.x), mix(on.range.x, on.range.y, shares.y));
    vec2 beside = clamp(vec2(share - 1.0e-2f, share + 1.0e-2f), vec2(0.0f, 0.0f), vec2(1.0f, 1.0f));
    float rate = dot(burin_along(on, beside.y) - burin_along(on, beside.x), across) / ((beside.y - beside.x) * (on.range.y - on.range.x));
    // As steep as the chord of the values at least, within reason: where the parabola turns its tangent says nothing.
    float least = 0.25f * (values.y - values.x) / max(part.y - part.x, 1.0e-30f);
    rate = abs(rate) < abs(least) ? least : rate;
    for (int i = 0; i < BURIN_CROSSING_STEPS; ++i) {
        float f = dot(burin_section(e, style, piece, ray, t).q - anchor, across);
        t = clamp(t - f / rate, part.x, part.y);
    }
#endif
    return t;
}

// Side of the profile's point that the ray passes on. On a bent stretch the ray is asked at the height of the point.
bool burin_passes_left(BurinTrack on, vec2 point) {
    vec2 d = on.b - on.a;
    vec2 q = on.a;
#if BURIN_BENDS != 0
    if (!on.straight) q = burin_along(on, clamp((point.y - on.a.y) / min(d.y, -1.0e-20f), 0.0f, 1.0f));
#endif
    return d.x * (point.y - q.y) - d.y * (point.x - q.x) > 0.0f;
}

BurinEvents burin_no_events() {
    BurinEvents found;
    found.add = 1.0e30f;
    found.add_facet = BURIN_FACET_WALL;
    found.add_enters = false;
    found.add_tied = false;
    found.add_odd = false;
    found.add_at_end = false;
    found.cut = 1.0e30f;
    found.cut_facet = BURIN_FACET_WALL;
    found.cut_leaves = false;
    found.cut_tied = false;
    found.cut_odd = false;
    found.cut_once = true;
    found.cut_at_end = false;
    return found;
}

// Notes a crossing of the add's border at drop t.
void burin_note_add(float t, int facet, bool inwards, BURIN_INOUT(BurinEvents) found) {
    float same = BURIN_SAME_DROP * burin_map.depth;
    found.add_odd = !found.add_odd;
    found.add_tied = abs(t - found.add) < same || (found.add_tied && t > found.add);
    if (t >= found.add) return;
    found.add = t;
    found.add_facet = facet;
    found.add_enters = inwards;
}

// The same for the cut's border.
void burin_note_cut(float t, int facet, bool inwards, BURIN_INOUT(BurinEvents) found) {
    float same = BURIN_SAME_DROP * burin_map.depth;
    found.cut_odd = !found.cut_odd;
    found.cut_once = found.cut > 1.0e29f;
    found.cut_tied = abs(t - found.cut) < same || (found.cut_tied && t > found.cut);
    if (t >= found.cut) return;
    found.cut = t;
    found.cut_facet = facet;
    found.cut_leaves = inwards;
}

// Whether the facet from a to b stands over or under the offset x, and its height there.
bool burin_spans(vec2 a, vec2 b, float x) {
    return (a.x <= x) != (b.x <= x);
}

float burin_facet_height(vec2 a, vec2 b, float x) {
    return a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x));
}

// Where a stretch crosses the line of a border, parted so that each part crosses it once at most.
struct BurinCrossings {
    vec2 across;   // normal of the line
    float middle;  // share where the parts meet; 1 where there is one part
    vec3 values;   // along the normal, where the stretch begins, at the middle and where it ends
    bool first;    // whether the crossing of the first part lies on the border
    bool second;
};

// Where in [0, 1] the parabola through fa at 0, f at s and fb at 1 turns; -1 where it clearly does so on fa's side of 0.
float burin_turn(float fa, float s, float f, float fb) {
    float rate = (f - fa) / s;
    float bend = (fb - fa - rate) / (1.0f - s);
    float start = rate - bend * s;
    float turn = -0.5f * start / bend;
    if (!(turn > 0.0f && turn < 1.0f)) return -1.0f;
    float left = (fa - bend * turn * turn) * (fa > 0.0f ? 1.0f : -1.0f);
    return left < 0.1f * abs(bend) ? turn : -1.0f;
}

// Of the border from `last` to `point`, which the ray passes on their left or not; `sense`: +1, or -1 where it is crossed
// inwards from its right. Ends of the stretch on different sides of the line are joined by one crossing, which lies on the
// border where `odd` says so. A bent stretch whose ends lie on the same side may come through and go back: a parabola tells
// where it turns.
BurinCrossings burin_crossings(BurinTrack on, vec2 last, vec2 point, float sense, bool last_left, bool left, bool odd) {
    vec2 way = point - last;
    BurinCrossings found;
    found.across = vec2(-way.y, way.x) * sense;
    float fa = dot(on.a - last, found.across);
    float fb = dot(on.b - last, found.across);
    found.middle = 1.0f;
    found.values = vec3(fa, fb, fb);
    found.first = odd;
    found.second = false;
#if BURIN_BENDS != 0
    bool apart = min(abs(fa), abs(fb)) > 0.1f * length(way);
    if (on.straight || apart || (fa > 0.0f) != (fb > 0.0f)) return found;
    float turn = 0.5f;
    vec2 q = on.a;
    float value = fa;
    for (int n = 0; n < 3; ++n) {
        if (n > 0) turn = burin_turn(fa, turn, value, fb);
        if (turn < 0.0f) break;
        q = burin_along(on, turn);
        value = dot(q - last, found.across);
        if ((value > 0.0f) != (fa > 0.0f)) break;
    }
    if ((value > 0.0f) == (fa > 0.0f)) return found;
    found.middle = turn;
    found.values.y = value;
    // A point of the line between the two crossings has the ray on its other side, and lies at a height that the stretch has.
    vec2 d = on.b - on.a;
    bool behind = (d.x * found.across.y - d.y * found.across.x > 0.0f) == (fa > 0.0f);
    bool last_between = last_left == behind && last.y < on.a.y && last.y > on.b.y;
    bool between = left == behind && point.y < on.a.y && point.y > on.b.y;
    float along = dot(q - last, way);
    if (between != last_between) found.first = between == (dot(d, way) > 0.0f);
    else found.first = !between && along > 0.0f && along < dot(way, way);
    found.second = between != last_between ? !found.first : found.first;
#endif
    return found;
}

// Notes the crossings of one border, which bounds the add between the drops add_range, and the cut after cut_from.
void burin_note_crossings(BurinElement e, BurinStyle style, BurinPiece piece, BurinRay ray, BurinTrack on, BurinCrossings at,
                          vec2 anchor, vec2 add_range, float cut_from, int facet, BURIN_INOUT(BurinEvents) found) {
    for (int k = 0; k < 2; ++k) {
        vec2 shares = k == 0 ? vec2(0.0f, at.middle) : vec2(at.middle, 1.0f);
        vec2 values = k == 0 ? vec2(at.values.x, at.values.y) : vec2(at.values.y, at.values.z);
        bool inwards = values.x > 0.0f;
        if ((k == 0 ? at.first : at.second) && inwards != (values.y > 0.0f)) {
            float t = burin_crossing(e, style, piece, ray, on, shares, values, anchor, at.across);
            if (t > add_range.x && t < add_range.y) burin_note_add(t, facet, inwards, found);
            if (t > cut_from) burin_note_cut(t, facet, inwards, found);
        }
        if (!at.second) break;
    }
}

// The borders of a profile that a stretch may cross. Bit i of `facets`: the facet from point i to the next; of `uprights`: the
// vertical ray over point i, where a run of cutting facets begins or ends; of `lefts`: the ray passes point i on its left.
// Finding them costs a look at every point, asking them where they are crossed many times that.
struct BurinBounds {
    uint facets;
    uint uprights;
    uint lefts;
};

bool burin_bit(uint bits, int i) {
    return ((bits >> uint(i)) & 1u) != 0u;
}

// Whether the border from `last` along `way` can be crossed, of which `odd` says whether a straight stretch crosses it.
bool burin_may_cross(BurinTrack on, vec2 last, vec2 way, bool odd) {
    if (odd || on.straight) return odd;
    vec2 across = vec2(-way.y, way.x);
    float fa = dot(on.a - last, across);
    float fb = dot(on.b - last, across);
    return (fa > 0.0f) == (fb > 0.0f) && min(abs(fa), abs(fb)) <= 0.1f * length(way);
}

// Finds them, and whether the stretch ends in the cut, and its part above the ground, which ends at `qe`, in the add.
BurinBounds burin_bounds(BurinStyle style, BurinTrack on, vec2 qe, BURIN_INOUT(BurinEvents) found) {
    BurinBounds bounds;
    bounds.facets = 0u;
    bounds.uprights = 0u;
    bounds.lefts = 0u;
    bool rightwards = on.b.x > on.a.x;
    vec2 up = vec2(0.0f, BURIN_FAR_UP);
    float bulge = on.straight ? 0.0f : 0.1f;
    float b_low = min(on.a.x, on.b.x) - bulge;
    float b_high = max(on.a.x, on.b.x) + bulge;
    uvec4 texel = uvec4(0u, 0u, 0u, 0u);
    vec2 last = vec2(0.0f, 0.0f);
    bool last_left = false;
    bool last_internal = false;
    bool run_odd = false;
    for (int i = 0; i < BURIN_MAX_PROFILE_POINTS; ++i) {
        if (i % BURIN_POINTS_PER_TEXEL == 0) texel = burin_point_texel(style, i);
        vec2 point = burin_point(texel, i);
        bool internal = i > 0 && burin_bit(style.internal, i - 1);
        bool left = burin_passes_left(on, point);
        bounds.lefts = bounds.lefts | (left ? 1u << uint(i) : 0u);
        if (internal && burin_spans(last, point, on.b.x) && burin_facet_height(last, point, on.b.x) <= on.b.y) run_odd = !run_odd;
        bool ends = last_internal && !internal;
        found.cut_at_end = found.cut_at_end || (ends && run_odd);
        run_odd = run_odd && !ends;
        // A facet whose ends lie beside the stretch, on one side of it, is not crossed.
        if (i > 0 && max(point.x, last.x) >= b_low && min(point.x, last.x) <= b_high) {
            if (burin_spans(last, point, qe.x) && burin_facet_height(last, point, qe.x) > qe.y + BURIN_FILM)
                found.add_at_end = !found.add_at_end;
            uint bit = 1u << uint(i - 1);
            if (burin_may_cross(on, last, point - last, last_left != left)) bounds.facets = bounds.facets | bit;
            if (internal != last_internal && burin_may_cross(on, last, up, rightwards != last_left))
                bounds.uprights = bounds.uprights | bit;
        }
        last = point;
        last_left = left;
        last_internal = internal;
        if (i + 1 >= style.count) break;
    }
    found.cut_at_end = found.cut_at_end || (last_internal && run_odd);
    if (last_internal && burin_may_cross(on, last, up, rightwards != last_left))
        bounds.uprights = bounds.uprights | (1u << uint(style.count - 1));
    return bounds;
}

// The next crossings of a profile's borders: of its add between the drops add_range, of its cut after cut_from.
BurinEvents burin_events(BurinElement e, BurinStyle style, BurinPiece piece, BurinRay ray, BurinTrack on, vec2 add_range,
                         float cut_from) {
    BurinEvents found = burin_no_events();
    // An add ends at the ground; below it the profile says nothing about it.
    vec2 qe = burin_along(on, clamp((add_range.y - on.range.x) / (on.range.y - on.range.x), 0.0f, 1.0f));
    BurinBounds bounds = burin_bounds(style, on, qe, found);
    for (int n = 0; n < 2 * BURIN_MAX_PROFILE_POINTS; ++n) {
        uint left_over = bounds.facets | bounds.uprights;
        if (left_over == 0u) break;
        int i = burin_lowest_bit(left_over);
        uint bit = 1u << uint(i);
        bool own = (bounds.facets & bit) != 0u;
        bool internal = i + 1 < style.count && burin_bit(style.internal, i);
        vec2 last = burin_profile_point(style, i);
        vec2 next = own ? burin_profile_point(style, i + 1) : last + vec2(0.0f, BURIN_FAR_UP);
        bool last_left = burin_bit(bounds.lefts, i);
        bool left = own && burin_bit(bounds.lefts, i + 1);
        bool odd = last_left != (own ? left : on.b.x > on.a.x);
        float sense = own || !internal ? 1.0f : -1.0f;
        BurinCrossings at = burin_crossings(on, last, next, sense, last_left, left, odd);
        vec2 add_part = own ? add_range : vec2(1.0f, 0.0f);
        float cuts_after = own && !internal ? 1.0e30f : cut_from;
        burin_note_crossings(e, style, piece, ray, on, at, last, add_part, cuts_after, own ? i : BURIN_FACET_WALL, found);
        if (own) bounds.facets = bounds.facets ^ bit;
        else bounds.uprights = bounds.uprights ^ bit;
        // Drivers that run every turn of a loop for all pixels of a block run one more for a test at its beginning.
        if ((bounds.facets | bounds.uprights) == 0u) break;
    }
    // Two facets that lie on each other, as in a slot of no width: the crossings are counted instead.
    if (found.add_tied) found.add_enters = found.add_at_end == found.add_odd;
    if (found.cut_tied) found.cut_leaves = found.cut_at_end != found.cut_odd;
    return found;
}
