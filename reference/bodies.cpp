#include "bodies.hpp"

#include <algorithm>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <glm/geometric.hpp>

#include "gl/camera.hpp"

namespace burin::reference {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Traits = CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>;

struct Origin {
    std::uint32_t primitive, first;
    glm::dvec3 normal;  // of any length
    bool glass;
};

Kernel::Point_3 point_of(const glm::dvec3& p) { return {p.x, p.y, p.z}; }

}  // namespace

struct Bodies::Tree {
    Triangles triangles;
    std::vector<Origin> origins;
    CGAL::AABB_tree<Traits> tree;
    double size = 0.0;

    void add(const Asset& asset, std::uint32_t primitive) {
        const Primitive& part = asset.primitives[primitive];
        const MaterialInfo& material = asset.materials[std::size_t(part.material)];
        for (std::uint32_t i = 0; i + 2 < part.indices.size(); i += 3) {
            glm::dvec3 p[3];
            for (std::uint32_t k = 0; k < 3; ++k) p[k] = vertex(part.positions, part.indices[i + k]);
            const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
            if (glm::dot(normal, normal) == 0.0) continue;
            triangles.emplace_back(point_of(p[0]), point_of(p[1]), point_of(p[2]));
            origins.push_back({primitive, i, normal, material.transmission > 0.0f && material.metallic < 1.0f});
        }
    }
    glm::dvec3 weights(std::size_t index, const glm::dvec3& p) const {
        const auto& t = triangles[index];
        glm::dvec3 corner[3];
        for (int k = 0; k < 3; ++k) corner[k] = {t[k].x(), t[k].y(), t[k].z()};
        const glm::dvec3& n = origins[index].normal;
        const double whole = glm::dot(n, n);
        const double b = glm::dot(glm::cross(corner[2] - p, corner[0] - p), n) / whole, c = glm::dot(glm::cross(corner[0] - p, corner[1] - p), n) / whole;
        return {1.0 - b - c, b, c};
    }
};

Bodies::Bodies(const Asset& asset) : tree_(std::make_unique<Tree>()) {
    for (std::uint32_t i = 0; i < asset.primitives.size(); ++i) tree_->add(asset, i);
    tree_->tree.insert(tree_->triangles.cbegin(), tree_->triangles.cend());
    tree_->tree.build();
    if (tree_->triangles.empty()) return;
    const CGAL::Bbox_3 box = tree_->tree.bbox();
    tree_->size = std::max({box.xmax() - box.xmin(), box.ymax() - box.ymin(), box.zmax() - box.zmin()});
}
Bodies::~Bodies() = default;
Bodies::Bodies(Bodies&&) noexcept = default;

std::optional<MeshPoint> Bodies::first_hit(const glm::dvec3& from, const glm::dvec3& direction, bool within) const {
    if (tree_->triangles.empty()) return std::nullopt;
    const auto index_of = [&](const auto& id) { return std::size_t(id - tree_->triangles.cbegin()); };
    const auto passes = [&](const auto& id) {
        const Origin& origin = tree_->origins[index_of(id)];
        const bool leaves = glm::dot(origin.normal, direction) > 0.0;
        return leaves ? !(within && origin.glass) : within && origin.glass;
    };
    // Not what it starts on.
    const glm::dvec3 start = from + direction * (1e-7 * tree_->size);
    const Kernel::Ray_3 ray(point_of(start), Kernel::Vector_3(direction.x, direction.y, direction.z));
    const auto hit = tree_->tree.first_intersection(ray, passes);
    if (!hit) return std::nullopt;
    const auto* p = boost::get<Kernel::Point_3>(&hit->first);
    if (!p) return std::nullopt;  // seen edge-on
    const std::size_t index = index_of(hit->second);
    return MeshPoint{tree_->origins[index].primitive, tree_->origins[index].first, tree_->weights(index, {p->x(), p->y(), p->z()})};
}

}  // namespace burin::reference
