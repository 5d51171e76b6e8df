// Which part of each pixel shows which triangle: exact areas, nearest first.
//
//     Asset, view --[CoverageMap]--> per tile its triangles --[cover_pixel]--> polygons of the pixel
//
// Homogeneous coordinates: a triangle's weights are linear on the screen before they are divided by their sum, so that no
// triangle need be cut where it passes the eye.
#pragma once

#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <burin/model.hpp>

#include "polygon.hpp"

namespace burin::reference {

inline constexpr int kTileSide = 16;  // pixels

struct ScreenTriangle {
    std::uint32_t primitive = 0;
    std::uint32_t first = 0;     // into its indices
    glm::dmat3 weights{0.0};     // times (x, y, 1) in pixels: of the corners, times 1 / w
    glm::dvec3 depth{0.0};       // of the corners, z and w of clip space: depth = (weights . z) / (weights . w)
    glm::dvec3 w{1.0};
    int low[2] = {0, 0}, high[2] = {0, 0};  // pixels, both included

    glm::dvec3 weights_at(Vec2 pixel) const { return weights * glm::dvec3(pixel.x, pixel.y, 1.0); }
};

struct Covered {
    const ScreenTriangle* triangle = nullptr;
    Polygon polygon;  // of the pixel, pixels from the picture's upper left corner
    double depth = 0.0;
};

// Memory of one thread.
struct CoverageWork {
    Polygons<Vec2> plane;
    std::vector<Covered> touched, seen;
    std::vector<Polygon> kept, next;
};

class CoverageMap {
  public:
    // Triangles that face away are left out unless their material is double-sided. Keeps a reference to nothing.
    CoverageMap(const Asset& asset, const glm::dmat4& world_to_clip, int width, int height);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    // Fills work.seen with the parts of the pixel that show a triangle; parts do not overlap.
    void cover_pixel(int x, int y, CoverageWork& work) const;

  private:
    void touch_pixel(int x, int y, CoverageWork& work) const;
    void add_triangle(const Asset& asset, std::uint32_t primitive, std::uint32_t first, const glm::dmat4& world_to_clip);

    int width_, height_, columns_, rows_;
    std::vector<ScreenTriangle> triangles_;
    std::vector<std::vector<std::uint32_t>> tiles_;
};

}  // namespace burin::reference
