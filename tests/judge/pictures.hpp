// How far pictures are apart.
#pragma once

#include <algorithm>
#include <cmath>

#include <burin/image_io.hpp>

namespace burin::testing {

// dB over all channels, sRGB values, peak 255. Requires equal sizes.
inline double psnr(const RgbaImage& a, const RgbaImage& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) {
        const double off = double(a.texels[i]) - double(b.texels[i]);
        sum += off * off;
    }
    return 10.0 * std::log10(255.0 * 255.0 * double(a.texels.size()) / std::max(sum, 1e-9));
}

}  // namespace burin::testing
