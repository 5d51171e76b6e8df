#include <burin/image_io.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstring>

#include "exr.hpp"
#include "file_io.hpp"
#include "png.hpp"

namespace burin {
namespace {

std::string suffix_of(const std::string& path) {
    const auto dot = path.find_last_of('.');
    const auto slash = path.find_last_of('/');
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return "";
    std::string suffix = path.substr(dot);
    for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return suffix;
}

template <typename T>
void append_little_endian(std::vector<std::uint8_t>& bytes, T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

// Baseline TIFF with one uncompressed strip of 32-bit floats: the simplest form that every reader knows.
std::vector<std::uint8_t> encode_tiff(const Image& heights) {
    struct Entry {
        std::uint16_t tag, type;
        std::uint32_t value;
    };
    constexpr std::uint16_t kShort = 3, kLong = 4;
    const auto data_size = static_cast<std::uint32_t>(heights.texels.size() * sizeof(float));
    const Entry entries[] = {
        {256, kLong, static_cast<std::uint32_t>(heights.width)},
        {257, kLong, static_cast<std::uint32_t>(heights.height)},
        {258, kShort, 32},  // bits per sample
        {259, kShort, 1},   // no compression
        {262, kShort, 1},   // black is zero
        {273, kLong, 8},    // the strip follows the file header
        {277, kShort, 1},   // samples per pixel
        {278, kLong, static_cast<std::uint32_t>(heights.height)},
        {279, kLong, data_size},
        {339, kShort, 3},  // IEEE floating point
    };
    std::vector<std::uint8_t> bytes{'I', 'I', 42, 0};
    append_little_endian<std::uint32_t>(bytes, 8u + data_size);
    for (const float v : heights.texels) append_little_endian(bytes, std::bit_cast<std::uint32_t>(v));
    append_little_endian<std::uint16_t>(bytes, static_cast<std::uint16_t>(std::size(entries)));
    for (const Entry& e : entries) {
        append_little_endian(bytes, e.tag);
        append_little_endian(bytes, e.type);
        append_little_endian<std::uint32_t>(bytes, 1);
        append_little_endian(bytes, e.value);
    }
    append_little_endian<std::uint32_t>(bytes, 0);
    return bytes;
}

Status write_tiff(const std::string& path, const Image& heights) {
    if (heights.texels.size() >= (1ull << 30) - 64)
        return Error{ErrorCode::invalid_argument, "TIFF holds 4 GiB; write '" + path + "' as .exr"};
    return write_file(path, encode_tiff(heights));
}

Status write_exr(const std::string& path, const Image& heights) {
    auto exr = encode_exr(heights);
    if (!exr.ok()) return exr.error();
    return write_file(path, *exr);
}

Status write_grey_png(const std::string& path, const Image& heights) {
    std::vector<std::uint8_t> rows;
    rows.reserve(heights.texels.size() * 2);
    for (const float v : heights.texels) {
        if (!(v >= 0.0f && v <= 1.0f))
            return Error{ErrorCode::invalid_argument, "PNG holds heights from 0 to 1, got " +
                                                          std::to_string(v) + "; write '" + path +
                                                          "' as .exr or .tif"};
        const auto code = static_cast<std::uint16_t>(std::lround(v * 65535.0f));
        rows.push_back(static_cast<std::uint8_t>(code >> 8));
        rows.push_back(static_cast<std::uint8_t>(code));
    }
    auto png = encode_png_rows(heights.width, heights.height, 1, 16, rows);
    if (!png.ok()) return png.error();
    return write_file(path, *png);
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_png(const RgbaImage& image) {
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    assert(image.texels.size() == count * 4);
    bool grey = true, opaque = true;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* t = image.texels.data() + 4 * i;
        grey = grey && t[0] == t[1] && t[1] == t[2];
        opaque = opaque && t[3] == 255;
    }
    const int colors = grey ? 1 : 3;
    const int channels = colors + (opaque ? 0 : 1);
    std::vector<std::uint8_t> rows;
    rows.reserve(count * static_cast<std::size_t>(channels));
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* t = image.texels.data() + 4 * i;
        rows.insert(rows.end(), t, t + colors);
        if (!opaque) rows.push_back(t[3]);
    }
    return encode_png_rows(image.width, image.height, channels, 8, rows);
}

Status write_png(const std::string& path, const RgbaImage& image) {
    auto png = encode_png(image);
    if (!png.ok()) return png.error();
    return write_file(path, *png);
}

Status write_height(const std::string& path, const Image& heights) {
    if (heights.width < 1 || heights.height < 1 || heights.width > 65535 || heights.height > 65535)
        return Error{ErrorCode::invalid_argument,
                     "cannot write '" + path + "': size " + std::to_string(heights.width) + "x" +
                         std::to_string(heights.height) + ", sides must be 1 to 65535"};
    const std::string suffix = suffix_of(path);
    if (suffix == ".exr") return write_exr(path, heights);
    if (suffix == ".tif" || suffix == ".tiff") return write_tiff(path, heights);
    if (suffix == ".png") return write_grey_png(path, heights);
    return Error{ErrorCode::invalid_argument,
                 "cannot write heights to '" + path + "': the name must end in .exr, .tif, .tiff or .png"};
}

}  // namespace burin
