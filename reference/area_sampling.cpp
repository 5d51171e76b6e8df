#include "area_sampling.hpp"

#include <algorithm>

#include <burin/evaluate.hpp>

namespace burin::reference {
namespace {

constexpr double kEdgeOn = 1e-9;

class Sampler {
  public:
    Sampler(Blocks& blocks, const AreaRequest& request, AreaSampling& work)
        : blocks_(blocks), request_(request), slopes_(request.slopes), eye_(request.direction), lamp_{request.slopes.light, request.direction.top, false},
          across_(normal_of(unit(request.slopes.view))), work_(work) {
        work_.plane.clear();
        work_.plane.thin = 0.25 * request.fine;
    }

    void show_faces() {
        work_.front.clear();
        work_.hiding.clear();
        const std::uint32_t from = work_.plane.mark();
        Window window{across_};
        for (const Vec2 p : request_.footprint->corners) {
            work_.plane.add(p);
            window.include(p);
        }
        const Polygon whole = work_.plane.close(from);
        const double sign = request_.within ? -1.0 : 1.0;
        for_each_shown(window, eye_, request_.lowest, [](double) { return true; }, [&](Shown shown) {
            const double facing = eye_.facing(shown.normal) * sign;
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
                if (meet(front.box, other.box)) remove(front, other, eye_);
            for (const Polygon p : work_.kept) {
                work_.seen.push_back(front);
                work_.seen.back().polygon = p;
            }
        }
    }

    void show_shading() {
        work_.shading.clear();
        if (!slopes_.lit) return;
        Window window{across_};
        double lowest = 1e300;
        for (const Shown& seen : work_.seen) {
            if (lamp_.facing(seen.normal) <= kEdgeOn) continue;
            for (const Vec2* q = work_.plane.begin(seen.polygon); q != work_.plane.end(seen.polygon); ++q) {
                const Vec3 p = eye_.meet(seen.normal, seen.corner, *q);
                window.include(lamp_.show(p));
                lowest = std::min(lowest, p.z);
            }
        }
        if (lowest >= request_.highest) return;
        for_each_shown(window, lamp_, lowest, [](double facing) { return facing < 0.0; }, [&](const Shown& shown) { work_.shading.push_back(shown); });
    }

    // Share of what is seen that the light reaches.
    double lit_part(const Shown& seen) {
        if (!slopes_.lit || lamp_.facing(seen.normal) <= kEdgeOn) return 0.0;
        const std::uint32_t from = work_.plane.mark();
        for (std::uint32_t i = 0; i < seen.polygon.count; ++i) work_.plane.add(lamp_.show(eye_.meet(seen.normal, seen.corner, work_.plane(seen.polygon, i))));
        Shown lit = seen;
        lit.polygon = work_.plane.close(from);
        const double whole = std::abs(orient(lit));
        if (whole <= 0.0) return 0.0;
        lit.box = box_of(work_.plane, lit.polygon);
        work_.kept.assign(1, lit.polygon);
        for (const Shown& other : work_.shading)
            if (meet(lit.box, other.box)) remove(seen, other, lamp_);
        double rest = 0.0;
        for (const Polygon p : work_.kept) rest += burin::reference::area_of(work_.plane, p);
        return std::min(rest / whole, 1.0);
    }

    Vec3 place_of(const Shown& seen) const {
        return eye_.meet(seen.normal, seen.corner, burin::reference::middle_of(work_.plane, seen.polygon));
    }

    void keep_corners(const Shown& seen, Share& share) {
        share.first_corner = static_cast<std::uint32_t>(work_.corners.size());
        share.corners = seen.polygon.count;
        for (std::uint32_t i = 0; i < seen.polygon.count; ++i)
            work_.corners.push_back(eye_.meet(seen.normal, seen.corner, work_.plane(seen.polygon, i)));
    }

  private:
    // Whether the rays of a beam come to it after they left.
    bool lies_before(const Shown& shown) const {
        if (!request_.leaves) return true;
        const Vec2 q = burin::reference::middle_of(work_.plane, shown.polygon);
        const double rise = eye_.meet(shown.normal, shown.corner, q).z - eye_.meet(request_.normal, request_.corner, q).z;
        return (eye_.rising ? rise : -rise) > 64.0 * request_.fine;
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

    // Calls use(shown) for the pieces of faces that are not seen edge-on and whose facing is wanted, where their boxes meet the window; of those that lie
    // wholly below `lowest` perhaps not.
    template <typename Wanted, typename Use>
    void for_each_shown(const Window& window, const Direction& direction, double lowest, const Wanted& wanted, const Use& use) {
        std::uint32_t met = 0;
        blocks_.for_each_face(window, direction, lowest, request_.highest, [&](Block& block, std::uint32_t i) {
            const Face face = block.geometry.faces[i];
            const double facing = direction.facing(face.normal);
            if (std::abs(facing) < kEdgeOn || !wanted(facing)) return;
            Shown shown;
            shown.face = met++;
            shown.element = face.instance == kGround ? kGround : block.gathered.instances[face.instance].element;
            shown.facet = face.facet;
            shown.normal = face.normal;
            shown.corner = block.geometry.points(face.polygon, 0);
            const Carving::Pieces pieces = block.carver->pieces_of(i);
            for (std::uint32_t k = 0; k < pieces.count; ++k) {
                const Part& part = block.carver->piece(pieces.first + k);
                if (!window.meets(direction.show(part.box, block.extents[i].lowest, block.extents[i].highest))) continue;
                if (show(block.geometry.points, part.polygon, direction, shown) && window.meets(shown.box)) use(shown);
            }
        });
    }

    // False: nothing of it is left.
    bool show(const Polygons<Vec3>& points, Polygon polygon, const Direction& direction, Shown& shown) {
        const std::uint32_t from = work_.plane.mark();
        for (const Vec3* p = points.begin(polygon); p != points.end(polygon); ++p) work_.plane.add(direction.show(*p));
        shown.polygon = work_.plane.close(from);
        orient(shown);
        if (!is_solid(work_.plane, shown.polygon)) return false;
        shown.box = box_of(work_.plane, shown.polygon);
        return true;
    }

    // Takes from work_.kept, parts of a face, what `other` stands before.
    void remove(const Shown& own, const Shown& other, const Direction& direction) {
        work_.next.clear();
        for (const Polygon p : work_.kept) {
            const std::size_t before = work_.next.size();
            if (!ever_nearer(other, own, p, direction) || parts(work_.plane, other.polygon, p) || parts(work_.plane, p, other.polygon)) {
                work_.next.push_back(p);
                continue;
            }
            const Polygon rest = cut_out(work_.plane, p, other.polygon, work_.next);
            if (rest && nearer(other, own, burin::reference::middle_of(work_.plane, rest), direction)) continue;
            work_.next.resize(before);
            work_.next.push_back(p);
        }
        work_.kept.swap(work_.next);
    }

    // False: a lies behind b all over p. Both are flat.
    bool ever_nearer(const Shown& a, const Shown& b, Polygon p, const Direction& direction) const {
        return std::any_of(work_.plane.begin(p), work_.plane.end(p), [&](Vec2 q) { return nearer(a, b, q, direction); });
    }

    static bool nearer(const Shown& a, const Shown& b, Vec2 q, const Direction& direction) {
        const double rise = direction.meet(a.normal, a.corner, q).z - direction.meet(b.normal, b.corner, q).z;
        return direction.rising ? rise < 0.0 : rise > 0.0;
    }

    Blocks& blocks_;
    const AreaRequest& request_;
    const Slopes& slopes_;
    Direction eye_, lamp_;
    Vec2 across_;  // what is seen from low down is long
    AreaSampling& work_;
};

Share share_of(const Shown& seen) {
    Share share;
    share.element = seen.element;
    share.facet = seen.facet;
    share.normal = seen.normal;
    return share;
}

}  // namespace

void sample_areas(Blocks& blocks, const AreaRequest& request, AreaSampling& work, std::vector<Share>& out) {
    Sampler sampler(blocks, request, work);
    sampler.show_faces();
    sampler.hide();
    sampler.show_shading();
    for (std::size_t i = 0; i < work.seen.size();) {
        const std::uint32_t index = work.seen[i].face;
        Share share = share_of(work.seen[i]);
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
