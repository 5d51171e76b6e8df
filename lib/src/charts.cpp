// Charts by joining vertices, borders by pairing the edges of triangles.
#include <burin/charts.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>

#include "layout.h"

namespace burin {
namespace {

using Vec3 = std::array<double, 3>;

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 times(const Vec3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
Vec3 plus(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
double dot3(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length3(const Vec3& a) { return std::sqrt(dot3(a, a)); }

// Names the vertices of all meshes one after the other.
struct Vertices {
    std::vector<Vec3> positions, normals;
    std::vector<Vec2> uvs;
    std::vector<std::uint32_t> places;   // vertices of equal position have equal ones
    std::vector<std::uint32_t> joined;   // of equal position and uv
    std::vector<std::uint32_t> corners;  // three per triangle
};

// Equal keys get the index of the first of them.
template <typename Key>
std::vector<std::uint32_t> join_equal(const std::vector<Key>& keys) {
    std::vector<std::uint32_t> order(keys.size()), same(keys.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return std::pair(keys[a], a) < std::pair(keys[b], b); });
    for (std::size_t i = 0; i < order.size(); ++i)
        same[order[i]] = i > 0 && keys[order[i]] == keys[order[i - 1]] ? same[order[i - 1]] : order[i];
    return same;
}

Vertices gather_vertices(std::span<const SurfaceMesh> meshes) {
    Vertices all;
    std::vector<std::array<float, 3>> places;
    std::vector<std::array<float, 5>> joined;
    for (const SurfaceMesh& mesh : meshes) {
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        for (std::size_t i = 0; i < mesh.positions.size() / 3; ++i) {
            const float *p = &mesh.positions[3 * i], *n = &mesh.normals[3 * i], *uv = &mesh.uvs[2 * i];
            all.positions.push_back({double(p[0]), double(p[1]), double(p[2])});
            all.normals.push_back({double(n[0]), double(n[1]), double(n[2])});
            all.uvs.push_back({double(uv[0]), double(uv[1])});
            places.push_back({p[0], p[1], p[2]});
            joined.push_back({p[0], p[1], p[2], uv[0], uv[1]});
        }
        for (const std::uint32_t i : mesh.indices) all.corners.push_back(first + i);
    }
    all.places = join_equal(places);
    all.joined = join_equal(joined);
    return all;
}

// Numbers of the parts that hang together, per vertex, in the order of their first vertices.
std::vector<std::uint32_t> number_charts(const Vertices& all, std::uint32_t first, std::uint32_t& count) {
    std::vector<std::uint32_t> parent = all.joined;
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (std::size_t i = 0; i < all.corners.size(); ++i) {
        const std::uint32_t a = root(all.corners[i]), b = root(all.corners[i % 3 == 2 ? i - 2 : i + 1]);
        parent[std::max(a, b)] = std::min(a, b);
    }
    std::vector<std::uint32_t> numbers(parent.size()), seen(parent.size(), ~0u);
    for (std::uint32_t i = 0; i < parent.size(); ++i) {
        std::uint32_t& number = seen[root(i)];
        if (number == ~0u) number = first + count++;
        numbers[i] = number;
    }
    return numbers;
}

// One side of an edge: its triangle with the edge's vertices first, the one at the lower place before the other.
struct Side {
    std::uint32_t low, high;  // places, the key
    std::uint32_t begin, end, apex;
    double order;  // 1: they go round the triangle as its corners do; else -1
};

// The triangle's pattern at its edge: columns of a map from space, along the edge and inwards, to metres of the pattern.
struct Footing {
    Vec2 along, inward;
    Vec3 inward_way;
    double winding;
};

std::optional<Footing> footing_of(const Vertices& all, const Side& side, Vec2 size) {
    const auto at = [&](std::uint32_t i) { return Vec2{all.uvs[i].x * size.x, all.uvs[i].y * size.y}; };
    const Vec3 edge = minus(all.positions[side.end], all.positions[side.begin]);
    const double length = length3(edge);
    if (!(length > 0.0)) return std::nullopt;
    const Vec3 along = times(edge, 1.0 / length), leg = minus(all.positions[side.apex], all.positions[side.begin]);
    const double run = dot3(leg, along);
    const Vec3 rise = minus(leg, times(along, run));
    const double height = length3(rise);
    const Vec2 step = (at(side.end) - at(side.begin)) * (1.0 / length);
    const Vec2 inward = (at(side.apex) - at(side.begin) - step * run) * (1.0 / std::max(height, 1e-300));
    if (!(height > 1e-9 * length) || !(std::abs(cross(step, inward)) > 1e-12 * dot(step, step) + 1e-300)) return std::nullopt;
    return Footing{step, inward, times(rise, 1.0 / height), cross(step, inward)};
}

// Angle by which the surface turns over the edge; 0 below the crease.
double crease_angle(const Vertices& all, const Side& here, const Side& there, const Footing& foot, double crease_cosine) {
    const Vec3 a = plus(all.normals[here.begin], all.normals[here.end]), b = plus(all.normals[there.begin], all.normals[there.end]);
    const double cosine = dot3(a, b) / std::max(length3(a) * length3(b), 1e-300);
    if (cosine >= crease_cosine) return 0.0;
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    return dot3(b, foot.inward_way) < 0.0 ? angle : -angle;
}

bool whole(double x) { return std::abs(x - std::round(x)) < 1e-6; }

class BorderFinder {
  public:
    BorderFinder(const Vertices& all, const std::vector<std::uint32_t>& charts, const ChartOptions& options, ChartSet& set)
        : all_(all), charts_(charts), options_(options), set_(set) {}

    void run() {
        const std::vector<Side> sides = collect_sides();
        for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
            while (next < sides.size() && sides[next].low == sides[i].low && sides[next].high == sides[i].high) ++next;
            if (next - i == 2) pair(sides[i], sides[i + 1]);
        }
    }

  private:
    std::vector<Side> collect_sides() const {
        std::vector<Side> sides;
        for (std::size_t first = 0; first + 2 < all_.corners.size(); first += 3)
            for (std::size_t k = 0; k < 3; ++k) {
                std::uint32_t a = all_.corners[first + k], b = all_.corners[first + (k + 1) % 3];
                if (all_.places[a] == all_.places[b]) continue;
                const bool swapped = all_.places[a] > all_.places[b];
                if (swapped) std::swap(a, b);
                sides.push_back({all_.places[a], all_.places[b], a, b, all_.corners[first + (k + 2) % 3], swapped ? -1.0 : 1.0});
            }
        std::stable_sort(sides.begin(), sides.end(),
                         [](const Side& x, const Side& y) { return std::pair(x.low, x.high) < std::pair(y.low, y.high); });
        return sides;
    }

    void pair(const Side& a, const Side& b) {
        const auto foot_a = footing_of(all_, a, options_.size), foot_b = footing_of(all_, b, options_.size);
        if (!foot_a || !foot_b) return;
        const bool alike = (foot_a->winding * a.order > 0.0) == (foot_b->winding * b.order > 0.0);
        const double angle = crease_angle(all_, a, b, *foot_a, options_.crease_cosine);
        // Folded back on itself: a sheet of two sides, or a triangle whose normals look the wrong way. There is nothing beyond.
        if (std::abs(angle) > BURIN_MOST_EDGE_ANGLE) return;
        const Vec2 begin = all_.uvs[b.begin] - all_.uvs[a.begin], end = all_.uvs[b.end] - all_.uvs[a.end];
        const bool same = all_.joined[a.begin] == all_.joined[b.begin] && all_.joined[a.end] == all_.joined[b.end];
        if (alike && angle == 0.0 && same) return;
        const bool tiles = options_.repeat && whole(begin.x) && whole(begin.y) && std::abs(begin.x - end.x) < 1e-6 &&
                           std::abs(begin.y - end.y) < 1e-6;
        if (!alike || angle != 0.0 || !tiles) set_.needed = true;
        set_.borders.push_back(record(a, *foot_a, b, *foot_b, angle));
        set_.borders.push_back(record(b, *foot_b, a, *foot_a, angle));
    }

    ChartBorder record(const Side& here, const Footing& foot, const Side& there, const Footing& other, double angle) const {
        const auto at = [&](std::uint32_t i) { return Vec2{all_.uvs[i].x * options_.size.x, all_.uvs[i].y * options_.size.y}; };
        ChartBorder border;
        border.from = key_of(here, foot);
        border.to = key_of(there, other);
        border.begin = at(here.begin), border.end = at(here.end), border.there = at(there.begin);
        // Outwards lies to the left of `along` in the frame where inwards lies to the right.
        const bool turned = foot.winding > 0.0;
        if (turned) std::swap(border.begin, border.end), border.there = at(there.end);
        border.across = other.inward;
        // [along' across'] [along outward]^-1
        const Vec2 out = foot.inward * -1.0;
        const double area = cross(foot.along, out);
        border.map = {(other.along.x * out.y - other.inward.x * foot.along.y) / area,
                      (other.inward.x * foot.along.x - other.along.x * out.x) / area,
                      (other.along.y * out.y - other.inward.y * foot.along.y) / area,
                      (other.inward.y * foot.along.x - other.along.y * out.x) / area};
        border.scale = length(foot.along) / std::abs(area);
        border.angle = angle;
        return border;
    }

    std::uint32_t key_of(const Side& side, const Footing& foot) const {
        return 2 * charts_[side.begin] + (foot.winding * side.order < 0.0 ? 1u : 0u);
    }

    const Vertices& all_;
    const std::vector<std::uint32_t>& charts_;
    const ChartOptions& options_;
    ChartSet& set_;
};

}  // namespace

ChartSet find_charts(std::span<const SurfaceMesh> meshes, const ChartOptions& options, std::uint32_t first_chart) {
    ChartSet set;
    const Vertices all = gather_vertices(meshes);
    const std::vector<std::uint32_t> charts = number_charts(all, first_chart, set.count);
    BorderFinder(all, charts, options, set).run();
    auto next = charts.begin();
    for (const SurfaceMesh& mesh : meshes) {
        const auto count = static_cast<std::ptrdiff_t>(mesh.positions.size() / 3);
        set.charts.emplace_back(next, next + count);
        next += count;
    }
    return set;
}

}  // namespace burin
