// Comparison of two height maps: the figures that a conversion is judged by (DESIGN 7).
//
//     reconstruction, input --[compare_heights]--> Comparison --> `burin check`, ConvertStats
//
// Units: both maps in the map's own scale, 0 to 1 (1 = object surface); every error is a fraction of that
// range.
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
    // nor hurts. 1 for a constant input reproduced exactly, and 0 for a constant input that is not.
    double explained = 0.0;

    double input_variance = 0.0;  // var(HP(input)): what there is to explain
    double error_variance = 0.0;  // var(HP(input - reconstruction)): what is left

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
// Cost: about 20 ns a texel, below half a second for 4096 x 4096; scratch memory of two maps.
Comparison compare_heights(const Image& reconstruction, const Image& input, Wrap wrap);

// HP of the figure above, on its own: the map minus its wide Gaussian. Same border, same error.
Image subtract_smooth(const Image& map, Wrap wrap);

}  // namespace burin
