#include "area_sampling.hpp"

#include <burin/evaluate.hpp>

namespace burin::reference {
namespace {

constexpr double kEdgeOn = 1e-9;

class Sampler {
  public:
    Sampler(Carver& carver, const AreaRequest& request, AreaSampling& work)
        : carver_(carver), geometry_(carver.geometry()), request_(request), slopes_(request.slopes), eye_(request.direction),
          lamp_{request.slopes.light, request.direction.top, false}, work_(work) {
        work_.plane.clear();
        work_.plane.thin = geometry_.points.thin;
    }

    void show_faces() {
        work_.front.clear();
        work_.hiding.clear();
        const std::uint32_t from = work_.plane.mark();
        Box box;
        for (const Vec2 p : request_.footprint->corners) {
            work_.plane.add(p);
            include(box, p);
        }
        const Polygon whole = work_.plane.close(from);
        for_each_shown(box, eye_, [&](Shown shown) {
            const double facing = eye_.facing(geometry_.faces[shown.face].normal) * (request_.within ? -1.0 : 1.0);
            shown.polygon = clip_to(work_.plane, shown.polygon, whole);
            if (!is_solid(work_.plane, shown.polygon) || !lies_before(shown)) return;
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
            if (lamp_.facing(face.normal) <= kEdgeOn) continue;
            for (const Vec2* q = work_.plane.begin(seen.polygon); q != work_.plane.end(seen.polygon); ++q)
                include(box, lamp_.show(eye_.meet(face.normal, corner_of(face), *q)));
        }
        for_each_shown(box, lamp_, [&](const Shown& shown) {
            if (lamp_.facing(geometry_.faces[shown.face].normal) < 0.0) work_.shading.push_back(shown);
        });
    }

    // Share of what is seen that the light reaches.
    double lit_part(const Shown& seen) {
        const Face& face = geometry_.faces[seen.face];
        if (!slopes_.lit || lamp_.facing(face.normal) <= kEdgeOn) return 0.0;
        const std::uint32_t from = work_.plane.mark();
        for (std::uint32_t i = 0; i < seen.polygon.count; ++i)
            work_.plane.add(lamp_.show(eye_.meet(face.normal, corner_of(face), work_.plane(seen.polygon, i))));
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
        return eye_.meet(face.normal, corner_of(face), burin::reference::middle_of(work_.plane, seen.polygon));
    }

    void keep_corners(const Shown& seen, Share& share) {
        const Face& face = geometry_.faces[seen.face];
        share.first_corner = static_cast<std::uint32_t>(work_.corners.size());
        share.corners = seen.polygon.count;
        for (std::uint32_t i = 0; i < seen.polygon.count; ++i)
            work_.corners.push_back(eye_.meet(face.normal, corner_of(face), work_.plane(seen.polygon, i)));
    }

  private:
    Vec3 corner_of(const Face& face) const { return geometry_.points(face.polygon, 0); }

    // Whether the rays of a beam come to it after they left.
    bool lies_before(const Shown& shown) const {
        if (!request_.leaves) return true;
        const Face& face = geometry_.faces[shown.face];
        const Vec2 q = burin::reference::middle_of(work_.plane, shown.polygon);
        const double rise = eye_.meet(face.normal, corner_of(face), q).z - eye_.meet(request_.normal, request_.corner, q).z;
        return (eye_.rising ? rise : -rise) > 64.0 * geometry_.fine;
    }

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
            if (std::abs(direction.facing(face.normal)) < kEdgeOn) continue;
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
            const Polygon rest = cut_out(work_.plane, p, other.polygon, work_.next);
            if (rest && nearer(other.face, index, burin::reference::middle_of(work_.plane, rest), direction)) continue;
            work_.next.resize(before);
            work_.next.push_back(p);
        }
        work_.kept.swap(work_.next);
    }

    bool nearer(std::uint32_t a, std::uint32_t b, Vec2 q, const Direction& direction) const {
        const Face &first = geometry_.faces[a], &second = geometry_.faces[b];
        const double rise = direction.meet(first.normal, corner_of(first), q).z - direction.meet(second.normal, corner_of(second), q).z;
        return direction.rising ? rise < 0.0 : rise > 0.0;
    }

    Carver& carver_;
    const LocalGeometry& geometry_;
    const AreaRequest& request_;
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

void sample_areas(Carver& carver, const AreaRequest& request, AreaSampling& work, std::vector<Share>& out) {
    Sampler sampler(carver, request, work);
    sampler.show_faces();
    sampler.hide();
    sampler.show_shading();
    for (std::size_t i = 0; i < work.seen.size();) {
        const std::uint32_t index = work.seen[i].face;
        Share share = share_of(carver.geometry().faces[index], carver.gathered());
        Vec3 places;
        const std::size_t first = i;
        for (; i < work.seen.size() && work.seen[i].face == index && (i == first || !request.corners); ++i) {
            const double seen = area_of(work.plane, work.seen[i].polygon) / request.whole;
            share.seen += seen;
            share.lit += seen * sampler.lit_part(work.seen[i]);
            places = places + sampler.place_of(work.seen[i]) * seen;
        }
        if (!(share.seen > 0.0)) continue;
        share.place = places * (1.0 / share.seen);
        if (request.corners) sampler.keep_corners(work.seen[first], share);
        out.push_back(share);
    }
}

}  // namespace burin::reference
