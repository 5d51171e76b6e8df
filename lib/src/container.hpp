// Walks the container of an image file before any decoder sees it, for the sources of this library only.
//
// A Container promises: the header is sane, every checksum, offset and length that the decoder will follow
// lies within the bytes, and `bytes` holds nothing but what the heights need; metadata (profiles, Exif, text,
// thumbnails, further pages) is gone, so that its parsers never run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <burin/result.hpp>

namespace burin {

struct Container {
    std::string format;       // "PNG", "JPEG", "TIFF", "OpenEXR"
    const char* plugin = "";  // OpenImageIO's name of the reader
    const char* suffix = "";  // what that reader expects a name to end in
    std::uint64_t width = 0, height = 0;
    int channels = 1;  // stored per texel; 1 for a palette
    int bit_depth = 8;
    bool is_float = false;
    bool is_signed = false;
    bool lossy = false;
    bool progressive = false;  // the decoder must hold the whole picture
    // Rows must be asked for in multiples of this: channels stored apart from each other cannot be left
    // half-way.
    std::uint64_t band_rows = 1;
    std::vector<std::uint8_t> bytes{};
};

// Byte access that never leaves the file; reading past the end gives 0 and is remembered.
class ByteReader {
  public:
    ByteReader(const std::uint8_t* data, std::uint64_t size, bool big_endian)
        : data_(data), size_(size), big_endian_(big_endian) {}
    std::uint64_t size() const { return size_; }
    bool has(std::uint64_t at, std::uint64_t count) const { return at <= size_ && count <= size_ - at; }
    std::uint64_t unsigned_at(std::uint64_t at, int bytes) {
        if (!has(at, static_cast<std::uint64_t>(bytes))) {
            overrun_ = true;
            return 0;
        }
        std::uint64_t value = 0;
        for (int i = 0; i < bytes; ++i) {
            const int shift = 8 * (big_endian_ ? bytes - 1 - i : i);
            value |= static_cast<std::uint64_t>(data_[at + static_cast<std::uint64_t>(i)]) << shift;
        }
        return value;
    }
    std::uint8_t u8(std::uint64_t at) { return static_cast<std::uint8_t>(unsigned_at(at, 1)); }
    std::uint16_t u16(std::uint64_t at) { return static_cast<std::uint16_t>(unsigned_at(at, 2)); }
    std::uint32_t u32(std::uint64_t at) { return static_cast<std::uint32_t>(unsigned_at(at, 4)); }
    std::uint64_t u64(std::uint64_t at) { return unsigned_at(at, 8); }
    bool overrun() const { return overrun_; }

  private:
    const std::uint8_t* data_;
    std::uint64_t size_;
    bool big_endian_;
    bool overrun_ = false;
};

// Takes the bytes of the whole file. `max_texels` bounds width * height. Fails with unsupported,
// invalid_input or limit_exceeded; the messages do not name the file.
Result<Container> inspect_image(std::vector<std::uint8_t> file, std::uint64_t max_texels);

// Whether a picture of that size is taken at all.
Status check_size(std::uint64_t width, std::uint64_t height, std::uint64_t max_texels);

// One per format; `inspect_image` chooses by the first bytes. PNG asks for the limit itself, before it
// inflates.
Result<Container> inspect_png(const std::vector<std::uint8_t>& file, std::uint64_t max_texels);
Result<Container> inspect_jpeg(const std::vector<std::uint8_t>& file);
Result<Container> inspect_tiff(std::vector<std::uint8_t> file);
Result<Container> inspect_exr(const std::vector<std::uint8_t>& file);

inline Error damaged(const std::string& message) { return Error{ErrorCode::invalid_input, message}; }
inline Error not_promised(const std::string& message) { return Error{ErrorCode::unsupported, message}; }

}  // namespace burin
