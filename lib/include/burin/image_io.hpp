// Files and encoded pictures. The only place of the library that opens files for writing, besides the reading
// in heightmap and model.
//
// All writing is atomic: a temporary file beside the target, renamed when it is complete. A failure leaves
// neither a partial file nor the temporary one, and an existing target as it was. Equal input gives equal
// bytes: no dates, no program names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <burin/image.hpp>
#include <burin/result.hpp>

namespace burin {

// Eight bits a channel, red first, four channels, row-major from the top; colours in sRGB unless the use says
// otherwise (normal maps are linear).
struct RgbaImage {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> texels;  // width * height * 4 entries
};

// PNG in memory. Stored as grey when the colours are equal, without alpha when it is 255 everywhere, so that
// decoding gives the same texels back with the least bytes. Requires: texels has width * height * 4 entries.
// Fails with invalid_argument: a side of 0 or above 65535. Cost: deflate at level 6 with a filter chosen per
// row; up to 1 MiB of rows, four tries at level 9.
Result<std::vector<std::uint8_t>> encode_png(const RgbaImage& image);

// The texels of a PNG or JPEG as they are stored, 8 bits of each channel. Input is not trusted, as in heightmap.hpp.
// Fails with unsupported, invalid_input, limit_exceeded (more than max_texels); the messages do not name a file.
Result<RgbaImage> decode_picture(std::vector<std::uint8_t> bytes, std::uint64_t max_texels);

Status write_png(const std::string& path, const RgbaImage& image);

// Heights of one channel by suffix: .exr and .tif/.tiff as 32-bit float, .png as 16-bit grey (values must lie
// in [0, 1]; rounded to the nearest code). Fails with invalid_argument (suffix, size, a value out of range
// for PNG), io_failed.
Status write_height(const std::string& path, const Image& heights);

Status write_file(const std::string& path, std::span<const std::uint8_t> bytes);

// Reads a regular file. Fails with io_failed (missing, not a regular file, unreadable), limit_exceeded
// (larger than max_bytes).
Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::uint64_t max_bytes);

}  // namespace burin
