// A float image and its conventions, stated here once.
//
// Texel (i, j) is the square [i, i+1) x [j, j+1) of texel space, x right, y down; its sample is the mean of the
// surface over that square (box filter), placed at (i + 0.5, j + 0.5). uv (0,0) is the corner of texel (0,0).
#pragma once

#include <cstddef>
#include <vector>

namespace burin {

struct Image {
    int width = 0;
    int height = 0;
    std::vector<float> texels;  // row-major, one channel, width * height entries

    Image() = default;
    Image(int w, int h, float fill = 0.0f)
        : width(w), height(h), texels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}
    float& at(int x, int y) { return texels[static_cast<std::size_t>(y) * width + x]; }
    float at(int x, int y) const { return texels[static_cast<std::size_t>(y) * width + x]; }
};

}  // namespace burin
