// SVG path data to lines and quadratics.
//
//     "M 0 0 C 1 0 2 1 2 2 Z" --[parse_path_data]--> subpaths of elements, in pattern space
//
// Every command of SVG 1.1 9.3 is read. Lines and quadratics are exact; a cubic that is a raised quadratic becomes that quadratic,
// any other as many quadratics as keep to the tolerance, with common tangents wherever that is possible; an arc of an ellipse
// becomes quadratics that touch it at their ends.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <burin/geometry.hpp>
#include <burin/pattern.hpp>

namespace burin {

// x' = a x + c y + e, y' = b x + d y + f, as SVG's matrix(a b c d e f).
struct Affine {
    double a = 1.0, b = 0.0, c = 0.0, d = 1.0, e = 0.0, f = 0.0;
    bool identity() const { return a == 1.0 && b == 0.0 && c == 0.0 && d == 1.0 && e == 0.0 && f == 0.0; }
    double determinant() const { return a * d - b * c; }
    // The identity gives the same point bit by bit.
    Vec2 operator()(Vec2 p) const { return identity() ? p : Vec2{a * p.x + c * p.y + e, b * p.x + d * p.y + f}; }
    Vec2 direction(Vec2 v) const { return {a * v.x + c * v.y, b * v.x + d * v.y}; }
};
// First `inner`, then `outer`.
Affine operator*(const Affine& outer, const Affine& inner);

// Elements follow each other bit by bit; none has length zero. Closed: Z was given, and a line to the start added where the last
// point was another one.
struct Subpath {
    std::vector<Element> elements;
    bool closed = false;
    bool closing_line = false;  // Z added a line
    // Of a subpath without elements, which shows as a dot where its line has round or square caps.
    Vec2 start;
};

struct PathData {
    std::vector<Subpath> subpaths;
    std::string problem;  // "" or what is wrong, and where; the subpaths are those up to there, as SVG asks for
};

// `tolerance`: farthest that curves may lie from the ones given, after the transform; > 0.
// Ensures: points of the data are those of the elements exactly, where `transform` is the identity. Cost: linear.
PathData parse_path_data(std::string_view data, const Affine& transform, double tolerance);

// What the parser draws with, for shapes that have no path data. Appends to the subpath, which begins at `start`.
class PathPen {
  public:
    PathPen(const Affine& transform, double tolerance) : transform_(transform), tolerance_(tolerance) {}
    void move_to(Vec2 p);
    void line_to(Vec2 p);
    void quadratic_to(Vec2 control, Vec2 p);
    void cubic_to(Vec2 control0, Vec2 control1, Vec2 p);
    // Radii, rotation in radians, flags as in SVG; radii that are too small grow, and a radius of 0 is a line.
    void arc_to(double rx, double ry, double rotation, bool large, bool sweep, Vec2 p);
    void close();
    std::vector<Subpath> finish();

  private:
    void append(const Element& element);
    Subpath& current();
    Vec2 here_{}, start_{};  // before the transform
    bool open_ = false;
    Affine transform_;
    double tolerance_;
    std::vector<Subpath> subpaths_;
};

}  // namespace burin
