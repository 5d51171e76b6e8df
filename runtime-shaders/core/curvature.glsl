// Rays over a surface that is not flat: [2010] 5.1. A line that is straight in space is a curve in pattern space, since
// the surface bends away under it or towards it and stretches; it is followed in straight chords whose ends lie on it.
//
// THE LOCAL FRAME. Everything is written along the columns of the frame at the uv where the eye's ray passes the mesh:
// one metre of pattern space along x, along y, and the unit normal. The surface's point there is the origin. A point of
// space p belongs to the place (d, drop) of pattern space, d metres from the origin, with
//     p = P(d) - drop N(d)
//     P(d) = (d, 0) + (xx d.x d.x + 2 xy d.x d.y + yy d.y d.y) / 2 = (over, height),   N(d) ~ (turn over, 1).
// So a point that is deep against the radius is met at its own scale, 1 - drop / radius, and not at the surface's.
//
// A MESH IS MADE OF FLAT TRIANGLES, and the object surface is those: uv and drop 0 are where the mesh is, as for every other texture
// of the material. The ray begins on the triangle; only how the surface goes on from there is taken to be round.
//
// A RAY THAT RISES. Beside the outline of a convex surface a ray falls, then rises. While it rises its chords still fall, by the
// least there is, from the height where the curve is: they meet the walls it would meet. Where it comes up through the
// object surface again it has left the object: met is false, nothing is to be drawn, what is behind it shows.

#define BURIN_MAX_CHORDS 32
// Part of the depth by which a chord may stand off the curve.
#define BURIN_CHORD_ERROR 4.0e-3f
// The most that the offset surface may shrink at the lowest point: where it is rounder than that it would fold.
#define BURIN_MOST_SHRINK 0.75f

// The most that the surface may turn or stretch over one depth.
#define BURIN_MOST_CURVE 10.0f

// Part of the depth by which a ray of one depth may bend and still count as straight.
#define BURIN_MOST_RAY_BEND 0.05f

// Slope beyond which no straight ray stands in for one over a round surface: some 70 degrees.
#define BURIN_MOST_STRAIGHT 3.0f

struct BurinRound {
    bool bent;  // false: flat and evenly stretched; the others are not asked
    vec3 xx;    // second derivatives of the surface along the local frame, per metre
    vec3 xy;
    vec3 yy;
    vec2 turn_x;  // how the normal leans, per metre along x and along y
    vec2 turn_y;
};

// A line of space. Its points are from + s along, s in metres where `along` has unit length in space.
struct BurinSight {
    BurinRay ray;  // on a flat surface: the line as it is there, from drop 0 to `until`
    float until;
    vec3 from;
    vec3 along;
    float first;  // s where it begins, and the length of a chord: the line is followed with growing s
    float chord;
    bool outward;   // it rises with growing s, as a ray to the light does
    vec3 shift;     // (x, y, drop) that is added to all places of the curve
    vec2 near;      // place of its beginning, about
    int chords;
    BurinSheet sheet;  // where it begins
};

struct BurinFound {
    BurinHit hit;
    float way;   // s of the hit
    vec2 place;  // where it is, metres of the pattern that the ray began in; not moved into the tile
    float drop;  // there
    BurinSheet sheet;  // where what was met is looked up
};

// The round surface over its tangent plane.
struct BurinSpot {
    vec2 lean;     // of its normal (lean, 1)
    vec2 slope;    // of itself
    float height;
};

// Requires: second derivatives along the local frame; the metric (x . x, x . y, y . y) of its first two columns.
BurinRound burin_bend_from(vec3 xx, vec3 xy, vec3 yy, vec3 metric) {
    BurinRound bend;
    bend.xx = xx;
    bend.xy = xy;
    bend.yy = yy;
    float area = max(metric.x * metric.z - metric.y * metric.y, 1.0e-20f);
    bend.turn_x = vec2(metric.y * xy.z - metric.z * xx.z, metric.y * xx.z - metric.x * xy.z) * (1.0f / area);
    bend.turn_y = vec2(metric.y * yy.z - metric.z * xy.z, metric.y * xy.z - metric.x * yy.z) * (1.0f / area);
    float middle = 0.5f * (bend.turn_x.x + bend.turn_y.y);
    float gauss = bend.turn_x.x * bend.turn_y.y - bend.turn_x.y * bend.turn_y.x;
    float shrink = (middle + sqrt(max(middle * middle - gauss, 0.0f))) * burin_map.depth;
    if (shrink > BURIN_MOST_SHRINK) {
        float less = BURIN_MOST_SHRINK / shrink;
        bend.xx.z = bend.xx.z * less;
        bend.xy.z = bend.xy.z * less;
        bend.yy.z = bend.yy.z * less;
        bend.turn_x = bend.turn_x * less;
        bend.turn_y = bend.turn_y * less;
    }
    // What the surface turns and stretches over one depth; less than rounding makes of it is nothing, and far too much is
    // a broken triangle.
    float most = max(max(length(bend.xx), length(bend.xy)), length(bend.yy));
    bend.bent = BURIN_ROUND != 0 && most * burin_map.depth > 1.0e-6f && most * burin_map.depth < BURIN_MOST_CURVE;
    return bend;
}

// Metres over the plane per metre of fall, of a direction that goes down.
vec2 burin_slope_of(vec3 direction) {
    return vec2(direction) / max(-direction.z, BURIN_LEAST_FALL * length(direction) + 1.0e-12f);
}

// From derivatives per uv; `frame` has the local frame as its columns, `to_local` is its inverse.
BurinRound burin_bend_at(mat3 frame, mat3 to_local, vec3 duu, vec3 duv, vec3 dvv) {
    vec2 size = burin_map.size;
    vec3 square = vec3(size.x * size.x, size.x * size.y, size.y * size.y);
    vec3 metric = vec3(dot(frame[0], frame[0]), dot(frame[0], frame[1]), dot(frame[1], frame[1]));
    return burin_bend_from(to_local * duu * (1.0f / square.x), to_local * duv * (1.0f / square.y),
                           to_local * dvv * (1.0f / square.z), metric);
}

// Second derivative of the surface in a direction.
vec3 burin_second(BurinRound bend, vec2 d) {
    return bend.xx * (d.x * d.x) + bend.xy * (2.0f * d.x * d.y) + bend.yy * (d.y * d.y);
}

// Of a point of the surface, known by its place over the tangent plane at the origin.
BurinSpot burin_spot(BurinRound bend, vec2 over) {
    BurinSpot spot;
    spot.lean = bend.turn_x * over.x + bend.turn_y * over.y;
    spot.slope = vec2(bend.xx.z * over.x + bend.xy.z * over.y, bend.xy.z * over.x + bend.yy.z * over.y);
    spot.height = 0.5f * dot(spot.slope, over);
    return spot;
}

// Place (d, drop) of a local point: Newton over the tangent plane, where nothing depends on how uv is laid out, from a
// place nearby; then the stretch.
vec3 burin_place(BurinRound bend, vec3 p, vec2 near) {
    vec2 over = near;
    float most = length(vec2(p)) * (1.0f / (1.0f - BURIN_MOST_SHRINK));
    BurinSpot spot = burin_spot(bend, over);
    for (int i = 0; i < 2; ++i) {
        float fall = spot.height - p.z;
        vec2 off = over - spot.lean * fall - vec2(p);
        vec2 jx = vec2(1.0f, 0.0f) - bend.turn_x * fall - spot.lean * spot.slope.x;
        vec2 jy = vec2(0.0f, 1.0f) - bend.turn_y * fall - spot.lean * spot.slope.y;
        float area = max(jx.x * jy.y - jx.y * jy.x, 1.0e-2f);
        over = over - vec2(off.x * jy.y - off.y * jy.x, off.y * jx.x - off.x * jx.y) * (1.0f / area);
        // As far as the surface may shrink; what is beyond it has no place.
        over = over * min(1.0f, most / max(length(over), 1.0e-20f));
        spot = burin_spot(bend, over);
    }
    // (lean, 1) is this much longer than the unit normal, since the lean is the negative slope of the surface.
    float longer = sqrt(max(1.0f - dot(spot.lean, spot.slope), 1.0f));
    vec2 d = over - 0.5f * vec2(burin_second(bend, over));
    d = over - 0.5f * vec2(burin_second(bend, d));
    return vec3(d.x, d.y, (spot.height - p.z) * longer);
}

// Columns: what a metre along x, along y and upwards at a place of pattern space is in the local frame.
mat3 burin_bend_frame(BurinRound bend, vec2 d, float drop) {
    BurinSpot spot = burin_spot(bend, d + 0.5f * vec2(burin_second(bend, d)));
    vec2 x = vec2(1.0f, 0.0f) + vec2(bend.xx) * d.x + vec2(bend.xy) * d.y;
    vec2 y = vec2(0.0f, 1.0f) + vec2(bend.xy) * d.x + vec2(bend.yy) * d.y;
    vec2 lower_x = x - drop * (bend.turn_x * x.x + bend.turn_y * x.y);
    vec2 lower_y = y - drop * (bend.turn_x * y.x + bend.turn_y * y.y);
    return mat3(vec3(lower_x.x, lower_x.y, dot(spot.slope, x)), vec3(lower_y.x, lower_y.y, dot(spot.slope, y)),
                vec3(spot.lean.x, spot.lean.y, 1.0f));
}

// A normal of pattern space at a place, as a normal of the local frame; not of unit length.
vec3 burin_bend_normal(BurinRound bend, vec2 d, float drop, vec3 normal) {
    if (!bend.bent) return normal;
    mat3 frame = burin_bend_frame(bend, d, drop);
    return cross(frame[1], frame[2]) * normal.x + cross(frame[2], frame[0]) * normal.y + cross(frame[0], frame[1]) * normal.z;
}

// Chords that a stretch of a line needs. `fall`: drop per metre of it.
int burin_chord_count(BurinRound bend, vec2 along, float fall, float stretch) {
    vec3 second = burin_second(bend, along);
    vec2 turn = bend.turn_x * along.x + bend.turn_y * along.y;
    float curve = abs(second.z) + length(vec2(second)) + 2.0f * abs(fall) * length(turn);
    float count = stretch * sqrt(curve / (8.0f * BURIN_CHORD_ERROR * burin_map.depth));
    return int(clamp(ceil(count), 1.0f, float(BURIN_MAX_CHORDS) * 0.5f));
}

// An eye's ray through the mesh at ray.origin, at `start` or within the pixel beside it. `direction` of unit length in
// space, along the local frame; it falls. `chart`: that of the triangle.
BurinSight burin_eye_sight(BurinRound bend, vec2 start, BurinRay ray, vec3 direction, int chart) {
    BurinSight sight;
    sight.sheet = burin_first_sheet(chart);
    sight.ray = ray;
    sight.until = burin_map.depth;
    sight.from = vec3(0.0f, 0.0f, 0.0f);
    sight.along = direction;
    sight.first = 0.0f;
    sight.chord = 0.0f;
    sight.outward = false;
    sight.shift = vec3(0.0f, 0.0f, 0.0f);
    sight.near = ray.origin - start;
    sight.chords = 1;
    if (!bend.bent) return sight;
    // drop(s) = fall s + second s^2 / 2: it reaches the lowest point, or comes up before.
    float fall = max(-direction.z, 1.0e-6f);
    float second = burin_second(bend, vec2(direction)).z;
    sight.from = vec3(sight.near.x, sight.near.y, 0.0f);
    float square = fall * fall + 2.0f * second * burin_map.depth;
    float stretch = square > 0.0f ? 2.0f * burin_map.depth / (fall + sqrt(square)) : -2.0f * fall / second;
    stretch = min(stretch, 1.0e3f * burin_map.depth);
    sight.chords = burin_chord_count(bend, vec2(direction), fall, stretch);
    sight.chord = stretch / float(sight.chords);
    // It may take somewhat longer than to second order.
    sight.chords = BURIN_MAX_CHORDS;
    return sight;
}

// From what the eye's ray through `origin` met towards the light; both local directions have unit length in space. `ray` as
// on a flat surface, where it ends at the drop `until`.
BurinSight burin_light_sight(BurinRound bend, BurinRay ray, float until, BurinFound found, vec2 start, vec2 origin,
                             vec3 direction, vec3 light) {
    BurinSight sight;
    sight.sheet = found.sheet;
    sight.ray = ray;
    sight.until = until;
    sight.outward = true;
    sight.first = 0.0f;
    sight.chord = 0.0f;
    sight.shift = vec3(0.0f, 0.0f, 0.0f);
    sight.near = found.place - start;
    sight.chords = 1;
    if (!bend.bent) return sight;
    sight.from = vec3(origin.x - start.x, origin.y - start.y, 0.0f) + direction * found.way;
    sight.along = light;
    vec2 d = found.place - start;
    BurinSpot spot = burin_spot(bend, d);
    float rise = max(light.z - dot(vec2(light), spot.slope), 1.0e-3f);
    float second = burin_second(bend, vec2(light)).z;
    float square = rise * rise - 2.0f * second * found.drop;
    float stretch = square > 0.0f ? 2.0f * found.drop / (rise + sqrt(square)) : rise / second;
    sight.chords = burin_chord_count(bend, vec2(light), rise, stretch);
    sight.chord = stretch * 1.001f / float(sight.chords);
    sight.first = max(found.drop - until, 0.0f) / rise;
    // The hit lies on a chord; the curve goes through it from here on.
    sight.shift = vec3(d.x, d.y, found.drop) - burin_place(bend, sight.from, d);
    sight.near = d;
    return sight;
}

// First solid point along a sight, for `outward` any. met is false where it leaves the object, or reaches its end, before.
// `start`: pattern metres where the eye's ray passes the object surface.
BurinFound burin_trace_sight(BurinRound bend, vec2 start, BurinSight sight) {
    BurinFound found;
    found.sheet = sight.sheet;
    BurinChord chord;
    chord.ray = sight.ray;
    chord.t0 = 0.0f;
    chord.t1 = sight.until;
    BurinPassage passage;
    vec3 from = vec3(chord.ray.origin.x, chord.ray.origin.y, 0.0f);
    vec2 over = chord.ray.origin + chord.ray.slope * sight.until;
    vec3 to = vec3(over.x, over.y, sight.until);
    if (sight.outward) {
        from = to;
        to = vec3(chord.ray.origin.x, chord.ray.origin.y, 0.0f);
    }
    float s = sight.first;
    vec3 here = vec3(0.0f, 0.0f, 0.0f);
    if (bend.bent) {
        here = burin_place(bend, sight.from + sight.along * s, sight.near) + sight.shift;
        // Exactly on the object surface, or ground that lies there would count as a wall.
        if (!sight.outward) here.z = 0.0f;
    }
    float length_here = sight.chord;
    for (int i = 0; i < BURIN_MAX_CHORDS; ++i) {
        vec3 next = here;
        bool leaves = !bend.bent || i + 1 >= sight.chords;
        if (bend.bent) {
            vec3 p = sight.from + sight.along * (s + sight.chord);
            next = burin_place(bend, p, vec2(here) - vec2(sight.shift)) + sight.shift;
            // A ray that is still inside after all its chords ends on what is below it: no pixel stays empty.
            if (!sight.outward && i + 1 == BURIN_MAX_CHORDS) next.z = burin_map.depth;
            if (next.z <= 0.0f) {
                float part = here.z / max(here.z - next.z, 1.0e-20f);
                next = mix(here, next, part);
                length_here = sight.chord * part;
                leaves = true;
            }
            from = vec3(start.x, start.y, 0.0f) + here;
            to = vec3(start.x, start.y, 0.0f) + next;
            chord = burin_chord(sight.outward ? to : from, sight.outward ? from : to, sight.outward, BURIN_LEAST_FALL);
        }
        passage = burin_trace_passage(found.sheet, chord, from, to, sight.outward);
        if (passage.hit.met || leaves || passage.turned) break;
        s = s + length_here;
        here = next;
    }
    found.hit = passage.hit;
    found.place = chord.ray.origin + chord.ray.slope * found.hit.t;
    found.drop = found.hit.t;
    if (found.sheet.moved) {
        vec3 place = mix(from, to, passage.part);
        found.place = vec2(place);
        found.drop = place.z;
    }
    found.way = s + length_here * passage.part;
    if (!bend.bent) found.way = found.drop / max(-sight.along.z, BURIN_LEAST_FALL * length(sight.along) + 1.0e-12f);
    return found;
}

// A straight ray of pattern space that stands in for the eye's where it meets the relief, about half its depth down: for
// what looks at a pixel as a whole. `drop` is where the two meet. False where the eye's ray does not come so deep, or
// is too flat there.
bool burin_straighten(BurinRound bend, vec3 direction, BURIN_INOUT(BurinRay) ray, BURIN_OUT(float) drop) {
    drop = 0.0f;
    if (!bend.bent) return true;
    float fall = max(-direction.z, 1.0e-6f);
    float second = burin_second(bend, vec2(direction)).z;
    float deep = 0.5f * burin_map.depth;
    float square = fall * fall + 2.0f * second * deep;
    if (square < 0.25f * fall * fall) return false;
    float way = 2.0f * deep / (fall + sqrt(square));
    vec3 lower = burin_place(bend, direction * way, vec2(0.0f, 0.0f));
    if (lower.z < 0.25f * deep) return false;
    ray.slope = vec2(lower) * (1.0f / lower.z);
    if (length(ray.slope) > BURIN_MOST_STRAIGHT) return false;
    drop = lower.z;
    return true;
}

// Whether a ray with a slope bends too much, on its way through the relief, for a straight one to stand in for it.
bool burin_bends(BurinRound bend, vec2 slope) {
    if (!bend.bent) return false;
    return 0.5f * abs(burin_second(bend, slope * burin_map.depth).z) > BURIN_MOST_RAY_BEND * burin_map.depth;
}
