#include "stroke_surface.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "gltf_geometry.hpp"

namespace burin::stroking {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Primitives = std::vector<Kernel::Triangle_3>;
using TreeTraits = CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Primitives::const_iterator>>;

Kernel::Point_3 kernel_point(Point3 p) { return {p.x, p.y, p.z}; }

Point3 transformed(const Matrix& m, const float* p) {
    const auto row = [&](std::size_t r) { return m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]; };
    return {row(0), row(1), row(2)};
}

// Gradients of the pattern in the plane of the triangle: linear in its corners.
void finish(Triangle& t) {
    const Point3 e = t.p[1] - t.p[0], f = t.p[2] - t.p[0], n = cross(e, f);
    const double area = length(n);
    const double longest = std::max({length(e), length(f), length(f - e)});
    if (!(area > 1e-12 * longest * longest)) return;
    t.normal = n * (1.0 / area);
    const Vec2 a = t.uv[1] - t.uv[0], b = t.uv[2] - t.uv[0];
    // Without area in uv there is no way back from the pattern.
    if (!(std::abs(cross(a, b)) > 1e-12 * (dot(a, a) + dot(b, b)))) return;
    const Point3 to_e = cross(f, t.normal) * (1.0 / area), to_f = cross(t.normal, e) * (1.0 / area);
    t.gradient = {to_e * a.x + to_f * b.x, to_e * a.y + to_f * b.y};
}

double winding(const Triangle& t) { return cross(t.uv[1] - t.uv[0], t.uv[2] - t.uv[0]); }

// One side of one triangle under the numbers of its corners, the lower first.
struct Side {
    std::uint32_t low = 0, high = 0, triangle = 0, side = 0;
    bool upwards = false;  // the triangle goes round from low to high
};

std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
    std::vector<Side> sides;
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = triangles[i].corner[k], b = triangles[i].corner[(k + 1) % 3];
            if (a != b) sides.push_back({std::min(a, b), std::max(a, b), i, k, a < b});
        }
    std::stable_sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) { return std::pair(x.low, x.high) < std::pair(y.low, y.high); });
    return sides;
}

bool same_corners(const Triangle& a, const Triangle& b) {
    return std::is_permutation(a.corner.begin(), a.corner.end(), b.corner.begin());
}

bool whole(double x) { return std::abs(x - std::round(x)) < 1e-6; }

}  // namespace

struct Surface::Tree {
    Primitives primitives;
    std::vector<std::uint32_t> numbers;
    CGAL::AABB_tree<TreeTraits> tree;
};

Surface::Surface(const Model& model, const AttachOptions& attach, const MaterialTarget& target) : pattern_size_(target.metres_per_uv) {
    gather(model, attach, target);
    number_corners();
    pair_sides();
    number_charts();
    tree_ = std::make_unique<Tree>();
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        const Triangle& t = triangles_[i];
        if (dot(t.normal, t.normal) == 0.0) continue;
        if (!has_pattern(t)) ++flat_uvs_;
        tree_->primitives.emplace_back(kernel_point(t.p[0]), kernel_point(t.p[1]), kernel_point(t.p[2]));
        tree_->numbers.push_back(i);
    }
    tree_->tree.insert(tree_->primitives.cbegin(), tree_->primitives.cend());
    tree_->tree.build();
}

Surface::~Surface() = default;

void Surface::gather(const Model& model, const AttachOptions& attach, const MaterialTarget& target) {
    const ModelData& data = model.data();
    Point3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    const std::size_t no_material = array_of(data.document, "materials").size();
    for (const PlacedMesh& placed : placed_meshes(data))
        for (const Json& primitive : array_of(data.document, "meshes")[placed.mesh]["primitives"]) {
            if (!is_triangles(primitive) || unsigned_or(primitive, "material", no_material) != target.index) continue;
            const std::vector<float> positions = read_numbers(data, *attribute_of(primitive, "POSITION"));
            const std::vector<float> uvs = read_numbers(data, *attribute_of(primitive, "TEXCOORD_" + std::to_string(attach.tex_coord)));
            const std::vector<std::uint32_t> indices = triangle_indices(data, primitive);
            for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
                Triangle t;
                for (std::size_t k = 0; k < 3; ++k) {
                    const std::size_t v = indices[i + k];
                    t.p[k] = transformed(placed.transform, &positions[3 * v]);
                    t.uv[k] = {uvs[2 * v] * pattern_size_.x, uvs[2 * v + 1] * pattern_size_.y};
                    if (uvs[2 * v] < 0.0f || uvs[2 * v] > 1.0f || uvs[2 * v + 1] < 0.0f || uvs[2 * v + 1] > 1.0f) repeats_ = true;
                    low = {std::min(low.x, t.p[k].x), std::min(low.y, t.p[k].y), std::min(low.z, t.p[k].z)};
                    high = {std::max(high.x, t.p[k].x), std::max(high.y, t.p[k].y), std::max(high.z, t.p[k].z)};
                }
                finish(t);
                triangles_.push_back(t);
            }
        }
    size_ = length(high - low);
}

void Surface::number_corners() {
    std::map<std::array<double, 3>, std::uint32_t> numbers;
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const Point3 p = triangles_[i].p[k];
            const auto [at, fresh] = numbers.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(triangles_at_.size()));
            if (fresh) triangles_at_.emplace_back();
            triangles_[i].corner[k] = at->second;
            if (triangles_at_[at->second].empty() || triangles_at_[at->second].back() != i) triangles_at_[at->second].push_back(i);
        }
}

// Each side with the one that runs the other way and turns least: a sheet that is modelled from both sides has four at each edge.
void Surface::pair_sides() {
    const std::vector<Side> sides = sorted_sides(triangles_);
    std::vector<bool> taken(sides.size(), false);
    for (std::size_t i = 0, next = 0; i < sides.size(); ++i) {
        if (i == next)
            while (next < sides.size() && sides[next].low == sides[i].low && sides[next].high == sides[i].high) ++next;
        if (taken[i]) continue;
        std::size_t best = sides.size();
        double most = -2.0;
        for (std::size_t k = i + 1; k < next; ++k) {
            const Triangle &a = triangles_[sides[i].triangle], &b = triangles_[sides[k].triangle];
            if (taken[k] || sides[k].triangle == sides[i].triangle || (next - i > 2 && same_corners(a, b))) continue;
            // Where two triangles alone meet they are neighbours, however they are wound.
            const double cosine = dot(a.normal, b.normal) * (sides[k].upwards == sides[i].upwards ? -1.0 : 1.0) -
                                  (sides[k].upwards == sides[i].upwards ? 0.5 : 0.0);
            if (cosine > most) best = k, most = cosine;
        }
        if (best == sides.size()) continue;
        taken[i] = taken[best] = true;
        const Side &a = sides[i], &b = sides[best];
        triangles_[a.triangle].neighbour[a.side] = b.triangle;
        triangles_[b.triangle].neighbour[b.side] = a.triangle;
    }
}

// Where the pattern repeats, a border that moves it by whole tiles is none.
void Surface::number_charts() {
    std::vector<std::uint32_t> parent(triangles_.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    for (std::uint32_t i = 0; i < triangles_.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            Triangle& t = triangles_[i];
            if (t.neighbour[k] == kNone || !has_pattern(t)) continue;
            const Triangle& other = triangles_[t.neighbour[k]];
            const auto step = [&](std::size_t corner) {
                const auto at = std::find(other.corner.begin(), other.corner.end(), t.corner[corner]) - other.corner.begin();
                const Vec2 d = other.uv[static_cast<std::size_t>(at)] - t.uv[corner];
                return Vec2{d.x / pattern_size_.x, d.y / pattern_size_.y};
            };
            const bool turned = other.corner[static_cast<std::size_t>(std::find(other.corner.begin(), other.corner.end(), t.corner[k]) -
                                                                      other.corner.begin() + 1) % 3] == t.corner[(k + 1) % 3];
            const Vec2 a = step(k), b = step((k + 1) % 3);
            const bool alike = (winding(t) > 0.0) == ((winding(other) > 0.0) != turned);
            const double shift = std::abs(a.x) + std::abs(a.y);
            if (!has_pattern(other) || !alike || length(a - b) > 1e-6 || !whole(a.x) || !whole(a.y)) continue;
            if (shift > 0.5) repeats_ = true;
            t.joined[k] = true;
            parent[std::max(root(i), root(t.neighbour[k]))] = std::min(root(i), root(t.neighbour[k]));
        }
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) triangles_[i].chart = root(i);
}

Place Surface::nearest(Point3 p) const {
    const auto found = tree_->tree.closest_point_and_primitive(kernel_point(p));
    const std::size_t at = static_cast<std::size_t>(found.second - tree_->primitives.cbegin());
    return {{found.first.x(), found.first.y(), found.first.z()}, tree_->numbers[at]};
}

std::vector<std::uint32_t> Surface::around(const Place& place, double slack) const {
    std::vector<std::uint32_t> found{place.triangle};
    const Triangle& t = triangles_[place.triangle];
    for (std::size_t k = 0; k < 3; ++k) {
        if (length(place.p - t.p[k]) <= slack) return triangles_at_[t.corner[k]];
        const Point3 side = unit(t.p[(k + 1) % 3] - t.p[k]), from = place.p - t.p[k];
        if (t.neighbour[k] != kNone && length(from - side * dot(from, side)) <= slack) found.push_back(t.neighbour[k]);
    }
    return found;
}

bool Surface::on_open_side(const Place& place, double slack) const {
    for (const std::uint32_t i : around(place, slack)) {
        const Triangle& t = triangles_[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const Point3 side = t.p[(k + 1) % 3] - t.p[k], from = place.p - t.p[k];
            const double along = dot(from, unit(side));
            if (t.neighbour[k] == kNone && along >= -slack && along <= length(side) + slack && length(from - unit(side) * along) <= slack) return true;
        }
    }
    return false;
}

namespace {

// Shares of the corners in a point or, summing to 0, in a vector of the triangle's plane.
std::array<double, 3> shares(const Triangle& t, Point3 v) {
    const double area = length(cross(t.p[1] - t.p[0], t.p[2] - t.p[0]));
    std::array<double, 3> out{};
    for (std::size_t k = 0; k < 3; ++k) out[k] = dot(cross(t.p[(k + 2) % 3] - t.p[(k + 1) % 3], v), t.normal) / area;
    return out;
}

// The side that the way leaves by, and after how many metres; `entry` is not asked.
std::pair<std::size_t, double> exit_of(const Triangle& t, Point3 from, Point3 way, std::size_t entry) {
    const std::array<double, 3> moving = shares(t, way);
    std::size_t side = 3;
    double least = 1e300;
    for (std::size_t k = 0; k < 3; ++k) {
        // Corner k lies opposite side k + 1.
        const std::size_t opposite = (k + 1) % 3;
        if (opposite == entry || !(moving[k] < 0.0)) continue;
        const double share = shares(t, from - t.p[opposite])[k];
        const double after = std::max(share, 0.0) / -moving[k];
        if (after < least) least = after, side = opposite;
    }
    return {side, least};
}

Point3 turned(Point3 v, Point3 edge, Point3 out_here, Point3 in_there) { return unit(edge * dot(v, edge) + in_there * dot(v, out_here)); }

}  // namespace

std::vector<WayStep> straight_way(const Surface& surface, const Place& start, Point3 way, Point3 beside, double distance) {
    constexpr int kMostSteps = 100000;
    std::vector<WayStep> steps;
    WayStep step{start.triangle, start.p, way, beside};
    std::size_t entry = 3;
    for (int n = 0; n < kMostSteps && distance > 0.0; ++n) {
        const Triangle& t = surface.triangles()[step.triangle];
        if (dot(t.normal, t.normal) == 0.0) return steps;
        const auto [side, room] = exit_of(t, step.from, step.way, entry);
        step.length = std::min(room, distance);
        steps.push_back(step);
        distance -= step.length;
        if (side == 3 || !(distance > 0.0) || t.neighbour[side] == kNone) return steps;
        const Triangle& next = surface.triangles()[t.neighbour[side]];
        const Point3 edge = unit(t.p[(side + 1) % 3] - t.p[side]);
        // Outwards here is inwards there; a neighbour that is wound the other way has its normal turned over.
        std::size_t back = 0;
        while (back < 3 && !((next.corner[back] == t.corner[side] && next.corner[(back + 1) % 3] == t.corner[(side + 1) % 3]) ||
                             (next.corner[back] == t.corner[(side + 1) % 3] && next.corner[(back + 1) % 3] == t.corner[side])))
            ++back;
        if (back == 3) return steps;
        const Point3 out = cross(edge, t.normal);
        const Point3 apex = next.p[(back + 2) % 3] - t.p[side];
        const Point3 in = unit(apex - edge * dot(apex, edge));
        step.from = step.from + step.way * step.length;
        step.way = turned(step.way, edge, out, in);
        step.beside = turned(step.beside, edge, out, in);
        step.joined = t.joined[side];
        step.triangle = t.neighbour[side];
        entry = back;
    }
    return steps;
}

}  // namespace burin::stroking
