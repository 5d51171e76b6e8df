// How far a picture is from the truth's, over the pixels whose footprint meets a feature.
#pragma once

#include <burin/image_io.hpp>

#include "truth_picture.hpp"

namespace burin::bench {

struct ImageError {
    double psnr = 0.0;       // dB, sRGB values, peak 1; 99 for equal pictures
    double ssim = 1.0;       // of luma, Gaussian window of sigma 1.5 over 11 x 11 pixels, mean over the pixels that count
    std::size_t pixels = 0;  // that count
    int bad_pixels = 0;      // off by more than a quarter of the range in some channel
    int worst_x = 0, worst_y = 0;
};
ImageError compare_pictures(const RgbaImage& picture, const TruthPicture& truth);

// Side by side: the truth, the picture, and eight times their difference.
RgbaImage show_difference(const RgbaImage& picture, const TruthPicture& truth);

}  // namespace burin::bench
