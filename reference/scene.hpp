// An asset as beams meet it: places of its mesh, with what is there of a pattern, and what facets are made of.
#pragma once

#include <memory>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <burin/model.hpp>

#include "areas.hpp"
#include "shade.hpp"

namespace burin::reference {

inline constexpr double kMostSlope = 20.0;  // of views, beams and light: 2.9 degrees

// A place of the mesh and the plane that touches it there, which stands for the mesh within a pixel's reach.
struct Place {
    const Primitive* primitive = nullptr;
    const GroovedSurface* surface = nullptr;  // null: smooth; pattern space then is the world's, turned
    glm::dvec3 position{0.0}, normal{0.0};    // of the world; out of the body
    glm::dvec3 to_eye{0.0};                   // or to where a beam comes from; unit length
    glm::dmat3 frame{1.0}, to_pattern{1.0};   // columns: world directions of one metre along x, y, z of pattern space; the inverse
    Vec3 at;                                  // `position` in pattern space
    bool within = false;                      // what looks at it is inside of the body
    bool is_back = false;                     // the flat side that a sheet has behind its mesh

    glm::dvec3 world(Vec3 p) const { return position + frame * glm::dvec3(p.x - at.x, p.y - at.y, p.z - at.z); }
    glm::dvec3 world_normal(Vec3 n) const;
    Vec3 pattern_direction(const glm::dvec3& d) const;
    // Where in the plane what lies at `p` is seen along `d`, pattern space.
    Vec2 project(const glm::dvec3& p, const glm::dvec3& d) const;
    // Metres over the plane per metre of fall along `away`, which points to where rays come from.
    Vec2 slope(const glm::dvec3& away) const;
};

// A point of a triangle of the asset.
struct MeshPoint {
    std::uint32_t primitive = 0, first = 0;  // the triangle's first index
    glm::dvec3 weights{0.0};                 // of its corners, sum 1
};

class Scene {
  public:
    // Unpacks the patterns. Fails with invalid_input: textures that break a rule of the format. Keeps a reference to the asset.
    static Result<Scene> make(const Asset& asset);

    const Asset& asset() const { return *asset_; }
    const MaterialInfo& material(const Place& place) const { return asset_->materials[std::size_t(place.primitive->material)]; }
    glm::dvec3 position(const MeshPoint& point) const;
    // `toward`: from the point to the eye, unit length; `turned`: the triangle is seen from behind, and its normal is turned to the eye. Smooth
    // where there is no pattern, no use of its uvs, or a look along the surface.
    Place place_at(const MeshPoint& point, const glm::dvec3& toward, bool turned, bool within) const;
    // Of a place without a mesh.
    static Place smooth_place(const Primitive& primitive, const glm::dvec3& position, const glm::dvec3& normal, const glm::dvec3& toward);
    Paint paint_of(const Place& place, const Share& share) const;

  private:
    explicit Scene(const Asset& asset) : asset_(&asset), surfaces_(asset.materials.size()) {}

    const Asset* asset_;
    std::vector<std::unique_ptr<GroovedSurface>> surfaces_;  // per material
};

}  // namespace burin::reference
