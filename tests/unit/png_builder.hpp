// PNG files of every kind, made by the test's own few lines, so that reading is not judged by burin's own
// writer.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace burin::test {

using Bytes = std::vector<std::uint8_t>;

inline void append_u32(Bytes& out, std::uint32_t v) {
    for (int s = 24; s >= 0; s -= 8) out.push_back(static_cast<std::uint8_t>(v >> s));
}

inline Bytes png_chunk(const std::string& type, const Bytes& data) {
    Bytes chunk, body(type.begin(), type.end());
    body.insert(body.end(), data.begin(), data.end());
    append_u32(chunk, static_cast<std::uint32_t>(data.size()));
    chunk.insert(chunk.end(), body.begin(), body.end());
    append_u32(chunk, static_cast<std::uint32_t>(crc32(0, body.data(), static_cast<uInt>(body.size()))));
    return chunk;
}

inline Bytes png_header(std::uint32_t w, std::uint32_t h, int depth, int color, int interlace = 0) {
    Bytes data;
    append_u32(data, w);
    append_u32(data, h);
    for (const int v : {depth, color, 0, 0, interlace}) data.push_back(static_cast<std::uint8_t>(v));
    return png_chunk("IHDR", data);
}

inline Bytes deflated(const Bytes& raw) {
    uLongf size = compressBound(static_cast<uLong>(raw.size()));
    Bytes out(size);
    compress(out.data(), &size, raw.data(), static_cast<uLong>(raw.size()));
    out.resize(size);
    return out;
}

inline Bytes png_file(const std::vector<Bytes>& chunks) {
    Bytes file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    for (const Bytes& c : chunks) file.insert(file.end(), c.begin(), c.end());
    return file;
}

// `rows` hold the packed samples of each row, without filter bytes.
inline Bytes png_of_rows(std::uint32_t w, std::uint32_t h, int depth, int color,
                         const std::vector<Bytes>& rows, const Bytes& palette = {}) {
    Bytes raw;
    for (const Bytes& row : rows) {
        raw.push_back(0);
        raw.insert(raw.end(), row.begin(), row.end());
    }
    std::vector<Bytes> chunks{png_header(w, h, depth, color)};
    if (!palette.empty()) chunks.push_back(png_chunk("PLTE", palette));
    chunks.push_back(png_chunk("IDAT", deflated(raw)));
    chunks.push_back(png_chunk("IEND", {}));
    return png_file(chunks);
}

}  // namespace burin::test
