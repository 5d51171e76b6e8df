// Lines in files as strokes, and what is refused.
#include <burin/strokes.hpp>

#include <gtest/gtest.h>

namespace burin {
namespace {

Result<std::vector<Stroke>> read(const std::string& text) {
    return read_strokes_bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, "");
}

std::string message(const std::string& text) {
    const auto strokes = read(text);
    return strokes ? "read" : strokes.error().message;
}

const std::string kPoints = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 3 1 0\n";

TEST(StrokesObj, PolylinesAndNames) {
    const auto strokes = read("# curves\no first\n" + kPoints + "l 1 2 3\ng second one\nl -2/7 -1\n");
    ASSERT_TRUE(strokes.ok()) << strokes.error().message;
    ASSERT_EQ(strokes->size(), 2u);
    EXPECT_EQ((*strokes)[0].name, "first");
    EXPECT_EQ((*strokes)[0].points.size(), 3u);
    EXPECT_EQ((*strokes)[0].points[2].x, 2.0);
    EXPECT_FALSE((*strokes)[0].closed);
    EXPECT_EQ((*strokes)[1].name, "second");
    EXPECT_EQ((*strokes)[1].points[1].y, 1.0);
}

// Blender writes one line per edge, in any order.
TEST(StrokesObj, EdgesAreJoined) {
    const auto strokes = read(kPoints + "l 3 4\nl 2 1\nl 3 2\nl 5 4\n");
    ASSERT_TRUE(strokes.ok()) << strokes.error().message;
    ASSERT_EQ(strokes->size(), 1u);
    ASSERT_EQ((*strokes)[0].points.size(), 5u);
    EXPECT_EQ((*strokes)[0].points.front().x, 0.0);
    EXPECT_EQ((*strokes)[0].points.back().y, 1.0);
}

TEST(StrokesObj, ClosedByNumberOrByPlace) {
    for (const std::string lines : {"l 1 2 5 1\n", "v 0 0 0\nl 1 2 5 6\n", "l 2 5\nl 1 2\nl 5 1\n"}) {
        const auto strokes = read(kPoints + lines);
        ASSERT_TRUE(strokes.ok()) << strokes.error().message;
        ASSERT_EQ(strokes->size(), 1u) << lines;
        EXPECT_TRUE((*strokes)[0].closed) << lines;
        EXPECT_EQ((*strokes)[0].points.size(), 3u) << lines;
    }
}

TEST(StrokesObj, BranchesPart) {
    const auto strokes = read(kPoints + "l 1 2 3\nl 2 5\n");
    ASSERT_TRUE(strokes.ok());
    EXPECT_EQ(strokes->size(), 3u);
}

TEST(StrokesObj, WhatIsWrongIsNamed) {
    EXPECT_EQ(message(kPoints + "l 1 9\n"), "OBJ: line 6: point '9': there are 5 positions");
    EXPECT_EQ(message(kPoints + "l 1\n"), "OBJ: line 6: a line needs two points or more, here are 1");
    EXPECT_EQ(message("v 0 zero 0\n"), "OBJ: line 1: 'zero' is no number within 1e30");
    EXPECT_EQ(message(kPoints + "f 1 2 3\n"), "OBJ: there is no line (l) among 6 lines of text; it holds faces");
    EXPECT_EQ(message("cstype bspline\ncurv 0 1 1 2\n"), "OBJ: there is no line (l) among 2 lines of text; free-form curves are not read, export them as a mesh of edges");
    EXPECT_NE(message(std::string("\0\1", 2)).find("neither glTF nor text"), std::string::npos);
}

// Six points along x in a buffer, under a node that turns x into z, doubles and lifts them.
std::string gltf(const std::string& primitives) {
    const std::string floats =
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAQAAAAAAAAAAAAABAQAAAAAAAAAAAAACAQAAAAAAAAAAAAACgQAAAAAAAAAAA";
    return R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":72,"uri":"data:application/octet-stream;base64,)" + floats +
           R"("}],"bufferViews":[{"buffer":0,"byteLength":72}],"accessors":[{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3","min":[0,0,0],"max":[5,0,0]}],)"
           R"("meshes":[{"name":"rim","primitives":[)" + primitives + R"(]}],"nodes":[{"mesh":0,"rotation":[0,-0.70710678118654752,0,0.70710678118654752],"scale":[2,2,2],"translation":[0,1,0]}],"scenes":[{"nodes":[0]}],"scene":0})";
}

TEST(StrokesGltf, StripsLoopsAndPairs) {
    const auto strip = read(gltf(R"({"attributes":{"POSITION":0},"mode":3})"));
    ASSERT_TRUE(strip.ok()) << strip.error().message;
    ASSERT_EQ(strip->size(), 1u);
    EXPECT_EQ((*strip)[0].name, "rim");
    ASSERT_EQ((*strip)[0].points.size(), 6u);
    EXPECT_NEAR((*strip)[0].points[5].z, 10.0, 1e-5);
    EXPECT_NEAR((*strip)[0].points[5].x, 0.0, 1e-5);
    EXPECT_NEAR((*strip)[0].points[5].y, 1.0, 1e-5);
    const auto loop = read(gltf(R"({"attributes":{"POSITION":0},"mode":2})"));
    ASSERT_TRUE(loop.ok() && loop->size() == 1u);
    EXPECT_TRUE((*loop)[0].closed);
    const auto pairs = read(gltf(R"({"attributes":{"POSITION":0},"mode":1})"));
    ASSERT_TRUE(pairs.ok());
    EXPECT_EQ(pairs->size(), 3u);
}

TEST(StrokesGltf, TrianglesAreNoLines) {
    EXPECT_EQ(message(gltf(R"({"attributes":{"POSITION":0},"mode":4})")),
              "glTF: there is no line in the scene shown (LINES, LINE_STRIP or LINE_LOOP), but 1 primitives of triangles or points");
}

TEST(StrokesMeaning, TheWordsOfDrawings) {
    StrokeOptions options;
    ASSERT_TRUE(mean_strokes("ridge flat 0.5mm 2mm", options).ok());
    EXPECT_TRUE(options.ridge);
    EXPECT_EQ(options.profile.name, "flat");
    EXPECT_DOUBLE_EQ(options.height, 0.0005);
    EXPECT_DOUBLE_EQ(options.width, 0.002);
    ASSERT_TRUE(mean_strokes("groove", options).ok());
    EXPECT_FALSE(options.ridge);
    EXPECT_EQ(options.width, 0.0);
    EXPECT_FALSE(mean_strokes("plateau", options).ok());
}

TEST(StrokesProject, WhatIsUsual) {
    const Stroke stroke{"", {{-0.3, 0, 0}, {0.3, 0, 0.1}}, false};
    const auto made = project_strokes(make_plane({1.0, 1.0}), std::span(&stroke, 1), {});
    ASSERT_TRUE(made.ok()) << made.error().message;
    EXPECT_NEAR(made->pattern.profiles[0].points.back().b * 2.0, std::sqrt(2.0) / 200.0, 1e-9);
    EXPECT_NEAR(made->pattern.depth, std::sqrt(2.0) / 400.0, 1e-9);
    ASSERT_EQ(made->pattern.paths.size(), 1u);
    ASSERT_EQ(made->pattern.paths[0].elements.size(), 1u) << "a straight line on a plane is one line";
    EXPECT_NEAR(made->pattern.paths[0].elements[0].p0.x, 0.2, 1e-6);
    EXPECT_NEAR(made->pattern.paths[0].elements[0].p2.y, 0.6, 1e-6);
    EXPECT_NEAR(made->pattern.paths[0].elements[0].width0, 1.0, 1e-6);
}

TEST(StrokesProject, OptionsOutOfRange) {
    const Stroke stroke{"", {{-0.3, 0, 0}, {0.3, 0, 0.1}}, false};
    StrokeOptions options;
    options.width = -1.0;
    EXPECT_EQ(project_strokes(make_plane({1.0, 1.0}), std::span(&stroke, 1), options).error().message, "strokes: width is -1 m; 0 or more works");
    EXPECT_EQ(project_strokes(make_plane({1.0, 1.0}), {}, {}).error().message, "there is no stroke");
    const Stroke point{"dot", {{0, 0, 0}}, false};
    EXPECT_EQ(project_strokes(make_plane({1.0, 1.0}), std::span(&point, 1), {}).error().message, "stroke 1 'dot' has 1 points; a line needs 2, a closed one 3");
}

}  // namespace
}  // namespace burin
