// PNG: chunks and their checksums. Kept: IHDR, PLTE, IDAT, IEND.
#include <zlib.h>

#include <array>
#include <string_view>

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
    if (!reader.has(at, 12)) return damaged("PNG: the file ends" + at_byte(file.size()) + ", before its last chunk");
    Chunk chunk;
    chunk.begin = at;
    chunk.data = at + 8;
    chunk.size = reader.u32(at);
    for (std::uint64_t i = at + 4; i < at + 8; ++i) {
        if (!is_letter(reader.u8(i))) return damaged("PNG: there is no chunk" + at_byte(at));
        chunk.type.push_back(static_cast<char>(reader.u8(i)));
    }
    if (chunk.size > 0x7fffffffu || !reader.has(chunk.data, chunk.size + 4))
        return damaged("PNG: the " + chunk.type + " chunk" + at_byte(at) + " has " + std::to_string(chunk.size) +
                       " bytes, more than the file");
    return chunk;
}

Status check_crc(const std::vector<std::uint8_t>& file, const Chunk& chunk) {
    ByteReader reader(file.data(), file.size(), true);
    const auto computed =
        static_cast<std::uint32_t>(crc32_z(0, file.data() + chunk.begin + 4, static_cast<z_size_t>(chunk.size) + 4));
    if (computed != reader.u32(chunk.data + chunk.size))
        return damaged("PNG: the checksum of the " + chunk.type + " chunk" + at_byte(chunk.begin) + " is wrong");
    return Done{};
}

struct Header {
    std::uint32_t width = 0, height = 0;
    int bit_depth = 0, color_type = 0, interlace = 0;
    int samples() const { return color_type == 2 ? 3 : color_type == 4 ? 2 : color_type == 6 ? 4 : 1; }
};

Result<Header> read_header(const std::vector<std::uint8_t>& file, const Chunk& chunk) {
    if (chunk.type != "IHDR") return damaged("PNG: the first chunk is " + chunk.type + " instead of IHDR");
    if (chunk.size != 13) return damaged("PNG: IHDR has " + std::to_string(chunk.size) + " bytes instead of 13");
    ByteReader reader(file.data(), file.size(), true);
    Header h;
    h.width = reader.u32(chunk.data);
    h.height = reader.u32(chunk.data + 4);
    h.bit_depth = reader.u8(chunk.data + 8);
    h.color_type = reader.u8(chunk.data + 9);
    h.interlace = reader.u8(chunk.data + 12);
    const bool power = h.bit_depth == 1 || h.bit_depth == 2 || h.bit_depth == 4 || h.bit_depth == 8 || h.bit_depth == 16;
    const bool type = h.color_type == 0 || h.color_type == 2 || h.color_type == 3 || h.color_type == 4 || h.color_type == 6;
    const bool pair = h.color_type == 0 || (h.color_type == 3 ? h.bit_depth <= 8 : h.bit_depth >= 8);
    if (!power || !type || !pair)
        return damaged("PNG: IHDR combines bit depth " + std::to_string(h.bit_depth) + " with color type " +
                       std::to_string(h.color_type));
    if (reader.u8(chunk.data + 10) != 0 || reader.u8(chunk.data + 11) != 0 || h.interlace > 1)
        return damaged("PNG: IHDR names an unknown compression, filter or interlace method");
    if (h.width == 0 || h.height == 0 || h.width > 0x7fffffffu || h.height > 0x7fffffffu)
        return damaged("PNG: IHDR gives the size " + std::to_string(h.width) + "x" + std::to_string(h.height));
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
            return damaged("PNG: the IDAT chunk" + at_byte(chunk.begin) + " does not follow the one before it");
        if (header.color_type == 3 && !walk.palette) return damaged("PNG: a palette picture without a PLTE chunk");
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
        (std::uint64_t{header.width} * static_cast<unsigned>(header.samples() * header.bit_depth) + 7) / 8 + 1;
    const std::uint64_t rows_at_most = (data_bytes * kDeflateRatio + 1024) / row;
    if (rows_at_most < header.height)
        return damaged("PNG: " + std::to_string(data_bytes) + " bytes of data cannot hold " +
                       std::to_string(header.width) + "x" + std::to_string(header.height) + " texels");
    return Done{};
}

}  // namespace

Result<Container> inspect_png(const std::vector<std::uint8_t>& file) {
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
            // A palette is a mere suggestion in true-color pictures, and an error in grey ones that decoders mind.
            if (chunk->type != "PLTE" || header->color_type == 3) keep(at, chunk->end());
        }
        walk.palette = walk.palette || chunk->type == "PLTE";
        if (chunk->type == "IDAT") walk.data_bytes += chunk->size;
        walk.previous = chunk->type;
        at = chunk->end();
    }
    if (walk.data_bytes == 0) return damaged("PNG: there is no IDAT chunk, so no picture");
    if (Status status = check_data_size(*header, walk.data_bytes); !status.ok()) return status.error();
    result.width = header->width;
    result.height = header->height;
    result.channels = header->samples();
    result.bit_depth = header->bit_depth;
    result.progressive = header->interlace != 0;
    return result;
}

}  // namespace burin
