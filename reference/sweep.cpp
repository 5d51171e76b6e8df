#include "sweep.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "evaluate_prepare.hpp"
#include "stations.hpp"
#include "zones.hpp"

#include "layout.h"

namespace burin::reference {
namespace {

// As many values of b as a profile has points, and 0.
constexpr std::size_t kMostLines = BURIN_MAX_PROFILE_POINTS + 1;

// Four corners of what is swept between two stations and two lines, and heights there:
// 0 (a, low line), 1 (b, low), 2 (b, high), 3 (a, high); from x towards y.
struct Quad {
    Vec2 p[4];
    double z[4];
};

Plane plane_through(Vec2 p0, double z0, Vec2 p1, double z1, Vec2 p2, double z2) {
    const Vec2 u = p1 - p0, v = p2 - p0;
    const double det = cross(u, v);
    Plane plane;
    plane.g = {((z1 - z0) * v.y - (z2 - z0) * u.y) / det, ((z2 - z0) * u.x - (z1 - z0) * v.x) / det};
    plane.c = z0 - dot(plane.g, p0);
    return plane;
}

Vec2 crossing_of(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    const double lean = cross(b - a, d - c);
    return lean == 0.0 ? b : a + (b - a) * (cross(c - a, d - c) / lean);
}

// Twice the area of the triangle at corner i.
double corner_area(const Quad& q, int i) { return cross(q.p[(i + 1) & 3] - q.p[i], q.p[(i + 3) & 3] - q.p[i]); }

Plane plane_of(const Quad& q) {
    int widest = 0;
    for (int i = 1; i < 4; ++i)
        if (corner_area(q, i) > corner_area(q, widest)) widest = i;
    const int before = (widest + 3) & 3, after = (widest + 1) & 3;
    return plane_through(q.p[widest], q.z[widest], q.p[after], q.z[after], q.p[before], q.z[before]);
}

class Sweeper {
  public:
    Sweeper(const GroovedSurface& surface, const Gathered& gathered, const SweepOptions& options, LocalGeometry& out)
        : surface_(surface), gathered_(gathered), options_(options), out_(out), stations_(out.stations) {}

    // Brushes, faces and walls.
    void sweep(std::uint32_t index) {
        place(index);
        for (std::size_t k = 0; k + 1 < stations_.list.size(); ++k) sweep_between(stations_.list[k], stations_.list[k + 1]);
        for (int end = 0; end < 2; ++end) wall_ends(end);
    }

    // Brushes alone.
    void sweep_slabs(std::uint32_t index) {
        place(index);
        for (std::size_t k = 0; k + 1 < stations_.list.size(); ++k)
            if (place_lines(stations_.list[k], stations_.list[k + 1]))
                for (const Slab& slab : profile_->slabs) sweep_slab(stations_.list[k], stations_.list[k + 1], slab);
    }

  private:
    void place(std::uint32_t index) {
        const Instance& instance = gathered_.instances[index];
        const PreparedElement& e = surface_.truth().prepared().elements[instance.element];
        instance_ = index;
        element_ = &e;
        profile_ = &surface_.profiles()[e.profile];
        StationOptions options{&gathered_.region, options_.tolerance, 0.0};
        for (const ProfileFacet& facet : profile_->facets)
            options.deep = std::max({options.deep, std::abs(facet.h0), std::abs(facet.h1)});
        place_stations(e, surface_.pattern().elements[instance.element], instance.shift, options, stations_);
    }

    double height(const Station& station, double h) const { return element_->level + station.height * h; }
    double ground(std::uint32_t line) const { return profile_->lines[line] < 0.0 ? element_->left_level : element_->right_level; }
    // Of what lies between two lines.
    double ground(std::uint32_t from, std::uint32_t to) const {
        return profile_->lines[from] + profile_->lines[to] < 0.0 ? element_->left_level : element_->right_level;
    }

    // False: nothing between the two lies near.
    bool place_lines(const Station& a, const Station& b) {
        assert(profile_->lines.size() <= kMostLines);
        Box box;
        for (std::size_t i = 0; i < profile_->lines.size(); ++i) {
            at_a_[i] = a.at(profile_->lines[i] * a.width);
            at_b_[i] = b.at(profile_->lines[i] * b.width);
            include(box, at_a_[i]);
            include(box, at_b_[i]);
        }
        return gathered_.region.meets(box);
    }

    void sweep_between(const Station& a, const Station& b) {
        if (!place_lines(a, b)) return;
        for (const Slab& slab : profile_->slabs) sweep_slab(a, b, slab);
        for (const ProfileFacet& facet : profile_->facets) sweep_facet(a, b, facet);
        wall_sides(a, b);
    }

    Quad quad(const Station& a, const Station& b, std::uint32_t from, std::uint32_t to, double h0, double h1) const {
        return {{at_a_[from], at_b_[from], at_b_[to], at_a_[to]}, {height(a, h0), height(b, h0), height(b, h1), height(a, h1)}};
    }

    // Calls use(count, points, plane) for the flat parts of a quad.
    template <typename Use>
    void for_each_part(const Quad& q, const Use& use) {
        const double none = out_.fine * out_.fine;
        double area[4];
        for (int i = 0; i < 4; ++i) area[i] = corner_area(q, i);
        const int widest = static_cast<int>(std::max_element(area, area + 4) - area);
        if (area[widest] <= none) return;
        if (*std::min_element(area, area + 4) < -none) return use_untwisted(q, area, use);
        const int far = (widest + 2) & 3;
        const Plane whole = plane_of(q);
        if (std::abs(whole.at(q.p[far]) - q.z[far]) <= out_.fine) return use(4, q.p, whole);
        for (const int first : {0, 2}) {
            const int i[3] = {first, first + 1, (first + 2) & 3};
            const Vec2 p[3] = {q.p[i[0]], q.p[i[1]], q.p[i[2]]};
            if (cross(p[1] - p[0], p[2] - p[0]) > none) use(3, p, plane_through(p[0], q.z[i[0]], p[1], q.z[i[1]], p[2], q.z[i[2]]));
        }
    }

    // Where the sections at both ends cross, what lies beyond their crossing is turned over and belongs to neither.
    template <typename Use>
    void use_untwisted(const Quad& q, const double* area, const Use& use) {
        const double none = out_.fine * out_.fine;
        const bool low = area[0] < -none || area[1] < -none, high = area[2] < -none || area[3] < -none;
        if (low && high) return;
        const int i = low ? 2 : 0, k = i + 1, third = low ? 0 : 2;  // the side that is not turned over, and a corner of the other
        const Vec2 p[3] = {q.p[i], q.p[k], crossing_of(q.p[0], q.p[3], q.p[1], q.p[2])};
        if (cross(p[1] - p[0], p[2] - p[0]) <= none) return;
        const double z = plane_through(q.p[i], q.z[i], q.p[k], q.z[k], q.p[third], q.z[third]).at(p[2]);
        use(3, p, plane_through(p[0], q.z[i], p[1], q.z[k], p[2], z));
    }

    Brush brush_over(int count, const Vec2* p, bool cut) {
        Brush brush;
        brush.instance = instance_;
        brush.cut = cut;
        const std::uint32_t from = out_.plan.mark();
        for (int i = 0; i < count; ++i) {
            out_.plan.add(p[i]);
            include(brush.box, p[i]);
        }
        brush.polygon = out_.plan.close(from);
        return brush;
    }

    void sweep_slab(const Station& a, const Station& b, const Slab& slab) {
        const double level = ground(slab.line, slab.line + 1);
        // What is bounded on both sides is divided alike for both.
        const double* bound = slab.has_top && !slab.has_bottom ? slab.top : slab.bottom;
        const Quad q = quad(a, b, slab.line, slab.line + 1, bound[0], bound[1]);
        const Quad other = quad(a, b, slab.line, slab.line + 1, slab.top[0], slab.top[1]);
        if (!slab.cut && *std::max_element(other.z, other.z + 4) <= level + out_.fine) return;  // nothing rises above the ground
        for_each_part(q, [&](int count, const Vec2* p, const Plane& plane) {
            Brush brush = brush_over(count, p, slab.cut);
            brush.has_bottom = slab.has_bottom, brush.has_top = slab.has_top;
            brush.bottom_facet = slab.bottom_facet, brush.top_facet = slab.top_facet;
            brush.level = level;
            (slab.has_bottom ? brush.bottom : brush.top) = plane;
            if (slab.has_bottom && slab.has_top) brush.top = plane_of(other);
            put_brush(brush);
        });
    }

    void put_brush(const Brush& brush) {
        if (gathered_.region.meets(brush.box)) limit_to_zones(out_, brush);
    }

    Face face_of(FaceKind kind, std::uint32_t facet, double level) const {
        Face face;
        face.kind = kind;
        face.instance = instance_;
        face.facet = facet;
        face.level = level;
        return face;
    }

    // A facet bounds what is added; an internal one also what is cut.
    void put_facet(Face face, int count, const Vec3* p, Vec3 normal, const ProfileFacet& facet) {
        const std::uint32_t from = out_.points.mark();
        for (int i = 0; i < count; ++i) {
            out_.points.add(p[i]);
            include(face.box, plan(p[i]));
        }
        face.polygon = out_.points.close(from);
        face.normal = normal;
        if (!gathered_.region.meets(face.box)) return;
        double high = -1e300;
        for (int i = 0; i < count; ++i) high = std::max(high, p[i].z);
        face.kind = FaceKind::add;
        if (high > face.level + out_.fine) limit_to_zones(out_, face);
        face.kind = FaceKind::cut;
        if (facet.internal) limit_to_zones(out_, face);
    }

    void sweep_facet(const Station& a, const Station& b, const ProfileFacet& facet) {
        const Face face = face_of(FaceKind::add, facet.facet, ground(facet.from, facet.to));
        const Quad q = quad(a, b, facet.from, facet.to, facet.h0, facet.h1);
        if (facet.from == facet.to) return upright_facet(face, q, facet);
        for_each_part(q, [&](int count, const Vec2* p, const Plane& plane) {
            Vec3 corners[4];
            for (int i = 0; i < count; ++i) corners[i] = {p[i].x, p[i].y, plane.at(p[i])};
            const Vec3 up = unit(Vec3{-plane.g.x, -plane.g.y, 1.0});
            put_facet(face, count, corners, facet.rightward ? up : up * -1.0, facet);
        });
    }

    void upright_facet(const Face& face, const Quad& q, const ProfileFacet& facet) {
        if (element_->step && profile_->lines[facet.from] == 0.0) return;  // the ground's wall stands there
        const Vec2 along = q.p[1] - q.p[0];
        if (length(along) <= out_.fine) return;
        const Vec2 n = normal_of(unit(along));
        const Vec3 corners[4] = {{q.p[0].x, q.p[0].y, q.z[0]}, {q.p[1].x, q.p[1].y, q.z[1]}, {q.p[2].x, q.p[2].y, q.z[2]}, {q.p[3].x, q.p[3].y, q.z[3]}};
        // The solid lies to the right of the way from the first point to the last: beyond it where the facet falls, before it
        // where it rises.
        const double sign = facet.h1 < facet.h0 ? 1.0 : -1.0;
        put_facet(face, 4, corners, {n.x * sign, n.y * sign, 0.0}, facet);
    }

    void put_wall(FaceKind kind, Vec2 p, double zp, Vec2 q, double zq, Vec2 outward, double level) {
        if (length(q - p) <= out_.fine) return;
        const double edge = kind == FaceKind::cut ? std::max({gathered_.highest, zp, zq}) : level;
        Face face = face_of(kind, kWall, level);
        raise_wall(out_, face, {p.x, p.y, zp}, {q.x, q.y, zq}, edge, kind == FaceKind::cut ? -outward : outward);
        if (gathered_.region.meets(face.box)) limit_to_zones(out_, face);
    }

    void wall_of_facet(const ProfileFacet& facet, Vec2 p, double zp, Vec2 q, double zq, Vec2 outward) {
        if (length(q - p) <= out_.fine) return;
        const double level = ground(facet.from, facet.to);
        const Vec2 off = outward * (64.0 * out_.fine);
        for (std::size_t i = 0; i < out_.zones.size(); ++i) {
            // Where the ground changes just there, the border of the zone has the wall.
            if (!acts_in(out_, out_.zones[i], level)) continue;
            const Stretch part = stretch_inside(out_, out_.zones[i], p + off, q + off);
            if (part.low >= part.high) continue;
            const Vec2 a = lerp(p, q, part.low), b = lerp(p, q, part.high);
            const double za = zp + (zq - zp) * part.low, zb = zp + (zq - zp) * part.high;
            if (facet.internal) put_wall(FaceKind::cut, a, za, b, zb, outward, level);
            if (std::max(za, zb) > level + out_.fine) put_wall(FaceKind::add, a, za, b, zb, outward, level);
        }
    }

    // Where an end is open, across the path; and between the halves of a cap.
    void wall_ends(int end) {
        const OpenEnd& open = stations_.ends[end];
        const Station& station = stations_.list[open.station];
        const Vec2 outward = element_->ends[end].outward;
        for (const ProfileFacet& facet : profile_->facets) {
            const int side = profile_->lines[facet.from] + profile_->lines[facet.to] < 0.0 ? 0 : 1;
            if (!open.open[side] || facet.from == facet.to) continue;
            const Vec2 p = station.at(profile_->lines[facet.from] * station.width), q = station.at(profile_->lines[facet.to] * station.width);
            Vec2 out = normal_of(unit(q - p));
            if (dot(out, outward) < 0.0) out = -out;
            wall_of_facet(facet, p, height(station, facet.h0), q, height(station, facet.h1), out);
        }
        if (stations_.capped[end]) wall_cap(station);
    }

    void wall_cap(const Station& station) {
        Station apex = station;
        apex.kind = Station::Kind::apex;
        for (const ProfileFacet& facet : profile_->facets) {
            if (facet.from == facet.to) continue;
            const double b0 = profile_->lines[facet.from] * station.width, b1 = profile_->lines[facet.to] * station.width;
            // The other half lies to the right of the left one.
            wall_of_facet(facet, apex.at(b0), height(station, facet.h0), apex.at(b1), height(station, facet.h1),
                          b0 + b1 < 0.0 ? station.n : -station.n);
        }
    }

    // Where a run of internal facets ends a cut goes straight up; where the profile ends above the ground something stands.
    void wall_sides(const Station& a, const Station& b) {
        const auto& facets = profile_->facets;
        for (std::size_t k = 0; k < facets.size(); ++k)
            for (const bool first : {true, false}) {
                const bool ends = first ? k == 0 : k + 1 == facets.size();
                if (!ends && (!facets[k].internal || facets[first ? k - 1 : k + 1].internal)) continue;
                wall_side(a, b, facets[k], first, ends);
            }
    }

    // At the facet's first point, where its run begins, or at its last.
    void wall_side(const Station& a, const Station& b, const ProfileFacet& facet, bool first, bool ends) {
        const bool low = first == facet.rightward;
        const std::uint32_t line = low ? facet.from : facet.to;
        if (element_->step && profile_->lines[line] == 0.0) return;  // the ground's wall stands there
        const double h = low ? facet.h0 : facet.h1, za = height(a, h), zb = height(b, h), level = ground(facet.from, facet.to);
        Vec2 outward = normal_of(unit(at_b_[line] - at_a_[line]));
        if (first) outward = -outward;
        if (facet.internal && std::min(za, zb) < gathered_.highest - out_.fine) put_wall(FaceKind::cut, at_a_[line], za, at_b_[line], zb, outward, level);
        if (ends && std::max(za, zb) > level + out_.fine) put_wall(FaceKind::add, at_a_[line], za, at_b_[line], zb, outward, level);
    }

    const GroovedSurface& surface_;
    const Gathered& gathered_;
    const SweepOptions& options_;
    LocalGeometry& out_;
    std::uint32_t instance_ = 0;
    const PreparedElement* element_ = nullptr;
    const SlabbedProfile* profile_ = nullptr;
    Stations& stations_;
    Vec2 at_a_[kMostLines], at_b_[kMostLines];
};

}  // namespace

namespace {

void clear(const GroovedSurface& surface, const Gathered& gathered, LocalGeometry& out) {
    out.points.clear();
    out.plan.clear();
    out.zones.clear();
    out.edges.clear();
    out.brushes.clear();
    out.faces.clear();
    const Vec2 extent = gathered.region.box.high - gathered.region.box.low;
    out.fine = 1e-9 * std::max({extent.x, extent.y, surface.pattern().depth});
    out.points.thin = out.plan.thin = 0.25 * out.fine;
}

}  // namespace

void sweep_brushes(const GroovedSurface& surface, const Gathered& gathered, const SweepOptions& options, LocalGeometry& out) {
    clear(surface, gathered, out);
    Sweeper sweeper(surface, gathered, options, out);
    for (std::uint32_t i = 0; i < gathered.instances.size(); ++i) sweeper.sweep_slabs(i);
}

void sweep_grooves(const GroovedSurface& surface, const Gathered& gathered, const SweepOptions& options, LocalGeometry& out) {
    clear(surface, gathered, out);
    divide_zones(surface, gathered, options, out);
    Sweeper sweeper(surface, gathered, options, out);
    for (std::uint32_t i = 0; i < gathered.instances.size(); ++i) sweeper.sweep(i);
}

}  // namespace burin::reference
