#include "damage.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include <OpenImageIO/imageio.h>

#include <burin/image_io.hpp>

#include "leave.hpp"

namespace burin::bench {
namespace {

std::vector<std::uint8_t> bytes_of(const Image& map) {
    std::vector<std::uint8_t> bytes(map.texels.size());
    std::transform(map.texels.begin(), map.texels.end(), bytes.begin(), [](float v) {
        return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(double(v), 0.0, 1.0)));
    });
    return bytes;
}

void write_jpeg(const std::string& path, const Image& map) {
    const std::vector<std::uint8_t> bytes = bytes_of(map);
    OIIO::ImageSpec form(map.width, map.height, 1, OIIO::TypeDesc::UINT8);
    form.attribute("Compression", "jpeg:85");
    const auto output = OIIO::ImageOutput::create(path);
    if (!output || !output->open(path, form) || !output->write_image(OIIO::TypeDesc::UINT8, bytes.data()) || !output->close())
        leave(path + ": " + (output ? output->geterror() : OIIO::geterror()));
}

void write_grey(const std::string& path, const Image& map) {
    RgbaImage picture{map.width, map.height, {}};
    for (const std::uint8_t grey : bytes_of(map)) picture.texels.insert(picture.texels.end(), {grey, grey, grey, 255});
    value_or_leave(write_png(path, picture));
}

void write_fine(const std::string& path, Image map) {
    for (float& v : map.texels) v = std::clamp(v, 0.0f, 1.0f);
    value_or_leave(write_height(path, map));
}

}  // namespace

HeightMap damaged(const Image& map, Damage damage, const std::string& folder) {
    const std::string path = folder + (damage == Damage::jpeg ? "/map.jpg" : "/map.png");
    switch (damage) {
        case Damage::sixteen_bit: write_fine(path, map); break;
        case Damage::eight_bit: write_grey(path, map); break;
        case Damage::jpeg: write_jpeg(path, map); break;
    }
    HeightMapOptions options;
    options.threads = 1;
    HeightMap read = value_or_leave(read_height_map(path, options));
    std::remove(path.c_str());
    return read;
}

}  // namespace burin::bench
