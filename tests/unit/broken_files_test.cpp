// Every damaged, hostile or unusual file of the shared data, read as height map and as model: an error with a
// message, or, for what is merely unusual, a correct result. A crash, or 10 s of processor time for one file,
// ends the program.
#include <burin/heightmap.hpp>
#include <burin/image_io.hpp>
#include <burin/model.hpp>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/time.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace burin {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> broken_files() {
    std::vector<std::string> files;
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(std::string(BURIN_SHARED_DATA) + "/broken", absent))
        files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

// The process ends by SIGPROF when it computes longer than that before the next call; 0: no limit. Processor
// time, so that other work on the machine does not count.
void limit_seconds(int seconds) {
#ifdef __SANITIZE_ADDRESS__
    seconds *= 10;
#endif
    const itimerval timer{{0, 0}, {seconds, 0}};
    ::setitimer(ITIMER_PROF, &timer, nullptr);
}

class BrokenFiles : public ::testing::Test {
  protected:
    void SetUp() override {
        files_ = broken_files();
        if (files_.empty()) GTEST_SKIP() << "no shared data at " << BURIN_SHARED_DATA << "/broken";
    }
    void TearDown() override { limit_seconds(0); }
    std::vector<std::string> files_;
};

bool says_something(const Error& error) {
    return !error.message.empty() && error.message.find('\n') == std::string::npos &&
           error.message.size() < 400;
}

TEST_F(BrokenFiles, AsHeightMaps) {
    // Damaged only in metadata that heights do not need.
    const std::set<std::string> readable{"png_bad_broken_iccp.png", "png_bad_iccp_scratches_gold01_1k.png",
                                         "png_bug_acid2.png"};
    // Valid, but coded in ways that are not promised.
    const std::set<std::string> refused{"tif_edge_thunderscan_text.tif"};
    for (const std::string& file : files_) {
        const std::string name = fs::path(file).filename().string();
        SCOPED_TRACE(name);
        limit_seconds(10);
        const auto map = read_height_map(file);
        const bool edge = name.find("_edge_") != std::string::npos;
        EXPECT_EQ(map.ok(), readable.count(name) != 0 || (edge && refused.count(name) == 0))
            << (map.ok() ? "" : map.error().message);
        if (!map.ok()) {
            EXPECT_TRUE(says_something(map.error())) << map.error().message;
            continue;
        }
        ASSERT_EQ(map->image.texels.size(),
                  static_cast<std::size_t>(map->image.width) * static_cast<std::size_t>(map->image.height));
        for (const float v : map->image.texels) ASSERT_TRUE(v >= 0.0f && v <= 1.0f);
    }
#ifndef __SANITIZE_ADDRESS__
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    EXPECT_LT(usage.ru_maxrss, 2 * 1024 * 1024) << "peak memory in KiB";
#endif
}

TEST_F(BrokenFiles, UnusualOnesGiveTheRightTexels) {
    const std::string folder = std::string(BURIN_SHARED_DATA) + "/broken/";
    const auto interlaced = read_height_map(folder + "png_edge_valid_basi0g16.png");
    const auto plain = read_height_map(folder + "png_edge_valid_basn0g16.png");
    const auto split = read_height_map(folder + "png_edge_valid_oi9n0g16.png");
    ASSERT_TRUE(interlaced.ok() && plain.ok() && split.ok());
    EXPECT_EQ(interlaced->image.texels, plain->image.texels);
    EXPECT_EQ(split->image.texels, plain->image.texels);
    EXPECT_EQ(plain->bit_depth, 16);
    const auto gradient = read_height_map(folder + "tif_edge_valid_gradient-1c-64b-float.tiff");
    ASSERT_TRUE(gradient.ok());
    ASSERT_EQ(gradient->image.width, 256);
    for (int x = 1; x < 256; ++x) EXPECT_GT(gradient->image.at(x, 0), gradient->image.at(x - 1, 0));
    const auto large = read_height_map(folder + "jpg_edge_8500x8146_69Mpx.jpg");
    ASSERT_TRUE(large.ok());
    EXPECT_EQ(large->image.width, 8500);
    EXPECT_EQ(large->image.height, 8146);
}

TEST_F(BrokenFiles, AsPictures) {
    for (const std::string& file : files_) {
        SCOPED_TRACE(fs::path(file).filename().string());
        limit_seconds(10);
        auto bytes = read_file(file, 1u << 30);
        if (!bytes.ok()) continue;
        const auto picture = decode_picture(std::move(*bytes), 1u << 24);
        if (picture.ok())
            EXPECT_EQ(picture->texels.size(), 4u * static_cast<unsigned>(picture->width) * static_cast<unsigned>(picture->height));
        else
            EXPECT_TRUE(says_something(picture.error())) << picture.error().message;
    }
}

TEST_F(BrokenFiles, AsModels) {
    for (const std::string& file : files_) {
        SCOPED_TRACE(fs::path(file).filename().string());
        limit_seconds(10);
        const auto model = read_model(file);
        if (!model.ok()) {
            EXPECT_TRUE(says_something(model.error())) << model.error().message;
            continue;
        }
        const auto target = find_material(*model);
        ASSERT_FALSE(target.ok()) << "a pattern would go onto " << target->name;
        EXPECT_TRUE(says_something(target.error())) << target.error().message;
    }
}

TEST_F(BrokenFiles, AsAssets) {
    for (const std::string& file : files_) {
        if (file.find(".gl") == std::string::npos) continue;
        SCOPED_TRACE(fs::path(file).filename().string());
        limit_seconds(10);
        const auto model = read_model(file);
        if (model.ok()) (void)write_glb(*model, PackedTextures{}, PathDetail{}, Fallback{});
    }
}

}  // namespace
}  // namespace burin
