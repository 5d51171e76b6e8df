#include "coverage.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "gl/camera.hpp"

namespace burin::reference {
namespace {

// Where all corners lie before the eye the triangle's box bounds it; else it may be anywhere.
void set_bounds(const glm::dvec4 clip[3], int width, int height, ScreenTriangle& triangle) {
    Box box;
    for (int k = 0; k < 3; ++k) {
        if (clip[k].w <= 1e-12) {
            box = {{0, 0}, {double(width), double(height)}};
            break;
        }
        include(box, {(clip[k].x / clip[k].w + 1.0) * 0.5 * width, (1.0 - clip[k].y / clip[k].w) * 0.5 * height});
    }
    const auto pixel = [](double at, int count) { return int(std::clamp(std::floor(at), -1.0, double(count))); };
    triangle.low[0] = std::max(pixel(box.low.x - 1e-9, width), 0), triangle.high[0] = std::min(pixel(box.high.x + 1e-9, width), width - 1);
    triangle.low[1] = std::max(pixel(box.low.y - 1e-9, height), 0), triangle.high[1] = std::min(pixel(box.high.y + 1e-9, height), height - 1);
}

}  // namespace

CoverageMap::CoverageMap(const Asset& asset, const glm::dmat4& world_to_clip, int width, int height)
    : width_(width), height_(height), columns_((width + kTileSide - 1) / kTileSide), rows_((height + kTileSide - 1) / kTileSide),
      tiles_(std::size_t(columns_) * std::size_t(rows_)) {
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p)
        for (std::uint32_t first = 0; first + 2 < asset.primitives[p].indices.size(); first += 3) add_triangle(asset, p, first, world_to_clip);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
        const ScreenTriangle& t = triangles_[i];
        for (int y = t.low[1] / kTileSide; y <= t.high[1] / kTileSide; ++y)
            for (int x = t.low[0] / kTileSide; x <= t.high[0] / kTileSide; ++x) tiles_[std::size_t(y) * std::size_t(columns_) + std::size_t(x)].push_back(i);
    }
}

void CoverageMap::add_triangle(const Asset& asset, std::uint32_t primitive, std::uint32_t first, const glm::dmat4& world_to_clip) {
    const Primitive& part = asset.primitives[primitive];
    glm::dvec4 clip[3];
    for (std::uint32_t k = 0; k < 3; ++k) clip[k] = world_to_clip * glm::dvec4(vertex(part.positions, part.indices[first + k]), 1.0);
    if (clip[0].w <= 0.0 && clip[1].w <= 0.0 && clip[2].w <= 0.0) return;
    glm::dmat3 corners;
    for (int k = 0; k < 3; ++k) corners[k] = {clip[k].x, clip[k].y, clip[k].w};
    const double facing = glm::determinant(corners);
    if (facing == 0.0 || (facing < 0.0 && !asset.materials[std::size_t(part.material)].double_sided)) return;
    ScreenTriangle triangle;
    triangle.primitive = primitive;
    triangle.first = first;
    // Pixels to the coordinates of clip space before the division.
    const glm::dmat3 to_clip(2.0 / width_, 0.0, 0.0, 0.0, -2.0 / height_, 0.0, -1.0, 1.0, 1.0);
    triangle.weights = glm::inverse(corners) * to_clip;
    triangle.depth = {clip[0].z, clip[1].z, clip[2].z};
    triangle.w = {clip[0].w, clip[1].w, clip[2].w};
    set_bounds(clip, width_, height_, triangle);
    if (triangle.low[0] <= triangle.high[0] && triangle.low[1] <= triangle.high[1]) triangles_.push_back(triangle);
}

// The parts of triangles that lie in the pixel, nearest first.
void CoverageMap::touch_pixel(int x, int y, CoverageWork& work) const {
    work.plane.clear();
    work.plane.thin = 1e-10;
    work.touched.clear();
    for (const std::uint32_t i : tiles_[std::size_t(y / kTileSide) * std::size_t(columns_) + std::size_t(x / kTileSide)]) {
        const ScreenTriangle& t = triangles_[i];
        if (x < t.low[0] || x > t.high[0] || y < t.low[1] || y > t.high[1]) continue;
        const std::uint32_t from = work.plane.mark();
        for (const Vec2 corner : {Vec2{double(x), double(y)}, Vec2{x + 1.0, double(y)}, Vec2{x + 1.0, y + 1.0}, Vec2{double(x), y + 1.0}})
            work.plane.add(corner);
        Polygon p = work.plane.close(from);
        for (int k = 0; p && k < 3; ++k) {
            const glm::dvec3 row(t.weights[0][k], t.weights[1][k], t.weights[2][k]);
            const double scale = 1.0 / std::max(std::hypot(row.x, row.y), 1e-300);
            p = work.plane.clip(p, HalfPlane{{-row.x * scale, -row.y * scale}, row.z * scale});
        }
        if (!is_solid(work.plane, p)) continue;
        const glm::dvec3 weights = t.weights_at(middle_of(work.plane, p));
        work.touched.push_back({&t, p, glm::dot(weights, t.depth) / glm::dot(weights, t.w)});
    }
    std::stable_sort(work.touched.begin(), work.touched.end(), [](const Covered& a, const Covered& b) { return a.depth < b.depth; });
}

void CoverageMap::cover_pixel(int x, int y, CoverageWork& work) const {
    touch_pixel(x, y, work);
    work.seen.clear();
    double rest = 1.0;
    for (std::size_t i = 0; i < work.touched.size() && rest > 1e-9; ++i) {
        work.kept.assign(1, work.touched[i].polygon);
        for (std::size_t k = 0; k < i; ++k) {
            work.next.clear();
            for (const Polygon p : work.kept) cut_out(work.plane, p, work.touched[k].polygon, work.next);
            work.kept.swap(work.next);
        }
        for (const Polygon p : work.kept) {
            if (!is_solid(work.plane, p)) continue;
            work.seen.push_back({work.touched[i].triangle, p, work.touched[i].depth});
            rest -= area_of(work.plane, p);
        }
    }
}

}  // namespace burin::reference
