// OpenEXR writing for the sources of this library only: one channel of 32-bit floats, no dates, no program
// names, so that equal heights give equal bytes.
#pragma once

#include <cstdint>
#include <vector>

#include <burin/image.hpp>
#include <burin/result.hpp>

namespace burin {

// Single part, scan lines, ZIP compression, channel "Y". Requires: image not empty, sides below 2^16.
Result<std::vector<std::uint8_t>> encode_exr(const Image& image);

}  // namespace burin
