#include "exr.hpp"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <string_view>

namespace burin {
namespace {

constexpr int kRowsPerBlock = 16;  // of ZIP compression
using Bytes = std::vector<std::uint8_t>;

template <typename T>
void append(Bytes& bytes, T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
        bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
}

void append_text(Bytes& bytes, std::string_view text) {
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.push_back(0);
}

void append_attribute(Bytes& bytes, std::string_view name, std::string_view type, const Bytes& value) {
    append_text(bytes, name);
    append_text(bytes, type);
    append(bytes, static_cast<std::uint32_t>(value.size()));
    bytes.insert(bytes.end(), value.begin(), value.end());
}

Bytes words(std::initializer_list<std::uint32_t> values) {
    Bytes bytes;
    for (const std::uint32_t v : values) append(bytes, v);
    return bytes;
}

Bytes header(const Image& image) {
    Bytes bytes;
    append(bytes, 20000630u);  // magic number
    append(bytes, 2u);         // version 2, single part, scan lines
    Bytes channels;
    append_text(channels, "Y");
    const Bytes kind = words({2, 0, 1, 1});  // FLOAT, not perceptually linear, sampling 1 by 1
    channels.insert(channels.end(), kind.begin(), kind.end());
    channels.push_back(0);
    const Bytes window = words(
        {0, 0, static_cast<std::uint32_t>(image.width - 1), static_cast<std::uint32_t>(image.height - 1)});
    const Bytes one = words({std::bit_cast<std::uint32_t>(1.0f)});
    append_attribute(bytes, "channels", "chlist", channels);
    append_attribute(bytes, "compression", "compression", {3});
    append_attribute(bytes, "dataWindow", "box2i", window);
    append_attribute(bytes, "displayWindow", "box2i", window);
    append_attribute(bytes, "lineOrder", "lineOrder", {0});
    append_attribute(bytes, "pixelAspectRatio", "float", one);
    append_attribute(bytes, "screenWindowCenter", "v2f", words({0, 0}));
    append_attribute(bytes, "screenWindowWidth", "float", one);
    bytes.push_back(0);
    return bytes;
}

// Rows [y, end) as the format compresses them: bytes of even places before those of odd places, then
// differences to the byte before, then deflate; the rows as they are when that is no gain.
Result<Bytes> block(const Image& image, int y, int end) {
    Bytes raw;
    for (int row = y; row < end; ++row)
        for (int x = 0; x < image.width; ++x) append(raw, std::bit_cast<std::uint32_t>(image.at(x, row)));
    Bytes parted(raw.size());
    const std::size_t half = (raw.size() + 1) / 2;
    for (std::size_t i = 0; i < raw.size(); ++i) parted[i % 2 == 0 ? i / 2 : half + i / 2] = raw[i];
    for (std::size_t i = parted.size() - 1; i > 0; --i)
        parted[i] = static_cast<std::uint8_t>(parted[i] - parted[i - 1] + 128);
    uLongf size = compressBound(static_cast<uLong>(parted.size()));
    Bytes packed(size);
    if (compress(packed.data(), &size, parted.data(), static_cast<uLong>(parted.size())) != Z_OK)
        return Error{ErrorCode::limit_exceeded, "OpenEXR: not enough memory to compress"};
    packed.resize(size);
    return packed.size() < raw.size() ? packed : raw;
}

}  // namespace

Result<Bytes> encode_exr(const Image& image) {
    assert(image.width > 0 && image.height > 0 && image.width < 65536 && image.height < 65536);
    Bytes bytes = header(image);
    const int blocks = (image.height + kRowsPerBlock - 1) / kRowsPerBlock;
    const std::size_t table = bytes.size();
    bytes.resize(table + 8 * static_cast<std::size_t>(blocks));
    for (int i = 0; i < blocks; ++i) {
        const int y = i * kRowsPerBlock;
        Result<Bytes> data = block(image, y, std::min(image.height, y + kRowsPerBlock));
        if (!data.ok()) return data;
        for (std::size_t k = 0; k < 8; ++k)
            bytes[table + 8 * static_cast<std::size_t>(i) + k] =
                static_cast<std::uint8_t>(bytes.size() >> (8 * k));
        append(bytes, static_cast<std::uint32_t>(y));
        append(bytes, static_cast<std::uint32_t>(data->size()));
        bytes.insert(bytes.end(), data->begin(), data->end());
    }
    return bytes;
}

}  // namespace burin
