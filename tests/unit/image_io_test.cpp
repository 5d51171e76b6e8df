#include <burin/heightmap.hpp>
#include <burin/image_io.hpp>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <random>

#include "temporary_folder.hpp"

namespace burin {
namespace {

RgbaImage noise(int w, int h, bool grey, bool opaque, unsigned seed) {
    std::mt19937 random(seed);
    RgbaImage image{w, h, {}};
    for (int i = 0; i < w * h; ++i) {
        const auto v = static_cast<std::uint8_t>(random());
        image.texels.push_back(v);
        image.texels.push_back(grey ? v : static_cast<std::uint8_t>(random()));
        image.texels.push_back(grey ? v : static_cast<std::uint8_t>(random()));
        image.texels.push_back(opaque ? 255 : static_cast<std::uint8_t>(random()));
    }
    return image;
}

// Texels as another reader sees them, spread to four channels.
std::vector<std::uint8_t> decoded(const std::string& path, int& channels) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    auto input = OIIO::ImageInput::open(path, &config);
    if (input == nullptr) return {};
    channels = input->spec().nchannels;
    std::vector<std::uint8_t> raw(static_cast<std::size_t>(input->spec().image_pixels()) *
                                  static_cast<std::size_t>(channels));
    input->read_image(OIIO::TypeDesc::UINT8, raw.data());
    std::vector<std::uint8_t> texels;
    const auto n = static_cast<std::size_t>(channels);
    for (std::size_t i = 0; i < raw.size(); i += n) {
        const std::uint8_t* t = raw.data() + i;
        for (std::size_t k = 0; k < 3; ++k) texels.push_back(n < 3 ? t[0] : t[k]);
        texels.push_back(n % 2 == 0 ? t[n - 1] : 255);
    }
    return texels;
}

TEST(ImageIo, PngKeepsEveryTexelWithAsFewChannelsAsPossible) {
    const test::TemporaryFolder folder;
    for (const bool grey : {false, true})
        for (const bool opaque : {false, true})
            for (const auto& [w, h] : {std::pair{1, 1}, {7, 5}, {300, 200}}) {
                const RgbaImage image = noise(w, h, grey, opaque, 5);
                const std::string path = folder.file("picture.png");
                ASSERT_TRUE(write_png(path, image).ok());
                int channels = 0;
                EXPECT_EQ(decoded(path, channels), image.texels);
                EXPECT_EQ(channels, (grey ? 1 : 3) + (opaque ? 0 : 1));
            }
}

TEST(ImageIo, EqualPicturesGiveEqualBytes) {
    const RgbaImage image = noise(64, 64, false, true, 1);
    EXPECT_EQ(*encode_png(image), *encode_png(image));
}

TEST(ImageIo, FailureLeavesNothingBehind) {
    const test::TemporaryFolder folder;
    Image heights(4, 4, 2.0f);  // out of PNG's range
    const Status status = write_height(folder.file("h.png"), heights);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().code, ErrorCode::invalid_argument);
    EXPECT_FALSE(write_height(folder.file("h.bmp"), heights).ok());
    EXPECT_FALSE(write_file(folder.file("no/such/folder/file"), std::vector<std::uint8_t>{1}).ok());
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ImageIo, AFailedWriteKeepsTheOldFile) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(write_file(folder.file("h.png"), std::vector<std::uint8_t>{1, 2, 3}).ok());
    EXPECT_FALSE(write_height(folder.file("h.png"), Image(4, 4, -1.0f)).ok());
    EXPECT_EQ(*read_file(folder.file("h.png"), 10), (std::vector<std::uint8_t>{1, 2, 3}));
}

TEST(ImageIo, ErrorsNameTheTarget) {
    const test::TemporaryFolder folder;
    const Status status = write_file(folder.path(), std::vector<std::uint8_t>{1});
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find(folder.path()), std::string::npos);
    const auto large = read_file(folder.file("x"), 1);
    EXPECT_FALSE(large.ok());
    ASSERT_TRUE(write_file(folder.file("x"), std::vector<std::uint8_t>{1, 2}).ok());
    EXPECT_EQ(read_file(folder.file("x"), 1).error().code, ErrorCode::limit_exceeded);
}

TEST(ImageIo, WrittenHeightsHaveNoDate) {
    const test::TemporaryFolder folder;
    const Image heights(16, 16, 0.25f);
    for (const char* suffix : {".exr", ".tif", ".png"}) {
        ASSERT_TRUE(write_height(folder.file(std::string("a") + suffix), heights).ok());
        ::setenv("TZ", "Asia/Tokyo", 1);
        ASSERT_TRUE(write_height(folder.file(std::string("b") + suffix), heights).ok());
        const auto a = read_file(folder.file(std::string("a") + suffix), 1 << 20);
        EXPECT_EQ(*a, *read_file(folder.file(std::string("b") + suffix), 1 << 20)) << suffix;
        const std::string text(a->begin(), a->end());
        for (const char* word : {"OpenImageIO", "DateTime", "capDate", ":202"})
            EXPECT_EQ(text.find(word), std::string::npos) << suffix << word;
    }
}

}  // namespace
}  // namespace burin
