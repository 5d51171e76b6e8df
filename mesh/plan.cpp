#include "plan.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_plus_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace burin::mesh {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
struct FaceInfo {
    std::int32_t index = kBorder;
    std::uint32_t step[3] = {kNoStep, kNoStep, kNoStep};  // of the edge across from vertex i
};
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<FaceInfo, Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
// Crossings are exact: those of lines that nearly coincide would be anywhere after rounding.
using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_intersections_tag>;
using Triangulation = CGAL::Constrained_triangulation_plus_2<Delaunay>;

// Points, of which those nearer to each other than a distance are one: the first.
class SnappedPoints {
  public:
    SnappedPoints(Vec2 size, double snap) : size_(size), snap_(snap) {}

    std::uint32_t index_of(Vec2 p) {
        p = {to_border(p.x, size_.x), to_border(p.y, size_.y)};
        const std::int64_t x = cell(p.x), y = cell(p.y);
        for (std::int64_t j = y - 1; j <= y + 1; ++j)
            for (std::int64_t i = x - 1; i <= x + 1; ++i)
                for (auto [it, end] = cells_.equal_range(key(i, j)); it != end; ++it)
                    if (is_same(points_[it->second], p)) return it->second;
        cells_.emplace(key(x, y), static_cast<std::uint32_t>(points_.size()));
        points_.push_back(p);
        return static_cast<std::uint32_t>(points_.size() - 1);
    }
    const std::vector<Vec2>& points() const { return points_; }

  private:
    double to_border(double at, double side) const { return at <= snap_ ? 0.0 : at >= side - snap_ ? side : at; }
    std::int64_t cell(double at) const { return static_cast<std::int64_t>(std::floor(at / (2.0 * snap_))); }
    static std::uint64_t key(std::int64_t i, std::int64_t j) { return static_cast<std::uint64_t>(i) << 32 ^ static_cast<std::uint64_t>(j & 0xffffffff); }
    // What lies on the border stays there.
    bool is_same(Vec2 a, Vec2 b) const {
        const auto pinned = [](double at, double side) { return at == 0.0 || at == side; };
        if (pinned(a.x, size_.x) != pinned(b.x, size_.x) || pinned(a.y, size_.y) != pinned(b.y, size_.y)) return false;
        return length(a - b) <= snap_;
    }

    Vec2 size_;
    double snap_;
    std::vector<Vec2> points_;
    std::unordered_multimap<std::uint64_t, std::uint32_t> cells_;
};

// False: nothing of the line lies in the rectangle.
bool clip_to_map(PlanLine& line, Vec2 size) {
    double low = 0.0, high = 1.0;
    const Vec2 way = line.b - line.a;
    const auto limit = [&](double at, double by, double side) {
        if (by == 0.0) return at >= 0.0 && at <= side;
        const double s = -at / by, t = (side - at) / by;
        low = std::max(low, std::min(s, t));
        high = std::min(high, std::max(s, t));
        return low < high;
    };
    if (!limit(line.a.x, way.x, size.x) || !limit(line.a.y, way.y, size.y)) return false;
    const Vec2 a = line.a;
    if (low > 0.0) line.a = a + way * low;
    if (high < 1.0) line.b = a + way * high;
    return true;
}

struct SnappedLine {
    std::uint32_t a, b;
    std::uint32_t step;
    bool operator<(const SnappedLine& other) const { return std::tie(a, b, step) < std::tie(other.a, other.b, other.step); }
};

// Each line once; of those with a step the first step.
std::vector<SnappedLine> snap_lines(const std::vector<PlanLine>& lines, Vec2 size, SnappedPoints& points) {
    std::vector<SnappedLine> snapped;
    for (PlanLine line : lines) {
        if (!clip_to_map(line, size)) continue;
        std::uint32_t a = points.index_of(line.a), b = points.index_of(line.b);
        if (a == b) continue;
        if (a > b) std::swap(a, b);
        snapped.push_back({a, b, line.step});
    }
    std::sort(snapped.begin(), snapped.end());
    const auto same = [](const SnappedLine& l, const SnappedLine& k) { return l.a == k.a && l.b == k.b; };
    snapped.erase(std::unique(snapped.begin(), snapped.end(), same), snapped.end());
    return snapped;
}

void mark_step(Triangulation& triangulation, Triangulation::Constraint_id line, std::uint32_t step) {
    auto it = triangulation.vertices_in_constraint_begin(line);
    const auto end = triangulation.vertices_in_constraint_end(line);
    for (auto before = it++; it != end; before = it++) {
        Triangulation::Face_handle face;
        int i = 0;
        if (!triangulation.is_edge(*before, *it, face, i)) continue;
        face->info().step[i] = step;
        face->neighbor(i)->info().step[triangulation.mirror_index(face, i)] = step;
    }
}

void insert_lines(Triangulation& triangulation, const std::vector<Vec2>& points, const std::vector<SnappedLine>& lines) {
    // Neighbours in the list are near each other in the plane as well: each point is looked for from the last.
    std::vector<Triangulation::Vertex_handle> vertices;
    Triangulation::Face_handle near;
    for (const Vec2 p : points) {
        vertices.push_back(triangulation.insert({p.x, p.y}, near));
        near = vertices.back()->face();
    }
    std::vector<std::pair<Triangulation::Constraint_id, std::uint32_t>> steps;
    for (const SnappedLine& line : lines) {
        const auto id = triangulation.insert_constraint(vertices[line.a], vertices[line.b]);
        if (line.step != kNoStep) steps.emplace_back(id, line.step);
    }
    for (const auto& [id, step] : steps) mark_step(triangulation, id, step);
}

Plan plan_of(Triangulation& triangulation) {
    Plan plan;
    for (const auto vertex : triangulation.finite_vertex_handles()) {
        vertex->info() = static_cast<std::uint32_t>(plan.corners.size());
        plan.corners.push_back({CGAL::to_double(vertex->point().x()), CGAL::to_double(vertex->point().y())});
    }
    std::int32_t count = 0;
    for (const auto face : triangulation.finite_face_handles()) face->info().index = count++;
    for (const auto face : triangulation.finite_face_handles()) {
        PlanTriangle triangle;
        for (int i = 0; i < 3; ++i) {
            triangle.corner[i] = face->vertex(i)->info();
            const int opposite = (i + 2) % 3;
            const auto beyond = face->neighbor(opposite);
            triangle.across[i] = triangulation.is_infinite(beyond) ? kBorder : beyond->info().index;
            triangle.step[i] = face->info().step[opposite];
        }
        plan.triangles.push_back(triangle);
    }
    return plan;
}

}  // namespace

Plan divide_plan(const std::vector<PlanLine>& lines, Vec2 size, double snap) {
    SnappedPoints points(size, snap);
    std::vector<SnappedLine> border;
    for (const Vec2 corner : {Vec2{0, 0}, Vec2{size.x, 0}, size, Vec2{0, size.y}}) points.index_of(corner);
    std::vector<SnappedLine> snapped = snap_lines(lines, size, points);
    for (std::uint32_t i = 0; i < 4; ++i) snapped.push_back({i, (i + 1) % 4, kNoStep});
    Triangulation triangulation;
    insert_lines(triangulation, points.points(), snapped);
    return plan_of(triangulation);
}

}  // namespace burin::mesh
