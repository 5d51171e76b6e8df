// Comparison of two height maps: the figures that a conversion is judged by (DESIGN 7).
//
//     reconstruction, input --[compare_heights]--> Comparison --> `burin check`, ConvertStats
//
//     reconstruction, input --[compare_edges]----> EdgeError
//
// Units: both maps in the map's own scale, 0 to 1 (1 = object surface); every height error is a fraction of that
// range. Lengths and places in texels of the map. Both maps are means over texels (image.hpp): a reconstruction
// from paths is rasterized with the box filter first, so that like is compared with like.
#pragma once

#include <burin/image.hpp>
#include <burin/pattern.hpp>

namespace burin {

struct Comparison {
    double rms = 0.0;         // root mean square of reconstruction - input
    double p999 = 0.0;        // 99.9th percentile of the absolute error: at most 1 texel in 1000 errs by more
    double max = 0.0;         // largest absolute error
    double mean_error = 0.0;  // mean of reconstruction - input; a level that sits wrong shows here
    double mean_abs = 0.0;    // mean of the absolute error

    // 1 - var(HP(input - reconstruction)) / var(HP(input)); 1 is perfect, 0 as good as a flat plane, below 0
    // worse. HP subtracts a Gaussian of sigma = shorter side / 16 texels, so that soft ground neither helps
    // nor hurts. Exactly 0 for a constant reconstruction of a map that has detail. 1 for a constant input
    // reproduced exactly, and 0 for a constant input that is not.
    double explained = 0.0;

    double input_variance = 0.0;  // var(HP(input)): what there is to explain
    double error_variance = 0.0;  // var(HP(input - reconstruction)): what is left

    // The errors without the smooth part of both maps: standard deviation and 99.9th percentile of the absolute
    // value of HP(reconstruction - input).
    double rms_without_smooth = 0.0, p999_without_smooth = 0.0;

    int worst_x = 0, worst_y = 0;  // texel of `max`, the first in row order
};

// Compares a reconstruction with the map it was made from.
//
// Requires (asserted): equal sizes, at least one texel, finite values.
//
// The Gaussian reaches 4 sigma and is normalised. Wrap::repeat: it goes on across the border. Wrap::clamp:
// the map is mirrored there (half-sample symmetric, ...cba|abc...), which neither invents an edge nor
// stretches the border row.
//
// Ensures: `explained` within 1e-4 of the direct computation in double precision (the blur is done on means
// over blocks of texels much smaller than sigma, and interpolated); the other figures exact in double
// precision. Equal input gives equal bytes.
//
// Cost: about 15 ns a texel, a quarter of a second for 4096 x 4096 on one thread; little scratch memory. The figures do
// not depend on `threads`.
Comparison compare_heights(const Image& reconstruction, const Image& input, Wrap wrap, int threads = 1);

// Comparison::input_variance alone.
double detail_variance(const Image& map, Wrap wrap, int threads = 1);

// How far the edges of a reconstruction lie from those of the map.
struct EdgeError {
    double length = 0.0;     // of the map's strong edges, texels; 0: it has none, and the other figures are 0
    double rms = 0.0;        // root mean square of the distance, texels, by length; a lost edge counts as 2
    double rms_found = 0.0;  // the same over the edges that are not lost; 0 when all are
    double p999 = 0.0;       // 99.9th percentile of the distance, within 0.001; 2 when more than that is lost
    double lost = 0.0;       // share of the length that is farther than 2 texels from any such contour, [0, 1]
};

// Measures, along the half-height contours of the map's strong edges, how far away the reconstruction's contour
// lies that has the same height and rises the same way.
//
// A strong edge is a place where the map goes over from one level to another within four texels to either side of
// its steepest place (level: less than a quarter of the steepest slope), by at least 1/16 of the map's own range
// and four steps of an 8-bit map, and by at least ten standard deviations of the map's grain per texel. Wider
// ramps are shape and no edges; grain and rock without clear walls have none. The height is half of each wall's
// own: steps on many levels, and both walls of a groove, are measured each at its middle.
//
// Distances are taken along the row or the column, whichever is nearer to the edge's normal, and projected on the
// normal; where that gives more than half a texel, or nothing, to the nearest contour in any direction if it is
// nearer. The place of a wall is the mean over as many heights around the contour's as both maps have: a
// box-filtered wall, however sharp, then moves by what the surface moved, while a contour drawn from sample to
// sample moves by half to twice that.
//
// Requires (asserted): equal sizes, at least one texel, finite values.
// Ensures: equal maps give 0 for all but `length`; a straight wall moved by 0.25 texel gives 0.25 within 0.02 at any
// angle, place and sharpness; figures are finite for any maps. With Wrap::repeat edges go on across the border.
// Equal input gives equal bytes.
// Cost: linear; 15 ns a texel and 0.4 microseconds a texel of edge, 0.1 s for a dense map of 1024 x 1024; less
// scratch memory than the map.
EdgeError compare_edges(const Image& reconstruction, const Image& input, Wrap wrap);

// HP of the figure above, on its own: the map minus its wide Gaussian. Same border, same error.
Image subtract_smooth(const Image& map, Wrap wrap);

}  // namespace burin
