#include "judge.hpp"

#include <algorithm>
#include <cmath>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <burin/fit.hpp>
#include <burin/pack.hpp>

namespace burin::bench {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Traits = CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>;

std::array<double, 3> shares(const std::array<Point3, 3>& t, Point3 p) {
    const Point3 n = cross(t[1] - t[0], t[2] - t[0]);
    const double b = dot(cross(p - t[0], t[2] - t[0]), n) / dot(n, n), c = dot(cross(t[1] - t[0], p - t[0]), n) / dot(n, n);
    return {1.0 - b - c, b, c};
}

double distance_to(Point3 p, const Stroke& stroke) {
    double least = 1e300;
    for (std::size_t i = 0; i + (stroke.closed ? 0 : 1) < stroke.points.size(); ++i) {
        const Point3 a = stroke.points[i], d = stroke.points[(i + 1) % stroke.points.size()] - a;
        const double along = std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0);
        least = std::min(least, length(p - a - d * along));
    }
    return least;
}

double distance_to(Point3 p, const std::vector<Stroke>& strokes) {
    double least = 1e300;
    for (const Stroke& stroke : strokes) least = std::min(least, distance_to(p, stroke));
    return least;
}

}  // namespace

struct Mesh::Tree {
    Triangles triangles;
    std::vector<std::size_t> numbers;
    CGAL::AABB_tree<Traits> tree;
};

Mesh::Mesh(const Model& model, const std::string& material) : tree_(std::make_unique<Tree>()) {
    const auto asset = read_asset(*write_model(model));
    Point3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
    for (const Primitive& primitive : asset->primitives) {
        if (!material.empty() && asset->materials[std::size_t(primitive.material)].name != material) continue;
        for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
            std::array<Point3, 3> p;
            std::array<Vec2, 3> uv;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t v = primitive.indices[i + k];
                p[k] = {primitive.positions[3 * v], primitive.positions[3 * v + 1], primitive.positions[3 * v + 2]};
                uv[k] = {primitive.uvs[2 * v], primitive.uvs[2 * v + 1]};
                low = {std::min(low.x, p[k].x), std::min(low.y, p[k].y), std::min(low.z, p[k].z)};
                high = {std::max(high.x, p[k].x), std::max(high.y, p[k].y), std::max(high.z, p[k].z)};
            }
            const double longest = std::max({length(p[1] - p[0]), length(p[2] - p[0]), length(p[2] - p[1])});
            if (!(length(cross(p[1] - p[0], p[2] - p[0])) > 1e-10 * longest * longest)) continue;
            const auto at = [](Point3 q) { return Kernel::Point_3(q.x, q.y, q.z); };
            tree_->triangles.emplace_back(at(p[0]), at(p[1]), at(p[2]));
            corners_.push_back(p);
            uvs_.push_back(uv);
        }
    }
    size_ = length(high - low);
    tree_->tree.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
    tree_->tree.build();
}

Mesh::~Mesh() = default;

Mesh::Place Mesh::nearest(Point3 p) const {
    const auto found = tree_->tree.closest_point_and_primitive({p.x, p.y, p.z});
    const std::size_t i = std::size_t(found.second - tree_->triangles.cbegin());
    Place place;
    place.p = {found.first.x(), found.first.y(), found.first.z()};
    place.normal = unit(cross(corners_[i][1] - corners_[i][0], corners_[i][2] - corners_[i][0]));
    const auto share = shares(corners_[i], place.p);
    place.uv = uvs_[i][0] * share[0] + uvs_[i][1] * share[1] + uvs_[i][2] * share[2];
    return place;
}

Stroke Mesh::march(Point3 from, Point3 way, double step, int points) const {
    Stroke stroke{"march", {}, false};
    Place at = nearest(from);
    for (int i = 0; i < points; ++i) {
        stroke.points.push_back(at.p);
        way = unit(way - at.normal * dot(way, at.normal));
        const Place next = nearest(at.p + way * step);
        if (length(next.p - at.p) < 0.5 * step) break;
        // Over an edge the way bends with the surface.
        const Point3 went = next.p - at.p;
        way = unit(went - next.normal * dot(went, next.normal));
        at = next;
    }
    return stroke;
}

Point3 Mesh::random_place(std::mt19937& random) const {
    const std::size_t i = random() % corners_.size();
    return (corners_[i][0] + corners_[i][1] + corners_[i][2]) * (1.0 / 3.0);
}

std::vector<Point3> Mesh::places_of(Vec2 uv, bool repeats) const {
    std::vector<Point3> places;
    for (std::size_t i = 0; i < uvs_.size(); ++i) {
        const auto& t = uvs_[i];
        Vec2 q = uv;
        if (repeats) {
            const Vec2 middle = (t[0] + t[1] + t[2]) * (1.0 / 3.0);
            q = q + Vec2{std::round(middle.x - q.x), std::round(middle.y - q.y)};
        }
        const double area = cross(t[1] - t[0], t[2] - t[0]);
        const double b = cross(q - t[0], t[2] - t[0]) / area, c = cross(t[1] - t[0], q - t[0]) / area;
        if (b >= 0.0 && c >= 0.0 && b + c <= 1.0) places.push_back(corners_[i][0] * (1.0 - b - c) + corners_[i][1] * b + corners_[i][2] * c);
    }
    return places;
}

namespace {

class Judge {
  public:
    Judge(const Mesh& mesh, const ResolvedPattern& pattern, const std::vector<Stroke>& strokes, const StrokeOptions& options)
        : mesh_(mesh), pattern_(pattern), truth_(pattern, {.level_tolerance = 1e-4}), strokes_(strokes), options_(options) {
        figures_.size = mesh.size();
        figures_.elements = int(pattern.elements.size());
    }

    StrokeFigures run(double margin) {
        map_elements();
        for (const Stroke& stroke : strokes_) look_across(stroke, margin);
        figures_.width_rms = std::sqrt(sum_ / std::max(figures_.widths, 1));
        return figures_;
    }

  private:
    void map_elements() {
        const bool repeats = pattern_.wrap == Wrap::repeat;
        for (const ResolvedElement& e : pattern_.elements)
            for (int k = 0; k <= 16; ++k) {
                const Vec2 p = point_at(e.element, k / 16.0);
                for (const Point3 place : mesh_.places_of({p.x / pattern_.size.x, p.y / pattern_.size.y}, repeats)) {
                    const double distance = distance_to(place, strokes_);
                    if (distance > 10.0 * options_.width)
                        ++figures_.echoes;
                    else if (distance > figures_.stray)
                        figures_.stray = distance, figures_.worst_stray = place, figures_.stray_path = e.path;
                }
            }
    }

    double height_at(Point3 p) const {
        const Mesh::Place place = mesh_.nearest(p);
        return truth_.surface_at({place.uv.x * pattern_.size.x, place.uv.y * pattern_.size.y}).height;
    }

    // How far to one side the flank comes up to a tenth of the depth; no more than the width.
    double flank(Point3 p, Point3 across) const {
        double low = 0.0, high = options_.width;
        for (int i = 0; i < 24; ++i) {
            const double middle = 0.5 * (low + high);
            (height_at(p + across * middle) < -0.1 * options_.height ? low : high) = middle;
        }
        return low;
    }

    void look_across(const Stroke& stroke, double margin) {
        const std::size_t count = stroke.points.size() - (stroke.closed ? 0 : 1);
        double total = 0.0, gone = 0.0;
        for (std::size_t i = 0; i < count; ++i) total += length(stroke.points[(i + 1) % stroke.points.size()] - stroke.points[i]);
        for (std::size_t i = 0; i < count; ++i) {
            const Point3 a = stroke.points[i], d = stroke.points[(i + 1) % stroke.points.size()] - a;
            const int parts = std::max(1, int(std::ceil(length(d) / (0.5 * options_.width))));
            for (int k = 0; k < parts; ++k) {
                const double s = gone + length(d) * (k + 0.5) / parts;
                if (stroke.closed || (s > margin && s < total - margin)) look_at(a + d * ((k + 0.5) / parts), d);
            }
            gone += length(d);
        }
    }

    // Whether the surface lies about flat and in one sheet under a width to both sides: else "across" has no length to compare with.
    bool is_plain(const Mesh::Place& place, Point3 across) const {
        for (int k = -4; k <= 4; ++k) {
            const Point3 q = place.p + across * (k * 0.15 * options_.width);
            const Mesh::Place there = mesh_.nearest(q);
            if (length(there.p - q) > 0.05 * options_.width || dot(there.normal, place.normal) < 0.95) return false;
        }
        return true;
    }

    void look_at(Point3 drawn, Point3 along) {
        const Mesh::Place place = mesh_.nearest(drawn);
        const Point3 across = unit(cross(place.normal, along));
        if (!is_plain(place, across)) {
            ++figures_.left_out;
            return;
        }
        for (const double b : {-0.4, -0.2, 0.0, 0.2, 0.4}) {
            ++figures_.seen;
            // A fifth of the groove's depth would be a gap or a step to the eye.
            const double expected = -options_.height * (1.0 - 2.0 * std::abs(b));
            if (height_at(place.p + across * (b * options_.width)) > expected + 0.2 * options_.height)
                ++figures_.missing, figures_.worst_missing = place.p;
        }
        const double left = flank(place.p, across * -1.0), right = flank(place.p, across);
        const double error = std::abs((left + right) / (0.9 * options_.width) - 1.0);
        if (error > figures_.width_error) figures_.width_error = error, figures_.worst_width = place.p;
        sum_ += error * error;
        ++figures_.widths;
        figures_.wide += error > 0.02;
        figures_.offset = std::max(figures_.offset, length(place.p + across * (0.5 * (right - left)) - drawn));
    }

    const Mesh& mesh_;
    const ResolvedPattern& pattern_;
    Truth truth_;
    const std::vector<Stroke>& strokes_;
    const StrokeOptions& options_;
    StrokeFigures figures_;
    double sum_ = 0.0;
};

}  // namespace

Result<StrokeFigures> judge_strokes(const Mesh& mesh, const Pattern& pattern, const std::vector<Stroke>& strokes, const StrokeOptions& options, double margin) {
    AuthorOptions author;
    author.fallback_heights = 16;
    const auto packed = author_textures(pattern, author);
    if (!packed) return packed.error();
    const auto unpacked = unpack_textures(packed->textures, packed->detail);
    if (!unpacked) return unpacked.error();
    return Judge(mesh, unpacked->pattern, strokes, options).run(margin);
}

}  // namespace burin::bench
