#include "carve.hpp"

#include "evaluate_prepare.hpp"

namespace burin::reference {
namespace {

class Carver {
  public:
    Carver(LocalGeometry& geometry, const GroovedSurface& surface, const Gathered& gathered, Carving& out)
        : geometry_(geometry), surface_(surface), gathered_(gathered), out_(out) {}

    void prepare() {
        out_.halves.clear();
        out_.first_half.clear();
        for (const Brush& brush : geometry_.brushes) {
            out_.first_half.push_back(static_cast<std::uint32_t>(out_.halves.size()));
            if (brush.has_bottom) out_.halves.push_back({{brush.bottom.g.x, brush.bottom.g.y, -1.0}, -brush.bottom.c});
            if (brush.has_top) out_.halves.push_back({{-brush.top.g.x, -brush.top.g.y, 1.0}, brush.top.c});
            for (std::uint32_t i = 0; i < brush.polygon.count; ++i) {
                const HalfPlane edge = edge_of(geometry_.plan, brush.polygon, i);
                out_.halves.push_back({{edge.n.x, edge.n.y, 0.0}, edge.d});
            }
        }
        out_.first_half.push_back(static_cast<std::uint32_t>(out_.halves.size()));
    }

    void carve(std::uint32_t index) {
        const Face face = geometry_.faces[index];
        out_.kept.clear();
        const double level = face.level + geometry_.fine;
        if (face.kind == FaceKind::ground)
            keep(face.polygon);
        else if (face.kind == FaceKind::add)
            keep(geometry_.points.clip(face.polygon, HalfSpace{{0, 0, -1}, -level}));
        else
            keep_solid(face);
        for (std::size_t b = 0; b < geometry_.brushes.size() && !out_.kept.empty(); ++b) {
            const Brush& brush = geometry_.brushes[b];
            if (!meet(brush.box, face.box) || (face.kind == FaceKind::cut && !brush.cut) || spares(face, brush)) continue;
            remove(face, b, tie(face, brush));
        }
        if (face.wall) keep_first_wall(face);
        for (const Polygon p : out_.kept) out_.pieces.push_back({index, p});
    }

  private:
    // Of walls at one place that of the first element stays: behind what stands, and before what is cut, lies no other's.
    void keep_first_wall(const Face& face) {
        Face turned = face;
        turned.normal = face.normal * -1.0;
        const bool cut = face.kind == FaceKind::cut;
        for (std::size_t b = 0; b < geometry_.brushes.size() && !out_.kept.empty(); ++b) {
            const Brush& brush = geometry_.brushes[b];
            if (brush.cut == cut && brush.instance < face.instance && meet(brush.box, face.box)) remove(turned, b, -geometry_.fine);
        }
    }

    void keep(Polygon p) {
        if (p) out_.kept.push_back(p);
    }

    bool overhangs(std::uint32_t instance) const {
        const auto& e = surface_.truth().prepared().elements[gathered_.instances[instance].element];
        return !surface_.profiles()[e.profile].height_field;
    }
    // Whether the brush is the face's own and bounded by it.
    bool spares(const Face& face, const Brush& brush) const {
        if (face.wall || face.instance != brush.instance) return false;
        return face.kind == FaceKind::cut || !brush.cut || !overhangs(face.instance);
    }
    // By how much a brush is larger than it is when faces coincide.
    double tie(const Face& face, const Brush& brush) const {
        if (face.wall) return geometry_.fine;
        const bool same_kind = (face.kind == FaceKind::cut) == brush.cut && face.kind != FaceKind::ground;
        return same_kind && brush.instance < face.instance ? geometry_.fine : -geometry_.fine;
    }

    // What of a cut's face lies in the ground or in additions of others.
    void keep_solid(const Face& face) {
        Polygon below, above;
        geometry_.points.split(face.polygon, HalfSpace{{0, 0, 1}, face.level - geometry_.fine}, below, above);
        keep(below);
        if (!above) return;
        out_.solid.assign(1, above);
        for (std::size_t b = 0; b < geometry_.brushes.size() && !out_.solid.empty(); ++b) {
            const Brush& brush = geometry_.brushes[b];
            if (brush.cut || !meet(brush.box, face.box) || (brush.instance == face.instance && !face.wall)) continue;
            out_.next.clear();
            for (const Polygon p : out_.solid) keep(subtract(face, p, b, -geometry_.fine));
            out_.solid.swap(out_.next);
        }
    }

    void remove(const Face& face, std::size_t brush, double grow) {
        out_.next.clear();
        for (const Polygon p : out_.kept) subtract(face, p, brush, grow);
        out_.kept.swap(out_.next);
    }

    // Walls stand on borders of brushes. What is added beside one hides it where that lies before it; what is cut takes it where that
    // lies behind it, and so does all else with the wall of a cut.
    Vec2 judged_at(const Face& face, const Brush& brush) const {
        if (!face.wall) return {0, 0};
        return plan(face.normal) * (brush.cut || face.kind == FaceKind::cut ? -8.0 * geometry_.fine : 8.0 * geometry_.fine);
    }

    // Adds what lies outside of the brush to out_.next; returns what lies inside. `grow`: by how much its top and bottom are moved outwards.
    Polygon subtract(const Face& face, Polygon p, std::size_t index, double grow) {
        const Brush& brush = geometry_.brushes[index];
        const std::uint32_t first = out_.first_half[index], last = out_.first_half[index + 1];
        const std::uint32_t sides = last - brush.polygon.count;
        const Vec2 moved = judged_at(face, brush);
        const auto half_of = [&](std::uint32_t k) {
            HalfSpace half = out_.halves[k];
            half.d += k < sides ? grow : -dot(plan(half.n), moved);
            return half;
        };
        for (std::uint32_t k = first; k < last; ++k)
            if (all_beyond(p, half_of(k))) {
                out_.next.push_back(p);
                return {};
            }
        Polygon rest = p;
        for (std::uint32_t k = first; k < last && rest; ++k) {
            Polygon inside, outside;
            geometry_.points.split(rest, half_of(k), inside, outside);
            if (outside) out_.next.push_back(outside);
            rest = inside;
        }
        return rest;
    }

    bool all_beyond(Polygon p, const HalfSpace& half) const {
        for (const Vec3* q = geometry_.points.begin(p); q != geometry_.points.end(p); ++q)
            if (beyond(half, *q) < -geometry_.points.thin) return false;
        return true;
    }

    LocalGeometry& geometry_;
    const GroovedSurface& surface_;
    const Gathered& gathered_;
    Carving& out_;
};

}  // namespace

void carve_faces(LocalGeometry& geometry, const GroovedSurface& surface, const Gathered& gathered, Carving& out) {
    out.pieces.clear();
    Carver carver(geometry, surface, gathered, out);
    carver.prepare();
    for (std::uint32_t i = 0; i < geometry.faces.size(); ++i) carver.carve(i);
}

}  // namespace burin::reference
