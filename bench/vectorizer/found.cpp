#include "found.hpp"

#include <ctime>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include <OpenImageIO/imageio.h>

#include <burin/compare.hpp>
#include <burin/grid.hpp>
#include <burin/image_io.hpp>
#include <burin/pack.hpp>
#include <burin/rasterize.hpp>
#include <burin/refine.hpp>
#include <burin/vectorize.hpp>

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

// The pattern packed and read back, and what it explains then.
Result<Found> stored(const Pattern& pattern, const Image& map) {
    const auto resolved = resolve_pattern(pattern, {.lenient = true});
    if (!resolved) return resolved.error();
    GridOptions grid_options;
    grid_options.threads = 1;
    const auto grid = build_grid(*resolved, grid_options);
    if (!grid) return grid.error();
    const auto textures = pack_textures(*resolved, *grid);
    if (!textures) return textures.error();
    Found found;
    found.pattern = pattern;
    found.stored = value_or_leave(unpack_textures(*textures, describe_pattern(*resolved, *textures))).pattern;
    found.texture_bytes = (textures->grid.size() + textures->data.size()) * sizeof(std::uint32_t);
    found.elements = found.stored.elements.size();
    RasterizeOptions drawing;
    drawing.threads = 1;
    drawing.level_tolerance = 4e-5;
    const Image heights = rasterize_height(found.stored, map.width, map.height, drawing);
    found.explained = compare_heights(heights, map, pattern.wrap).explained;
    return found;
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

Found find_pattern_of(const HeightMap& map, const Pattern& like) {
    const double begun = processor_seconds();
    VectorizeOptions options;
    options.size = like.size;
    options.depth = like.depth;
    options.wrap = like.wrap == Wrap::repeat ? WrapChoice::repeat : WrapChoice::clamp;
    options.threads = 1;
    const Pattern traced = value_or_leave(vectorize_map(map, options)).pattern;
    Found found = value_or_leave(stored(traced, map.image));
    Pattern refined = traced;
    RefineOptions refinement;
    refinement.threads = 1;
    if (!traced.paths.empty() && refine_pattern(refined, map.image, refinement)) {
        Result<Found> better = stored(refined, map.image);
        if (better && better->explained >= found.explained) found = std::move(*better);
    }
    found.seconds = processor_seconds() - begun;
    return found;
}

}  // namespace burin::bench
