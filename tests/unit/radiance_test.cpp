// Pictures of light: both formats, and damage.
#include <burin/image_io.hpp>
#include <burin/radiance.hpp>

#include <gtest/gtest.h>

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <random>

#include "temporary_folder.hpp"

namespace burin {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes hdr(const std::string& size, const Bytes& texels, const std::string& format = "FORMAT=32-bit_rle_rgbe") {
    const std::string head = "#?RADIANCE\n# made by a test\n" + format + "\n\n" + size + "\n";
    Bytes bytes(head.begin(), head.end());
    bytes.insert(bytes.end(), texels.begin(), texels.end());
    return bytes;
}

class Radiance : public ::testing::Test {
  protected:
    Result<RadianceMap> read(const Bytes& bytes) {
        EXPECT_TRUE(write_file(folder_.file("sky"), bytes).ok());
        return read_radiance(folder_.file("sky"));
    }
    void expect_error(const Bytes& bytes, ErrorCode code, const std::string& words) {
        const auto map = read(bytes);
        ASSERT_FALSE(map.ok()) << words;
        EXPECT_EQ(map.error().code, code) << map.error().message;
        EXPECT_NE(map.error().message.find(words), std::string::npos) << map.error().message;
    }
    test::TemporaryFolder folder_;
};

TEST_F(Radiance, FlatAndRunLengthEncodedRowsAreAlike) {
    // 8 x 2: bytes 128, 64, 32 with the exponent of 1, then of 8; and a black texel.
    Bytes flat, packed;
    for (int y = 0; y < 2; ++y) {
        const std::uint8_t exponent = y == 0 ? 129 : 132;
        for (int x = 0; x < 8; ++x)
            for (const std::uint8_t byte : {std::uint8_t(128), std::uint8_t(64), std::uint8_t(x), x == 3 ? std::uint8_t(0) : exponent}) flat.push_back(byte);
        // Runs of red and green, copies of blue, runs and a copy of the exponent.
        for (const std::uint8_t byte : {2, 2, 0, 8, 128 + 8, 128, 128 + 5, 64, 128 + 3, 64, 8, 0, 1, 2, 3, 4, 5, 6, 7}) packed.push_back(byte);
        for (const std::uint8_t byte : {std::uint8_t(131), exponent, std::uint8_t(1), std::uint8_t(0), std::uint8_t(132), exponent}) packed.push_back(byte);
    }
    for (const Bytes& texels : {flat, packed}) {
        const auto map = read(hdr("-Y 2 +X 8", texels));
        ASSERT_TRUE(map.ok()) << map.error().message;
        ASSERT_EQ(map->width, 8);
        ASSERT_EQ(map->height, 2);
        EXPECT_FLOAT_EQ(map->texels[0], 1.0f);
        EXPECT_FLOAT_EQ(map->texels[1], 0.5f);
        EXPECT_FLOAT_EQ(map->texels[3 * 8], 8.0f);
        EXPECT_FLOAT_EQ(map->texels[3 * 15 + 2], 8.0f * 7 / 128);
        EXPECT_FLOAT_EQ(map->texels[3 * 3], 0.0f);
    }
}

TEST_F(Radiance, WhatIsNotReadIsNamed) {
    const Bytes texels(8 * 2 * 4, 100);
    expect_error(hdr("-Y 2 +X 8", texels, "FORMAT=32-bit_rle_xyze"), ErrorCode::unsupported, "32-bit_rle_xyze");
    expect_error(hdr("+Y 2 +X 8", texels), ErrorCode::unsupported, "+Y 2 +X 8");
    expect_error(hdr("-Y 1 +X 8", texels), ErrorCode::limit_exceeded, "8x1");
    expect_error(hdr("-Y 20000 +X 8", texels), ErrorCode::limit_exceeded, "8x20000");
    expect_error(hdr("-Y 3 +X 8", texels), ErrorCode::invalid_input, "row 2");
    expect_error({'#', '?', 'R'}, ErrorCode::invalid_input, "ends within its header");
    expect_error({'G', 'I', 'F', '8'}, ErrorCode::unsupported, "neither Radiance HDR nor OpenEXR");
    // A run longer than the row.
    Bytes run{2, 2, 0, 8, 128 + 9, 1};
    run.resize(64, 0);
    expect_error(hdr("-Y 2 +X 8", run), ErrorCode::invalid_input, "row 0");
}

TEST_F(Radiance, ExrHasFloatsAndNoHoles) {
    const std::string path = folder_.file("sky.exr");
    std::vector<float> values(4 * 2 * 3, 2.5f);
    const auto write = [&] {
        auto out = OIIO::ImageOutput::create(path);
        ASSERT_TRUE(out && out->open(path, OIIO::ImageSpec(4, 2, 3, OIIO::TypeDesc::FLOAT)));
        ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, values.data()) && out->close());
    };
    values[4] = 1000.0f;
    values[5] = -0.25f;
    write();
    const auto map = read_radiance(path);
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(map->texels[3], 2.5f);
    EXPECT_EQ(map->texels[4], 1000.0f);
    EXPECT_EQ(map->texels[5], 0.0f);
    values[3 * 6 + 1] = std::nanf("");
    write();
    const auto broken = read_radiance(path);
    ASSERT_FALSE(broken.ok());
    EXPECT_NE(broken.error().message.find("texel (2, 1)"), std::string::npos) << broken.error().message;
}

TEST_F(Radiance, RandomDamageNeverCrashes) {
    const unsigned seed = std::random_device{}();
    std::printf("seed %u\n", seed);
    std::mt19937 random(seed);
    Bytes row{2, 2, 0, 8, 128 + 8, 128, 128 + 5, 64, 128 + 3, 64, 8, 0, 1, 2, 3, 4, 5, 6, 7, 136, 129};
    row.insert(row.end(), row.begin(), row.begin() + 21);
    const Bytes good = hdr("-Y 2 +X 8", row);
    int read_all = 0;
    for (int trial = 0; trial < 400; ++trial) {
        Bytes bytes = good;
        for (unsigned k = random() % 3; k > 0; --k) bytes[random() % bytes.size()] = std::uint8_t(random());
        if (random() % 4 == 0) bytes.resize(random() % bytes.size());
        const auto map = read(bytes);
        if (!map.ok()) continue;
        ++read_all;
        ASSERT_EQ(map->texels.size(), 3 * std::size_t(map->width) * std::size_t(map->height));
        for (const float value : map->texels) ASSERT_TRUE(std::isfinite(value) && value >= 0.0f);
    }
    EXPECT_GT(read_all, 50);
}

}  // namespace
}  // namespace burin
