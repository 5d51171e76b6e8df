// Where a stroke shows that nobody drew it to: places that share its texture coordinates. For the sources of this library only.
#pragma once

#include <memory>
#include <optional>

#include "stroke_pieces.hpp"

namespace burin::stroking {

// Triangles by their place in the pattern. Outlives nothing: the surface must stay.
class EchoFinder {
  public:
    explicit EchoFinder(const Surface& surface);

    // The first place off the stroke that a piece of `width` metres in space shows at.
    std::optional<Point3> find(const Piece& piece, double width) const;

  private:
    std::optional<Point3> elsewhere(Vec2 p, Point3 here, double slack) const;
    std::size_t cell_of(double x, double size) const;

    const Surface& surface_;
    std::size_t side_ = 1;  // cells along u and along v
    std::vector<std::vector<std::uint32_t>> cells_;
};

}  // namespace burin::stroking
