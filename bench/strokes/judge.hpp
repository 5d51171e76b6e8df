// What a pattern of strokes shows in space, measured from its packed textures by the truth: no code of project_strokes.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <burin/author.hpp>
#include <burin/evaluate.hpp>
#include <burin/strokes.hpp>

#include "shapes.hpp"

namespace burin::bench {

struct StrokeFigures {
    double size = 0.0;         // diagonal of the body, metres
    double stray = 0.0;        // greatest distance of a packed element's middle, mapped back to space, from the drawn lines, metres
    double offset = 0.0;       // greatest distance of the middle of the groove that is seen from the drawn lines, metres
    double width_error = 0.0;  // greatest, share of the width
    double width_rms = 0.0;
    int widths = 0, wide = 0;  // places whose width was measured, and those more than 2 % off
    int seen = 0, missing = 0;  // places across the drawn lines that were asked, and those where no groove lies
    int left_out = 0;           // places where the surface across is no plain sheet, which are not asked
    int echoes = 0;             // places of elements that show elsewhere on the body: more than 10 widths off
    int elements = 0;
    Point3 worst_width, worst_missing, worst_stray;
    std::uint32_t stray_path = 0;  // the path of the pattern that strays most
};

// A mesh to ask for nearest places and for the places of a point of the pattern.
class Mesh {
  public:
    Mesh(const Model& model, const std::string& material);
    ~Mesh();
    struct Place {
        Point3 p, normal;
        Vec2 uv;
    };
    Place nearest(Point3 p) const;
    // A line over the body, straight on from a place, nearest points of equal steps.
    Stroke march(Point3 from, Point3 way, double step, int points) const;
    Point3 random_place(std::mt19937& random) const;
    std::vector<Point3> places_of(Vec2 uv, bool repeats) const;
    double size() const { return size_; }

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
    std::vector<std::array<Point3, 3>> corners_;
    std::vector<std::array<Vec2, 3>> uvs_;
    double size_ = 0.0;
};

// Requires: grooves of the profile "vee", width and height given. Samples nearer than `margin` to the ends of open strokes are not asked.
Result<StrokeFigures> judge_strokes(const Mesh& mesh, const Pattern& pattern, const std::vector<Stroke>& strokes, const StrokeOptions& options, double margin);

}  // namespace burin::bench
