// Bodies with known texture coordinates, and lines drawn on them, for the bench of strokes and its tests.
#pragma once

#include <functional>
#include <random>
#include <string>
#include <vector>

#include <burin/strokes.hpp>

namespace burin::bench {

inline Point3 operator+(Point3 a, Point3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point3 operator-(Point3 a, Point3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point3 operator*(Point3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Point3 a, Point3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Point3 cross(Point3 a, Point3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Point3 a) { return std::sqrt(dot(a, a)); }
inline Point3 unit(Point3 a) { return a * (1.0 / length(a)); }

// A mesh as text of OBJ while it is made, with places and uvs by number from 1.
class Body {
  public:
    std::size_t place(Point3 p);
    std::size_t uv(Vec2 t);
    void triangle(std::array<std::size_t, 3> places, std::array<std::size_t, 3> uvs);
    // A grid of columns x rows quads over [0, 1]^2, two triangles each.
    void sheet(int columns, int rows, const std::function<Point3(double, double)>& at, const std::function<Vec2(double, double)>& lay);
    Model model() const;

  private:
    std::string text_;
    std::size_t places_ = 0, uvs_ = 0;
};

// Radius 0.5. One chart around the axis y, to 80 degrees of latitude, its seam a whole tile; rows: along the meridian.
Body latitude_sphere(int rows);
// Six charts beside each other, with gaps, each of rows x rows quads; every other chart is `stretch` times as long along u.
Body cube_sphere(int rows, double stretch);
// Radii 0.35 and 0.15; tubes x 3 of tubes quads. `charts` along the ring, each `stretch` times as long along u as along v; 1: it closes by whole tiles.
Body torus(int tubes, int charts, double stretch);
// A square of two metres in two charts that meet in the line x = 0, the right one turned by an angle in its texture coordinates.
Body two_charts(int rows, double angle);

// Around the unit vector `axis`, `height` above the centre of the sphere of radius 0.5, for `turn` radians.
Stroke circle_on_sphere(Point3 axis, double height, double begin, double turn, int points);
// On the torus: `rounds` around the ring while `winds` around the tube.
Stroke winding(double ring0, double tube0, double rounds, double winds, int points);

Point3 random_direction(std::mt19937& random);

}  // namespace burin::bench
