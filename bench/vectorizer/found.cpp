#include "found.hpp"

#include <ctime>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <OpenImageIO/imageio.h>

#include <burin/convert.hpp>
#include <burin/image_io.hpp>
#include <burin/pack.hpp>

namespace burin::bench {
namespace {

[[noreturn]] void leave(const std::string& message) {
    std::fprintf(stderr, "vectorizer: %s\n", message.c_str());
    std::exit(3);
}

template <typename T>
T value_or_leave(Result<T> result) {
    if (!result) leave(result.error().message);
    return std::move(*result);
}

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

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

Found found_in(const HeightMap& map, const Pattern& like) {
    ConvertOptions options;
    options.vectorize.size = like.size;
    options.vectorize.depth = like.depth;
    options.vectorize.wrap = like.wrap == Wrap::repeat ? WrapChoice::repeat : WrapChoice::clamp;
    options.threads = 1;
    const double begun = processor_seconds();
    FoundPattern pattern = value_or_leave(find_pattern(map, options));
    Found found;
    found.seconds = processor_seconds() - begun;
    found.stored = value_or_leave(unpack_textures(pattern.textures, pattern.detail)).pattern;
    found.pattern = std::move(pattern.pattern);
    found.texture_bytes = pattern.stats.grid_bytes + pattern.stats.data_bytes;
    found.elements = found.stored.elements.size();
    found.explained = pattern.stats.explained;
    return found;
}

}  // namespace burin::bench
