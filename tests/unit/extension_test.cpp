// The extension's JSON: bit-exact round trip, and a message for everything that can be wrong with it.
#include <string>

#include <gtest/gtest.h>

#include <burin/format/extension.hpp>

namespace burin {
namespace {

PathDetail sample() {
    PathDetail d;
    d.size_u = 0.1;
    d.size_v = 1.0 / 3.0;
    d.depth = 0.0123456789012345678;
    d.base_offset = 1e-7;
    d.outer_level = -0.007;
    d.repeat = false;
    d.tex_coord = 1;
    d.grid_view = 3;
    d.data_view = 4;
    d.grid_width = 32;
    d.grid_height = 16;
    d.data_width = 20;
    d.data_height = 19;
    d.sections = {210, 9, 18, 1, 140};
    return d;
}

TEST(Extension, RoundTripIsExact) {
    const PathDetail d = sample();
    const Result<PathDetail> read = parse_extension(write_extension(d));
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_EQ(read->size_u, d.size_u);
    EXPECT_EQ(read->size_v, d.size_v);
    EXPECT_EQ(read->depth, d.depth);
    EXPECT_EQ(read->base_offset, d.base_offset);
    EXPECT_EQ(read->outer_level, d.outer_level);
    EXPECT_EQ(read->repeat, d.repeat);
    EXPECT_EQ(read->tex_coord, d.tex_coord);
    EXPECT_EQ(read->grid_view, 3);
    EXPECT_EQ(read->data_view, 4);
    EXPECT_EQ(read->grid_width, 32);
    EXPECT_EQ(read->grid_height, 16);
    EXPECT_EQ(read->data_width, 20);
    EXPECT_EQ(read->data_height, 19);
    EXPECT_EQ(write_extension(*read), write_extension(d));
}

TEST(Extension, DefaultsHold) {
    const Result<PathDetail> read = parse_extension(
        R"({"version":1,"size":[1,2],"depth":0.5,"unknown":{},"grid":{"bufferView":0,"width":1.0,"height":1},
            "data":{"bufferView":1,"width":1,"height":1,"elements":0,"styles":0,"profiles":0,"materials":1,"lists":0}})");
    ASSERT_TRUE(read.ok()) << read.error().message;
    EXPECT_TRUE(read->repeat);
    EXPECT_EQ(read->tex_coord, 0);
    EXPECT_EQ(read->base_offset, 0.0);
    EXPECT_EQ(read->outer_level, 0.0);
}

std::string replaced(const std::string& from, const std::string& to) {
    std::string text = write_extension(sample());
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(Extension, WrongIsNamed) {
    const struct {
        std::string json, wanted;
        ErrorCode code;
    } rows[] = {
        {"{", "not JSON", ErrorCode::invalid_input},
        {"[]", "object is needed", ErrorCode::invalid_input},
        {replaced("\"version\":1", "\"version\":2"), "version is 2", ErrorCode::unsupported},
        {replaced("\"version\":1,", ""), "version is missing", ErrorCode::invalid_input},
        {replaced("\"depth\":", "\"deep\":"), "depth is missing", ErrorCode::invalid_input},
        {replaced("\"wrap\":\"clamp\"", "\"wrap\":\"mirror\""), "mirror", ErrorCode::invalid_input},
        {replaced("\"width\":32", "\"width\":4097"), "4097", ErrorCode::invalid_input},
        {replaced("\"width\":32", "\"width\":3.5"), "3.5", ErrorCode::invalid_input},
        {replaced("\"lists\":140", "\"lists\":143"), "381 texels", ErrorCode::invalid_input},
        {replaced("\"outerLevel\":-0.007", "\"outerLevel\":-7"), "outerLevel is -7",
         ErrorCode::invalid_input},
        {replaced("\"bufferView\":3", "\"bufferView\":-3"), "-3", ErrorCode::invalid_input},
        {replaced("\"bufferView\":3", "\"bufferView\":18446744073709551615"), "18446744073709551615",
         ErrorCode::invalid_input},
    };
    for (const auto& row : rows) {
        const Result<PathDetail> read = parse_extension(row.json);
        ASSERT_FALSE(read.ok()) << row.json;
        EXPECT_EQ(read.error().code, row.code) << read.error().message;
        EXPECT_NE(read.error().message.find(row.wanted), std::string::npos) << read.error().message;
    }
}

}  // namespace
}  // namespace burin
