#include <burin/heightmap.hpp>
#include <burin/image_io.hpp>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "png_builder.hpp"
#include "temporary_folder.hpp"

namespace burin {
namespace {

using test::Bytes;
using test::png_chunk;
using test::png_file;
using test::png_header;
using test::png_of_rows;

class HeightMapTest : public ::testing::Test {
  protected:
    Result<HeightMap> read(const Bytes& bytes, const HeightMapOptions& options = {},
                           const std::string& name = "map.bin") {
        EXPECT_TRUE(write_file(folder_.file(name), bytes).ok());
        return read_height_map(folder_.file(name), options);
    }

    // A file of OpenImageIO's own writer.
    std::string write(const std::string& name, OIIO::ImageSpec spec, const std::vector<float>& values,
                      const std::function<void(OIIO::ImageSpec&)>& tune = {}) {
        if (tune) tune(spec);
        auto output = OIIO::ImageOutput::create(name);
        EXPECT_TRUE(output != nullptr && output->open(folder_.file(name), spec));
        EXPECT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data())) << output->geterror();
        EXPECT_TRUE(output->close());
        return folder_.file(name);
    }

    test::TemporaryFolder folder_;
};

std::vector<float> ramp(int count, float low = 0.0f, float high = 1.0f) {
    std::vector<float> values;
    for (int i = 0; i < count; ++i)
        values.push_back(low + (high - low) * static_cast<float>(i) / static_cast<float>(count - 1));
    return values;
}

void expect_error(const Result<HeightMap>& map, ErrorCode code, const std::string& part) {
    ASSERT_FALSE(map.ok());
    EXPECT_EQ(map.error().code, code) << map.error().message;
    EXPECT_NE(map.error().message.find(part), std::string::npos) << map.error().message;
    EXPECT_EQ(map.error().message.find('\n'), std::string::npos);
}

TEST_F(HeightMapTest, GreyPngOfEveryDepth) {
    struct Case {
        int depth;
        Bytes row;
        std::vector<float> values;
    };
    const Case cases[] = {{1, {0b01000000}, {0, 1}},
                          {2, {0b01100000}, {1 / 3.0f, 2 / 3.0f}},
                          {4, {0x3c}, {3 / 15.0f, 12 / 15.0f}},
                          {8, {7, 200}, {7 / 255.0f, 200 / 255.0f}},
                          {16, {0x12, 0x34, 0xff, 0xfe}, {0x1234 / 65535.0f, 0xfffe / 65535.0f}}};
    for (const Case& c : cases) {
        const auto map = read(png_of_rows(2, 1, c.depth, 0, {c.row}));
        ASSERT_TRUE(map.ok()) << map.error().message;
        EXPECT_EQ(map->bit_depth, c.depth);
        EXPECT_EQ(map->format, "PNG");
        EXPECT_EQ(map->channel, "grey");
        EXPECT_FALSE(map->is_float);
        EXPECT_FALSE(map->lossy);
        ASSERT_EQ(map->image.width, 2);
        ASSERT_EQ(map->image.height, 1);
        for (int i = 0; i < 2; ++i)
            EXPECT_NEAR(map->image.at(i, 0), c.values[static_cast<std::size_t>(i)], 1e-6) << c.depth;
    }
}

TEST_F(HeightMapTest, PaletteGivesItsColors) {
    const auto map = read(png_of_rows(2, 1, 8, 3, {{1, 0}}, {10, 10, 10, 240, 240, 240}));
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_NEAR(map->image.at(0, 0), 240 / 255.0, 1e-6);
    EXPECT_NEAR(map->image.at(1, 0), 10 / 255.0, 1e-6);
    EXPECT_EQ(map->channel, "red");
}

TEST_F(HeightMapTest, InterlacedRowsFindTheirPlaces) {
    // Adam7 on 8 x 1 texels: pass 1 holds column 0, pass 2 column 4, pass 4 columns 2 and 6, pass 6 the odd
    // ones.
    const Bytes raw{0, 0, 0, 40, 0, 20, 60, 0, 10, 30, 50, 70};
    const auto map = read(
        png_file({png_header(8, 1, 8, 0, 1), png_chunk("IDAT", test::deflated(raw)), png_chunk("IEND", {})}));
    ASSERT_TRUE(map.ok()) << map.error().message;
    for (int x = 0; x < 8; ++x) EXPECT_NEAR(map->image.at(x, 0), x * 10 / 255.0, 1e-6);
}

TEST_F(HeightMapTest, AlphaNeitherScalesNorReplacesTheColors) {
    const auto map = read(png_of_rows(2, 1, 8, 6, {{100, 100, 100, 10, 200, 200, 200, 255}}));
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_NEAR(map->image.at(0, 0), 100 / 255.0, 1e-6);
    EXPECT_EQ(map->channel, "red");
    ASSERT_EQ(map->notes.size(), 1u);
    const auto grey = read(png_of_rows(2, 1, 8, 4, {{100, 0, 200, 255}}));
    ASSERT_TRUE(grey.ok()) << grey.error().message;
    EXPECT_NEAR(grey->image.at(0, 0), 100 / 255.0, 1e-6);
}

TEST_F(HeightMapTest, AlphaIsTakenWhenNothingElseVaries) {
    const auto map = read(png_of_rows(2, 1, 8, 6, {{9, 9, 9, 30, 9, 9, 9, 60}}));
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(map->channel, "alpha");
    EXPECT_EQ(map->notes.size(), 1u);
    EXPECT_NEAR(map->image.at(1, 0), 60 / 255.0, 1e-6);
}

TEST_F(HeightMapTest, ColorsThatDifferALittleGiveLumaAndStronglyTheirMean) {
    const auto luma = read(png_of_rows(2, 1, 8, 2, {{100, 104, 98, 0, 0, 0}}));
    ASSERT_TRUE(luma.ok());
    EXPECT_EQ(luma->channel, "luma");
    EXPECT_NEAR(luma->image.at(0, 0), (0.299 * 100 + 0.587 * 104 + 0.114 * 98) / 255.0, 1e-6);
    const auto mean = read(png_of_rows(2, 1, 8, 2, {{255, 0, 30, 0, 200, 0}}));
    ASSERT_TRUE(mean.ok());
    EXPECT_EQ(mean->channel, "mean");
    EXPECT_NEAR(mean->image.at(0, 0), 95 / 255.0, 1e-6);
    EXPECT_EQ(mean->notes.size(), 1u);
}

TEST_F(HeightMapTest, AskedChannelsAndPolarity) {
    const Bytes file = png_of_rows(2, 1, 8, 6, {{10, 20, 30, 40, 11, 21, 31, 41}});
    const std::pair<Channel, int> cases[] = {
        {Channel::red, 10}, {Channel::green, 20}, {Channel::blue, 30}, {Channel::alpha, 40}};
    for (const auto& [channel, value] : cases) {
        const auto map = read(file, {.channel = channel});
        ASSERT_TRUE(map.ok());
        EXPECT_NEAR(map->image.at(0, 0), value / 255.0, 1e-6);
    }
    const auto depth = read(file, {.polarity = Polarity::depth, .channel = Channel::red});
    ASSERT_TRUE(depth.ok());
    EXPECT_NEAR(depth->image.at(0, 0), 1 - 10 / 255.0, 1e-6);
    expect_error(read(png_of_rows(1, 1, 8, 0, {{1}}), {.channel = Channel::alpha}),
                 ErrorCode::invalid_argument, "alpha");
}

TEST_F(HeightMapTest, MetadataNeverReachesTheDecoder) {
    const Bytes raw{0, 128};
    const auto map = read(png_file({png_header(1, 1, 8, 0), png_chunk("gAMA", {0, 1, 0x11, 0x70}),
                                    png_chunk("iCCP", {'x', 0, 0, 1, 2, 3}), png_chunk("tRNS", {0, 128}),
                                    png_chunk("IDAT", test::deflated(raw)), png_chunk("IEND", {})}));
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_NEAR(map->image.at(0, 0), 128 / 255.0, 1e-6);
}

TEST_F(HeightMapTest, DamagedPngIsToldBySort) {
    const Bytes good = png_of_rows(4, 4, 8, 0, std::vector<Bytes>(4, Bytes{1, 2, 3, 4}));
    Bytes crc = good;
    crc[45] ^= 1;  // within IDAT
    expect_error(read(crc), ErrorCode::invalid_input, "checksum");
    expect_error(read(png_file({png_header(4, 4, 8, 0), png_chunk("IEND", {})})), ErrorCode::invalid_input,
                 "IDAT");
    expect_error(read(png_file({png_chunk("IDAT", {})})), ErrorCode::invalid_input, "IHDR");
    expect_error(read(png_file({png_header(4, 4, 3, 0)})), ErrorCode::invalid_input, "bit depth 3");
    expect_error(read(png_file({png_header(0, 4, 8, 0)})), ErrorCode::invalid_input, "0x4");
    // Good checksums over too little data, and over data that is no deflate stream.
    expect_error(read(png_of_rows(4, 4, 8, 0, {{1, 2, 3, 4}})), ErrorCode::invalid_input, "last row");
    expect_error(read(png_of_rows(1, 1, 8, 0, {{1}, {1}})), ErrorCode::invalid_input, "more data");
    expect_error(
        read(png_file({png_header(4, 4, 8, 0), png_chunk("IDAT", {1, 2, 3, 4}), png_chunk("IEND", {})})),
        ErrorCode::invalid_input, "inflated");
}

TEST_F(HeightMapTest, HugeSizesAreRefusedBeforeDecoding) {
    const auto bomb = [](std::uint32_t w, std::uint32_t h) {
        return png_file(
            {png_header(w, h, 8, 0), png_chunk("IDAT", test::deflated(Bytes(64, 0))), png_chunk("IEND", {})});
    };
    expect_error(read(bomb(16000, 16000)), ErrorCode::invalid_input, "cannot hold");
    expect_error(read(bomb(0x7fffffff, 0x7fffffff)), ErrorCode::invalid_input, "cannot hold");
    expect_error(read(png_of_rows(4, 1, 8, 0, {{1, 2, 3, 4}}), {.max_texels = 3}), ErrorCode::limit_exceeded,
                 "limit 3");
    expect_error(read(png_of_rows(4, 1, 8, 0, {{1, 2, 3, 4}}), {.max_file_bytes = 10}),
                 ErrorCode::limit_exceeded, "limit 10");
    expect_error(read(png_of_rows(1, 1, 8, 0, {{1}}), {.max_texels = 0}), ErrorCode::invalid_argument,
                 "max_texels");
}

TEST_F(HeightMapTest, ContentDecidesNotTheName) {
    const auto map = read(png_of_rows(1, 1, 8, 0, {{51}}), {}, "liar.exr");
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(map->format, "PNG");
    expect_error(read({'B', 'M', 0, 0}, {}, "picture.png"), ErrorCode::unsupported, "BMP");
    expect_error(read({}, {}, "picture.png"), ErrorCode::invalid_input, "empty");
    expect_error(read({1, 2, 3}, {}, "picture.png"), ErrorCode::unsupported, "PNG, JPEG, TIFF and OpenEXR");
}

TEST_F(HeightMapTest, OnlyRegularFilesAreRead) {
    expect_error(read_height_map(folder_.file("missing.png")), ErrorCode::io_failed, "missing.png");
    expect_error(read_height_map(folder_.path()), ErrorCode::io_failed, "regular file");
    ASSERT_EQ(::mkfifo(folder_.file("pipe").c_str(), 0600), 0);
    expect_error(read_height_map(folder_.file("pipe")), ErrorCode::io_failed, "regular file");
}

TEST_F(HeightMapTest, JpegIsLossyAndGrey) {
    const auto map = read_height_map(write("map.jpg", {64, 64, 1, OIIO::TypeDesc::UINT8}, ramp(64 * 64)));
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_TRUE(map->lossy);
    EXPECT_EQ(map->format, "JPEG");
    EXPECT_NEAR(map->image.at(32, 32), ramp(64 * 64)[32 * 64 + 32], 0.02);
    auto bytes = read_file(folder_.file("map.jpg"), 1 << 20);
    ASSERT_TRUE(bytes.ok());
    bytes->resize(bytes->size() / 2);
    expect_error(read(*bytes), ErrorCode::invalid_input, "cut off");
}

TEST_F(HeightMapTest, TiffOfEveryPromisedKind) {
    struct Case {
        const char* name;
        OIIO::TypeDesc::BASETYPE type;
        int bits;
        bool floating;
        const char* compression;
        int tile;
        double tolerance;
    };
    const Case cases[] = {{"u8", OIIO::TypeDesc::UINT8, 8, false, "none", 0, 0.5 / 255},
                          {"u8lzw", OIIO::TypeDesc::UINT8, 8, false, "lzw", 0, 0.5 / 255},
                          {"u16zip", OIIO::TypeDesc::UINT16, 16, false, "zip", 0, 0.5 / 65535},
                          {"u16tile", OIIO::TypeDesc::UINT16, 16, false, "zip", 16, 0.5 / 65535},
                          {"u32", OIIO::TypeDesc::UINT32, 32, false, "none", 0, 1e-6},
                          {"half", OIIO::TypeDesc::HALF, 32, true, "none", 0, 1e-3},
                          {"float", OIIO::TypeDesc::FLOAT, 32, true, "lzw", 0, 1e-7},
                          {"floattile", OIIO::TypeDesc::FLOAT, 32, true, "zip", 32, 1e-7},
                          {"double", OIIO::TypeDesc::DOUBLE, 64, true, "none", 0, 1e-6},
                          {"pack", OIIO::TypeDesc::UINT8, 8, false, "packbits", 0, 0.5 / 255}};
    const std::vector<float> values = ramp(50 * 40);
    for (const Case& c : cases) {
        const auto map = read_height_map(
            write(std::string(c.name) + ".tif", {50, 40, 1, c.type}, values, [&](OIIO::ImageSpec& s) {
                s.attribute("compression", c.compression);
                if (c.tile > 0) s.tile_width = s.tile_height = c.tile;
            }));
        ASSERT_TRUE(map.ok()) << c.name << ": " << map.error().message;
        EXPECT_EQ(map->is_float, c.floating) << c.name;
        EXPECT_EQ(map->bit_depth, c.bits) << c.name;
        for (std::size_t i = 0; i < values.size(); ++i)
            ASSERT_NEAR(map->image.texels[i], values[i], c.tolerance + 1e-7) << c.name << " texel " << i;
    }
}

TEST_F(HeightMapTest, ExrOfEveryPromisedKind) {
    const std::vector<float> values = ramp(50 * 40);
    for (const char* compression : {"none", "rle", "zips", "zip", "piz", "pxr24", "b44", "dwaa"})
        for (const int tile : {0, 16})
            for (const auto type : {OIIO::TypeDesc::HALF, OIIO::TypeDesc::FLOAT}) {
                const auto map =
                    read_height_map(write("map.exr", {50, 40, 1, type}, values, [&](OIIO::ImageSpec& s) {
                        s.attribute("compression", compression);
                        s.attribute("owner", "somebody");  // dropped on the way
                        s.channelnames = {"height"};
                        if (tile > 0) s.tile_width = s.tile_height = tile;
                    }));
                ASSERT_TRUE(map.ok()) << compression << ": " << map.error().message;
                EXPECT_TRUE(map->is_float);
                EXPECT_EQ(map->bit_depth, type == OIIO::TypeDesc::HALF ? 16 : 32);
                // The writer stores scan lines as zip where dwaa was asked for.
                const std::string name = compression;
                EXPECT_EQ(map->lossy, name == "pxr24" || name == "b44" || (name == "dwaa" && tile > 0))
                    << name;
                for (std::size_t i = 0; i < values.size(); i += 7)
                    ASSERT_NEAR(map->image.texels[i], values[i], 0.02) << compression;
            }
}

TEST_F(HeightMapTest, WrittenHeightsComeBack) {
    Image image(37, 23);
    image.texels = ramp(37 * 23, 0.1f, 0.9f);
    for (const char* name : {"h.exr", "h.tif", "h.png"}) {
        ASSERT_TRUE(write_height(folder_.file(name), image).ok());
        const auto map = read_height_map(folder_.file(name));
        ASSERT_TRUE(map.ok()) << map.error().message;
        for (std::size_t i = 0; i < image.texels.size(); ++i)
            EXPECT_NEAR(map->image.texels[i], image.texels[i], name[2] == 'p' ? 0.5 / 65535 + 1e-7 : 0.0)
                << name;
    }
}

TEST_F(HeightMapTest, FloatsOutsideTheUnitRangeAreStretched) {
    Image image(3, 1);
    image.texels = {-2.0f, 0.0f, 6.0f};
    ASSERT_TRUE(write_height(folder_.file("h.tif"), image).ok());
    const auto map = read_height_map(folder_.file("h.tif"));
    ASSERT_TRUE(map.ok());
    EXPECT_EQ(map->image.texels, (std::vector<float>{0.0f, 0.25f, 1.0f}));
    EXPECT_EQ(map->source_low, -2.0f);
    EXPECT_EQ(map->source_high, 6.0f);
    EXPECT_EQ(map->notes.size(), 1u);
    image.texels = {5, 5, 5};
    ASSERT_TRUE(write_height(folder_.file("h.tif"), image).ok());
    const auto constant = read_height_map(folder_.file("h.tif"));
    ASSERT_TRUE(constant.ok());
    EXPECT_TRUE(constant->constant);
    EXPECT_EQ(constant->image.at(0, 0), 1.0f);
    // The whole range of float does not fit into a float.
    const float most = std::numeric_limits<float>::max();
    image.texels = {-most, 0, most};
    ASSERT_TRUE(write_height(folder_.file("h.tif"), image).ok());
    const auto wide = read_height_map(folder_.file("h.tif"));
    ASSERT_TRUE(wide.ok());
    EXPECT_EQ(wide->image.texels, (std::vector<float>{0.0f, 0.5f, 1.0f}));
}

TEST_F(HeightMapTest, ValuesThatAreNotFiniteNameTheirTexel) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()})
        for (const char* name : {"h.exr", "h.tif"}) {
            Image image(5, 4, 0.5f);
            image.at(3, 2) = bad;
            image.at(1, 3) = bad;
            ASSERT_TRUE(write_height(folder_.file(name), image).ok());
            expect_error(read_height_map(folder_.file(name)), ErrorCode::invalid_input, "texel (3, 2)");
        }
}

TEST_F(HeightMapTest, ConstantMapsAreFine) {
    const auto map = read(png_of_rows(2, 2, 1, 0, {{0xc0}, {0xc0}}));
    ASSERT_TRUE(map.ok());
    EXPECT_TRUE(map->constant);
}

TEST_F(HeightMapTest, ThreadsDoNotChangeValues) {
    const std::string path = write("map.exr", {200, 300, 3, OIIO::TypeDesc::HALF}, ramp(200 * 300 * 3));
    const auto one = read_height_map(path, {.threads = 1}), two = read_height_map(path, {.threads = 2});
    ASSERT_TRUE(one.ok() && two.ok());
    EXPECT_EQ(one->image.texels, two->image.texels);
}

// Small files of every format, for damaging.
class DamageTest : public HeightMapTest {
  protected:
    std::vector<Bytes> seeds() {
        std::vector<Bytes> files{png_of_rows(8, 8, 16, 0, std::vector<Bytes>(8, Bytes(16, 77)))};
        const std::vector<float> values = ramp(24 * 24 * 3);
        write("a.jpg", {24, 24, 3, OIIO::TypeDesc::UINT8}, values);
        write("b.tif", {24, 24, 3, OIIO::TypeDesc::UINT16}, values,
              [](OIIO::ImageSpec& s) { s.attribute("compression", "lzw"); });
        write("c.tif", {24, 24, 1, OIIO::TypeDesc::FLOAT}, values,
              [](OIIO::ImageSpec& s) { s.tile_width = s.tile_height = 16; });
        write("d.exr", {24, 24, 3, OIIO::TypeDesc::HALF}, values,
              [](OIIO::ImageSpec& s) { s.attribute("compression", "piz"); });
        write("e.exr", {24, 24, 1, OIIO::TypeDesc::FLOAT}, values,
              [](OIIO::ImageSpec& s) { s.tile_width = s.tile_height = 16; });
        for (const char* name : {"a.jpg", "b.tif", "c.tif", "d.exr", "e.exr"})
            files.push_back(*read_file(folder_.file(name), 1 << 20));
        return files;
    }

    // Whatever comes out is an error with a message, or a map that keeps its promises.
    void expect_sane(const Bytes& bytes) {
        const auto map = read(bytes, {.max_texels = 1u << 20, .threads = 1});
        if (!map.ok()) {
            EXPECT_FALSE(map.error().message.empty());
            return;
        }
        for (const float v : map->image.texels) ASSERT_TRUE(v >= 0.0f && v <= 1.0f);
    }
};

TEST_F(DamageTest, CutFilesAreErrors) {
    for (const Bytes& seed : seeds()) {
        ASSERT_TRUE(read(seed).ok());
        const std::size_t step = std::max<std::size_t>(1, seed.size() / 150);
        for (std::size_t size = 0; size + 64 < seed.size(); size += step)
            expect_sane(Bytes(seed.begin(), seed.begin() + static_cast<std::ptrdiff_t>(size)));
    }
}

TEST_F(DamageTest, FlippedBytesNeverCrash) {
    const unsigned seed_number = std::random_device{}();
    RecordProperty("seed", static_cast<int>(seed_number));
    std::printf("seed %u\n", seed_number);
    std::mt19937 random(seed_number);
    for (const Bytes& seed : seeds())
        for (int trial = 0; trial < 400; ++trial) {
            Bytes bytes = seed;
            // Headers decide most; half of the damage goes there.
            for (unsigned k = 1 + random() % 4; k > 0; --k) {
                const std::size_t range =
                    random() % 2 == 0 ? std::min<std::size_t>(bytes.size(), 400) : bytes.size();
                const std::uint8_t values[] = {0, 0xff, 0x7f, 0x80, static_cast<std::uint8_t>(random())};
                bytes[random() % range] = values[random() % 5];
            }
            expect_sane(bytes);
        }
}

}  // namespace
}  // namespace burin
