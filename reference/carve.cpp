#include "carve.hpp"

#include "evaluate_prepare.hpp"

namespace burin::reference {

Carver::Carver(LocalGeometry& geometry, const GroovedSurface& surface, const Gathered& gathered, Carving& work)
    : geometry_(geometry), surface_(surface), gathered_(gathered), work_(work) {
    work_.pieces.clear();
    work_.of_face.assign(geometry.faces.size(), {});
    work_.halves.clear();
    work_.first_half.clear();
    for (const Brush& brush : geometry_.brushes) {
        work_.first_half.push_back(static_cast<std::uint32_t>(work_.halves.size()));
        if (brush.has_bottom) work_.halves.push_back({{brush.bottom.g.x, brush.bottom.g.y, -1.0}, -brush.bottom.c});
        if (brush.has_top) work_.halves.push_back({{-brush.top.g.x, -brush.top.g.y, 1.0}, brush.top.c});
        for (std::uint32_t i = 0; i < brush.polygon.count; ++i) {
            const HalfPlane edge = edge_of(geometry_.plan, brush.polygon, i);
            work_.halves.push_back({{edge.n.x, edge.n.y, 0.0}, edge.d});
        }
    }
    work_.first_half.push_back(static_cast<std::uint32_t>(work_.halves.size()));
}

Carving::Pieces Carver::pieces_of(std::uint32_t face) {
    Carving::Pieces& pieces = work_.of_face[face];
    if (pieces.carved) return pieces;
    carve(geometry_.faces[face]);
    pieces = {static_cast<std::uint32_t>(work_.pieces.size()), static_cast<std::uint32_t>(work_.kept.size()), true};
    work_.pieces.insert(work_.pieces.end(), work_.kept.begin(), work_.kept.end());
    return pieces;
}

void Carver::carve(const Face& face) {
    work_.kept.clear();
    if (face.kind == FaceKind::ground)
        keep(face.polygon);
    else if (face.kind == FaceKind::add)
        keep(geometry_.points.clip(face.polygon, HalfSpace{{0, 0, -1}, -(face.level + geometry_.fine)}));
    else
        keep_solid(face);
    for (std::size_t b = 0; b < geometry_.brushes.size() && !work_.kept.empty(); ++b) {
        const Brush& brush = geometry_.brushes[b];
        if (!meet(brush.box, face.box) || (face.kind == FaceKind::cut && !brush.cut) || spares(face, brush)) continue;
        remove(face, b, tie(face, brush));
    }
    if (face.wall && face.kind != FaceKind::ground) keep_first_wall(face);
}

// Of walls at one place that of the first element stays: behind what stands, and before what is cut, lies no other's.
void Carver::keep_first_wall(const Face& face) {
    Face turned = face;
    turned.normal = face.normal * -1.0;
    const bool cut = face.kind == FaceKind::cut;
    for (std::size_t b = 0; b < geometry_.brushes.size() && !work_.kept.empty(); ++b) {
        const Brush& brush = geometry_.brushes[b];
        if (brush.cut == cut && brush.instance < face.instance && meet(brush.box, face.box)) remove(turned, b, -geometry_.fine);
    }
}

void Carver::keep(Polygon p) {
    if (p) work_.kept.push_back(part_of(p));
}

bool Carver::overhangs(std::uint32_t instance) const {
    const auto& e = surface_.truth().prepared().elements[gathered_.instances[instance].element];
    return !surface_.profiles()[e.profile].height_field;
}

// Whether the brush is the face's own and bounded by it.
bool Carver::spares(const Face& face, const Brush& brush) const {
    if (face.wall || face.instance != brush.instance) return false;
    return face.kind == FaceKind::cut || !brush.cut || !overhangs(face.instance);
}

// By how much a brush is larger than it is when faces coincide.
double Carver::tie(const Face& face, const Brush& brush) const {
    if (face.wall) return geometry_.fine;
    const bool same_kind = (face.kind == FaceKind::cut) == brush.cut && face.kind != FaceKind::ground;
    return same_kind && brush.instance < face.instance ? geometry_.fine : -geometry_.fine;
}

// What of a cut's face lies in the ground or in additions of others.
void Carver::keep_solid(const Face& face) {
    Polygon below, above;
    geometry_.points.split(face.polygon, HalfSpace{{0, 0, 1}, face.level - geometry_.fine}, below, above);
    keep(below);
    if (!above) return;
    work_.solid.assign(1, part_of(above));
    for (std::size_t b = 0; b < geometry_.brushes.size() && !work_.solid.empty(); ++b) {
        const Brush& brush = geometry_.brushes[b];
        if (brush.cut || !meet(brush.box, face.box) || (brush.instance == face.instance && !face.wall)) continue;
        work_.next.clear();
        for (const Part& p : work_.solid) keep(subtract(face, p, b, -geometry_.fine));
        work_.solid.swap(work_.next);
    }
}

void Carver::remove(const Face& face, std::size_t brush, double grow) {
    work_.next.clear();
    for (const Part& p : work_.kept) subtract(face, p, brush, grow);
    work_.kept.swap(work_.next);
}

// Walls stand on borders of brushes. What is added beside one hides it where that lies before it; what is cut takes it where that
// lies behind it, and so does all else with the wall of a cut.
Vec2 Carver::judged_at(const Face& face, const Brush& brush) const {
    if (!face.wall) return {0, 0};
    return plan(face.normal) * (brush.cut || face.kind == FaceKind::cut ? -8.0 * geometry_.fine : 8.0 * geometry_.fine);
}

// Adds what lies outside of the brush to work_.next; returns what lies inside. `grow`: by how much its top and bottom are moved outwards.
Polygon Carver::subtract(const Face& face, const Part& part, std::size_t index, double grow) {
    const Brush& brush = geometry_.brushes[index];
    if (!meet(part.box, brush.box)) {
        work_.next.push_back(part);
        return {};
    }
    const std::uint32_t first = work_.first_half[index], last = work_.first_half[index + 1];
    const std::uint32_t sides = last - brush.polygon.count;
    const Vec2 moved = judged_at(face, brush);
    const auto half_of = [&](std::uint32_t k) {
        HalfSpace half = work_.halves[k];
        half.d += k < sides ? grow : -dot(plan(half.n), moved);
        return half;
    };
    for (std::uint32_t k = first; k < last; ++k)
        if (all_beyond(part.polygon, half_of(k))) {
            work_.next.push_back(part);
            return {};
        }
    Polygon rest = part.polygon;
    for (std::uint32_t k = first; k < last && rest; ++k) {
        Polygon inside, outside;
        geometry_.points.split(rest, half_of(k), inside, outside);
        if (outside) work_.next.push_back(part_of(outside));
        rest = inside;
    }
    return rest;
}

Part Carver::part_of(Polygon p) const {
    Part part{p, {}};
    for (const Vec3* q = geometry_.points.begin(p); q != geometry_.points.end(p); ++q) include(part.box, plan(*q));
    return part;
}

bool Carver::all_beyond(Polygon p, const HalfSpace& half) const {
    for (const Vec3* q = geometry_.points.begin(p); q != geometry_.points.end(p); ++q)
        if (beyond(half, *q) < -geometry_.points.thin) return false;
    return true;
}

}  // namespace burin::reference
