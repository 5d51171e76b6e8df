// Box-filtered maps of surfaces that are given as formulas.
#pragma once

#include <burin/image.hpp>

namespace burin::testing {

// Means over texels, of samples x samples heights surface(x, y) each; x and y in texels.
template <typename Surface>
Image sampled_image(int width, int height, int samples, const Surface& surface) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            double sum = 0.0;
            for (int k = 0; k < samples * samples; ++k)
                sum += surface(x + (k % samples + 0.5) / samples, y + (k / samples + 0.5) / samples);
            image.at(x, y) = static_cast<float>(sum / (samples * samples));
        }
    return image;
}

}  // namespace burin::testing
