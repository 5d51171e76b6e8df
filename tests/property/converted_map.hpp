// The whole conversion of an image, with the options of a user who gives none but a depth, in metres; the map is 1 m wide.
#pragma once

#include <utility>

#include <gtest/gtest.h>

#include <burin/convert.hpp>

namespace burin::testing {

inline Converted converted(const Image& image, double depth = VectorizeOptions{}.depth) {
    HeightMap map;
    map.image = image;
    ConvertOptions options;
    options.vectorize.size = {1.0, static_cast<double>(image.height) / image.width};
    options.vectorize.depth = depth;
    Result<Converted> result = convert_map(map, make_plane(options.vectorize.size), options);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? std::move(*result) : Converted{};
}

}  // namespace burin::testing
