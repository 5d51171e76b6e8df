// Convex polygons that are cut and cut again: those of a plane (Vec2) and those in space that are flat (Vec3).
//
// Vertices lie in one pool, which grows to the size that the largest footprint needs and stays: nothing is allocated per
// pixel. A polygon is a range of the pool, never changed once made. Source: [2008] 6, whose area sampling is clipping and
// subtraction of such polygons.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <burin/geometry.hpp>

namespace burin::reference {

struct Vec3 {
    double x = 0.0, y = 0.0, z = 0.0;
};
inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Vec3 unit(Vec3 a) { return a * (1.0 / std::sqrt(dot(a, a))); }
inline Vec2 plan(Vec3 p) { return {p.x, p.y}; }

// Inside: n . p <= d.
struct HalfPlane {
    Vec2 n;
    double d = 0.0;
};
struct HalfSpace {
    Vec3 n;
    double d = 0.0;
};
inline double beyond(const HalfPlane& h, Vec2 p) { return dot(h.n, p) - h.d; }
inline double beyond(const HalfSpace& h, Vec3 p) { return dot(h.n, p) - h.d; }

inline void include(Box& box, Vec2 p) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
}
inline bool meet(const Box& a, const Box& b) {
    return a.low.x <= b.high.x && a.high.x >= b.low.x && a.low.y <= b.high.y && a.high.y >= b.low.y;
}

// A range of vertices of a Polygons; none: empty.
struct Polygon {
    std::uint32_t first = 0, count = 0;
    explicit operator bool() const { return count > 2; }
};

template <typename Point>
class Polygons {
  public:
    // Parts thinner than this are dropped. In the unit of the points, > 0.
    double thin = 1e-12;

    void clear() { points_.clear(); }
    const Point& operator()(Polygon p, std::uint32_t i) const { return points_[p.first + i]; }
    const Point* begin(Polygon p) const { return points_.data() + p.first; }
    const Point* end(Polygon p) const { return points_.data() + p.first + p.count; }

    // The points added since `mark` become a polygon.
    std::uint32_t mark() const { return static_cast<std::uint32_t>(points_.size()); }
    void add(Point p) { points_.push_back(p); }
    Polygon close(std::uint32_t from) const { return {from, mark() - from}; }

    // Parts inside and outside of a half-plane or half-space. One that is nearly whole is the polygon itself.
    template <typename Half>
    void split(Polygon p, const Half& half, Polygon& inside, Polygon& outside) {
        const auto [low, high] = measure(p, half);
        inside = outside = Polygon{};
        if (high <= 0.0)
            inside = p;
        else if (low >= 0.0)
            outside = p;
        else
            inside = part(p, 1.0), outside = part(p, -1.0);
    }
    template <typename Half>
    Polygon clip(Polygon p, const Half& half) {
        const auto [low, high] = measure(p, half);
        if (high <= 0.0) return p;
        if (low >= 0.0) return {};
        return part(p, 1.0);
    }

  private:
    struct Range {
        double low, high;
    };
    template <typename Half>
    Range measure(Polygon p, const Half& half) {
        distances_.clear();
        Range range{1e300, -1e300};
        for (std::uint32_t i = 0; i < p.count; ++i) {
            double d = beyond(half, points_[p.first + i]);
            if (std::abs(d) <= thin) d = 0.0;  // no second vertex beside one that lies on the line
            distances_.push_back(d);
            range.low = std::min(range.low, d);
            range.high = std::max(range.high, d);
        }
        return range;
    }
    // Of what was measured: the side where the distance times `sign` is below 0.
    Polygon part(Polygon p, double sign) {
        const std::uint32_t from = mark();
        for (std::uint32_t i = 0; i < p.count; ++i) {
            const std::uint32_t k = i + 1 < p.count ? i + 1 : 0;
            const double a = distances_[i] * sign, b = distances_[k] * sign;
            const Point from_point = points_[p.first + i], to_point = points_[p.first + k];
            if (a <= 0.0) points_.push_back(from_point);
            if ((a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0)) points_.push_back(from_point + (to_point - from_point) * (a / (a - b)));
        }
        return close(from);
    }

    std::vector<Point> points_;
    std::vector<double> distances_;
};

// Twice the area is positive where the vertices go from x towards y.
inline double area_of(const Polygons<Vec2>& pool, Polygon p) {
    double twice = 0.0;
    for (std::uint32_t i = 2; i < p.count; ++i) twice += cross(pool(p, i - 1) - pool(p, 0), pool(p, i) - pool(p, 0));
    return 0.5 * twice;
}

template <typename Point>
Point middle_of(const Polygons<Point>& pool, Polygon p) {
    Point sum{};
    for (const Point* q = pool.begin(p); q != pool.end(p); ++q) sum = sum + *q;
    return sum * (1.0 / p.count);
}

inline Box box_of(const Polygons<Vec2>& pool, Polygon p) {
    Box box;
    for (const Vec2* q = pool.begin(p); q != pool.end(p); ++q) include(box, *q);
    return box;
}

// Whether there is something of it: not a needle as thin as rounding.
inline bool is_solid(const Polygons<Vec2>& pool, Polygon p) {
    if (!p) return false;
    const Box box = box_of(pool, p);
    return std::abs(area_of(pool, p)) > 4.0 * pool.thin * (box.high.x - box.low.x + box.high.y - box.low.y);
}

// The half-plane on the inner side of edge i, for polygons that go from x towards y; a unit normal. An edge of no length has no
// side: all of the plane.
inline HalfPlane edge_of(const Polygons<Vec2>& pool, Polygon p, std::uint32_t i) {
    const Vec2 a = pool(p, i), along = pool(p, i + 1 < p.count ? i + 1 : 0) - a;
    const double l = std::sqrt(dot(along, along));
    if (l <= pool.thin) return {{0, 0}, 1e300};
    const Vec2 n = normal_of(along) * (-1.0 / l);
    return {n, dot(n, a)};
}

// Whether an edge of one, from x towards y, has all of the other on its outer side.
inline bool parts(const Polygons<Vec2>& pool, Polygon one, Polygon other) {
    for (std::uint32_t i = 0; i < one.count; ++i) {
        const Vec2 a = pool(one, i), along = pool(one, i + 1 < one.count ? i + 1 : 0) - a;
        if (dot(along, along) <= pool.thin * pool.thin) continue;
        if (std::all_of(pool.begin(other), pool.end(other), [&](Vec2 q) { return cross(along, q - a) <= 0.0; })) return true;
    }
    return false;
}

// What of p lies inside of another convex polygon.
inline Polygon clip_to(Polygons<Vec2>& pool, Polygon p, Polygon other) {
    for (std::uint32_t i = 0; p && i < other.count; ++i) p = pool.clip(p, edge_of(pool, other, i));
    return p;
}

// The same; what lies outside is added to `outside`, in convex parts.
inline Polygon cut_out(Polygons<Vec2>& pool, Polygon p, Polygon other, std::vector<Polygon>& outside) {
    for (std::uint32_t i = 0; p && i < other.count; ++i) {
        Polygon inside, rest;
        pool.split(p, edge_of(pool, other, i), inside, rest);
        if (rest) outside.push_back(rest);
        p = inside;
    }
    return p;
}

}  // namespace burin::reference
