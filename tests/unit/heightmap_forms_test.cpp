// Every form of picture that height maps come in, with values that are known by hand: read as data, unchanged.
#include <burin/heightmap.hpp>
#include <burin/image_io.hpp>

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <functional>

#include "png_builder.hpp"
#include "temporary_folder.hpp"

namespace burin {
namespace {

using test::Bytes;
using test::png_chunk;
using test::png_file;
using test::png_header;
using test::png_of_rows;

constexpr int kGrey = 0, kRgb = 2, kPalette = 3, kGreyAlpha = 4, kRgba = 6;

struct Read {
    Channel channel;
    const char* name;  // as the report says
    double first, second;
};

struct Form {
    const char* name;
    Bytes file;
    int bits, channels;
    std::vector<Read> reads;
};

class FormsTest : public ::testing::Test {
  protected:
    // The two texels of the file are those of each read.
    void expect_form(const Form& form) {
        ASSERT_TRUE(write_file(folder_.file("map"), form.file).ok());
        for (const Read& wanted : form.reads) {
            SCOPED_TRACE(std::string(form.name) + ", " + wanted.name);
            const auto map = read_height_map(folder_.file("map"), {.channel = wanted.channel});
            ASSERT_TRUE(map.ok()) << map.error().message;
            EXPECT_EQ(map->bit_depth, form.bits);
            EXPECT_EQ(map->channels, form.channels);
            EXPECT_EQ(map->channel, wanted.name);
            ASSERT_EQ(map->image.width, 2);
            ASSERT_EQ(map->image.height, 1);
            EXPECT_NEAR(map->image.at(0, 0), wanted.first, 1e-7);
            EXPECT_NEAR(map->image.at(1, 0), wanted.second, 1e-7);
        }
    }

    std::string write(const std::string& name, const OIIO::ImageSpec& spec, const std::vector<float>& values) {
        auto output = OIIO::ImageOutput::create(name);
        EXPECT_TRUE(output != nullptr && output->open(folder_.file(name), spec));
        EXPECT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data())) << output->geterror();
        EXPECT_TRUE(output->close());
        return folder_.file(name);
    }

    test::TemporaryFolder folder_;
};

Bytes big_endian(const std::vector<int>& samples) {
    Bytes row;
    for (const int v : samples) {
        row.push_back(static_cast<std::uint8_t>(v >> 8));
        row.push_back(static_cast<std::uint8_t>(v));
    }
    return row;
}

double luma(double r, double g, double b) { return 0.299 * r + 0.587 * g + 0.114 * b; }

TEST_F(FormsTest, PngOfEveryForm) {
    const Bytes greys{0, 0, 0, 85, 85, 85, 170, 170, 170, 255, 255, 255};
    const Bytes colors{200, 30, 60, 100, 130, 180};
    const double r0 = 1000 / 65535.0, g0 = 1500 / 65535.0, b0 = 65000 / 65535.0, last = 65535 / 65535.0;
    const Form forms[] = {
        {"1-bit grey", png_of_rows(2, 1, 1, kGrey, {{0x40}}), 1, 1, {{Channel::automatic, "grey", 0, 1}}},
        {"1-bit palette", png_of_rows(2, 1, 1, kPalette, {{0x40}}, Bytes(greys.begin(), greys.begin() + 6)), 1, 1,
         {{Channel::automatic, "red", 0, 85 / 255.0}}},
        {"2-bit palette", png_of_rows(2, 1, 2, kPalette, {{0x90}}, greys), 2, 1,
         {{Channel::automatic, "red", 170 / 255.0, 85 / 255.0}}},
        {"4-bit palette", png_of_rows(2, 1, 4, kPalette, {{0x31}}, greys), 4, 1,
         {{Channel::automatic, "red", 1, 85 / 255.0}}},
        {"8-bit palette of colours", png_of_rows(2, 1, 8, kPalette, {{1, 0}}, colors), 8, 1,
         {{Channel::red, "red", 100 / 255.0, 200 / 255.0},
          {Channel::green, "green", 130 / 255.0, 30 / 255.0},
          {Channel::blue, "blue", 180 / 255.0, 60 / 255.0},
          {Channel::luminance, "luma", luma(100, 130, 180) / 255.0, luma(200, 30, 60) / 255.0}}},
        {"8-bit grey and alpha", png_of_rows(2, 1, 8, kGreyAlpha, {{10, 20, 30, 0}}), 8, 2,
         {{Channel::automatic, "grey", 10 / 255.0, 30 / 255.0}, {Channel::alpha, "alpha", 20 / 255.0, 0}}},
        {"16-bit grey and alpha", png_of_rows(2, 1, 16, kGreyAlpha, {big_endian({257, 40000, 65535, 3})}), 16, 2,
         {{Channel::automatic, "grey", 257 / 65535.0, 1}, {Channel::alpha, "alpha", 40000 / 65535.0, 3 / 65535.0}}},
        {"16-bit RGB", png_of_rows(2, 1, 16, kRgb, {big_endian({1000, 1500, 65000, 65535, 0, 1})}), 16, 3,
         {{Channel::red, "red", r0, last},
          {Channel::green, "green", g0, 0},
          {Channel::blue, "blue", b0, 1 / 65535.0},
          {Channel::luminance, "luma", luma(r0, g0, b0), luma(last, 0, 1 / 65535.0)},
          {Channel::automatic, "mean", (r0 + g0 + b0) / 3, (last + 1 / 65535.0) / 3}}},
        {"16-bit RGBA", png_of_rows(2, 1, 16, kRgba, {big_endian({9, 9, 9, 500, 700, 700, 700, 0})}), 16, 4,
         {{Channel::automatic, "red", 9 / 65535.0, 700 / 65535.0},
          {Channel::luminance, "luma", 9 / 65535.0, 700 / 65535.0},
          {Channel::alpha, "alpha", 500 / 65535.0, 0}}},
        {"8-bit RGBA", png_of_rows(2, 1, 8, kRgba, {{7, 7, 7, 0, 9, 9, 9, 255}}), 8, 4,
         {{Channel::automatic, "red", 7 / 255.0, 9 / 255.0}, {Channel::alpha, "alpha", 0, 1}}},
    };
    for (const Form& form : forms) expect_form(form);
}

// An sRGB file with gamma, chromaticities, a profile, and a transparent colour, in each colour type.
TEST_F(FormsTest, ColourManagementOfPngIsLeftAlone) {
    const std::vector<Bytes> managed{png_chunk("sRGB", {0}), png_chunk("gAMA", {0, 0, 0xb1, 0x8f}),
                                     png_chunk("cHRM", Bytes(32, 7)), png_chunk("iCCP", {'x', 0, 0, 1, 2, 3})};
    struct Case {
        int color;
        Bytes row, palette, transparent;
        double first, second;
    };
    const Case cases[] = {{kGrey, {128, 7}, {}, {0, 128}, 128, 7},
                          {kRgb, {50, 50, 50, 51, 51, 51}, {}, {0, 50, 0, 50, 0, 50}, 50, 51},
                          {kPalette, {1, 0}, {5, 5, 5, 77, 77, 77}, {0, 128}, 77, 5},
                          {kGreyAlpha, {99, 0, 98, 255}, {}, {}, 99, 98},
                          {kRgba, {1, 1, 1, 0, 254, 254, 254, 9}, {}, {}, 1, 254}};
    for (const Case& c : cases) {
        std::vector<Bytes> chunks{png_header(2, 1, 8, c.color)};
        chunks.insert(chunks.end(), managed.begin(), managed.end());
        if (!c.palette.empty()) chunks.push_back(png_chunk("PLTE", c.palette));
        if (!c.transparent.empty()) chunks.push_back(png_chunk("tRNS", c.transparent));
        Bytes raw{0};
        raw.insert(raw.end(), c.row.begin(), c.row.end());
        chunks.push_back(png_chunk("IDAT", test::deflated(raw)));
        chunks.push_back(png_chunk("IEND", {}));
        ASSERT_TRUE(write_file(folder_.file("map"), png_file(chunks)).ok());
        const auto map = read_height_map(folder_.file("map"));
        ASSERT_TRUE(map.ok()) << c.color << ": " << map.error().message;
        EXPECT_NEAR(map->image.at(0, 0), c.first / 255.0, 1e-7) << c.color;
        EXPECT_NEAR(map->image.at(1, 0), c.second / 255.0, 1e-7) << c.color;
    }
}

// A little-endian baseline TIFF of one strip, 2 x 1 texels.
Bytes tiff(int bits, int photometric, int samples, const Bytes& strip, const std::vector<int>& palette = {}) {
    struct Entry {
        int tag, type;
        std::size_t count, value;
    };
    const std::size_t strip_at = 8, palette_at = strip_at + strip.size() + strip.size() % 2;
    const std::size_t directory = palette_at + 2 * palette.size();
    std::vector<Entry> entries{{256, 3, 1, 2}, {257, 3, 1, 1}, {258, 3, 1, static_cast<std::size_t>(bits)},
                               {259, 3, 1, 1}, {262, 3, 1, static_cast<std::size_t>(photometric)},
                               {273, 4, 1, strip_at}, {274, 3, 1, 3},  // turned by 180 degrees, for viewers
                               {277, 3, 1, static_cast<std::size_t>(samples)}, {278, 3, 1, 1},
                               {279, 4, 1, strip.size()}};
    if (!palette.empty()) entries.push_back({320, 3, palette.size(), palette_at});
    Bytes file;
    const auto append = [&](std::size_t value, int size) {
        for (int i = 0; i < size; ++i) file.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    };
    for (const char c : {'I', 'I', '*', '\0'}) file.push_back(static_cast<std::uint8_t>(c));
    append(directory, 4);
    file.insert(file.end(), strip.begin(), strip.end());
    file.resize(palette_at);
    for (const int v : palette) append(static_cast<std::size_t>(v), 2);
    append(entries.size(), 2);
    for (const Entry& e : entries) {
        append(static_cast<std::size_t>(e.tag), 2);
        append(static_cast<std::size_t>(e.type), 2);
        append(e.count, 4);
        append(e.value, 4);
    }
    append(0, 4);
    return file;
}

TEST_F(FormsTest, TiffOfEveryForm) {
    std::vector<int> palette(3 * 256, 0);
    for (const int color : {0, 256, 512}) palette[static_cast<std::size_t>(color + 5)] = 0x6666;
    for (const int color : {0, 256, 512}) palette[static_cast<std::size_t>(color + 9)] = 0xffff;
    const Form forms[] = {
        {"1-bit", tiff(1, 1, 1, {0x40}), 1, 1, {{Channel::automatic, "grey", 0, 1}}},
        {"4-bit", tiff(4, 1, 1, {0x3c}), 4, 1, {{Channel::automatic, "grey", 3 / 15.0, 12 / 15.0}}},
        {"8-bit palette", tiff(8, 3, 1, {5, 9}, palette), 8, 1, {{Channel::automatic, "red", 0x66 / 255.0, 1}}},
        {"8-bit RGB", tiff(8, 2, 3, {1, 2, 3, 40, 50, 60}), 8, 3,
         {{Channel::green, "green", 2 / 255.0, 50 / 255.0},
          {Channel::luminance, "luma", luma(1, 2, 3) / 255.0, luma(40, 50, 60) / 255.0}}},
        {"16-bit RGB", tiff(16, 2, 3, {0, 1, 0, 2, 0, 3, 255, 255, 0, 0, 1, 0}), 16, 3,
         {{Channel::red, "red", 0x100 / 65535.0, 1}, {Channel::blue, "blue", 0x300 / 65535.0, 1 / 65535.0}}},
    };
    for (const Form& form : forms) expect_form(form);
}

TEST_F(FormsTest, ExrOfColours) {
    OIIO::ImageSpec spec(2, 1, 4, OIIO::TypeDesc::FLOAT);
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8),
                   std::vector<float>{0.7f, 0.3f, 0.2f, 0.7f, 0.1f, 0.1f, 0.3f, 0.3f}.data());
    spec.attribute("oiio:ColorSpace", "sRGB");
    const std::vector<float> values{0.125f, 0.25f, 0.5f, 0.75f, 1.0f, 0.0f, 0.375f, 0.0625f};
    const std::string path = write("map.exr", spec, values);
    const std::pair<Channel, std::size_t> channels[] = {
        {Channel::red, 0}, {Channel::green, 1}, {Channel::blue, 2}, {Channel::alpha, 3}};
    for (const auto& [channel, place] : channels) {
        const auto map = read_height_map(path, {.channel = channel});
        ASSERT_TRUE(map.ok()) << map.error().message;
        EXPECT_EQ(map->image.texels, (std::vector<float>{values[place], values[place + 4]}));
    }
    const auto mixed = read_height_map(path, {.channel = Channel::luminance});
    ASSERT_TRUE(mixed.ok());
    EXPECT_NEAR(mixed->image.at(1, 0), luma(1.0, 0.0, 0.375), 1e-7);
}

// A profile and a turn in the metadata change nothing of what a JPEG gives without them.
TEST_F(FormsTest, MetadataOfJpegIsLeftAlone) {
    for (const int channels : {1, 3}) {
        OIIO::ImageSpec spec(16, 8, channels, OIIO::TypeDesc::UINT8);
        std::vector<float> values;
        for (int i = 0; i < 16 * 8 * channels; ++i) values.push_back(static_cast<float>(i / channels) / 128.0f);
        const auto plain = read_height_map(write("plain.jpg", spec, values));
        spec.attribute("Orientation", 6);
        spec.attribute("oiio:ColorSpace", "AdobeRGB");
        spec.attribute("ICCProfile", OIIO::TypeDesc(OIIO::TypeDesc::UINT8, 200), Bytes(200, 3).data());
        const auto managed = read_height_map(write("managed.jpg", spec, values));
        ASSERT_TRUE(plain.ok() && managed.ok());
        EXPECT_EQ(managed->image.width, 16);
        EXPECT_EQ(managed->image.texels, plain->image.texels);
        EXPECT_EQ(managed->channels, channels);
    }
}

}  // namespace
}  // namespace burin
