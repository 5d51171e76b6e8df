#include "zones.hpp"

#include <algorithm>
#include <cmath>

#include "evaluate_prepare.hpp"
#include "stations.hpp"

namespace burin::reference {
namespace {

// `edge_at(i)` for the edges of a convex polygon.
template <typename Edge>
Stretch stretch_between(std::uint32_t count, const Edge& edge_at, double fine, Vec2 a, Vec2 b) {
    Stretch part;
    for (std::uint32_t i = 0; i < count; ++i) {
        const HalfPlane edge = edge_at(i);
        const double at_a = beyond(edge, a) + fine, at_b = beyond(edge, b) + fine;
        if (at_a >= 0.0 && at_b >= 0.0) return {1.0, 0.0};
        if (at_a > 0.0) part.low = std::max(part.low, at_a / (at_a - at_b));
        if (at_b > 0.0) part.high = std::min(part.high, at_a / (at_a - at_b));
    }
    return part;
}

}  // namespace

Stretch stretch_inside(const LocalGeometry& out, const Zone& zone, Vec2 a, Vec2 b) {
    if (std::max(a.x, b.x) < zone.box.low.x || std::min(a.x, b.x) > zone.box.high.x || std::max(a.y, b.y) < zone.box.low.y ||
        std::min(a.y, b.y) > zone.box.high.y)
        return {1.0, 0.0};
    return stretch_between(zone.polygon.count, [&](std::uint32_t i) { return out.edges[zone.first_edge + i]; }, out.fine, a, b);
}

void raise_wall(LocalGeometry& out, Face& face, Vec3 a, Vec3 b, double to, Vec2 toward) {
    face.wall = true;
    face.normal = {toward.x, toward.y, 0.0};
    face.box = {};
    const std::uint32_t from = out.points.mark();
    for (const Vec3 corner : {a, b, Vec3{b.x, b.y, to}, Vec3{a.x, a.y, to}}) {
        out.points.add(corner);
        include(face.box, plan(corner));
    }
    face.polygon = out.points.close(from);
}

namespace {

// The region's box without the corners that low view and light leave far from it.
Polygon polygon_of(LocalGeometry& out, const Region& region) {
    const Box& box = region.box;
    const std::uint32_t from = out.plan.mark();
    for (const Vec2 corner : {box.low, Vec2{box.high.x, box.low.y}, box.high, Vec2{box.low.x, box.high.y}}) out.plan.add(corner);
    Polygon p = out.plan.close(from);
    for (const Region::Slab& slab : region.slabs) {
        p = out.plan.clip(p, HalfPlane{slab.n, slab.high});
        p = out.plan.clip(p, HalfPlane{-slab.n, -slab.low});
    }
    return p;
}

Polygon overlap(LocalGeometry& out, Polygon p, const Zone& zone) {
    for (std::uint32_t i = 0; p && i < zone.polygon.count; ++i) p = out.plan.clip(p, out.edges[zone.first_edge + i]);
    return is_solid(out.plan, p) ? p : Polygon{};
}

void split_zone(LocalGeometry& out, std::size_t i, const HalfPlane& line) {
    Polygon inside, outside;
    out.plan.split(out.zones[i].polygon, line, inside, outside);
    if (!inside || !outside) return;
    out.zones[i].polygon = inside;
    out.zones.push_back({outside, 0.0, {}, false, 0});
}

// Those that the chord runs through.
void split_zones(LocalGeometry& out, const Chord& chord) {
    const Vec2 n = normal_of(unit(chord.b - chord.a));
    for (std::size_t i = 0, count = out.zones.size(); i < count; ++i) {
        const Polygon p = out.zones[i].polygon;
        const Stretch part = stretch_between(p.count, [&](std::uint32_t k) { return edge_of(out.plan, p, k); }, out.fine, chord.a, chord.b);
        if (part.low < part.high) split_zone(out, i, {n, dot(n, chord.a)});
    }
}

void split_at_borders(const GroovedSurface& surface, LocalGeometry& out) {
    const Vec2 size = surface.pattern().size;
    for (const HalfPlane& border : {HalfPlane{{-1, 0}, 0}, HalfPlane{{0, -1}, 0}, HalfPlane{{1, 0}, size.x}, HalfPlane{{0, 1}, size.y}})
        for (std::size_t i = 0, count = out.zones.size(); i < count; ++i) split_zone(out, i, border);
}

void find_chords(const GroovedSurface& surface, const Gathered& gathered, const SweepOptions& options, LocalGeometry& out) {
    out.chords.clear();
    if (!gathered.steps) return;
    for (std::uint32_t i = 0; i < gathered.instances.size(); ++i) {
        const Instance& instance = gathered.instances[i];
        const PreparedElement& e = surface.truth().prepared().elements[instance.element];
        if (!e.step) continue;
        const auto& list = out.stations.list;
        place_stations(e, surface.pattern().elements[instance.element], instance.shift, {&gathered.region, options.tolerance, 0.0}, out.stations);
        for (std::size_t k = 0; k + 1 < list.size(); ++k)
            if (length(list[k + 1].origin - list[k].origin) > 0.0) out.chords.push_back({list[k].origin, list[k + 1].origin, i});
    }
}

// It neither hides nor shades: only what rays meet of it is put.
void put_ground(const GroovedSurface& surface, const Gathered& gathered, const Zone& zone, LocalGeometry& out) {
    Polygon polygon = zone.polygon;
    if (gathered.from_top) {
        const std::uint32_t mark = out.plan.mark();
        for (const Vec2 p : gathered.region.footprint.corners) out.plan.add(p + gathered.view * (surface.top() - zone.level));
        const Polygon met = out.plan.close(mark);
        polygon = clip_to(out.plan, polygon, met);
        if (!is_solid(out.plan, polygon)) return;
    }
    Face face;
    face.facet = kGround;
    face.instance = kGround;
    face.level = zone.level;
    face.normal = {0, 0, 1};
    face.box = box_of(out.plan, polygon);
    const std::uint32_t from = out.points.mark();
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        const Vec2 p = out.plan(polygon, i);
        out.points.add({p.x, p.y, zone.level});
    }
    face.polygon = out.points.close(from);
    out.faces.push_back(face);
}

// Between the levels on both sides of a line from a to b. `outward` points to the lower.
void put_ground_wall(Vec2 a, Vec2 b, Vec2 outward, double low, double high, std::uint32_t facet, std::uint32_t instance, LocalGeometry& out) {
    Face face;
    face.instance = instance;
    face.facet = facet;
    face.level = low;
    raise_wall(out, face, {a.x, a.y, low}, {b.x, b.y, low}, high, outward);
    out.faces.push_back(face);
}

// The ground's own steps along a line: where its sides are of different level. Outlines may run back over themselves.
void put_ground_walls(Vec2 a, Vec2 b, std::uint32_t facet, std::uint32_t instance, LocalGeometry& out) {
    const Vec2 n = normal_of(unit(b - a)), off = n * (64.0 * out.fine);
    for (const Zone& right : out.zones) {
        const Stretch first = stretch_inside(out, right, a + off, b + off);
        if (first.low >= first.high) continue;
        for (const Zone& left : out.zones) {
            if (std::abs(left.level - right.level) <= 16.0 * out.fine) continue;
            const Stretch second = stretch_inside(out, left, a - off, b - off);
            const double from = std::max(first.low, second.low), to = std::min(first.high, second.high);
            if (from >= to) continue;
            put_ground_wall(lerp(a, b, from), lerp(a, b, to), left.level > right.level ? n : -n, std::min(left.level, right.level),
                            std::max(left.level, right.level), facet, instance, out);
        }
    }
}

// The upright facet of a step's profile on its path line; a wall without one.
std::uint32_t facet_on_line(const SlabbedProfile& profile) {
    for (const ProfileFacet& facet : profile.facets)
        if (facet.from == facet.to && profile.lines[facet.from] == 0.0) return facet.facet;
    return kWall;
}

void put_border_walls(const GroovedSurface& surface, LocalGeometry& out) {
    const Vec2 size = surface.pattern().size, corners[] = {{0, 0}, {size.x, 0}, size, {0, size.y}};
    for (std::size_t i = 0; i < 4; ++i) put_ground_walls(corners[i], corners[(i + 1) % 4], kWall, kGround, out);
}

}  // namespace

void divide_zones(const GroovedSurface& surface, const Gathered& gathered, const SweepOptions& options, LocalGeometry& out) {
    out.zones.push_back({polygon_of(out, gathered.region), 0.0, {}, false, 0});
    if (surface.pattern().wrap == Wrap::clamp) split_at_borders(surface, out);
    find_chords(surface, gathered, options, out);
    for (const Chord& chord : out.chords) split_zones(out, chord);
    for (Zone& zone : out.zones) {
        const Vec2 middle = middle_of(out.plan, zone.polygon);
        zone.level = ground_near(surface, middle);
        zone.outside = !truth::inside_map(surface.truth().prepared(), middle);
        zone.box = box_of(out.plan, zone.polygon);
        zone.first_edge = static_cast<std::uint32_t>(out.edges.size());
        for (std::uint32_t i = 0; i < zone.polygon.count; ++i) out.edges.push_back(edge_of(out.plan, zone.polygon, i));
        put_ground(surface, gathered, zone, out);
    }
    for (const Chord& chord : out.chords) {
        const auto& e = surface.truth().prepared().elements[gathered.instances[chord.instance].element];
        put_ground_walls(chord.a, chord.b, facet_on_line(surface.profiles()[e.profile]), chord.instance, out);
    }
    if (surface.pattern().wrap == Wrap::clamp && out.zones.size() > 1) put_border_walls(surface, out);
}

bool acts_in(const LocalGeometry& out, const Zone& zone, double level) {
    return !zone.outside && std::abs(zone.level - level) <= 16.0 * out.fine;
}

void limit_to_zones(LocalGeometry& out, const Brush& brush) {
    const bool whole = std::all_of(out.zones.begin(), out.zones.end(), [&](const Zone& zone) {
        return acts_in(out, zone, brush.level) || !meet(zone.box, brush.box) || !overlap(out, brush.polygon, zone);
    });
    if (whole) return out.brushes.push_back(brush);
    for (const Zone& zone : out.zones) {
        if (!acts_in(out, zone, brush.level) || !meet(zone.box, brush.box)) continue;
        Brush part = brush;
        part.polygon = overlap(out, brush.polygon, zone);
        if (!part.polygon) continue;
        part.box = box_of(out.plan, part.polygon);
        out.brushes.push_back(part);
    }
}

namespace {

Polygon inside_zone(LocalGeometry& out, Polygon p, const Zone& zone) {
    for (std::uint32_t i = 0; p && i < zone.polygon.count; ++i) {
        const HalfPlane& edge = out.edges[zone.first_edge + i];
        p = out.points.clip(p, HalfSpace{{edge.n.x, edge.n.y, 0.0}, edge.d});
    }
    return p;
}

// The wall over, or under, the edge from a to b of a face that ends at a zone of another level.
void wall_edge(LocalGeometry& out, const Face& face, Vec3 a, Vec3 b, Vec2 outward, double level, double far) {
    Face wall = face;
    wall.facet = kWall;
    wall.level = level;
    raise_wall(out, wall, a, b, far, face.kind == FaceKind::cut ? -outward : outward);
    out.faces.push_back(wall);
}

// What a groove or ridge that stops at a step, or at the border of the map, leaves open: above or below each edge on the zone's
// border, as far as another level lies beyond it.
void wall_border(LocalGeometry& out, const Face& face, const Zone& zone) {
    if (face.wall || face.kind == FaceKind::ground) return;
    double highest = face.level;
    for (const Zone& other : out.zones) highest = std::max(highest, other.level);
    const double far = face.kind == FaceKind::cut ? highest : face.level;
    for (std::uint32_t k = 0; k < zone.polygon.count; ++k) {
        const HalfPlane edge = out.edges[zone.first_edge + k];
        const Vec2 off = edge.n * (64.0 * out.fine);
        for (std::uint32_t i = 0; i < face.polygon.count; ++i) {
            const Vec3 a = out.points(face.polygon, i), b = out.points(face.polygon, i + 1 < face.polygon.count ? i + 1 : 0);
            if (std::abs(beyond(edge, plan(a))) > out.fine || std::abs(beyond(edge, plan(b))) > out.fine) continue;
            if (length(plan(b) - plan(a)) <= out.fine) continue;
            for (const Zone& other : out.zones) {
                if (acts_in(out, other, face.level)) continue;
                const Stretch part = stretch_inside(out, other, plan(a) + off, plan(b) + off);
                if (part.low < part.high) wall_edge(out, face, a + (b - a) * part.low, a + (b - a) * part.high, edge.n, other.level, far);
            }
        }
    }
}

}  // namespace

void limit_to_zones(LocalGeometry& out, const Face& face) {
    if (out.zones.size() == 1) {
        if (acts_in(out, out.zones[0], face.level)) out.faces.push_back(face);
        return;
    }
    for (const Zone& zone : out.zones) {
        if (!acts_in(out, zone, face.level) || !meet(zone.box, face.box)) continue;
        Face part = face;
        part.polygon = inside_zone(out, face.polygon, zone);
        if (!part.polygon) continue;
        out.faces.push_back(part);
        wall_border(out, part, zone);
    }
}

}  // namespace burin::reference
