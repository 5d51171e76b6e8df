// OpenEXR, single part: header attributes, the table of chunk offsets and every chunk's head. Kept of the
// header: what decoding needs. The header keeps its length, since the offsets count from the start of the
// file.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "container.hpp"

namespace burin {
namespace {

struct Attribute {
    std::string name, type;
    std::uint64_t begin = 0, data = 0, size = 0;
    std::uint64_t end() const { return data + size; }
};

struct Window {
    std::int64_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;
    std::int64_t width() const { return x1 - x0 + 1; }
    std::int64_t height() const { return y1 - y0 + 1; }
};

constexpr std::array<const char*, 9> kKept{"channels",           "compression",       "dataWindow",
                                           "displayWindow",      "lineOrder",         "pixelAspectRatio",
                                           "screenWindowCenter", "screenWindowWidth", "tiles"};
// Rows of one chunk, by compression: none, RLE, ZIPS, ZIP, PIZ, PXR24, B44, B44A, DWAA, DWAB.
constexpr std::array<int, 10> kRows{1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
constexpr int kFirstLossy = 5;  // PXR24 and those after it

class ExrWalk {
  public:
    explicit ExrWalk(const std::vector<std::uint8_t>& file)
        : file_(file), reader_(file.data(), file.size(), false) {
        result_.format = "OpenEXR";
        result_.plugin = "openexr";
        result_.suffix = ".exr";
    }

    Result<Container> run() {
        for (Status (ExrWalk::*step)() : {&ExrWalk::version, &ExrWalk::header, &ExrWalk::windows,
                                          &ExrWalk::channels, &ExrWalk::coding, &ExrWalk::chunks}) {
            if (Status status = (this->*step)(); !status.ok()) return status.error();
        }
        rewrite();
        return std::move(result_);
    }

  private:
    Status version() {
        const std::uint32_t word = reader_.u32(4);
        if (file_.size() < 8) return damaged("OpenEXR: the file ends within its header");
        if ((word & 0xff) != 2)
            return not_promised("OpenEXR: version " + std::to_string(word & 0xff) + " is not read, only 2");
        if ((word & 0x1800) != 0)
            return not_promised("OpenEXR: deep and multi-part files are not read; save one flat part");
        if ((word & ~0x6ffu) != 0) return damaged("OpenEXR: unknown version flags");
        tiled_ = (word & 0x200) != 0;
        longest_name_ = (word & 0x400) != 0 ? 255 : 31;
        return Done{};
    }

    bool read_name(std::uint64_t& at, std::string& name) {
        name.clear();
        while (reader_.has(at, 1) && file_[at] != 0) {
            if (name.size() == 255) return false;
            name.push_back(static_cast<char>(file_[at++]));
        }
        return reader_.has(at++, 1);
    }

    Status header() {
        std::uint64_t at = 8;
        while (true) {
            Attribute a;
            a.begin = at;
            if (!read_name(at, a.name))
                return damaged("OpenEXR: the header at byte " + std::to_string(at) + " is damaged");
            if (a.name.empty()) break;
            const bool named = read_name(at, a.type) && a.name.size() <= longest_name_;
            a.size = reader_.u32(at);
            a.data = at + 4;
            if (!named || !reader_.has(at, 4) || !reader_.has(a.data, a.size))
                return damaged("OpenEXR: the attribute at byte " + std::to_string(a.begin) +
                               " runs past the file");
            at = a.end();
            attributes_.push_back(a);
            constexpr std::size_t kMaxAttributes = 4096;
            if (attributes_.size() > kMaxAttributes) return damaged("OpenEXR: more than 4096 attributes");
        }
        header_end_ = at;
        return Done{};
    }

    Result<Attribute> find(const char* name, const char* type, std::uint64_t size) {
        const Attribute* found = nullptr;
        for (const Attribute& a : attributes_) {
            if (a.name != name) continue;
            if (found != nullptr)
                return damaged(std::string("OpenEXR: the attribute ") + name + " stands there twice");
            found = &a;
        }
        if (found == nullptr) return damaged(std::string("OpenEXR: the attribute ") + name + " is missing");
        if (found->type != type || (size != 0 && found->size != size))
            return damaged(std::string("OpenEXR: the attribute ") + name + " has a wrong type or size");
        return *found;
    }

    std::int32_t i32(std::uint64_t at) { return static_cast<std::int32_t>(reader_.u32(at)); }

    Status windows() {
        for (const char* name : {"dataWindow", "displayWindow"}) {
            Result<Attribute> a = find(name, "box2i", 16);
            if (!a.ok()) return a.error();
            Window w{i32(a->data), i32(a->data + 4), i32(a->data + 8), i32(a->data + 12)};
            constexpr std::int64_t kFar = 1 << 28;
            const bool near = std::min(w.x0, w.y0) > -kFar && std::max(w.x1, w.y1) < kFar;
            if (!near || w.width() < 1 || w.height() < 1)
                return damaged(std::string("OpenEXR: the ") + name + " runs from (" + std::to_string(w.x0) +
                               ", " + std::to_string(w.y0) + ") to (" + std::to_string(w.x1) + ", " +
                               std::to_string(w.y1) + ")");
            if (name[1] == 'a') window_ = w;
        }
        result_.width = static_cast<std::uint64_t>(window_.width());
        result_.height = static_cast<std::uint64_t>(window_.height());
        return Done{};
    }

    Status channels() {
        Result<Attribute> list = find("channels", "chlist", 0);
        if (!list.ok()) return list.error();
        result_.channels = 0;
        int last_type = -1;
        for (std::uint64_t at = list->data; at < list->end();) {
            std::string name;
            if (!read_name(at, name) || at > list->end())
                return damaged("OpenEXR: the channel list is damaged");
            if (name.empty()) break;
            if (at + 16 > list->end()) return damaged("OpenEXR: the channel list is damaged");
            const int type = i32(at);
            if (type < 0 || type > 2)
                return damaged("OpenEXR: channel " + name + " has type " + std::to_string(type));
            if (i32(at + 8) != 1 || i32(at + 12) != 1)
                return not_promised("OpenEXR: channel " + name +
                                    " is subsampled (luminance and chroma); save it as RGB or Y");
            if (last_type >= 0 && type != last_type)
                return not_promised("OpenEXR: channels of different types are not read; give them the same");
            last_type = type;
            at += 16;
            ++result_.channels;
        }
        constexpr int kMaxChannels = 64;
        if (result_.channels < 1 || result_.channels > kMaxChannels)
            return not_promised("OpenEXR: " + std::to_string(result_.channels) +
                                " channels; 1 to 64 are read");
        result_.bit_depth = last_type == 1 ? 16 : 32;
        result_.is_float = last_type != 0;
        return Done{};
    }

    Status coding() {
        Result<Attribute> compression = find("compression", "compression", 1);
        if (!compression.ok()) return compression.error();
        compression_ = reader_.u8(compression->data);
        if (compression_ >= static_cast<int>(kRows.size()))
            return not_promised("OpenEXR: compression " + std::to_string(compression_) + " is not read");
        result_.lossy = compression_ >= kFirstLossy;
        struct Required {
            const char *name, *type;
            std::uint64_t size;
        };
        for (const Required& r :
             {Required{"lineOrder", "lineOrder", 1}, Required{"pixelAspectRatio", "float", 4},
              Required{"screenWindowCenter", "v2f", 8}, Required{"screenWindowWidth", "float", 4}}) {
            Result<Attribute> a = find(r.name, r.type, r.size);
            if (!a.ok()) return a.error();
            if (r.size == 1 && reader_.u8(a->data) > 2) return damaged("OpenEXR: unknown line order");
            if (std::strcmp(r.type, "float") == 0 &&
                !std::isfinite(std::bit_cast<float>(reader_.u32(a->data))))
                return damaged(std::string("OpenEXR: ") + r.name + " is not a finite number");
        }
        return tiled_ ? tiles() : Done{};
    }

    Status tiles() {
        Result<Attribute> a = find("tiles", "tiledesc", 9);
        if (!a.ok()) return a.error();
        tile_width_ = reader_.u32(a->data);
        tile_height_ = reader_.u32(a->data + 4);
        constexpr std::uint64_t kMaxTileSide = 1u << 14;
        if (tile_width_ == 0 || tile_height_ == 0 || tile_width_ > kMaxTileSide ||
            tile_height_ > kMaxTileSide)
            return damaged("OpenEXR: tiles of " + std::to_string(tile_width_) + "x" +
                           std::to_string(tile_height_) + " texels");
        if ((reader_.u8(a->data + 8) & 0x0f) != 0)
            return not_promised(
                "OpenEXR: files with several levels of resolution are not read; save one level");
        return Done{};
    }

    // Every chunk of the table lies within the file and is no larger than its texels.
    Status chunks() {
        const std::uint64_t w = tiled_ ? tile_width_ : result_.width;
        const std::uint64_t h =
            tiled_ ? tile_height_ : static_cast<std::uint64_t>(kRows[static_cast<std::size_t>(compression_)]);
        const std::uint64_t across = (result_.width + w - 1) / w;
        const std::uint64_t count = across * ((result_.height + h - 1) / h);
        if (count > file_.size() / 8 || !reader_.has(header_end_, count * 8))
            return damaged("OpenEXR: the file ends within its table of " + std::to_string(count) + " chunks");
        const std::uint64_t head = tiled_ ? 20 : 8;
        const auto texel_bytes = static_cast<std::uint64_t>(result_.channels * result_.bit_depth / 8);
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::uint64_t at = reader_.u64(header_end_ + 8 * i);
            if (at < header_end_ + 8 * count || !reader_.has(at, head))
                return damaged("OpenEXR: chunk " + std::to_string(i) + " would be at byte " +
                               std::to_string(at) + ", outside the data; the file is incomplete or damaged");
            const std::uint32_t size = reader_.u32(at + head - 4);
            if (size == 0 || !reader_.has(at + head, size) || size > w * h * texel_bytes)
                return damaged("OpenEXR: chunk " + std::to_string(i) + " has " + std::to_string(size) +
                               " bytes, none or more than its texels or the file");
            if (Status status = chunk_place(i, at, across, h); !status.ok()) return status;
        }
        return Done{};
    }

    Status chunk_place(std::uint64_t i, std::uint64_t at, std::uint64_t across, std::uint64_t rows) {
        const auto column = static_cast<std::int64_t>(tiled_ ? i % across : 0);
        const auto row = static_cast<std::int64_t>(tiled_ ? i / across : i * rows);
        const bool right =
            tiled_ ? i32(at) == column && i32(at + 4) == row && i32(at + 8) == 0 && i32(at + 12) == 0
                   : i32(at) == window_.y0 + row;
        if (!right) return damaged("OpenEXR: chunk " + std::to_string(i) + " says that it belongs elsewhere");
        return Done{};
    }

    // Dropped attributes give way to one of no known type that fills their place.
    void rewrite() {
        result_.bytes.assign(file_.begin(), file_.begin() + 8);
        for (const Attribute& a : attributes_) {
            if (std::none_of(kKept.begin(), kKept.end(), [&](const char* name) { return a.name == name; }))
                continue;
            if (a.name == "tiles" && !tiled_) continue;
            result_.bytes.insert(result_.bytes.end(), file_.begin() + static_cast<std::ptrdiff_t>(a.begin),
                                 file_.begin() + static_cast<std::ptrdiff_t>(a.end()));
        }
        // name "z", type "z", length: 8 bytes are the least that an attribute takes, so that the rest is
        // never negative.
        const std::uint64_t gap = header_end_ - 1 - result_.bytes.size();
        if (gap >= 8) {
            const auto rest = static_cast<std::uint32_t>(gap - 8);
            for (const char c : {'z', '\0', 'z', '\0'}) result_.bytes.push_back(static_cast<std::uint8_t>(c));
            for (int shift = 0; shift < 32; shift += 8)
                result_.bytes.push_back(static_cast<std::uint8_t>(rest >> shift));
            result_.bytes.resize(result_.bytes.size() + rest, 0);
        }
        result_.bytes.insert(result_.bytes.end(),
                             file_.begin() + static_cast<std::ptrdiff_t>(header_end_ - 1), file_.end());
    }

    const std::vector<std::uint8_t>& file_;
    ByteReader reader_;
    Container result_;
    std::vector<Attribute> attributes_;
    Window window_;
    std::uint64_t header_end_ = 0, tile_width_ = 0, tile_height_ = 0;
    std::size_t longest_name_ = 31;
    int compression_ = 0;
    bool tiled_ = false;
};

}  // namespace

Result<Container> inspect_exr(const std::vector<std::uint8_t>& file) { return ExrWalk(file).run(); }

}  // namespace burin
