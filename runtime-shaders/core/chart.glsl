// Rays over the borders of charts: [2010] 4.1. Where texture coordinates are cut, the plane of pattern space goes on as the
// border's record says (burin/charts.hpp, SPECIFICATION.md 14.1).
//
// A SHEET is the plane of one chart as it is seen from the chart that the ray entered: a point (place, drop) of the first one's
// pattern space is turn * point + shift in the other's. Rays keep the space that they began in; only what is looked up moves.
// Needs fetch_chart(int) -> uvec4 and burin_charts; a program whose meshes have no borders sets BURIN_CHARTS to 0.

// Borders that one ray may pass.
#define BURIN_MAX_HOPS 6
// Cells of the table that one ray may pass, and that a neighbourhood may have.
#define BURIN_MAX_CHART_STEPS 512
#define BURIN_MAX_CHART_CELLS_NEAR 64
// How far beyond a border, in its lengths, a ray may begin that has not passed it, and how far beside it it may pass.
#define BURIN_BORDER_SLACK 1.0e-3f
#define BURIN_BORDER_SIDE 1.0e-4f
// How often a stretch is halved to find what a ray that rises meets first.
#define BURIN_HALVINGS 12

struct BurinSheet {
    mat3 turn;
    vec3 shift;
    int chart;
    bool moved;   // not the one that the ray entered
    bool creased; // turned out of the plane
};

struct BurinBorder {
    vec2 begin;
    vec2 along;    // to its end
    vec2 there;
    vec2 across;
    mat2 map;
    float scale;
    float angle;
    int from;
    int to;
    vec2 normal;   // away from the chart, unit length
    float recede;  // metres of pattern per metre of drop by which the border gives way
};

BurinSheet burin_first_sheet(int chart) {
    BurinSheet sheet;
    sheet.turn = mat3(1.0f);
    sheet.shift = vec3(0.0f, 0.0f, 0.0f);
    sheet.chart = chart;
    sheet.moved = false;
    sheet.creased = false;
    return sheet;
}

vec3 burin_on_sheet(BurinSheet sheet, vec3 p) {
    return sheet.turn * p + sheet.shift;
}

// A normal of the sheet, z up, in the space that the ray began in. Drops, which `turn` is for, count downwards.
vec3 burin_off_sheet(BurinSheet sheet, vec3 normal) {
    vec3 down = transpose(sheet.turn) * vec3(normal.x, normal.y, -normal.z);
    return normalize(vec3(down.x, down.y, -down.z));
}

#if BURIN_CHARTS != 0

vec4 burin_chart_numbers(int texel) {
    uvec4 word = fetch_chart(texel);
    return vec4(uintBitsToFloat(word.x), uintBitsToFloat(word.y), uintBitsToFloat(word.z), uintBitsToFloat(word.w));
}

BurinBorder burin_border(int index) {
    int first = index * BURIN_BORDER_TEXELS;
    vec4 ends = burin_chart_numbers(first);
    vec4 beyond = burin_chart_numbers(first + 1);
    vec4 rows = burin_chart_numbers(first + 2);
    uvec4 last = fetch_chart(first + 3);
    BurinBorder border;
    border.begin = vec2(ends.x, ends.y);
    border.along = vec2(ends.z, ends.w) - border.begin;
    border.there = vec2(beyond.x, beyond.y);
    border.across = vec2(beyond.z, beyond.w);
    border.map = mat2(rows.x, rows.z, rows.y, rows.w);
    border.scale = uintBitsToFloat(last.x) * burin_charts.scale;
    border.across = border.across * (1.0f / burin_charts.scale);
    border.angle = uintBitsToFloat(last.y);
    border.from = int(last.z);
    border.to = int(last.w);
    border.normal = burin_direction(vec2(-border.along.y, border.along.x), vec2(1.0f, 0.0f));
    border.recede = border.angle == 0.0f ? 0.0f : tan(0.5f * border.angle) / max(border.scale, 1.0e-12f);
    return border;
}

// Part of the way from a to b at which a border is passed outwards; 2: it is not.
float burin_border_part(BurinBorder border, vec3 a, vec3 b) {
    float at_a = dot(border.normal, vec2(a) - border.begin) + border.recede * a.z;
    float at_b = dot(border.normal, vec2(b) - border.begin) + border.recede * b.z;
    float size = length(border.along);
    if (at_b <= 0.0f || at_b <= at_a || at_a > BURIN_BORDER_SLACK * size) return 2.0f;
    float part = clamp(-at_a / (at_b - at_a), 0.0f, 1.0f);
    vec3 p = mix(a, b, part);
    float place = dot(vec2(p) - border.begin, border.along) / max(size * size, 1.0e-24f);
    float beside = BURIN_BORDER_SIDE + abs(border.recede) * p.z / max(size, 1.0e-12f);
    return place < -beside || place > 1.0f + beside ? 2.0f : part;
}

ivec2 burin_chart_cell(vec2 p) {
    vec2 at = floor((p - burin_charts.origin) / burin_charts.cell);
    at = clamp(at, vec2(-1.0f, -1.0f), vec2(burin_charts.cells));
    return ivec2(int(at.x), int(at.y));
}

bool burin_has_chart_cell(ivec2 at) {
    return at.x >= 0 && at.y >= 0 && at.x < burin_charts.cells.x && at.y < burin_charts.cells.y;
}

// First reference of a cell, and how many there are.
ivec2 burin_chart_list(ivec2 at) {
    int index = at.y * burin_charts.cells.x + at.x;
    uvec4 word = fetch_chart(burin_charts.first_cell + index / 2);
    return index % 2 == 0 ? ivec2(int(word.x), int(word.y)) : ivec2(int(word.z), int(word.w));
}

BurinBorder burin_listed_border(int reference) {
    return burin_border(int(burin_word(fetch_chart(burin_charts.first_reference + reference / 4), reference % 4)));
}

// The first border of a chart that is passed on the way from a to b, and the part of the way; 2: none.
float burin_next_border(int chart, vec3 a, vec3 b, BURIN_OUT(BurinBorder) border) {
    float best = 2.0f;
    border = burin_border(0);
    if (burin_charts.cells.x == 0) return best;
    ivec2 at = burin_chart_cell(vec2(a));
    ivec2 last = burin_chart_cell(vec2(b));
    vec2 way = vec2(b) - vec2(a);
    for (int i = 0; i < BURIN_MAX_CHART_STEPS; ++i) {
        if (burin_has_chart_cell(at)) {
            ivec2 list = burin_chart_list(at);
            for (int k = 0; k < list.y; ++k) {
                BurinBorder candidate = burin_listed_border(list.x + k);
                if (candidate.from != chart) continue;
                float part = burin_border_part(candidate, a, b);
                if (part < best) {
                    best = part;
                    border = candidate;
                }
            }
        }
        if (at.x == last.x && at.y == last.y) break;
        // To the cell beyond the nearer side; cells outside of the grid count as one.
        vec2 low = burin_charts.origin + vec2(at) * burin_charts.cell;
        float to_x = at.x == last.x ? 2.0f : (low.x + (way.x > 0.0f ? burin_charts.cell.x : 0.0f) - a.x) / way.x;
        float to_y = at.y == last.y ? 2.0f : (low.y + (way.y > 0.0f ? burin_charts.cell.y : 0.0f) - a.y) / way.y;
        if (best <= min(to_x, to_y)) break;
        if (to_x <= to_y) at.x += way.x > 0.0f ? 1 : -1;
        else at.y += way.y > 0.0f ? 1 : -1;
    }
    return best;
}

// Whether a chart has a border within a distance of a place, or so many cells would have to be asked that it may.
bool burin_near_border(int chart, vec2 middle, float distance) {
    if (burin_charts.cells.x == 0) return false;
    ivec2 low = burin_chart_cell(middle - vec2(distance, distance));
    ivec2 high = burin_chart_cell(middle + vec2(distance, distance));
    int columns = high.x - low.x + 1;
    int count = columns * (high.y - low.y + 1);
    if (count > BURIN_MAX_CHART_CELLS_NEAR) return true;
    for (int i = 0; i < count; ++i) {
        ivec2 at = ivec2(low.x + i % columns, low.y + i / columns);
        if (!burin_has_chart_cell(at)) continue;
        ivec2 list = burin_chart_list(at);
        for (int k = 0; k < list.y; ++k) {
            BurinBorder border = burin_listed_border(list.x + k);
            if (border.from != chart) continue;
            vec2 off = middle - border.begin;
            float part = clamp(dot(off, border.along) / max(dot(border.along, border.along), 1.0e-24f), 0.0f, 1.0f);
            if (length(off - border.along * part) <= distance + abs(border.recede) * burin_map.depth) return true;
        }
    }
    return false;
}

// The sheet beyond a border of the one given.
BurinSheet burin_sheet_beyond(BurinSheet sheet, BurinBorder border) {
    float c = cos(border.angle);
    float s = sin(border.angle);
    vec2 away = border.normal * border.scale;
    // Flat, then turned about the edge: (x, z) becomes (x c + z s, z c - x s), x straight away from it.
    vec2 x_column = border.map * vec2(1.0f, 0.0f) + border.across * (away.x * (c - 1.0f));
    vec2 y_column = border.map * vec2(0.0f, 1.0f) + border.across * (away.y * (c - 1.0f));
    vec2 z_column = border.across * s;
    mat3 turn = mat3(vec3(x_column.x, x_column.y, -s * away.x), vec3(y_column.x, y_column.y, -s * away.y), vec3(z_column.x, z_column.y, c));
    BurinSheet beyond;
    beyond.turn = turn * sheet.turn;
    beyond.shift = turn * (sheet.shift - vec3(border.begin.x, border.begin.y, 0.0f)) + vec3(border.there.x, border.there.y, 0.0f);
    beyond.chart = border.to;
    beyond.moved = true;
    beyond.creased = sheet.creased || border.angle != 0.0f;
    return beyond;
}

#endif

// What is met on a way that may pass borders.
struct BurinPassage {
    BurinHit hit;
    float part;  // of the way, where the hit is; beyond 1 where a crease has turned the way
    bool turned;
};

#if BURIN_CHARTS != 0

// Beyond a crease a straight line goes on until it is below all relief or above it.
float burin_whole_way(BurinSheet sheet, vec3 a, vec3 b) {
    vec3 from = burin_on_sheet(sheet, a);
    float fall = burin_on_sheet(sheet, b).z - from.z;
    if (abs(fall) < 1.0e-9f * burin_map.depth) return 1.0e3f;
    // Beyond the lowest point, so that rounding leaves no gap above it.
    return clamp(((fall > 0.0f ? 1.01f * burin_map.depth : 0.0f) - from.z) / fall, 0.0f, 1.0e3f);
}

// Along `chord`, whose ends are a and b in the space that the ray began in; b is above a where the way leads outward. Asks until
// something is met, changing to the sheets beyond the borders that are passed.
BurinPassage burin_trace_passage(BURIN_INOUT(BurinSheet) sheet, BurinChord chord, vec3 a, vec3 b, bool outward) {
    BurinPassage passage;
    BurinBorder border;
    passage.turned = false;
    float from = 0.0f;
    float to = sheet.creased ? burin_whole_way(sheet, a, b) : 1.0f;
    float border_part = 2.0f;
    float until = to;
    int halvings = 0;  // of a stretch of a rising way in which something is met
    for (int i = 0; i < BURIN_MAX_HOPS + BURIN_HALVINGS; ++i) {
        vec3 here = burin_on_sheet(sheet, mix(a, b, from));
        if (halvings == 0) {
            border_part = burin_next_border(sheet.chart, here, burin_on_sheet(sheet, mix(a, b, to)), border);
            until = mix(from, to, min(border_part, 1.0f));
        }
        float stop = halvings == 0 || halvings >= BURIN_HALVINGS ? until : 0.5f * (from + until);
        vec3 there = burin_on_sheet(sheet, mix(a, b, stop));
        bool backward = there.z < here.z && (outward || sheet.creased);
        BurinChord piece = chord;
        if (sheet.moved || border_part <= 1.0f || from > 0.0f)
            piece = burin_chord(backward ? there : here, backward ? here : there, backward, sheet.creased ? BURIN_LEAST_CREASED_FALL : BURIN_LEAST_FALL);
        passage.hit = burin_trace(piece.ray, piece.t0, piece.t1);
        float met = clamp((passage.hit.t - piece.t0) / max(piece.t1 - piece.t0, 1.0e-20f), 0.0f, 1.0f);
        passage.part = mix(from, stop, backward ? 1.0f - met : met);
        // Backwards the last point is met first: the first one lies where halving leads to.
        if (backward && !outward && (passage.hit.met || halvings > 0) && halvings < BURIN_HALVINGS) {
            if (passage.hit.met) until = stop;
            else from = stop;
            ++halvings;
            continue;
        }
        if (passage.hit.met || border_part > 1.0f) break;
        from = until;
        sheet = burin_sheet_beyond(sheet, border);
        if (border.angle != 0.0f) {
            to = mix(from, to, burin_whole_way(sheet, mix(a, b, from), mix(a, b, to)));
            passage.turned = true;
        }
    }
    return passage;
}

#else

BurinPassage burin_trace_passage(BurinSheet sheet, BurinChord chord, vec3 a, vec3 b, bool outward) {
    BurinPassage passage;
    passage.turned = false;
    passage.hit = burin_trace(chord.ray, chord.t0, chord.t1);
    float part = (passage.hit.t - chord.t0) / max(chord.t1 - chord.t0, 1.0e-20f);
    passage.part = outward ? 1.0f - part : part;
    return passage;
}

#endif
