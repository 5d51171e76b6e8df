#include <burin/radiance.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <string_view>

#include <burin/image_io.hpp>

#include "decoder.hpp"

namespace burin {
namespace {

constexpr std::uint64_t kMaxFileBytes = 1ull << 30;

Status check_sides(std::int64_t width, std::int64_t height) {
    if (width >= kMinRadianceSide && height >= kMinRadianceSide && width <= kMaxRadianceSide && height <= kMaxRadianceSide)
        return Done{};
    return Error{ErrorCode::limit_exceeded, "its size is " + std::to_string(width) + "x" + std::to_string(height) +
                                                ", sides of " + std::to_string(kMinRadianceSide) + " to " +
                                                std::to_string(kMaxRadianceSide) + " texels work"};
}

// Text lines at the start of a Radiance file; bytes are taken from the front.
class HdrBytes {
  public:
    explicit HdrBytes(const std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

    // Without its end; nothing when the file ends first, or a line is longer than any header has.
    std::optional<std::string> line() {
        std::string text;
        while (at_ < bytes_.size() && text.size() < 4096) {
            const char c = static_cast<char>(bytes_[at_++]);
            if (c == '\n') return text;
            text += c;
        }
        return std::nullopt;
    }
    bool has(std::size_t count) const { return count <= bytes_.size() - at_; }
    std::uint8_t next() { return bytes_[at_++]; }
    std::uint8_t peek(std::size_t ahead) const { return bytes_[at_ + ahead]; }

  private:
    const std::vector<std::uint8_t>& bytes_;
    std::size_t at_ = 0;
};

struct HdrSize {
    int width = 0, height = 0;
};

Result<HdrSize> read_hdr_header(HdrBytes& bytes) {
    for (auto line = bytes.line(); line.has_value(); line = bytes.line()) {
        if (line->rfind("FORMAT=", 0) == 0 && *line != "FORMAT=32-bit_rle_rgbe")
            return not_promised("Radiance HDR: " + *line + "; 32-bit_rle_rgbe works");
        if (!line->empty()) continue;
        const auto size = bytes.line();
        long width = 0, height = 0;
        char rest = 0;
        if (!size.has_value() || std::sscanf(size->c_str(), "-Y %9ld +X %9ld%c", &height, &width, &rest) != 2)
            return not_promised("Radiance HDR: its rows lie in the order '" + size.value_or("") + "'; -Y HEIGHT +X WIDTH works");
        if (Status status = check_sides(width, height); !status.ok()) return status.error();
        return HdrSize{static_cast<int>(width), static_cast<int>(height)};
    }
    return damaged("Radiance HDR: the file ends within its header");
}

// One channel of a row: runs and copies.
bool read_run_lengths(HdrBytes& bytes, std::size_t width, std::uint8_t* out) {
    for (std::size_t x = 0; x < width;) {
        if (!bytes.has(2)) return false;
        std::size_t count = bytes.next();
        const bool run = count > 128;
        if (run) count -= 128;
        if (count == 0 || count > width - x || !bytes.has(run ? 1 : count)) return false;
        const std::uint8_t value = run ? bytes.next() : 0;
        for (std::size_t i = 0; i < count; ++i) out[4 * x++] = run ? value : bytes.next();
    }
    return true;
}

bool read_hdr_row(HdrBytes& bytes, std::size_t width, std::vector<std::uint8_t>& row) {
    if (!bytes.has(4)) return false;
    const bool packed = width >= 8 && width < 32768 && bytes.peek(0) == 2 && bytes.peek(1) == 2 && bytes.peek(2) < 128;
    if (packed) {
        if ((std::size_t{bytes.peek(2)} << 8 | bytes.peek(3)) != width) return false;
        for (int i = 0; i < 4; ++i) bytes.next();
        for (std::size_t channel = 0; channel < 4; ++channel)
            if (!read_run_lengths(bytes, width, row.data() + channel)) return false;
        return true;
    }
    if (!bytes.has(4 * width)) return false;
    for (std::uint8_t& byte : row) byte = bytes.next();
    return true;
}

Result<RadianceMap> decode_hdr(const std::vector<std::uint8_t>& file) {
    HdrBytes bytes(file);
    Result<HdrSize> size = read_hdr_header(bytes);
    if (!size.ok()) return size.error();
    RadianceMap map{size->width, size->height, {}};
    const auto width = static_cast<std::size_t>(map.width);
    std::vector<std::uint8_t> row(4 * width);
    for (int y = 0; y < map.height; ++y) {
        if (!read_hdr_row(bytes, width, row)) return damaged("Radiance HDR: row " + std::to_string(y) + " is damaged or missing");
        for (std::size_t x = 0; x < width; ++x)
            for (std::size_t c = 0; c < 3; ++c)
                map.texels.push_back(row[4 * x + 3] == 0 ? 0.0f : std::ldexp(static_cast<float>(row[4 * x + c]), row[4 * x + 3] - 136));
    }
    return map;
}

// Where red, green and blue lie in a texel.
Result<std::array<std::size_t, 3>> color_channels(const OIIO::ImageSpec& spec) {
    if (spec.nchannels == 1) return std::array<std::size_t, 3>{0, 0, 0};
    std::array<std::size_t, 3> places{};
    constexpr std::array<const char*, 3> kNames{"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
        const int place = spec.channelindex(kNames[c]);
        if (place < 0) return not_promised("OpenEXR: there is no channel " + std::string(kNames[c]) + "; R, G and B work, or one channel");
        places[c] = static_cast<std::size_t>(place);
    }
    return places;
}

Result<RadianceMap> decode_exr(const Container& container) {
    Decoder decoder(container);
    if (Status status = open_decoder(decoder, 1); !status.ok()) return status.error();
    const OIIO::ImageSpec& spec = decoder.spec;
    const auto places = color_channels(spec);
    if (!places.ok()) return places.error();
    const std::size_t count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
    const auto channels = static_cast<std::size_t>(spec.nchannels);
    std::vector<float> values(count * channels);
    if (!decoder.input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data()) || decoder.input->has_error())
        return decoder_error(container, decoder.input->geterror());
    RadianceMap map{spec.width, spec.height, {}};
    map.texels.reserve(count * 3);
    for (std::size_t i = 0; i < count; ++i)
        for (const std::size_t place : *places) {
            const float value = values[i * channels + place];
            if (!std::isfinite(value))
                return damaged("OpenEXR: the value of texel (" + std::to_string(i % static_cast<std::size_t>(spec.width)) + ", " +
                               std::to_string(i / static_cast<std::size_t>(spec.width)) + ") is not a finite number");
            map.texels.push_back(std::max(value, 0.0f));
        }
    return map;
}

Result<RadianceMap> decode_radiance(std::vector<std::uint8_t> file) {
    const std::string_view start(reinterpret_cast<const char*>(file.data()), std::min<std::size_t>(file.size(), 10));
    if (start.rfind("#?", 0) == 0) return decode_hdr(file);
    if (start.rfind("\x76\x2f\x31\x01", 0) != 0) return not_promised("it is neither Radiance HDR nor OpenEXR");
    Result<Container> container = inspect_image(std::move(file), 1ull << 28);
    if (!container.ok()) return container.error();
    if (Status status = check_sides(static_cast<std::int64_t>(container->width), static_cast<std::int64_t>(container->height)); !status.ok())
        return status.error();
    return decode_exr(*container);
}

}  // namespace

Result<RadianceMap> read_radiance(const std::string& path) {
    Result<std::vector<std::uint8_t>> file = read_file(path, kMaxFileBytes);
    if (!file.ok()) return file.error();
    const auto named = [&](const Error& error) {
        return Error{error.code, "cannot read environment '" + path + "': " + error.message};
    };
    // Decoders may throw; nothing of that leaves this library.
    try {
        Result<RadianceMap> map = decode_radiance(std::move(*file));
        if (!map.ok()) return named(map.error());
        return map;
    } catch (const std::exception& problem) {
        return named(damaged(problem.what()));
    }
}

}  // namespace burin
