// JPEG: marker segments. Kept: everything but APPn and comments, save JFIF's APP0 and Adobe's APP14, which
// say how the colors are coded.
#include <algorithm>

#include "container.hpp"

namespace burin {
namespace {

// Each scan of a progressive picture visits every block: a bound on the work, in scans times texels.
constexpr std::uint64_t kMaxScanTexels = 1ull << 32;

std::string at_byte(std::uint64_t at) { return " at byte " + std::to_string(at); }

bool is_frame(int marker) {  // SOF0..15 without DHT, JPG, DAC
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

class JpegWalk {
  public:
    explicit JpegWalk(const std::vector<std::uint8_t>& file)
        : file_(file), reader_(file.data(), file.size(), true) {
        result_.format = "JPEG";
        result_.plugin = "jpeg";
        result_.suffix = ".jpg";
        result_.lossy = true;
    }

    Result<Container> run() {
        keep(0, 2);
        std::uint64_t at = 2;
        while (true) {
            // Fill bytes may stand before a marker.
            while (reader_.has(at, 2) && reader_.u8(at) == 0xff && reader_.u8(at + 1) == 0xff) ++at;
            if (!reader_.has(at, 2))
                return damaged("JPEG: the file is cut off at byte " + std::to_string(file_.size()));
            if (reader_.u8(at) != 0xff) return damaged("JPEG: there is no marker" + at_byte(at));
            const int marker = reader_.u8(at + 1);
            if (marker == 0xd9) return finish(at);
            if (marker == 0x01 || (marker >= 0xd0 && marker <= 0xd7)) {
                at += 2;  // stands alone and means nothing here
                continue;
            }
            if (Status status = segment(marker, at); !status.ok()) return status.error();
            at += 2 + reader_.u16(at + 2);
            if (marker == 0xda) at = scan_data(at);
        }
    }

  private:
    void keep(std::uint64_t begin, std::uint64_t end) {
        result_.bytes.insert(result_.bytes.end(), file_.begin() + static_cast<std::ptrdiff_t>(begin),
                             file_.begin() + static_cast<std::ptrdiff_t>(end));
    }

    Status segment(int marker, std::uint64_t at) {
        const std::uint64_t size = reader_.u16(at + 2);
        if (marker < 0xc0 || marker == 0xd8) return damaged("JPEG: misplaced marker" + at_byte(at));
        if (size < 2 || !reader_.has(at + 2, size))
            return damaged("JPEG: the segment" + at_byte(at) + " has " + std::to_string(size) +
                           " bytes, more than the file or less than two");
        if (is_frame(marker)) {
            if (Status status = frame(marker, at + 4, size - 2); !status.ok()) return status;
        }
        if (marker == 0xda) {
            if (result_.width == 0)
                return damaged("JPEG: a scan" + at_byte(at) + " comes before the frame header");
            ++scans_;
            if (scans_ * result_.width * result_.height > kMaxScanTexels && scans_ > 1)
                return Error{ErrorCode::limit_exceeded,
                             "JPEG: " + std::to_string(scans_) + " scans of " +
                                 std::to_string(result_.width) + "x" + std::to_string(result_.height) +
                                 " texels, limit " + std::to_string(kMaxScanTexels) +
                                 " texel visits; save it as baseline JPEG"};
        }
        const bool application = marker >= 0xe0 && marker <= 0xef && marker != 0xe0 && marker != 0xee;
        if (!application && marker != 0xfe) keep(at, at + 2 + size);
        return Done{};
    }

    Status frame(int marker, std::uint64_t at, std::uint64_t size) {
        const bool progressive = marker == 0xc2 || marker == 0xca;
        if (marker != 0xc0 && marker != 0xc1 && marker != 0xc9 && !progressive)
            return not_promised("JPEG: frame type " + std::to_string(marker - 0xc0) +
                                " (lossless or hierarchical) is not read; save it as baseline JPEG");
        if (result_.width != 0) return damaged("JPEG: there is a second frame header" + at_byte(at));
        const int components = reader_.u8(at + 5);
        if (size != 6 + 3 * static_cast<std::uint64_t>(components))
            return damaged("JPEG: the frame header has a wrong size");
        if (reader_.u8(at) != 8)
            return not_promised("JPEG: " + std::to_string(reader_.u8(at)) +
                                " bits a channel are not read, only 8");
        if (components != 1 && components != 3)
            return not_promised("JPEG: " + std::to_string(components) +
                                " components (CMYK, for instance) are not read, only grey and color");
        result_.height = reader_.u16(at + 1);
        result_.width = reader_.u16(at + 3);
        if (result_.width == 0 || result_.height == 0)
            return damaged("JPEG: the frame header gives the size " + std::to_string(result_.width) + "x" +
                           std::to_string(result_.height));
        result_.channels = components;
        result_.progressive = progressive;
        arithmetic_ = marker >= 0xc9;
        return Done{};
    }

    // Entropy-coded bytes run to the next marker that is neither a restart nor a stuffed zero.
    std::uint64_t scan_data(std::uint64_t at) {
        const std::uint64_t begin = at;
        while (at + 1 < file_.size()) {
            if (file_[at] == 0xff && file_[at + 1] != 0 && (file_[at + 1] < 0xd0 || file_[at + 1] > 0xd7) &&
                file_[at + 1] != 0xff)
                break;
            ++at;
        }
        if (at + 1 >= file_.size()) at = file_.size();
        scan_bytes_ += at - begin;
        keep(begin, at);
        return at;
    }

    Result<Container> finish(std::uint64_t at) {
        if (scans_ == 0) return damaged("JPEG: there is no scan, so no picture");
        // Every block of 8 x 8 needs a bit in the first scan when the coding is Huffman's.
        constexpr std::uint64_t kTexelsPerByte = 8 * 64 * 2;
        if (!arithmetic_ && scan_bytes_ * kTexelsPerByte + 4096 < result_.width * result_.height)
            return damaged("JPEG: " + std::to_string(scan_bytes_) + " bytes of data cannot hold " +
                           std::to_string(result_.width) + "x" + std::to_string(result_.height) + " texels");
        keep(at, at + 2);
        return std::move(result_);
    }

    const std::vector<std::uint8_t>& file_;
    ByteReader reader_;
    Container result_;
    std::uint64_t scans_ = 0;
    std::uint64_t scan_bytes_ = 0;
    bool arithmetic_ = false;
};

}  // namespace

Result<Container> inspect_jpeg(const std::vector<std::uint8_t>& file) { return JpegWalk(file).run(); }

}  // namespace burin
