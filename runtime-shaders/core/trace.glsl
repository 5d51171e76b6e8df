// First point of the ray that is solid: [2010] 5.1 to 5.4. Cell by cell, none skipped that lists something; in a cell
// stretch by stretch of equal ground; in a stretch by passes over the listed elements:
//     find the first point in (ground U additions); while it lies in a cut, go on where the cuts end; else it is met.

// What one stretch of an element says about the first solid point.
void burin_judge(BurinElement e, BurinStyle style, BurinPiece piece, BurinRay ray, BurinTrack on, BurinMark mark,
                 BURIN_INOUT(BurinPass) pass) {
    vec2 range = on.range;
    if (style.stepped) {
        // The overlap of the sides must not reach over the path line, where the run of cutting facets ends.
        on.a.x = piece.side * max(on.a.x * piece.side, 1.0e-6f);
        on.b.x = piece.side * max(on.b.x * piece.side, 1.0e-6f);
    }
    float margin = on.straight ? 1.0f : 1.25f;
    if (min(on.a.x, on.b.x) > margin || max(on.a.x, on.b.x) < -margin) return;
    float same = BURIN_SAME_DROP * burin_map.depth;
    float add_from = max(pass.from, range.x);
    vec2 add_range = vec2(add_from > pass.from ? add_from : pass.from + same, pass.ground - same);
    BurinEvents next = burin_events(e, style, piece, ray, on, add_range, pass.air + same);
    mark.wall = range.y == piece.hi ? piece.hi_wall : vec2(0.0f, 0.0f);
    if (pass.air < range.y) {
        bool crossed = next.cut < 1.0e29f;
        bool inside = crossed ? next.cut_leaves : next.cut_at_end;
        if (inside && range.x <= pass.air) {
            pass.air = crossed ? next.cut : range.y;
            mark.facet = next.cut_facet;
            if (crossed && mark.facet == BURIN_FACET_WALL) mark.wall = piece.gradient;
            pass.air_mark = mark;
            // The same profile may open again further on.
            if (crossed) pass.reopen = min(pass.reopen, next.cut_once ? 1.0e30f : next.cut);
        } else if (inside) {
            pass.reopen = min(pass.reopen, range.x);
        } else if (crossed) {
            pass.reopen = min(pass.reopen, next.cut);
        }
    }
    if (!pass.want_adds || add_from >= range.y) return;
    bool crossed = next.add < 1.0e29f;
    bool inside = crossed ? !next.add_enters : next.add_at_end;
    if (!inside && !(crossed && next.add_enters)) return;
    float entry = inside ? add_from : next.add;
    if (entry >= min(pass.add, pass.ground)) return;
    pass.add = entry;
    int before = pass.from <= BURIN_FILM * burin_map.depth ? BURIN_FACET_TOP : BURIN_FACET_KEEP;
    mark.facet = inside ? (add_from > pass.from ? BURIN_FACET_WALL : before) : next.add_facet;
    mark.wall = piece.lo_wall;
    pass.add_mark = mark;
}

// Stretches on which b' runs nearly straight, so that no crossing of the profile is passed over; 0: one that is straight.
int burin_segment_count(BurinElement e, BurinStyle style, BurinPiece piece, BurinRay ray) {
    if (burin_is_straight(piece)) return 0;
    float way = length(ray.slope) * (piece.hi - piece.lo);
    float bend = 0.0f;
    if (piece.kind == BURIN_PIECE_CURVE) bend = burin_greatest_curvature(e);
    if (piece.kind == BURIN_PIECE_RADIAL) bend = 2.0f / style.reach;
    if (!piece.fixed_scale) bend = bend + 1.0f / max(e.extent, 1.0e-6f);
    // A parabola through three places of an arc is off by the third power of the way times the square of the bend, both in reaches.
    float tight = burin_cube_root(bend * style.reach);
    int count = clamp(int(ceil(BURIN_TRACK_PARTS * way / style.reach * tight * tight)), 1, BURIN_MAX_SEGMENTS);
    if (piece.fixed_scale || !e.waved) return count;
    float run = e.curved ? way : abs(dot(ray.slope, e.t0)) * (piece.hi - piece.lo);
    float turns = e.argument.y * min(run / max(e.extent, 1.0e-6f), 1.0f);
    return min(count + int(ceil(turns * sqrt(burin_waviness(e) * 8.0f))), BURIN_MAX_WAVE_SEGMENTS);
}

// The sides of a curve part where b changes sign. Keeps the part of a stretch on the side of the piece; false: there is none.
bool burin_keep_side(BurinElement e, BurinStyle style, BurinPiece piece, BurinRay ray, BURIN_INOUT(BurinTrack) on) {
#if BURIN_CURVES != 0
    if (piece.kind != BURIN_PIECE_CURVE || piece.side == 0.0f) return true;
    // They overlap a little, as those of a line do.
    float middle = -piece.side * 4.0f * BURIN_OVERLAP * max(burin_map.size.x, burin_map.size.y) / style.reach;
    vec2 inside = (vec2(on.a.x, on.b.x) - vec2(middle, middle)) * piece.side;
    bool from_inside = inside.x >= 0.0f;
    bool to_inside = inside.y >= 0.0f;
    if (from_inside == to_inside) return from_inside;
    float t = burin_crossing(e, style, piece, ray, on, vec2(0.0f, 1.0f), inside, vec2(middle, 0.0f), vec2(piece.side, 0.0f));
    float share = (t - on.range.x) / (on.range.y - on.range.x);
    on = from_inside ? burin_track_part(on, 0.0f, share) : burin_track_part(on, share, 1.0f);
    if (from_inside) on.b.x = middle;
    else on.a.x = middle;
#endif
    return true;
}

void burin_visit_piece(BurinElement e, BurinStyle style, BurinPiece piece, BurinRay ray, BurinMark mark,
                       BURIN_INOUT(BurinPass) pass) {
    int count = burin_segment_count(e, style, piece, ray);
    // Additions end at the ground and most cuts begin there, so a bent stretch is parted there.
    int above = 0;
    float part = piece.lo;
    if (count > 0 && pass.level > piece.lo && pass.level < piece.hi) {
        part = pass.level;
        int share = int(floor(float(count) * (part - piece.lo) / (piece.hi - piece.lo) + 0.5f));
        above = max(share, 1);
        count = above + max(count - share, 1);
    }
    count = max(count, 1);
    vec2 range = vec2(piece.lo, piece.lo);
    BurinSection b = burin_section(e, style, piece, ray, piece.lo);
    for (int i = 1; i <= BURIN_MAX_WAVE_SEGMENTS + 1; ++i) {
        float to = i == count ? piece.hi : (i == above ? part : mix(part, piece.hi, float(i - above) / float(count - above)));
        if (i < above) to = mix(piece.lo, part, float(i) / float(above));
        range = vec2(range.y, to);
        BurinSection a = b;
        BurinSection middle = a;
#if BURIN_BENDS != 0
        middle = burin_section(e, style, piece, ray, 0.5f * (range.x + range.y));
#endif
        b = burin_section(e, style, piece, ray, range.y);
        BurinTrack on = burin_track(style, piece, ray, range, a, middle, b);
        if (burin_keep_side(e, style, piece, ray, on)) burin_judge(e, style, piece, ray, on, mark, pass);
        // At the end, as everywhere here: see burin_events.
        if (i >= count) break;
    }
}

// Metres around the vertex within which what an end does to the element lies: a hip's corner, or where the clip line leaves
// the reach.
float burin_end_reach(BurinEnd end, float reach) {
    if (end.priority == BURIN_PRIORITY_NONE) return 0.0f;
    float lean = dot(end.clip, end.inward) / max(abs(dot(end.clip, end.normal)), 1.0e-4f);
    return reach * sqrt(1.0f + max(lean * lean, 1.0f));
}

// Whether the ray from a to b passes farther than `room` beside the element's path, or before or behind it. Most of a cell's
// list does not lie in a ray's way, and this costs a fraction of what asking it would.
bool burin_passes_beside(BurinElement e, vec2 a, vec2 b, float room) {
    vec2 normal = burin_normal_of(burin_direction(e.p2 - e.p0, e.t0));
    // Between path and chord lies at most half of what the control point is off.
    float sag = e.curved ? 0.5f * dot(e.p1 - e.p0, normal) : 0.0f;
    vec2 across = vec2(dot(a - e.p0, normal), dot(b - e.p0, normal));
    return max(across.x, across.y) < min(sag, 0.0f) - room || min(across.x, across.y) > max(sag, 0.0f) + room;
}

bool burin_passes_beyond(BurinElement e, vec2 a, vec2 b, float room) {
    vec2 tangent = burin_direction(e.p2 - e.p0, e.t0);
    float middle = e.curved ? dot(e.p1 - e.p0, tangent) : 0.0f;
    vec2 along = vec2(dot(a - e.p0, tangent), dot(b - e.p0, tangent));
    return max(along.x, along.y) < min(middle, 0.0f) - room || min(along.x, along.y) > max(middle, e.extent) + room;
}

// An element that a stretch of equal ground may meet.
struct BurinCandidate {
    uint reference;
    BurinElement e;
    BurinStyle style;
    BurinEnd start;
    BurinEnd end;
    bool left;  // whether its sides belong to this ground
    bool right;
};

// The element named by `reference`, and whether the stretch comes near it.
bool burin_comes_near(uint reference, BurinRay ray, vec2 centre, bool stepped, vec2 stretch, float ground, BURIN_OUT(BurinCandidate) next) {
    BurinElement e = burin_element(reference, ray.origin, centre);
    BurinStyle style = burin_style(e.style);
    float same = BURIN_SAME_LEVEL * burin_map.depth;
    if (stepped) e.slack = burin_clip_slack(e, style);
    next.reference = reference;
    next.e = e;
    next.style = style;
    next.start = burin_end(e, true);
    next.end = burin_end(e, false);
    next.left = abs(style.level - ground) < same;
    next.right = abs(style.right_level - ground) < same;
    if (!next.left && !next.right) return false;
    float pad = BURIN_SAME_DROP * burin_map.depth + 1.0e-5f * (stretch.y - stretch.x);
    vec2 from = ray.slope * (stretch.x - pad);
    vec2 to = ray.slope * (stretch.y + pad);
    float room = style.reach * burin_widest(e) * 1.001f + e.slack + BURIN_OVERLAP * max(burin_map.size.x, burin_map.size.y);
    if (!e.curved && burin_passes_beside(e, from, to, room)) return false;
    float tip = max(burin_end_reach(next.start, room), burin_end_reach(next.end, room));
    if (e.curved) tip = max(tip, room);
    if (burin_passes_beyond(e, from, to, tip + room * 1.0e-3f)) return false;
    return !(e.curved && burin_passes_beside(e, from, to, tip));
}

// Every part of one element over the stretch.
void burin_visit(BurinCandidate next, BurinRay ray, vec2 stretch, BURIN_INOUT(BurinPass) pass) {
    float pad = BURIN_SAME_DROP * burin_map.depth + 1.0e-5f * (stretch.y - stretch.x);
    BurinElement e = next.e;
    BurinPiece whole = burin_whole(e, stretch.x - pad, stretch.y + pad);
    bool alike = next.left && next.right && burin_ends_alike(whole, ray, next.start) && burin_ends_alike(whole, ray, next.end);
    BurinMark mark;
    mark.element = next.reference;
    mark.facet = BURIN_FACET_WALL;
    mark.wall = vec2(0.0f, 0.0f);
    uint parts = alike ? 1u : burin_parts_of(next.start, next.end, next.left, next.right, e.curved);
    for (int n = 0; n < 2 * BURIN_PARTS; ++n) {
        BurinPiece piece = whole;
        bool found = false;
        // Parts that the ray does not come to are passed by before the next one is visited.
        for (int k = 0; k < 2 * BURIN_PARTS; ++k) {
            int i = burin_lowest_bit(parts);
            parts = parts & (parts - 1u);
            mark.part = i / 2;
            mark.side = alike ? 0.0f : (i % 2 == 0 ? -1.0f : 1.0f);
            if (alike) piece = burin_clip_both(burin_clip_both(whole, ray, next.start, e.slack), ray, next.end, e.slack);
            else piece = burin_part(e, next.start, next.end, ray, whole, mark.part, mark.side);
            found = piece.hi > piece.lo;
            if (found || parts == 0u) break;
        }
        if (found) burin_visit_piece(e, next.style, burin_formula(e, piece, mark.part), ray, mark, pass);
        if (parts == 0u) break;
    }
}

// Every element of a cell's list. Most are passed by, and are looked through before the next one is visited.
void burin_visit_all(BurinCell cell, BurinRay ray, vec2 centre, vec2 stretch, float ground, BURIN_INOUT(BurinPass) pass) {
    uvec4 texel = uvec4(0u, 0u, 0u, 0u);
    BurinCandidate next;
    int i = 0;
    for (int n = 0; n < BURIN_MAX_REFS_PER_CELL; ++n) {
        bool near = false;
        for (int k = 0; k < BURIN_MAX_REFS_PER_CELL; ++k) {
            if (near || i >= cell.count) break;
            near = burin_comes_near(burin_listed(cell, i, texel), ray, centre, cell.stepped, stretch, ground, next);
            ++i;
            if (near || i >= cell.count) break;
        }
        if (near) burin_visit(next, ray, stretch, pass);
        if (i >= cell.count) break;
    }
}

// First solid point of a stretch with equal ground. `hit.mark` on entry names the wall that stands at its start.
bool burin_trace_stretch(BurinCell cell, vec2 stretch, float ground, BURIN_INOUT(BurinHit) hit) {
    float at = stretch.x;
    bool at_add = false;
    float add = 0.0f;
    for (int n = 0; n < BURIN_MAX_PASSES; ++n) {
        BurinPass pass;
        pass.from = at;
        pass.ground = max(at, ground);
        pass.level = ground;
        pass.want_adds = !at_add && at < ground;
        pass.add = 1.0e30f;
        float probe = at_add ? add : pass.ground;
        pass.air = probe;
        pass.reopen = 1.0e30f;
        pass.add_mark = hit.mark;
        pass.air_mark = hit.mark;
        burin_visit_all(cell, hit.ray, hit.centre, stretch, ground, pass);
        if (pass.add < pass.ground) {
            at_add = true;
            add = pass.add;
            if (pass.add_mark.facet != BURIN_FACET_KEEP) hit.mark = pass.add_mark;
            continue;
        }
        if (probe >= stretch.y) return false;
        if (pass.air <= probe) {
            if (!at_add && ground >= at - BURIN_SAME_DROP * burin_map.depth) {
                hit.mark.element = BURIN_NO_ELEMENT;
                hit.mark.facet = BURIN_FACET_GROUND;
            }
            hit.t = probe;
            return true;
        }
        at = pass.air;
        hit.mark = pass.air_mark;
        at_add = false;
        if (at >= stretch.y) return false;
        // Nothing that was judged before could contradict: no second pass is needed.
        if (at >= ground && at < pass.reopen) {
            hit.t = at;
            return true;
        }
    }
    hit.t = at;
    return true;
}

// First solid point of the ray between two drops inside one cell.
bool burin_trace_cell(BurinCell cell, vec2 range, BURIN_INOUT(BurinHit) hit) {
#if BURIN_STEPS == 0
    return burin_trace_stretch(cell, range, cell.level, hit);
#else
    float ground = cell.level;
    vec2 a = hit.ray.slope * range.x;
    vec2 b = hit.ray.slope * range.y;
    if (cell.stepped) {
        vec2 start = (hit.centre + cell.start / vec2(burin_map.cells)) * burin_map.size - hit.ray.origin;
        ground = burin_step_line(cell, hit.ray, hit.centre, start, a, -1.0f, true).level;
    }
    float after = -1.0f;
    float from = range.x;
    for (int n = 0; n < BURIN_MAX_GROUND_CHANGES; ++n) {
        BurinStepLine line = burin_no_step_line(cell, false);
        if (cell.stepped) line = burin_step_line(cell, hit.ray, hit.centre, a, b, after, false);
        bool last = line.at > 1.0f;
        float to = last ? range.y : mix(range.x, range.y, max(line.at, 0.0f));
        if (to > from || last) {
            if (burin_trace_stretch(cell, vec2(from, to), ground, hit)) return true;
        }
        if (last) return false;
        after = line.at;
        from = to;
        ground = line.level;
        hit.mark = line.mark;
    }
    return false;
#endif
}

// Drop where the ray leaves the box low-high, along `axis` (0 or 1).
float burin_leave(BurinRay ray, vec2 low, vec2 high, BURIN_OUT(int) axis) {
    float tx = ray.slope.x == 0.0f ? 1.0e30f : ((ray.slope.x > 0.0f ? high.x : low.x) - ray.origin.x) / ray.slope.x;
    float ty = ray.slope.y == 0.0f ? 1.0e30f : ((ray.slope.y > 0.0f ? high.y : low.y) - ray.origin.y) / ray.slope.y;
    axis = tx < ty ? 0 : 1;
    return min(tx, ty);
}

// Outside a map that does not repeat: true when the ray ends on the ground there; else `t` is moved to the border.
bool burin_trace_outside(BURIN_INOUT(BurinHit) hit, BURIN_INOUT(float) t) {
    vec2 low = vec2(0.0f, 0.0f) - hit.ray.origin;
    vec2 high = burin_map.size - hit.ray.origin;
    float enter = t;
    float leave = 1.0e30f;
    vec2 wall = vec2(0.0f, 0.0f);
    for (int axis = 0; axis < 2; ++axis) {
        float slope = axis == 0 ? hit.ray.slope.x : hit.ray.slope.y;
        float a = axis == 0 ? low.x : low.y;
        float b = axis == 0 ? high.x : high.y;
        if (slope == 0.0f) {
            if (a > 0.0f || b < 0.0f) leave = -1.0f;
            continue;
        }
        float near = min(a / slope, b / slope);
        if (near > enter) wall = axis == 0 ? vec2(1.0f, 0.0f) : vec2(0.0f, 1.0f);
        enter = max(enter, near);
        leave = min(leave, max(a / slope, b / slope));
    }
    if (enter >= leave || enter >= burin_map.outer_level) {
        hit.t = max(t, burin_map.outer_level);
        if (t <= burin_map.outer_level) hit.mark.facet = BURIN_FACET_GROUND;
        return true;
    }
    t = enter;
    hit.mark.wall = wall;
    return false;
}

BurinHit burin_begin(BurinRay ray, float t1) {
    BurinHit hit;
    hit.met = true;
    hit.t = t1;
    hit.ray = ray;
    hit.centre = vec2(0.0f, 0.0f);
    hit.mark.element = BURIN_NO_ELEMENT;
    hit.mark.part = BURIN_PART_MAIN;
    hit.mark.side = 0.0f;
    hit.mark.facet = BURIN_FACET_WALL;
    hit.mark.wall = vec2(0.0f, 0.0f);
    return hit;
}

ivec2 burin_cell_at(vec2 p) {
    ivec2 index = ivec2(floor(p / (burin_map.size / vec2(burin_map.cells))));
    return clamp(index, ivec2(0, 0), burin_map.cells - ivec2(1, 1));
}

// The cell on the other side of the border that the ray reaches at drop t; in a tiling map the ray moves along.
ivec2 burin_next_cell(ivec2 index, int skip, int axis, float t, BURIN_INOUT(BurinHit) hit) {
    ivec2 next = index;
    if (skip > 0) {
        vec2 p = hit.ray.origin + hit.ray.slope * t;
        vec2 cell_size = burin_map.size / vec2(burin_map.cells);
        next = clamp(ivec2(floor(p / cell_size)), index - ivec2(skip, skip), index + ivec2(skip, skip));
    }
    int forward = (axis == 0 ? hit.ray.slope.x : hit.ray.slope.y) > 0.0f ? skip + 1 : -skip - 1;
    if (axis == 0) next.x = index.x + forward;
    else next.y = index.y + forward;
    hit.mark.element = BURIN_NO_ELEMENT;
    hit.mark.facet = BURIN_FACET_WALL;
    hit.mark.wall = axis == 0 ? vec2(1.0f, 0.0f) : vec2(0.0f, 1.0f);
    if (burin_map.repeats == 0) return next;
    ivec2 tile = ivec2(floor(vec2(next) / vec2(burin_map.cells)));
    hit.ray.origin = hit.ray.origin - vec2(tile) * burin_map.size;
    return next - tile * burin_map.cells;
}

// A ray on its way from cell to cell.
struct BurinWalk {
    BurinHit hit;
    bool ended;   // `hit` is the answer
    float t;      // drop where it enters the cell
    float t1;     // and where it ends
    float leave;  // drop where it leaves the cell, across `axis`
    int axis;
    ivec2 index;
    bool outside;  // of a map that does not repeat
    BurinCell cell;
    vec2 range;  // drops between which there is something to meet in the cell; below them all is solid
    int cells;   // so far
};

void burin_end_walk(bool met, float t, BURIN_INOUT(BurinWalk) walk) {
    walk.ended = true;
    walk.hit.met = met;
    walk.hit.t = t;
}

// Looks at the cell that the walk has come to, or brings it to the map.
void burin_enter_cell(BURIN_INOUT(BurinWalk) walk) {
    if (walk.outside) {
        bool ends = burin_trace_outside(walk.hit, walk.t);
        if ((ends ? walk.hit.t : walk.t) > walk.t1) burin_end_walk(false, walk.t1, walk);
        else if (ends) burin_end_walk(true, walk.hit.t, walk);
        walk.index = burin_cell_at(walk.hit.ray.origin + walk.hit.ray.slope * walk.t);
    }
    if (walk.ended) return;
    BurinCell cell = burin_cell(walk.index);
    vec2 cell_size = burin_map.size / vec2(burin_map.cells);
    vec2 low = vec2(walk.index - ivec2(cell.skip, cell.skip)) * cell_size;
    vec2 high = vec2(walk.index + ivec2(cell.skip + 1, cell.skip + 1)) * cell_size;
    walk.cell = cell;
    walk.leave = max(burin_leave(walk.hit.ray, low, high, walk.axis), walk.t);
    // Above the cell's highest surface there is nothing to meet; below its lowest one all is solid.
    float bottom = max(cell.lowest + BURIN_SAME_DROP * burin_map.depth, walk.t);
    walk.range = vec2(walk.t, min(min(walk.leave, walk.t1), bottom));
    walk.range.x = max(walk.range.x, min(cell.highest, walk.range.y));
    walk.hit.centre = (vec2(walk.index) + vec2(0.5f, 0.5f)) / vec2(burin_map.cells);
}

// Whether the ray comes below the cell's highest surface in it.
bool burin_may_meet(BurinWalk walk) {
    return walk.leave > walk.cell.highest || walk.t1 <= walk.leave;
}

// On to the next cell, if nothing was met in this one.
void burin_leave_cell(BURIN_INOUT(BurinWalk) walk) {
    if (burin_may_meet(walk) && walk.range.y < min(walk.leave, walk.t1)) {
        burin_end_walk(true, walk.range.y, walk);
    } else if (walk.leave >= walk.t1) {
        burin_end_walk(false, walk.t1, walk);
    } else {
        walk.t = walk.leave;
        walk.index = burin_next_cell(walk.index, walk.cell.skip, walk.axis, walk.t, walk.hit);
        walk.outside = burin_map.repeats == 0 && (walk.index.x < 0 || walk.index.y < 0 || walk.index.x >= burin_map.cells.x ||
                                                  walk.index.y >= burin_map.cells.y);
    }
}

// To the next cell whose list must be asked, over those that list nothing, whose ground may be met.
void burin_walk_to_list(BURIN_INOUT(BurinWalk) walk) {
    for (int n = 0; n < BURIN_MAX_CELLS_PER_RAY; ++n) {
        if (walk.ended) break;
        burin_enter_cell(walk);
        if (walk.ended) break;
        bool asked = burin_may_meet(walk);
        if ((asked && walk.cell.count > 0) || ++walk.cells >= BURIN_MAX_CELLS_PER_RAY) break;
        float ground = max(walk.range.x, walk.cell.level);
        if (asked && ground < walk.range.y) {
            if (walk.cell.level >= walk.range.x - BURIN_SAME_DROP * burin_map.depth) {
                walk.hit.mark.element = BURIN_NO_ELEMENT;
                walk.hit.mark.facet = BURIN_FACET_GROUND;
            }
            burin_end_walk(true, ground, walk);
        } else {
            burin_leave_cell(walk);
        }
        if (walk.ended) break;
    }
}

// Follows the ray from drop t0 until it meets the surface or has fallen to t1. At the lowest point there is always surface.
BurinHit burin_trace(BurinRay start, float t0, float t1) {
    // Ground that lies there is met before the ray ends.
    if (t1 >= burin_map.depth) t1 = burin_map.depth * (1.0f + 4.0f * BURIN_SAME_DROP);
    vec2 size = burin_map.size;
    vec2 p = start.origin + start.slope * t0;
    bool repeats = burin_map.repeats != 0;
    vec2 tile = repeats ? floor(p / size) * size : vec2(0.0f, 0.0f);
    BurinWalk walk;
    walk.hit = burin_begin(start, t1);
    walk.hit.ray.origin = start.origin - tile;
    p = p - tile;
    walk.ended = false;
    walk.t = t0;
    walk.t1 = t1;
    walk.outside = !repeats && (p.x < 0.0f || p.y < 0.0f || p.x > size.x || p.y > size.y);
    walk.index = burin_cell_at(p);
    walk.cells = 0;
    for (int n = 0; n < BURIN_MAX_CELLS_PER_RAY; ++n) {
        burin_walk_to_list(walk);
        if (walk.ended || ++walk.cells > BURIN_MAX_CELLS_PER_RAY) break;
        if (burin_trace_cell(walk.cell, walk.range, walk.hit)) walk.ended = true;
        else burin_leave_cell(walk);
        if (walk.ended) break;
    }
    return walk.hit;
}
