// PNG encoding of 8 and 16 bit rows, for the sources of this library only. Deterministic: the same texels
// give the same bytes on every machine with the same deflate.
#pragma once

#include <cstdint>
#include <vector>

#include <burin/result.hpp>

namespace burin {

// `rows` holds height rows of width * channels samples of `bit_depth` 8 or 16 (big-endian), tightly packed.
// channels: 1 grey, 2 grey + alpha, 3 RGB, 4 RGBA.
Result<std::vector<std::uint8_t>> encode_png_rows(int width, int height, int channels, int bit_depth,
                                                  const std::vector<std::uint8_t>& rows);

}  // namespace burin
