// coarsen.hpp: soft maps lose texels and nothing else; sharp ones lose none.
#include <burin/coarsen.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <burin/convert.hpp>

namespace burin {
namespace {

// A round plateau whose wall is about `wall` texels wide, and a groove across the tile.
HeightMap soft_map(int width, int height, double wall, int levels = 0) {
    HeightMap map;
    map.image = Image(width, height);
    map.bit_depth = levels > 0 ? 8 : 16;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double u = (x + 0.5) * 512.0 / width, v = (y + 0.5) * 512.0 / width, scale = 0.25 * wall * 512.0 / width;
            const double rise = 0.3 * std::tanh((90.0 - std::hypot(u - 170.0, v - 150.0)) / scale);
            const double cut = 0.25 * (std::tanh((v - 330.0) / scale) - std::tanh((v - 370.0) / scale));
            const double h = 0.5 + rise - 0.3 * cut;
            map.image.at(x, y) = static_cast<float>(levels > 0 ? std::round(h * levels) / levels : h);
        }
    return map;
}

CoarsenOptions small_maps(int threads = 1) {
    CoarsenOptions options;
    options.least_texels = 1;
    options.threads = threads;
    return options;
}

TEST(Coarsen, SoftMapsAreHalvedUntilTheirWallsAreSharp) {
    EXPECT_EQ(coarsen_map(soft_map(512, 512, 32.0), small_maps()).halvings, 2);
    EXPECT_EQ(coarsen_map(soft_map(512, 512, 16.0), small_maps()).halvings, 1);
    EXPECT_EQ(coarsen_map(soft_map(512, 512, 2.0), small_maps()).halvings, 0);
}

TEST(Coarsen, RoundingToEightBitsHidesNoSoftness) {
    EXPECT_GE(coarsen_map(soft_map(512, 512, 16.0, 255), small_maps()).halvings, 1);
}

TEST(Coarsen, EveryTexelIsTheMeanOfFour) {
    const HeightMap map = soft_map(512, 256, 16.0);
    CoarsenOptions once = small_maps();
    once.least_texels = map.image.texels.size();
    const Coarsened coarse = coarsen_map(map, once);
    ASSERT_EQ(coarse.halvings, 1);
    ASSERT_EQ(coarse.map->image.width, 256);
    ASSERT_EQ(coarse.map->image.height, 128);
    for (int y = 0; y < 128; y += 7)
        for (int x = 0; x < 256; x += 5) {
            const Image& fine = map.image;
            const double mean = 0.25 * (double(fine.at(2 * x, 2 * y)) + fine.at(2 * x + 1, 2 * y) + fine.at(2 * x, 2 * y + 1) +
                                        fine.at(2 * x + 1, 2 * y + 1));
            EXPECT_NEAR(coarse.map->image.at(x, y), mean, 1e-6);
        }
}

TEST(Coarsen, WhatCannotBeHalvedStays) {
    EXPECT_FALSE(coarsen_map(soft_map(511, 512, 64.0), small_maps()).map.has_value());
    EXPECT_FALSE(coarsen_map(soft_map(512, 512, 64.0)).map.has_value()) << "small maps are quick as they are";
    HeightMap flat;
    flat.image = Image(64, 64, 0.5f);
    EXPECT_FALSE(coarsen_map(flat, small_maps()).map.has_value());
}

TEST(Coarsen, ThreadsChangeNothing) {
    const HeightMap map = soft_map(512, 384, 20.0);
    const Coarsened one = coarsen_map(map, small_maps(1)), three = coarsen_map(map, small_maps(3));
    ASSERT_GE(one.halvings, 1);
    EXPECT_EQ(one.halvings, three.halvings);
    EXPECT_EQ(one.map->image.texels, three.map->image.texels);
}

// The paths of the coarser map show the finer one as well as its own would, from no more bytes.
TEST(Coarsen, PathsLieWhereTheFineMapHasThem) {
    const HeightMap map = soft_map(512, 512, 16.0);
    ConvertOptions fine, coarse;
    fine.vectorize.depth = coarse.vectorize.depth = 0.05;
    coarse.coarsen.least_texels = 1;
    const auto from_fine = find_pattern(map, fine), from_coarse = find_pattern(map, coarse);
    ASSERT_TRUE(from_fine.ok() && from_coarse.ok());
    EXPECT_EQ(from_fine->stats.halvings, 0);
    EXPECT_EQ(from_coarse->stats.halvings, 1);
    EXPECT_GT(from_coarse->stats.explained, 0.995);
    EXPECT_GT(from_coarse->stats.explained, from_fine->stats.explained - 0.002);
    EXPECT_NEAR(from_coarse->stats.path_length_texels, from_fine->stats.path_length_texels, 40.0);
}

}  // namespace
}  // namespace burin
