// PNG: chunks and their checksums. Kept: IHDR, PLTE, IDAT, IEND.
#include <zlib.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "container.hpp"

namespace burin {
namespace {

struct Chunk {
    std::string type;
    std::uint64_t begin = 0;  // of the whole chunk
    std::uint64_t data = 0;
    std::uint64_t size = 0;  // of the data
    std::uint64_t end() const { return data + size + 4; }
};

std::string at_byte(std::uint64_t at) { return " at byte " + std::to_string(at); }

bool is_letter(std::uint8_t c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

Result<Chunk> read_chunk(const std::vector<std::uint8_t>& file, std::uint64_t at) {
    ByteReader reader(file.data(), file.size(), true);
    if (!reader.has(at, 12))
        return damaged("PNG: the file ends" + at_byte(file.size()) + ", before its last chunk");
    Chunk chunk;
    chunk.begin = at;
    chunk.data = at + 8;
    chunk.size = reader.u32(at);
    for (std::uint64_t i = at + 4; i < at + 8; ++i) {
        if (!is_letter(reader.u8(i))) return damaged("PNG: there is no chunk" + at_byte(at));
        chunk.type.push_back(static_cast<char>(reader.u8(i)));
    }
    if (chunk.size > 0x7fffffffu || !reader.has(chunk.data, chunk.size + 4))
        return damaged("PNG: the " + chunk.type + " chunk" + at_byte(at) + " has " +
                       std::to_string(chunk.size) + " bytes, more than the file");
    return chunk;
}

Status check_crc(const std::vector<std::uint8_t>& file, const Chunk& chunk) {
    ByteReader reader(file.data(), file.size(), true);
    const auto computed = static_cast<std::uint32_t>(
        crc32_z(0, file.data() + chunk.begin + 4, static_cast<z_size_t>(chunk.size) + 4));
    if (computed != reader.u32(chunk.data + chunk.size))
        return damaged("PNG: the checksum of the " + chunk.type + " chunk" + at_byte(chunk.begin) +
                       " is wrong");
    return Done{};
}

struct Header {
    std::uint32_t width = 0, height = 0;
    int bit_depth = 0, color_type = 0, interlace = 0;
    int samples() const { return color_type == 2 ? 3 : color_type == 4 ? 2 : color_type == 6 ? 4 : 1; }
};

Result<Header> read_header(const std::vector<std::uint8_t>& file, const Chunk& chunk) {
    if (chunk.type != "IHDR") return damaged("PNG: the first chunk is " + chunk.type + " instead of IHDR");
    if (chunk.size != 13)
        return damaged("PNG: IHDR has " + std::to_string(chunk.size) + " bytes instead of 13");
    ByteReader reader(file.data(), file.size(), true);
    Header h;
    h.width = reader.u32(chunk.data);
    h.height = reader.u32(chunk.data + 4);
    h.bit_depth = reader.u8(chunk.data + 8);
    h.color_type = reader.u8(chunk.data + 9);
    h.interlace = reader.u8(chunk.data + 12);
    const bool power =
        h.bit_depth == 1 || h.bit_depth == 2 || h.bit_depth == 4 || h.bit_depth == 8 || h.bit_depth == 16;
    const bool type =
        h.color_type == 0 || h.color_type == 2 || h.color_type == 3 || h.color_type == 4 || h.color_type == 6;
    const bool pair = h.color_type == 0 || (h.color_type == 3 ? h.bit_depth <= 8 : h.bit_depth >= 8);
    if (!power || !type || !pair)
        return damaged("PNG: IHDR combines bit depth " + std::to_string(h.bit_depth) + " with color type " +
                       std::to_string(h.color_type));
    if (reader.u8(chunk.data + 10) != 0 || reader.u8(chunk.data + 11) != 0 || h.interlace > 1)
        return damaged("PNG: IHDR names an unknown compression, filter or interlace method");
    if (h.width == 0 || h.height == 0 || h.width > 0x7fffffffu || h.height > 0x7fffffffu)
        return damaged("PNG: IHDR gives the size " + std::to_string(h.width) + "x" +
                       std::to_string(h.height));
    return h;
}

// Where the walk stands; the order of chunks that matter is IHDR, PLTE?, IDAT..., IEND.
struct Walk {
    bool palette = false;
    std::uint64_t data_bytes = 0;
    std::string previous;
};

Status check_order(const Chunk& chunk, const Header& header, const Walk& walk) {
    if (chunk.type == "IHDR") return damaged("PNG: there is a second IHDR" + at_byte(chunk.begin));
    if (chunk.type == "PLTE") {
        if (walk.palette || walk.data_bytes > 0 || chunk.size == 0 || chunk.size % 3 != 0 || chunk.size > 768)
            return damaged("PNG: the palette" + at_byte(chunk.begin) + " is misplaced or has a wrong size");
        return Done{};
    }
    if (chunk.type == "IDAT") {
        if (walk.data_bytes > 0 && walk.previous != "IDAT")
            return damaged("PNG: the IDAT chunk" + at_byte(chunk.begin) +
                           " does not follow the one before it");
        if (header.color_type == 3 && !walk.palette)
            return damaged("PNG: a palette picture without a PLTE chunk");
        return Done{};
    }
    const bool critical = (chunk.type[0] & 0x20) == 0;
    if (critical && chunk.type != "IEND")
        return damaged("PNG: unknown critical chunk " + chunk.type + at_byte(chunk.begin));
    return Done{};
}

// Deflate makes at most 1032 bytes of one.
Status check_data_size(const Header& header, std::uint64_t data_bytes) {
    constexpr std::uint64_t kDeflateRatio = 1032;
    const std::uint64_t row =
        (std::uint64_t{header.width} * static_cast<unsigned>(header.samples() * header.bit_depth) + 7) / 8 +
        1;
    const std::uint64_t rows_at_most = (data_bytes * kDeflateRatio + 1024) / row;
    if (rows_at_most < header.height)
        return damaged("PNG: " + std::to_string(data_bytes) + " bytes of data cannot hold " +
                       std::to_string(header.width) + "x" + std::to_string(header.height) + " texels");
    return Done{};
}

// Bytes of one row of each pass with its filter byte, and the number of rows.
struct Pass {
    std::uint64_t row_bytes = 0, rows = 0;
};

std::vector<Pass> passes_of(const Header& h) {
    const auto row_bytes = [&](std::uint64_t width) {
        return (width * static_cast<unsigned>(h.samples() * h.bit_depth) + 7) / 8 + 1;
    };
    if (h.interlace == 0) return {{row_bytes(h.width), h.height}};
    // Adam7: first column and row, and the steps, of the seven passes.
    static constexpr std::uint32_t kSteps[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                                   {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
    std::vector<Pass> passes;
    for (const auto& s : kSteps) {
        if (h.width <= s[0] || h.height <= s[1]) continue;  // nothing of a small picture falls into this pass
        const std::uint64_t columns = (std::uint64_t{h.width} - s[0] + s[2] - 1) / s[2];
        passes.push_back({row_bytes(columns), (std::uint64_t{h.height} - s[1] + s[3] - 1) / s[3]});
    }
    return passes;
}

// Follows the inflated bytes: which of them is a row's filter byte, and whether they are as many as the size
// asks for.
class RowWalk {
  public:
    explicit RowWalk(const Header& header) : passes_(passes_of(header)) {}

    Status take(const std::uint8_t* bytes, std::uint64_t count) {
        while (count > 0) {
            if (pass_ == passes_.size()) return damaged("PNG: there is more data than the picture has rows");
            if (in_row_ == 0 && *bytes > 4)
                return damaged("PNG: row " + std::to_string(row_) + " has the unknown filter " +
                               std::to_string(*bytes));
            const std::uint64_t step = std::min(count, passes_[pass_].row_bytes - in_row_);
            bytes += step;
            count -= step;
            in_row_ += step;
            if (in_row_ < passes_[pass_].row_bytes) continue;
            in_row_ = 0;
            if (++row_ == passes_[pass_].rows) {
                row_ = 0;
                ++pass_;
            }
        }
        return Done{};
    }

    bool complete() const { return pass_ == passes_.size(); }

  private:
    std::vector<Pass> passes_;
    std::size_t pass_ = 0;
    std::uint64_t row_ = 0, in_row_ = 0;
};

// Inflates the data once to see that it is whole: the decoder would write its complaints to the terminal, and
// some would be warnings over rows that it made up.
class DataCheck {
  public:
    explicit DataCheck(const Header& header) : rows_(header) { started_ = inflateInit(&stream_) == Z_OK; }
    ~DataCheck() {
        if (started_) inflateEnd(&stream_);
    }
    DataCheck(const DataCheck&) = delete;
    DataCheck& operator=(const DataCheck&) = delete;

    Status take(const std::uint8_t* data, std::uint64_t size) {
        if (!started_) return Error{ErrorCode::limit_exceeded, "PNG: not enough memory to inflate"};
        stream_.next_in = const_cast<Bytef*>(data);
        stream_.avail_in = static_cast<uInt>(size);  // chunks stay below 2^31
        while (!ended_ && (stream_.avail_in > 0 || stream_.avail_out == 0)) {
            stream_.next_out = piece_.data();
            stream_.avail_out = static_cast<uInt>(piece_.size());
            const int state = inflate(&stream_, Z_NO_FLUSH);
            if (state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR)
                return damaged(std::string("PNG: the data cannot be inflated: ") +
                               (stream_.msg != nullptr ? stream_.msg : "wrong stream"));
            if (Status status = rows_.take(piece_.data(), piece_.size() - stream_.avail_out); !status.ok())
                return status;
            ended_ = state == Z_STREAM_END;
            if (state == Z_BUF_ERROR) break;
        }
        if (ended_ && stream_.avail_in > 0) return damaged("PNG: there are bytes after the end of the data");
        return Done{};
    }

    Status finish() const {
        if (!ended_ || !rows_.complete()) return damaged("PNG: the data ends before the last row");
        return Done{};
    }

  private:
    z_stream stream_{};
    std::vector<std::uint8_t> piece_ = std::vector<std::uint8_t>(1u << 16);
    RowWalk rows_;
    bool started_ = false, ended_ = false;
};

// Requires: the chunks from `at` on were walked without finding fault.
Status check_data(const std::vector<std::uint8_t>& file, const Header& header, std::uint64_t at) {
    DataCheck check(header);
    while (true) {
        Result<Chunk> chunk = read_chunk(file, at);
        if (!chunk.ok()) return chunk.error();
        if (chunk->type == "IEND") return check.finish();
        if (chunk->type == "IDAT")
            if (Status status = check.take(file.data() + chunk->data, chunk->size); !status.ok())
                return status;
        at = chunk->end();
    }
}

}  // namespace

Result<Container> inspect_png(const std::vector<std::uint8_t>& file, std::uint64_t max_texels) {
    constexpr std::string_view kSignature{"\x89PNG\r\n\x1a\n", 8};
    if (file.size() < 8 || std::string_view(reinterpret_cast<const char*>(file.data()), 8) != kSignature)
        return damaged("PNG: the signature is damaged, as by a transfer in text mode");
    Result<Chunk> first = read_chunk(file, 8);
    if (!first.ok()) return first.error();
    Result<Header> header = read_header(file, *first);
    if (!header.ok()) return header.error();
    if (Status status = check_crc(file, *first); !status.ok()) return status.error();

    Container result{.format = "PNG", .plugin = "png", .suffix = ".png"};
    const auto keep = [&](std::uint64_t begin, std::uint64_t end) {
        result.bytes.insert(result.bytes.end(), file.begin() + static_cast<std::ptrdiff_t>(begin),
                            file.begin() + static_cast<std::ptrdiff_t>(end));
    };
    keep(0, first->end());
    Walk walk;
    for (std::uint64_t at = first->end(); walk.previous != "IEND";) {
        Result<Chunk> chunk = read_chunk(file, at);
        if (!chunk.ok()) return chunk.error();
        if (Status status = check_order(*chunk, *header, walk); !status.ok()) return status.error();
        if (chunk->type == "IDAT" || chunk->type == "PLTE" || chunk->type == "IEND") {
            if (Status status = check_crc(file, *chunk); !status.ok()) return status.error();
            // A palette is a mere suggestion in true-color pictures, and an error in grey ones that decoders
            // mind.
            if (chunk->type != "PLTE" || header->color_type == 3) keep(at, chunk->end());
        }
        walk.palette = walk.palette || chunk->type == "PLTE";
        if (chunk->type == "IDAT") walk.data_bytes += chunk->size;
        walk.previous = chunk->type;
        at = chunk->end();
    }
    if (walk.data_bytes == 0) return damaged("PNG: there is no IDAT chunk, so no picture");
    if (Status status = check_data_size(*header, walk.data_bytes); !status.ok()) return status.error();
    if (Status status = check_size(header->width, header->height, max_texels); !status.ok())
        return status.error();
    if (Status status = check_data(file, *header, first->end()); !status.ok()) return status.error();
    result.width = header->width;
    result.height = header->height;
    result.channels = header->samples();
    result.bit_depth = header->bit_depth;
    result.progressive = header->interlace != 0;
    return result;
}

}  // namespace burin
