#include "scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <burin/evaluate.hpp>
#include <burin/pack.hpp>

#include "gl/camera.hpp"

namespace burin::reference {
namespace {

constexpr double kGrazing = 1e-3;  // cosine below which a look runs along the surface

glm::dvec3 of_array(const std::array<float, 3>& a) { return {double(a[0]), double(a[1]), double(a[2])}; }
glm::dvec3 of_array(const float* a) { return {double(a[0]), double(a[1]), double(a[2])}; }

Vec2 uv_of(const Primitive& part, std::uint32_t i) { return {double(part.uvs[2 * i]), double(part.uvs[2 * i + 1])}; }

struct Directions {
    glm::dvec3 u{0.0}, v{0.0};  // of the world, per unit of uv
};

// As the shader has it: the mesh's own directions where it brings them and they go with the triangle.
bool directions_at(const Primitive& part, const std::uint32_t* corner, const glm::dvec3& weights, const glm::dvec3& normal, Directions& out) {
    const glm::dvec3 p0 = vertex(part.positions, corner[0]), p1 = vertex(part.positions, corner[1]) - p0, p2 = vertex(part.positions, corner[2]) - p0;
    const Vec2 a = uv_of(part, corner[1]) - uv_of(part, corner[0]), b = uv_of(part, corner[2]) - uv_of(part, corner[0]);
    const double area = cross(a, b);
    if (area == 0.0) return false;
    out = {(p1 * b.y - p2 * a.y) / area, (p2 * a.x - p1 * b.x) / area};
    if (part.frames.empty()) return true;
    glm::dvec3 du(0.0), dv(0.0);
    for (int k = 0; k < 3; ++k) {
        du += of_array(part.frames[corner[k]].du) * weights[k];
        dv += of_array(part.frames[corner[k]].dv) * weights[k];
    }
    const double own = glm::dot(normal, glm::cross(du, dv)), facing = glm::dot(normal, glm::cross(out.u, out.v));
    if (own * facing > 0.05 * facing * facing) out = {du, dv};
    return true;
}

// Makes the place a part of the pattern; false where it cannot.
bool set_pattern(const GroovedSurface& surface, const std::uint32_t* corner, const glm::dvec3& weights, Place& place) {
    Directions d;
    if (!directions_at(*place.primitive, corner, weights, place.normal, d)) return false;
    const Vec2 size = surface.pattern().size;
    const glm::dvec3 n = place.normal, x = d.u / size.x, y = d.v / size.y;
    const glm::dmat3 frame(x - n * glm::dot(x, n), y - n * glm::dot(y, n), n);
    if (!(std::abs(glm::determinant(frame)) > 1e-12) || !(glm::dot(n, place.to_eye) * (place.within ? -1.0 : 1.0) > kGrazing)) return false;
    Vec2 uv{0, 0};
    for (int k = 0; k < 3; ++k) uv = uv + uv_of(*place.primitive, corner[k]) * weights[k];
    place.surface = &surface;
    place.frame = frame;
    place.to_pattern = glm::inverse(frame);
    place.at = {uv.x * size.x, uv.y * size.y, surface.top()};
    return true;
}

// Null: the glTF material itself.
const Material* own_material(const Place& place, const Share& share) {
    if (!place.surface || share.element == kGround) return nullptr;
    const ResolvedPattern& pattern = place.surface->pattern();
    const Material& material = pattern.materials[pattern.styles[pattern.elements[share.element].style].material];
    return material.overrides ? &material : nullptr;
}

}  // namespace

glm::dvec3 Place::world_normal(Vec3 n) const { return glm::normalize(glm::transpose(to_pattern) * glm::dvec3(n.x, n.y, n.z)); }

Vec3 Place::pattern_direction(const glm::dvec3& d) const {
    const glm::dvec3 p = to_pattern * d;
    return {p.x, p.y, p.z};
}

Vec2 Place::project(const glm::dvec3& p, const glm::dvec3& d) const {
    const double fall = glm::dot(d, normal);
    const glm::dvec3 way = p - position, on = way - d * (glm::dot(way, normal) / (std::abs(fall) > kGrazing ? fall : fall < 0.0 ? -kGrazing : kGrazing));
    const Vec3 q = pattern_direction(on);
    return {at.x + q.x, at.y + q.y};
}

Vec2 Place::slope(const glm::dvec3& away) const {
    const Vec3 a = pattern_direction(away);
    const double rise = within ? std::min(a.z, -1e-9) : std::max(a.z, 1e-9);
    const Vec2 s{-a.x / rise, -a.y / rise};
    const double l = length(s);
    return l > kMostSlope ? s * (kMostSlope / l) : s;
}

Result<Scene> Scene::make(const Asset& asset) {
    Scene scene(asset);
    for (std::size_t i = 0; i < asset.materials.size(); ++i) {
        if (!asset.materials[i].has_detail) continue;
        const auto unpacked = unpack_textures(asset.materials[i].textures, asset.materials[i].detail);
        if (!unpacked) return unpacked.error();
        scene.surfaces_[i] = std::make_unique<GroovedSurface>(unpacked->pattern, unpacked->grid);
    }
    return scene;
}

glm::dvec3 Scene::position(const MeshPoint& point) const {
    const Primitive& part = asset_->primitives[point.primitive];
    glm::dvec3 sum(0.0);
    for (int k = 0; k < 3; ++k) sum += vertex(part.positions, part.indices[point.first + std::uint32_t(k)]) * point.weights[k];
    return sum;
}

Place Scene::place_at(const MeshPoint& point, const glm::dvec3& toward, bool turned, bool within) const {
    const Primitive& part = asset_->primitives[point.primitive];
    const std::uint32_t* corner = &part.indices[point.first];
    glm::dvec3 normal(0.0);
    for (int k = 0; k < 3; ++k) normal += vertex(part.normals, corner[k]) * point.weights[k];
    normal = glm::normalize(normal);
    if (turned && glm::dot(normal, toward) < 0.0) normal = -normal;
    Place place = smooth_place(part, position(point), normal, toward);
    place.within = within;
    const auto& surface = surfaces_[std::size_t(part.material)];
    if (surface) set_pattern(*surface, corner, point.weights, place);
    return place;
}

Place Scene::smooth_place(const Primitive& primitive, const glm::dvec3& position, const glm::dvec3& normal, const glm::dvec3& toward) {
    Place place;
    place.primitive = &primitive;
    place.position = position;
    place.normal = normal;
    place.to_eye = toward;
    place.frame = frame_about(normal);
    place.to_pattern = glm::transpose(place.frame);
    return place;
}

Paint Scene::paint_of(const Place& place, const Share& share) const {
    const MaterialInfo& info = material(place);
    const Material* own = own_material(place, share);
    Paint paint;
    paint.albedo = of_array(own ? own->base_color : info.base_color);
    paint.metal = double(own ? own->metallic : info.metallic);
    paint.rough = double(own ? own->roughness : info.roughness);
    if (own) return paint;
    paint.glow = of_array(info.emissive);
    paint.index = double(info.ior);
    paint.transmission = double(info.transmission);
    paint.thin = !(info.thickness > 0.0f);
    return paint;
}

}  // namespace burin::reference
