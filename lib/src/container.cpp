#include "container.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace burin {
namespace {

bool starts_with(const std::vector<std::uint8_t>& file, std::string_view signature, std::size_t at = 0) {
    return file.size() >= at + signature.size() &&
           std::memcmp(file.data() + at, signature.data(), signature.size()) == 0;
}

// What a file of another kind is, as far as its first bytes tell.
std::string known_kind(const std::vector<std::uint8_t>& file) {
    struct Kind {
        std::string_view signature;
        const char* name;
    };
    static constexpr Kind kKinds[] = {{"BM", "a BMP"},         {"DDS ", "a DDS"},
                                      {"GIF8", "a GIF"},       {"RIFF", "a WebP"},
                                      {"8BPS", "a Photoshop"}, {"glTF", "a binary glTF"},
                                      {"%PDF", "a PDF"},       {"\xabKTX", "a KTX"},
                                      {"<svg", "an SVG"},      {"<?xml", "an XML"},
                                      {"#?RAD", "a Radiance"}, {"P5", "a PGM"},
                                      {"P6", "a PPM"},         {"Pf", "a PFM"},
                                      {"PF", "a PFM"},         {"\xff\x4f\xff\x51", "a JPEG 2000"}};
    for (const Kind& kind : kKinds)
        if (starts_with(file, kind.signature)) return kind.name;
    if (starts_with(file, "jP  ", 4)) return "a JPEG 2000";
    if (starts_with(file, "ftypavif", 4)) return "an AVIF";
    if (starts_with(file, "ftyphei", 4)) return "a HEIF";
    return "";
}

Error unknown_format(const std::vector<std::uint8_t>& file) {
    constexpr const char* kPromised = "; height maps are read from PNG, JPEG, TIFF and OpenEXR";
    if (file.empty()) return damaged("the file is empty");
    const std::string kind = known_kind(file);
    if (!kind.empty()) return not_promised("it is " + kind + " file" + kPromised);
    return not_promised(std::string("its first bytes are of no known picture format") + kPromised);
}

}  // namespace

Status check_size(std::uint64_t width, std::uint64_t height, std::uint64_t max_texels) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    if (width == 0 || height == 0) return damaged("its size is " + size);
    if (width > max_texels / height)
        return Error{ErrorCode::limit_exceeded,
                     "it has " + size + " texels, limit " + std::to_string(max_texels) + "; scale it down"};
    constexpr std::uint64_t kMaxSide = 1u << 20;
    if (std::max(width, height) > kMaxSide)
        return Error{ErrorCode::limit_exceeded,
                     "its size is " + size + ", the limit of a side is " + std::to_string(kMaxSide)};
    return Done{};
}

Result<Container> inspect_image(std::vector<std::uint8_t> file, std::uint64_t max_texels) {
    const auto checked = [&](Result<Container> container) -> Result<Container> {
        if (!container.ok()) return container;
        if (Status status = check_size(container->width, container->height, max_texels); !status.ok())
            return status.error();
        return container;
    };
    using namespace std::string_view_literals;
    if (starts_with(file, "\x89PNG"sv)) return inspect_png(file, max_texels);
    if (starts_with(file, "\xff\xd8\xff"sv)) return checked(inspect_jpeg(file));
    if (starts_with(file, "II\x2a\0"sv) || starts_with(file, "MM\0\x2a"sv) ||
        starts_with(file, "II\x2b\0"sv) || starts_with(file, "MM\0\x2b"sv))
        return checked(inspect_tiff(std::move(file)));
    if (starts_with(file, "\x76\x2f\x31\x01"sv)) return checked(inspect_exr(file));
    return unknown_format(file);
}

}  // namespace burin
