// The height error as a picture.
//
//     reconstruction, input --[draw_error]--> RgbaImage
//
// Signed: where the reconstruction lies above the map the picture is red, where it lies below blue, and white where both
// agree. Lightness and colourfulness grow in equal steps to the eye with the error (Oklab), alike on both sides.
#pragma once

#include <burin/image.hpp>
#include <burin/image_io.hpp>

namespace burin {

// The error, a share of the range, that is drawn in full colour for maps that err by `p999`: the next of 1, 2, 5, 10, ...
// tenths of a per cent above, so that pictures can be compared and a legend reads well. At least 0.001.
double full_error(double p999);

// Colour of an error, `share` of the full one in [-1, 1]; beyond, as at the ends. 0xRRGGBB.
std::uint32_t error_color(double share);

// Requires (asserted): equal sizes, full > 0. Ensures: equal input gives equal bytes. Cost: a few ns a texel.
RgbaImage draw_error(const Image& reconstruction, const Image& input, double full);

}  // namespace burin
