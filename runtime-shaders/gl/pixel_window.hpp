// A part of a picture that a target shows.
#pragma once

namespace burin::gl {

// Pixels of the picture; rows count from below.
struct PixelWindow {
    int left = 0, low = 0;
    int width = 0, height = 0;
    int across = 1;  // texels of the target on each side of a pixel
};

}  // namespace burin::gl
