#include "area_sampling.hpp"

#include <burin/evaluate.hpp>

namespace burin::reference {
namespace {

// Parallel rays that fall along `slope` and are known by where they pass the height `top`.
struct Direction {
    Vec2 slope;
    double top;

    Vec2 show(Vec3 p) const { return plan(p) - slope * (top - p.z); }
    // How much a face turns towards where the rays come from; below 0: away.
    double facing(const Face& face) const { return face.normal.z - dot(plan(face.normal), slope); }
    // Height at which the ray through q meets the face's plane.
    double height(const Face& face, Vec3 corner, Vec2 q) const {
        return (dot(face.normal, corner) - dot(plan(face.normal), q + slope * top)) / facing(face);
    }
    Vec3 meet(const Face& face, Vec3 corner, Vec2 q) const {
        const double z = height(face, corner, q);
        const Vec2 p = q + slope * (top - z);
        return {p.x, p.y, z};
    }
};

constexpr double kEdgeOn = 1e-9;

class Sampler {
  public:
    Sampler(Carver& carver, const Slopes& slopes, double top, AreaSampling& work)
        : carver_(carver), geometry_(carver.geometry()), slopes_(slopes), eye_{slopes.view, top}, lamp_{slopes.light, top}, work_(work) {
        work_.plane.clear();
        work_.plane.thin = geometry_.points.thin;
    }

    void show_faces(const Footprint& footprint) {
        work_.front.clear();
        work_.hiding.clear();
        const std::uint32_t from = work_.plane.mark();
        Box box;
        for (const Vec2 p : footprint.corners) {
            work_.plane.add(p);
            include(box, p);
        }
        const Polygon whole = work_.plane.close(from);
        for_each_shown(box, eye_, [&](Shown shown) {
            const double facing = eye_.facing(geometry_.faces[shown.face]);
            for (std::uint32_t i = 0; shown.polygon && i < whole.count; ++i)
                shown.polygon = work_.plane.clip(shown.polygon, edge_of(work_.plane, whole, i));
            if (!is_solid(work_.plane, shown.polygon)) return;
            shown.box = box_of(work_.plane, shown.polygon);
            (facing > 0.0 ? work_.front : work_.hiding).push_back(shown);
        });
    }

    void hide() {
        work_.seen.clear();
        for (const Shown& front : work_.front) {
            work_.kept.assign(1, front.polygon);
            for (const Shown& other : work_.hiding)
                if (other.face != front.face && meet(front.box, other.box)) remove(front.face, other, eye_);
            for (const Polygon p : work_.kept) work_.seen.push_back({front.face, p, {}});
        }
    }

    void show_shading() {
        work_.shading.clear();
        if (!slopes_.lit) return;
        Box box;
        for (const Shown& seen : work_.seen) {
            const Face& face = geometry_.faces[seen.face];
            if (lamp_.facing(face) <= kEdgeOn) continue;
            for (const Vec2* q = work_.plane.begin(seen.polygon); q != work_.plane.end(seen.polygon); ++q)
                include(box, lamp_.show(eye_.meet(face, corner_of(face), *q)));
        }
        for_each_shown(box, lamp_, [&](const Shown& shown) {
            if (lamp_.facing(geometry_.faces[shown.face]) < 0.0) work_.shading.push_back(shown);
        });
    }

    // Share of what is seen that the light reaches.
    double lit_part(const Shown& seen) {
        const Face& face = geometry_.faces[seen.face];
        if (!slopes_.lit || lamp_.facing(face) <= kEdgeOn) return 0.0;
        const std::uint32_t from = work_.plane.mark();
        for (std::uint32_t i = 0; i < seen.polygon.count; ++i)
            work_.plane.add(lamp_.show(eye_.meet(face, corner_of(face), work_.plane(seen.polygon, i))));
        Shown lit{seen.face, work_.plane.close(from), {}};
        const double whole = std::abs(orient(lit));
        if (whole <= 0.0) return 0.0;
        lit.box = box_of(work_.plane, lit.polygon);
        work_.kept.assign(1, lit.polygon);
        for (const Shown& other : work_.shading)
            if (other.face != seen.face && meet(lit.box, other.box)) remove(seen.face, other, lamp_);
        double rest = 0.0;
        for (const Polygon p : work_.kept) rest += burin::reference::area_of(work_.plane, p);
        return std::min(rest / whole, 1.0);
    }

    Vec3 place_of(const Shown& seen) const {
        const Face& face = geometry_.faces[seen.face];
        return eye_.meet(face, corner_of(face), burin::reference::middle_of(work_.plane, seen.polygon));
    }

  private:
    Vec3 corner_of(const Face& face) const { return geometry_.points(face.polygon, 0); }

    // Turns the polygon so that it goes from x towards y; its area.
    double orient(Shown& shown) {
        const double area = burin::reference::area_of(work_.plane, shown.polygon);
        if (area >= 0.0) return area;
        const std::uint32_t from = work_.plane.mark();
        for (std::uint32_t i = shown.polygon.count; i > 0; --i) work_.plane.add(Vec2(work_.plane(shown.polygon, i - 1)));
        shown.polygon = work_.plane.close(from);
        return -area;
    }

    // Calls use(shown) for the pieces of faces that are not seen edge-on, where their boxes meet `box`.
    template <typename Use>
    void for_each_shown(const Box& box, const Direction& direction, const Use& use) {
        for (std::uint32_t i = 0; i < geometry_.faces.size(); ++i) {
            const Face& face = geometry_.faces[i];
            if (std::abs(direction.facing(face)) < kEdgeOn) continue;
            Box whole;
            for (const Vec3* p = geometry_.points.begin(face.polygon); p != geometry_.points.end(face.polygon); ++p) include(whole, direction.show(*p));
            if (!meet(whole, box)) continue;
            const Carving::Pieces pieces = carver_.pieces_of(i);
            for (std::uint32_t k = 0; k < pieces.count; ++k) {
                const Shown shown = show(i, carver_.piece(pieces.first + k), direction);
                if (shown.polygon && meet(shown.box, box)) use(shown);
            }
        }
    }

    Shown show(std::uint32_t face, Polygon polygon, const Direction& direction) {
        Shown shown{face, {}, {}};
        const std::uint32_t from = work_.plane.mark();
        for (const Vec3* p = geometry_.points.begin(polygon); p != geometry_.points.end(polygon); ++p)
            work_.plane.add(direction.show(*p));
        shown.polygon = work_.plane.close(from);
        orient(shown);
        if (!is_solid(work_.plane, shown.polygon)) shown.polygon = {};
        shown.box = box_of(work_.plane, shown.polygon);
        return shown;
    }

    // Takes from work_.kept, parts of a face, what `other` stands before.
    void remove(std::uint32_t index, const Shown& other, const Direction& direction) {
        work_.next.clear();
        for (const Polygon p : work_.kept) {
            const std::size_t before = work_.next.size();
            Polygon rest = p;
            for (std::uint32_t i = 0; rest && i < other.polygon.count; ++i) {
                Polygon inside, outside;
                work_.plane.split(rest, edge_of(work_.plane, other.polygon, i), inside, outside);
                if (outside) work_.next.push_back(outside);
                rest = inside;
            }
            if (rest && nearer(other.face, index, burin::reference::middle_of(work_.plane, rest), direction)) continue;
            work_.next.resize(before);
            work_.next.push_back(p);
        }
        work_.kept.swap(work_.next);
    }

    bool nearer(std::uint32_t a, std::uint32_t b, Vec2 q, const Direction& direction) const {
        const Face &first = geometry_.faces[a], &second = geometry_.faces[b];
        return direction.height(first, corner_of(first), q) > direction.height(second, corner_of(second), q);
    }

    Carver& carver_;
    const LocalGeometry& geometry_;
    const Slopes& slopes_;
    Direction eye_, lamp_;
    AreaSampling& work_;
};

Share share_of(const Face& face, const Gathered& gathered) {
    Share share;
    share.element = face.instance == kGround ? kGround : gathered.instances[face.instance].element;
    share.facet = face.facet;
    share.normal = face.normal;
    return share;
}

}  // namespace

void sample_areas(Carver& carver, const Footprint& footprint, double top, const Slopes& slopes, double whole, AreaSampling& work,
                  std::vector<Share>& out) {
    Sampler sampler(carver, slopes, top, work);
    sampler.show_faces(footprint);
    sampler.hide();
    sampler.show_shading();
    for (std::size_t i = 0; i < work.seen.size();) {
        const std::uint32_t index = work.seen[i].face;
        Share share = share_of(carver.geometry().faces[index], carver.gathered());
        Vec3 places;
        for (; i < work.seen.size() && work.seen[i].face == index; ++i) {
            const double seen = area_of(work.plane, work.seen[i].polygon) / whole;
            share.seen += seen;
            share.lit += seen * sampler.lit_part(work.seen[i]);
            places = places + sampler.place_of(work.seen[i]) * seen;
        }
        if (!(share.seen > 0.0)) continue;
        share.place = places * (1.0 / share.seen);
        out.push_back(share);
    }
}

}  // namespace burin::reference
