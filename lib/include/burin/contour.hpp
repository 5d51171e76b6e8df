// Contours: where a map crosses a level, as chains of sub-pixel points.
//
//     Image --[trace_contours]--> Contour --[fit_curve]--> Path
//
// Marching squares over the quadrilaterals between four neighbouring samples, linear interpolation along
// their sides. A step contour lost here is a plateau that never appears, and one that is cut into pieces
// becomes a step path that ends in the open, which is an error: so every contour is either a loop or ends at
// the map's border.
//
// Units: texels. Sample (i, j) lies at (i + 0.5, j + 0.5), see image.hpp.
#pragma once

#include <vector>

#include <burin/geometry.hpp>
#include <burin/image.hpp>

namespace burin {

struct Contour {
    // In order, about 0.7 texel apart on the average; consecutive points differ. In a wrapping map the row
    // runs on beyond the border (coordinates below 0 or above width), so that it is continuous.
    std::vector<Vec2> points;

    // After the last point comes the first + period. False only for a contour that meets the border of a map
    // that does not wrap; its ends then lie on the outermost rows or columns of samples, half a texel inside
    // the map.
    bool closed = false;

    // (0, 0), or whole multiples of the map's size for a contour that runs across a wrapping map and meets
    // itself.
    Vec2 period{0.0, 0.0};
};

// Signed area enclosed by a loop (period (0, 0)), in square texels: positive when the loop encloses low
// values (a pit), negative when it encloses high ones (a plateau). Zero for open contours and those with a
// period.
double enclosed_area(const Contour& contour);

// Traces every contour of `level`.
//
// A sample >= level counts as high. High values lie on the left of the way the contour runs, b < 0 (n =
// (-t.y, t.x)). In a saddle the mean of the four samples decides: high joins the two high samples, low the
// two low ones. So the same map always gives the same topology and contours neither touch nor cross.
//
// Requires (asserted): width and height at least 2, texels finite.
//
// Ensures: contours in the order in which a scan by rows first meets them, each starting there; a loop is
// never cut; points lie on the segments between neighbouring samples, strictly inside or on a sample of
// exactly `level`. A contour that passes through samples of exactly `level` is moved by at most 1e-4 texel
// there, which keeps points apart.
//
// Cost: one pass over the texels and one over the crossings; memory one byte a texel and the points.
std::vector<Contour> trace_contours(const Image& image, float level, bool wrap);

}  // namespace burin
