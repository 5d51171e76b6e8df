// TIFF and BigTIFF: the first image file directory, rewritten to the tags that heights need; no further
// pages.
#include <algorithm>
#include <bit>
#include <map>

#include "container.hpp"

namespace burin {
namespace {

enum Tag : std::uint16_t {
    kWidth = 256,
    kHeight = 257,
    kBits = 258,
    kCompression = 259,
    kPhotometric = 262,
    kFillOrder = 266,
    kStripOffsets = 273,
    kSamples = 277,
    kRowsPerStrip = 278,
    kStripBytes = 279,
    kPlanar = 284,
    kPredictor = 317,
    kColorMap = 320,
    kTileWidth = 322,
    kTileHeight = 323,
    kTileOffsets = 324,
    kTileBytes = 325,
    kExtraSamples = 338,
    kSampleFormat = 339,
    kJpegTables = 347,
    kChromaSubsampling = 530,
};
constexpr std::uint16_t kKept[] = {
    kWidth,      kHeight,       kBits,       kCompression,  kPhotometric,  kFillOrder,  kStripOffsets,
    kSamples,    kRowsPerStrip, kStripBytes, kPlanar,       kPredictor,    kColorMap,   kTileWidth,
    kTileHeight, kTileOffsets,  kTileBytes,  kExtraSamples, kSampleFormat, kJpegTables, kChromaSubsampling};

struct Field {
    int type = 0;
    std::uint64_t count = 0;
    std::uint64_t at = 0;  // of the first value
};

int type_bytes(int type) {
    switch (type) {
        case 1:
        case 2:
        case 6:
        case 7:
            return 1;
        case 3:
        case 8:
            return 2;
        case 4:
        case 9:
        case 11:
        case 13:
            return 4;
        case 5:
        case 10:
        case 12:
        case 16:
        case 17:
        case 18:
            return 8;
        default:
            return 0;
    }
}

struct CompressionKind {
    std::uint64_t code;
    std::uint64_t ratio;  // the most bytes that one stored byte becomes
    bool lossy;
};
constexpr CompressionKind kCompressions[] = {
    {1, 1, false},        // none
    {5, 4096, false},     // LZW: a 9 to 12 bit code stands for at most 4096 bytes
    {7, 1024, true},      // JPEG
    {8, 1032, false},     // Deflate
    {32773, 64, false},   // PackBits
    {32946, 1032, false}  // Deflate, older code
};

class TiffWalk {
  public:
    explicit TiffWalk(std::vector<std::uint8_t> file)
        : file_(std::move(file)), reader_(file_.data(), file_.size(), file_[0] == 'M') {
        result_.format = "TIFF";
        result_.plugin = "tiff";
        result_.suffix = ".tif";
    }

    Result<Container> run() {
        big_ = reader_.u16(2) == 43;
        for (Status (TiffWalk::*step)() : {&TiffWalk::directory, &TiffWalk::size, &TiffWalk::samples,
                                           &TiffWalk::coding, &TiffWalk::blocks}) {
            if (Status status = (this->*step)(); !status.ok()) return status.error();
        }
        if (Status status = narrow_doubles(); !status.ok()) return status.error();
        result_.bytes = std::move(file_);
        return std::move(result_);
    }

  private:
    std::uint64_t value(std::uint16_t tag, std::uint64_t index = 0) {
        const Field& field = fields_.at(tag);
        const int bytes = type_bytes(field.type);
        return reader_.unsigned_at(field.at + index * static_cast<std::uint64_t>(bytes), bytes);
    }
    std::uint64_t value_or(std::uint16_t tag, std::uint64_t fallback) {
        return fields_.count(tag) != 0 ? value(tag) : fallback;
    }

    // Reads the directory, then writes the kept entries back to its front and ends the chain of pages there.
    Status directory() {
        const std::uint64_t at = big_ ? reader_.u64(8) : reader_.u32(4);
        if (big_ && (reader_.u16(4) != 8 || reader_.u16(6) != 0))
            return damaged("TIFF: wrong BigTIFF header");
        const int count_bytes = big_ ? 8 : 2;
        const std::uint64_t entry_bytes = big_ ? 20 : 12;
        if (at < 8 || !reader_.has(at, static_cast<std::uint64_t>(count_bytes)))
            return damaged("TIFF: the directory would be at byte " + std::to_string(at) + ", past the file");
        const std::uint64_t count = reader_.unsigned_at(at, count_bytes);
        const std::uint64_t first = at + static_cast<std::uint64_t>(count_bytes);
        const std::uint64_t link_bytes = big_ ? 8 : 4;
        if (count == 0 || count > 4096 || !reader_.has(first, count * entry_bytes))
            return damaged("TIFF: the directory at byte " + std::to_string(at) + " has " +
                           std::to_string(count) + " entries, none or more than the file holds");
        std::uint64_t kept = 0;
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::uint64_t entry = first + i * entry_bytes;
            const std::uint16_t tag = reader_.u16(entry);
            if (std::find(std::begin(kKept), std::end(kKept), tag) == std::end(kKept)) continue;
            if (Status status = read_entry(tag, entry); !status.ok()) return status;
            std::copy_n(file_.begin() + static_cast<std::ptrdiff_t>(entry), entry_bytes,
                        file_.begin() + static_cast<std::ptrdiff_t>(first + kept * entry_bytes));
            // Values within the entry moved with it.
            Field& field = fields_[tag];
            if (field.at >= entry && field.at < entry + entry_bytes)
                field.at -= entry - (first + kept * entry_bytes);
            ++kept;
        }
        // The room for the link that ends the chain is there as soon as one entry was dropped; otherwise it
        // stood there.
        const std::uint64_t link = first + kept * entry_bytes;
        if (!reader_.has(link, link_bytes)) file_.resize(link + link_bytes);
        reader_ = ByteReader(file_.data(), file_.size(), file_[0] == 'M');
        write_number(at, kept, count_bytes);
        write_number(link, 0, static_cast<int>(link_bytes));
        return Done{};
    }

    void write_number(std::uint64_t at, std::uint64_t number, int bytes) {
        const bool big_endian = file_[0] == 'M';
        for (int i = 0; i < bytes; ++i) {
            const int shift = 8 * (big_endian ? bytes - 1 - i : i);
            file_[at + static_cast<std::uint64_t>(i)] = static_cast<std::uint8_t>(number >> shift);
        }
    }

    Status read_entry(std::uint16_t tag, std::uint64_t entry) {
        Field field;
        field.type = reader_.u16(entry + 2);
        field.count = reader_.unsigned_at(entry + 4, big_ ? 8 : 4);
        const auto bytes = static_cast<std::uint64_t>(type_bytes(field.type));
        const std::uint64_t inside = big_ ? 8 : 4;
        const std::uint64_t value_at = entry + (big_ ? 12 : 8);
        if (bytes == 0 || field.count == 0 || field.count > reader_.size())
            return damaged("TIFF: tag " + std::to_string(tag) + " has type " + std::to_string(field.type) +
                           " and " + std::to_string(field.count) + " values");
        const std::uint64_t total = bytes * field.count;
        field.at = total <= inside ? value_at : reader_.unsigned_at(value_at, static_cast<int>(inside));
        if (!reader_.has(field.at, total))
            return damaged("TIFF: the values of tag " + std::to_string(tag) +
                           " lie past the end of the file");
        const bool number = field.type == 1 || field.type == 3 || field.type == 4 || field.type == 16 ||
                            field.type == 6 || field.type == 7;
        if (!number)
            return damaged("TIFF: tag " + std::to_string(tag) + " has the wrong type " +
                           std::to_string(field.type));
        if (!fields_.emplace(tag, field).second)
            return damaged("TIFF: tag " + std::to_string(tag) + " stands there twice");
        return Done{};
    }

    Status size() {
        if (fields_.count(kWidth) == 0 || fields_.count(kHeight) == 0)
            return damaged("TIFF: the directory names no width or no height");
        result_.width = value(kWidth);
        result_.height = value(kHeight);
        if (result_.width == 0 || result_.height == 0 || result_.width > 0x7fffffff ||
            result_.height > 0x7fffffff)
            return damaged("TIFF: the size is " + std::to_string(result_.width) + "x" +
                           std::to_string(result_.height));
        return Done{};
    }

    Status samples() {
        const std::uint64_t samples = value_or(kSamples, 1);
        if (samples < 1 || samples > 4)
            return not_promised("TIFF: " + std::to_string(samples) + " channels; 1 to 4 are read");
        if (fields_.count(kBits) != 0 && fields_[kBits].count != 1 && fields_[kBits].count < samples)
            return damaged("TIFF: bits per sample are given for " + std::to_string(fields_[kBits].count) +
                           " of " + std::to_string(samples) + " channels");
        const std::uint64_t bits = value_or(kBits, 1);
        const std::uint64_t kind = value_or(kSampleFormat, 1);
        for (const std::uint16_t tag : {kBits, kSampleFormat}) {
            for (std::uint64_t i = 1; fields_.count(tag) != 0 && i < std::min(samples, fields_[tag].count);
                 ++i)
                if (value(tag, i) != value(tag))
                    return not_promised(
                        "TIFF: channels of different kinds are not read; give them the same bits");
        }
        const bool integer = (kind == 1 || kind == 2 || kind == 4) &&
                             (bits == 1 || bits == 2 || bits == 4 || bits == 8 || bits == 16 || bits == 32);
        const bool floating = kind == 3 && (bits == 16 || bits == 32 || bits == 64);
        if (!integer && !floating)
            return not_promised("TIFF: " + std::to_string(bits) + " bits of sample format " +
                                std::to_string(kind) +
                                " are not read; 1 to 32 bit integers, 16, 32 and 64 bit floats are");
        result_.channels = static_cast<int>(samples);
        result_.bit_depth = static_cast<int>(bits);
        result_.is_float = floating;
        result_.is_signed = kind == 2;
        return Done{};
    }

    Status coding() {
        const std::uint64_t code = value_or(kCompression, 1);
        for (const CompressionKind& kind : kCompressions)
            if (kind.code == code) compression_ = kind;
        if (compression_.code == 0)
            return not_promised("TIFF: compression " + std::to_string(code) +
                                " is not read; save it without, or with LZW, Deflate, PackBits or JPEG");
        result_.lossy = compression_.lossy;
        const std::uint64_t photometric = value_or(kPhotometric, 1);
        const bool ycbcr = photometric == 6 && code == 7;
        if (photometric > 3 && !ycbcr)
            return not_promised("TIFF: color model " + std::to_string(photometric) +
                                " is not read; save it as grey, RGB or palette");
        if (code == 7 && result_.bit_depth != 8)
            return damaged("TIFF: JPEG data of " + std::to_string(result_.bit_depth) + " bits");
        if (photometric == 3 && (result_.is_float || result_.bit_depth > 8 || result_.channels != 1 ||
                                 fields_.count(kColorMap) == 0 || fields_[kColorMap].type != 3 ||
                                 fields_[kColorMap].count != 3ull << result_.bit_depth))
            return damaged("TIFF: the palette is missing or has a wrong size");
        if (photometric == 2 && result_.channels < 3)
            return damaged("TIFF: RGB with fewer than three channels");
        const std::uint64_t planar = value_or(kPlanar, 1);
        if (planar != 1 && planar != 2)
            return damaged("TIFF: planar configuration " + std::to_string(planar));
        return Done{};
    }

    // Strips or tiles: every one's bytes lie within the file and can hold its texels.
    Status blocks() {
        const bool tiled = fields_.count(kTileWidth) != 0;
        const std::uint64_t w = tiled ? value(kTileWidth) : result_.width;
        const std::uint64_t rows = tiled ? value_or(kTileHeight, 0) : value_or(kRowsPerStrip, result_.height);
        const std::uint64_t h = tiled ? rows : std::min(rows, result_.height);
        constexpr std::uint64_t kMaxTileSide = 1u << 16;
        if (w == 0 || h == 0 ||
            (tiled && (w > kMaxTileSide || h > kMaxTileSide || w % 16 != 0 || h % 16 != 0)))
            return damaged("TIFF: strips or tiles of " + std::to_string(w) + "x" + std::to_string(h) +
                           " texels");
        const std::uint16_t offsets = tiled ? kTileOffsets : kStripOffsets;
        const std::uint16_t sizes = tiled ? kTileBytes : kStripBytes;
        if (fields_.count(offsets) == 0) return damaged("TIFF: no strip or tile offsets");
        const bool planar = value_or(kPlanar, 1) == 2 && result_.channels > 1;
        const std::uint64_t planes = planar ? static_cast<std::uint64_t>(result_.channels) : 1;
        const std::uint64_t across = (result_.width + w - 1) / w, down = (result_.height + h - 1) / h;
        if (down > reader_.size() || across > reader_.size() / down ||
            across * down * planes > fields_[offsets].count)
            return damaged("TIFF: " + std::to_string(fields_[offsets].count) +
                           " strips or tiles do not cover " + std::to_string(result_.width) + "x" +
                           std::to_string(result_.height) + " texels");
        if (planar && !tiled) result_.band_rows = h;
        return block_sizes(offsets, sizes, across * down, planes, w, h, tiled);
    }

    Status block_sizes(std::uint16_t offsets, std::uint16_t sizes, std::uint64_t per_plane,
                       std::uint64_t planes, std::uint64_t w, std::uint64_t h, bool tiled) {
        const bool known = fields_.count(sizes) != 0;
        const std::uint64_t count = per_plane * planes;
        if (known && fields_[sizes].count < count) return damaged("TIFF: too few strip or tile sizes");
        if (!known && (compression_.code != 1 || count != 1)) return damaged("TIFF: no strip or tile sizes");
        const std::uint64_t samples = planes > 1 ? 1 : static_cast<std::uint64_t>(result_.channels);
        const std::uint64_t row = (w * samples * static_cast<std::uint64_t>(result_.bit_depth) + 7) / 8;
        constexpr std::uint64_t kMaxTileBytes = 1ull << 28;
        if (tiled && row > kMaxTileBytes / h)
            return Error{ErrorCode::limit_exceeded, "TIFF: tiles of " + std::to_string(row * h) +
                                                        " bytes, limit " + std::to_string(kMaxTileBytes)};
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::uint64_t at = value(offsets, i);
            const std::uint64_t y = tiled ? 0 : (i % per_plane) * h;
            const std::uint64_t needed = row * (tiled ? h : std::min(h, result_.height - y));
            const std::uint64_t bytes = known ? value(sizes, i) : needed;
            if (bytes == 0 || !reader_.has(at, bytes))
                return damaged("TIFF: strip or tile " + std::to_string(i) + " has " + std::to_string(bytes) +
                               " bytes at " + std::to_string(at) + ", none or past the end of the file");
            if (bytes * compression_.ratio + 64 * compression_.ratio - 64 < needed)
                return damaged("TIFF: the " + std::to_string(bytes) + " bytes of strip or tile " +
                               std::to_string(i) + " cannot hold its texels");
        }
        return Done{};
    }

    // The decoder gives zeros for 64-bit floats: they are rewritten in place as 32-bit ones, which is what
    // heights are kept in anyway.
    Status narrow_doubles() {
        if (!result_.is_float || result_.bit_depth != 64) return Done{};
        if (compression_.code != 1)
            return not_promised("TIFF: compressed 64 bit floats are not read; save them as 32 bit floats");
        const bool tiled = fields_.count(kTileWidth) != 0;
        const std::uint16_t offsets = tiled ? kTileOffsets : kStripOffsets;
        const std::uint16_t sizes = tiled ? kTileBytes : kStripBytes;
        if (fields_.count(sizes) == 0) return damaged("TIFF: no strip or tile sizes");
        std::uint64_t total = 0;
        for (std::uint64_t i = 0; i < std::min(fields_[offsets].count, fields_[sizes].count); ++i) {
            const std::uint64_t at = value(offsets, i), bytes = value(sizes, i);
            total += std::min(bytes, reader_.size());
            if (total > reader_.size()) return damaged("TIFF: strips or tiles overlap");
            if (!reader_.has(at, bytes))
                return damaged("TIFF: strip or tile " + std::to_string(i) + " lies past the end");
            for (std::uint64_t k = 0; k + 8 <= bytes; k += 8) {
                const auto narrow = static_cast<float>(std::bit_cast<double>(reader_.u64(at + k)));
                write_number(at + k / 2, std::bit_cast<std::uint32_t>(narrow), 4);
            }
            set_value(sizes, i, bytes / 2);
        }
        for (std::uint64_t i = 0; i < fields_[kBits].count; ++i) set_value(kBits, i, 32);
        return Done{};
    }

    void set_value(std::uint16_t tag, std::uint64_t index, std::uint64_t number) {
        const Field& field = fields_.at(tag);
        const int bytes = type_bytes(field.type);
        write_number(field.at + index * static_cast<std::uint64_t>(bytes), number, bytes);
    }

    std::vector<std::uint8_t> file_;
    ByteReader reader_;
    Container result_;
    std::map<std::uint16_t, Field> fields_;
    CompressionKind compression_{0, 0, false};
    bool big_ = false;
};

}  // namespace

Result<Container> inspect_tiff(std::vector<std::uint8_t> file) { return TiffWalk(std::move(file)).run(); }

}  // namespace burin
