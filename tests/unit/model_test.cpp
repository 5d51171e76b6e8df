#include <burin/image_io.hpp>
#include <burin/model.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>

#include <nlohmann/json.hpp>

#include "temporary_folder.hpp"

namespace burin {
namespace {

using Json = nlohmann::json;

std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

Result<Model> read_text(const std::string& text) { return read_model_bytes(bytes_of(text), ""); }

// The model with the smallest pattern: one empty cell, one material.
Result<std::vector<std::uint8_t>> glb_of(const Model& model) {
    PackedTextures textures;
    textures.grid_width = textures.grid_height = textures.data_width = textures.data_height = 1;
    textures.grid = {0, 0xffffffffu};
    textures.data = {0, 0, 0, 0};
    textures.sections.material_texels = 1;
    PathDetail detail;
    detail.grid_width = detail.grid_height = detail.data_width = detail.data_height = 1;
    detail.sections = textures.sections;
    return write_glb(model, textures, detail, Fallback{});
}

// The triangles of a model, by way of the asset reader.
Result<Asset> asset_of(const Model& model) {
    const auto glb = glb_of(model);
    if (!glb.ok()) return glb.error();
    return read_asset(*glb);
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
    static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t v = 0;
        const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
        for (std::size_t k = 0; k < 3; ++k) v = v << 8 | (k < n ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k) text.push_back(k <= n ? digits[v >> (18 - 6 * k) & 63] : '=');
    }
    return text;
}

// A triangle with uv as a glTF document with an embedded buffer: 3 positions, 3 uvs, 3 indices of 16 bits.
Json triangle() {
    const float values[] = {0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 1, 0, 0, 1};
    std::vector<std::uint8_t> buffer(sizeof values);
    std::memcpy(buffer.data(), values, sizeof values);
    for (const int i : {0, 0, 1, 0, 2, 0, 0, 0}) buffer.push_back(static_cast<std::uint8_t>(i));
    return Json::parse(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0}]}],
        "materials":[{"name":"skin"}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[2,3,0]},
                     {"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},
                     {"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"}],
        "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},
                       {"buffer":0,"byteOffset":60,"byteLength":6}],
        "buffers":[{"byteLength":68,"uri":"data:application/octet-stream;base64,)" +
                       base64(buffer) + R"("}]})");
}

void expect_error(const Result<Model>& model, ErrorCode code, const std::string& part) {
    ASSERT_FALSE(model.ok()) << part;
    EXPECT_EQ(model.error().code, code) << model.error().message;
    EXPECT_NE(model.error().message.find(part), std::string::npos) << model.error().message;
}

TEST(Model, PlaneLiesFlatWithUvFromCornerToCorner) {
    const auto asset = asset_of(make_plane({2.0, 3.0}));
    ASSERT_TRUE(asset.ok()) << asset.error().message;
    ASSERT_EQ(asset->primitives.size(), 1u);
    const Primitive& p = asset->primitives[0];
    ASSERT_EQ(p.indices.size(), 6u);
    for (std::size_t v = 0; v < 4; ++v) {
        EXPECT_NEAR(p.positions[3 * v], (p.uvs[2 * v] - 0.5) * 2.0, 1e-6);
        EXPECT_EQ(p.positions[3 * v + 1], 0.0f);
        EXPECT_NEAR(p.positions[3 * v + 2], (p.uvs[2 * v + 1] - 0.5) * 3.0, 1e-6);
        EXPECT_EQ(p.normals[3 * v + 1], 1.0f);
    }
    // Counter-clockwise from above: the edges' cross product points up.
    for (std::size_t t = 0; t < 6; t += 3) {
        const float *a = &p.positions[3 * p.indices[t]], *b = &p.positions[3 * p.indices[t + 1]],
                    *c = &p.positions[3 * p.indices[t + 2]];
        EXPECT_GT((b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]), 0.0f);
    }
    const auto target = find_material(make_plane({2.0, 3.0}));
    ASSERT_TRUE(target.ok());
    EXPECT_NEAR(target->metres_per_uv.x, 2.0, 1e-6);
    EXPECT_NEAR(target->metres_per_uv.y, 3.0, 1e-6);
}

TEST(Model, ObjQuadWithNegativeIndicesAndWindowsLines) {
    const auto model = read_text(
        "# plate\r\nv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nvt 0 0\r\nvt 1 0\r\nvt 1 1\r\nvt 0 1\r\n"
        "usemtl my steel \r\nf -4/-4 -3/-3 -2/-2 -1/-1\r\n");
    ASSERT_TRUE(model.ok()) << model.error().message;
    const auto target = find_material(*model);
    ASSERT_TRUE(target.ok()) << target.error().message;
    EXPECT_EQ(target->name, "my steel");
    EXPECT_EQ(target->triangles, 2u);
    const auto asset = asset_of(*model);
    ASSERT_TRUE(asset.ok());
    const Primitive& p = asset->primitives[0];
    for (std::size_t v = 0; v < p.positions.size() / 3; ++v) {
        EXPECT_EQ(p.uvs[2 * v], p.positions[3 * v]);
        EXPECT_EQ(p.uvs[2 * v + 1], 1.0f - p.positions[3 * v + 1]);  // v turned downwards
        EXPECT_EQ(p.normals[3 * v + 2], 1.0f);                       // computed from the face
    }
}

TEST(Model, ObjPolygonsKeepTheirArea) {
    // An arrow with a notch: a fan would cover the notch. Area 2 * 2 - 1.
    const auto model = read_text(
        "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 1 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt .5 .5\nvt 0 1\nf 1/1 2/2 "
        "3/3 4/4 5/5\n");
    ASSERT_TRUE(model.ok()) << model.error().message;
    const auto asset = asset_of(*model);
    ASSERT_TRUE(asset.ok());
    const Primitive& p = asset->primitives[0];
    double area = 0.0;
    for (std::size_t t = 0; t < p.indices.size(); t += 3) {
        const float *a = &p.positions[3 * p.indices[t]], *b = &p.positions[3 * p.indices[t + 1]],
                    *c = &p.positions[3 * p.indices[t + 2]];
        const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        EXPECT_GT(twice, 0.0);
        area += twice / 2;
    }
    EXPECT_NEAR(area, 3.0, 1e-6);
}

TEST(Model, ObjErrorsNameTheLine) {
    expect_error(read_text("v 0 0 0\nv 1 0 0\nf 1 2 3\n"), ErrorCode::invalid_input, "line 3");
    expect_error(read_text("v 0 0\n"), ErrorCode::invalid_input, "line 1");
    expect_error(read_text("v 0 0 nan\n"), ErrorCode::invalid_input, "line 1");
    expect_error(read_text("v 0 0 1e39\n"), ErrorCode::invalid_input, "1e39");
    expect_error(read_text("v 0 0 0\nv 1 0 0\nf 1 2\n"), ErrorCode::invalid_input, "2 corners");
    expect_error(read_text("v 0 0 0\nf 0 0 0\n"), ErrorCode::invalid_input, "'0'");
    expect_error(read_text("v 0 0 0\nf 1/1 1/1 1/1\n"), ErrorCode::invalid_input, "0 texture coordinates");
    expect_error(read_text("v 0 0 0\nf -2 -2 -2\n"), ErrorCode::invalid_input, "'-2'");
    expect_error(read_text("v 0 0 0\n"), ErrorCode::invalid_input, "no face");
    expect_error(read_text("hello\n"), ErrorCode::invalid_input, "'hello'");
    expect_error(read_text(""), ErrorCode::invalid_input, "empty");
    expect_error(read_text(std::string("a\0b", 3)), ErrorCode::unsupported, ".obj");
}

TEST(Model, ObjWithoutUvIsRefusedForAPattern) {
    const auto model = read_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    ASSERT_TRUE(model.ok());
    const auto target = find_material(*model);
    ASSERT_FALSE(target.ok());
    EXPECT_NE(target.error().message.find("TEXCOORD_0"), std::string::npos);
}

TEST(Model, EmbeddedTriangle) {
    const auto model = read_text(triangle().dump());
    ASSERT_TRUE(model.ok()) << model.error().message;
    const auto target = find_material(*model);
    ASSERT_TRUE(target.ok());
    EXPECT_NEAR(target->metres_per_uv.x, 2.0, 1e-6);
    EXPECT_NEAR(target->metres_per_uv.y, 3.0, 1e-6);
}

TEST(Model, MaterialsAreChosenByNameOrListed) {
    Json document = triangle();
    document["materials"].push_back({{"name", "glass"}});
    document["materials"].push_back({{"name", "unused"}});
    document["meshes"][0]["primitives"].push_back(document["meshes"][0]["primitives"][0]);
    document["meshes"][0]["primitives"][1]["material"] = 1;
    const auto model = read_text(document.dump());
    ASSERT_TRUE(model.ok());
    const auto open = find_material(*model);
    ASSERT_FALSE(open.ok());
    EXPECT_NE(open.error().message.find("'skin', 'glass'"), std::string::npos) << open.error().message;
    EXPECT_EQ(find_material(*model, {.material = "glass"})->index, 1u);
    EXPECT_FALSE(find_material(*model, {.material = "unused"}).ok());
    EXPECT_FALSE(find_material(*model, {.material = "glass", .tex_coord = 1}).ok());
    EXPECT_EQ(find_material(*model, {.material = "glass", .tex_coord = 9}).error().code,
              ErrorCode::invalid_argument);
}

// One change to the good document, and the words that must be in the message.
struct Damage {
    const char* pointer;
    Json value;
    const char* message;
    ErrorCode code = ErrorCode::invalid_input;
};

TEST(Model, EveryReferenceIsChecked) {
    const Damage damages[] = {
        {"/asset/version", "1.0", "version 1.0", ErrorCode::unsupported},
        {"/asset", 5, "asset"},
        {"/extensionsRequired",
         {"KHR_draco_mesh_compression"},
         "KHR_draco_mesh_compression",
         ErrorCode::unsupported},
        {"/extensionsRequired", {"VENDOR_unheard_of"}, "VENDOR_unheard_of", ErrorCode::unsupported},
        {"/extensionsUsed", 7, "extensionsUsed"},
        {"/extensions", {{"X_y", 1}}, "X_y"},
        {"/scene", 1, "scene is 1"},
        {"/scenes/0/nodes/0", 1, "scenes[0]"},
        {"/nodes/0/mesh", 1, "mesh is 1"},
        {"/nodes/0/children", {0}, "loop"},
        {"/nodes/0/children", {-1}, "children"},
        {"/nodes/0/matrix", {1, 2, 3}, "matrix"},
        {"/nodes/0/scale", {1, "x", 3}, "scale"},
        {"/nodes", 3, "nodes is no array"},
        {"/nodes/0", 3, "nodes[0]"},
        {"/meshes/0/primitives", Json::array(), "primitives"},
        {"/meshes/0/primitives/0/indices", 3, "indices is 3"},
        {"/meshes/0/primitives/0/indices", 0, "unsigned scalars"},
        {"/meshes/0/primitives/0/material", 1, "material is 1"},
        {"/meshes/0/primitives/0/mode", 7, "mode"},
        {"/meshes/0/primitives/0/attributes/POSITION", 1, "VEC2"},
        {"/meshes/0/primitives/0/attributes/TEXCOORD_0", 2, "TEXCOORD_0"},
        {"/meshes/0/primitives/0/attributes", {{"NORMAL", 0}}, "POSITION"},
        {"/accessors/0/bufferView", 3, "bufferView is 3"},
        {"/accessors/0/count", 4, "do not fit"},
        {"/accessors/0/count", 0, "count is 0"},
        {"/accessors/0/count", 3.5, "count"},
        {"/accessors/0/count", -3, "count"},
        {"/accessors/0/byteOffset", 1, "multiples"},
        {"/accessors/0/byteOffset", 1e18, "byteOffset"},
        {"/accessors/0/byteOffset", 1ull << 39, "do not fit"},
        {"/accessors/0/componentType", 5124, "5124"},
        {"/accessors/0/type", "VEC5", "VEC5"},
        {"/accessors/1/count", 2, "elements"},
        {"/bufferViews/0/buffer", 1, "buffer is 1"},
        {"/bufferViews/0/byteLength", 69, "bytes 0 to 69"},
        {"/bufferViews/0/byteLength", 0, "bytes 0 to 0"},
        {"/bufferViews/0/byteOffset", 1ull << 39, "bufferViews[0]"},
        {"/bufferViews/0/byteStride", 8, "byteStride 8"},
        {"/bufferViews/0/byteStride", 14, "byteStride"},
        {"/bufferViews/0/byteStride", 256, "byteStride"},
        {"/bufferViews/0/extensions",
         {{"EXT_meshopt_compression", Json::object()}},
         "EXT_meshopt_compression",
         ErrorCode::unsupported},
        {"/buffers/0/byteLength", 70, "byteLength is 70"},
        {"/buffers/0/byteLength", 0, "byteLength"},
        {"/buffers/0/uri", "data:application/octet-stream;base64,AA!A", "base64"},
        {"/buffers/0/uri", "data:application/octet-stream,AAAA", "base64"},
        {"/buffers/0/uri", "other.bin", "not allowed"},
        {"/buffers/0/uri", 5, "uri"},
        {"/images", {{{"bufferView", 9}}}, "bufferView is 9"},
        {"/images", {Json::object()}, "images[0]"},
        {"/textures", {{{"source", 0}}}, "source is 0"},
        {"/materials/0/normalTexture", {{"index", 0}}, "normalTexture"},
        {"/materials/0/extensions", 4, "extensions"},
    };
    for (const Damage& d : damages) {
        Json document = triangle();
        document[Json::json_pointer(d.pointer)] = d.value;
        SCOPED_TRACE(std::string(d.pointer) + " = " + d.value.dump());
        expect_error(read_text(document.dump()), d.code, d.message);
    }
}

TEST(Model, SparseAccessorsAreCheckedAndApplied) {
    Json document = triangle();
    // The second position is replaced by the third uv pair and its neighbour's first number: values of
    // view 1.
    document["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 62}, {"byteLength", 2}});
    document["accessors"][0]["sparse"] = {{"count", 1},
                                          {"indices", {{"bufferView", 3}, {"componentType", 5123}}},
                                          {"values", {{"bufferView", 1}, {"byteOffset", 12}}}};
    const auto model = read_text(document.dump());
    ASSERT_TRUE(model.ok()) << model.error().message;
    const auto asset = asset_of(*model);
    ASSERT_TRUE(asset.ok()) << asset.error().message;
    EXPECT_EQ(asset->primitives[0].positions[3], 0.0f);  // of index 1: was 2
    EXPECT_EQ(asset->primitives[0].positions[5], 1.0f);
    const Damage damages[] = {{"/accessors/0/sparse/count", 4, "sparse.count"},
                              {"/accessors/0/sparse/count", 2, "do not fit"},
                              {"/accessors/0/sparse/indices/componentType", 5126, "5126"},
                              {"/accessors/0/sparse/indices/bufferView", 0, ""},
                              {"/accessors/0/sparse/values/byteOffset", 16, "do not fit"},
                              {"/accessors/0/sparse/values", 1, "sparse"},
                              {"/bufferViews/3/byteOffset", 58, "sparse"}};
    for (const Damage& d : damages) {
        Json bad = document;
        bad[Json::json_pointer(d.pointer)] = d.value;
        SCOPED_TRACE(std::string(d.pointer) + " = " + d.value.dump());
        const auto result = read_text(bad.dump());
        if (std::string(d.message).empty())
            EXPECT_TRUE(result.ok());  // the view of positions begins with a 16-bit zero
        else
            expect_error(result, d.code, d.message);
    }
}

TEST(Model, IndicesBeyondTheVerticesAreRefused) {
    Json document = triangle();
    document["accessors"][0]["count"] = 2;
    document["accessors"][1]["count"] = 2;
    expect_error(read_text(document.dump()), ErrorCode::invalid_input, "an index is 2");
}

TEST(Model, DeepOrDamagedJsonIsRefused) {
    expect_error(read_text("{\"a\":" + std::string(100000, '[') + std::string(100000, ']') + "}"),
                 ErrorCode::limit_exceeded, "levels");
    expect_error(read_text("{\"a\":\n\n tru}"), ErrorCode::invalid_input, "line 3");
    expect_error(read_text("{\"asset\":{\"version\":\"2.0\",\"x\":1e999}}"), ErrorCode::invalid_input, "");
    expect_error(read_text("{\"asset\":{\"version\":\"2.0\",\"x\":\"\xff\"}}"), ErrorCode::invalid_input,
                 "JSON");
    expect_error(read_text("{"), ErrorCode::invalid_input, "JSON");
}

TEST(Model, NodesThatAreSharedOrReachedTwiceAreRefused) {
    Json document = triangle();
    document["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
    document["scenes"][0]["nodes"] = {0, 1};
    expect_error(read_text(document.dump()), ErrorCode::invalid_input, "child of two");
    document["nodes"] = {{{"children", {1}}}, {{"mesh", 0}}};
    expect_error(read_text(document.dump()), ErrorCode::invalid_input, "is no root");
    document["scenes"][0]["nodes"] = {0, 0};
    expect_error(read_text(document.dump()), ErrorCode::invalid_input, "twice");
}

TEST(Model, TransformsReachTheVertices) {
    Json document = triangle();
    document["nodes"] = {
        {{"children", {1}}, {"translation", {10, 0, 0}}},
        {{"mesh", 0}, {"scale", {-2, 1, 1}}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}}};
    const auto model = read_text(document.dump());
    ASSERT_TRUE(model.ok()) << model.error().message;
    const auto asset = asset_of(*model);
    ASSERT_TRUE(asset.ok());
    const Primitive& p = asset->primitives[0];
    // (2, 0, 0) is mirrored and doubled to (-4, 0, 0), turned to (0, -4, 0), moved to (10, -4, 0).
    EXPECT_NEAR(p.positions[3], 10.0f, 1e-5);
    EXPECT_NEAR(p.positions[4], -4.0f, 1e-5);
    // The mirror turns the triangle over; its order was swapped, so that front is still counter-clockwise.
    EXPECT_EQ(p.indices, (std::vector<std::uint32_t>{0, 2, 1}));
    EXPECT_NEAR(p.normals[2], 1.0f, 1e-5);
    EXPECT_NEAR(find_material(*model)->metres_per_uv.x, 4.0, 1e-5);
}

TEST(Model, StripsAndFansAreUnrolled) {
    for (const auto& [mode, expected] :
         {std::pair{5, std::vector<std::uint32_t>{0, 1, 2}}, {6, {0, 1, 2}}, {0, {}}, {1, {}}}) {
        Json document = triangle();
        document["meshes"][0]["primitives"][0]["mode"] = mode;
        const auto asset = read_asset(bytes_of(document.dump()));
        ASSERT_TRUE(asset.ok()) << asset.error().message;
        if (expected.empty())
            EXPECT_TRUE(asset->primitives.empty());
        else
            EXPECT_EQ(asset->primitives[0].indices, expected);
    }
}

class ModelFiles : public ::testing::Test {
  protected:
    void put(const std::string& name, const std::string& text) {
        std::filesystem::create_directories(std::filesystem::path(folder_.file(name)).parent_path());
        ASSERT_TRUE(write_file(folder_.file(name), bytes_of(text)).ok());
    }
    // The triangle with its buffer in a file of that uri.
    Result<Model> with_uri(const std::string& uri) {
        Json document = triangle();
        document["buffers"][0]["uri"] = uri;
        put("in/model.gltf", document.dump());
        return read_model(folder_.file("in/model.gltf"));
    }
    test::TemporaryFolder folder_;
};

TEST_F(ModelFiles, BuffersBesideTheModel) {
    std::string buffer(68, '\0');
    put("in/data.bin", buffer);
    put("in/sub dir/b.bin", buffer);
    EXPECT_TRUE(with_uri("data.bin").ok());
    EXPECT_TRUE(with_uri("./sub%20dir/b.bin").ok());
    put("in/short.bin", buffer.substr(1));
    expect_error(with_uri("short.bin"), ErrorCode::invalid_input, "only 67 bytes");
    expect_error(with_uri("none.bin"), ErrorCode::io_failed, "none.bin");
}

TEST_F(ModelFiles, UrisNeverLeaveTheFolder) {
    put("outside.bin", std::string(68, '\0'));
    put("in/x", "");
    std::filesystem::create_symlink(folder_.file("outside.bin"), folder_.file("in/link.bin"));
    std::filesystem::create_directory_symlink(folder_.path(), folder_.file("in/dir"));
    for (const std::string& uri :
         {std::string("../outside.bin"), std::string("sub/../../outside.bin"),
          std::string("%2e%2e/outside.bin"), folder_.file("outside.bin"),
          "file://" + folder_.file("outside.bin"), std::string("http://localhost/outside.bin"),
          std::string("..\\outside.bin"), std::string("link.bin"), std::string("dir/outside.bin"),
          std::string("a%00b"), std::string("a%zz")}) {
        const auto model = with_uri(uri);
        EXPECT_FALSE(model.ok()) << uri;
    }
}

TEST_F(ModelFiles, RandomDamageNeverCrashes) {
    const unsigned seed = std::random_device{}();
    std::printf("seed %u\n", seed);
    std::mt19937 random(seed);
    const auto glb = glb_of(*read_text(triangle().dump()));
    ASSERT_TRUE(glb.ok());
    const std::vector<std::vector<std::uint8_t>> seeds{
        *glb, bytes_of(triangle().dump()),
        bytes_of("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvn 0 0 1\nusemtl a\nf 1/1/1 2/2/1 "
                 "3/1/1 4/2/1\nf 1//1 2//1 3//1\n")};
    for (int trial = 0; trial < 6000; ++trial) {
        std::vector<std::uint8_t> bytes = seeds[static_cast<std::size_t>(trial) % seeds.size()];
        for (unsigned k = 1 + random() % 3; k > 0; --k) {
            static constexpr char kLikely[] = "0123456789-.[]{},:\"eE/ \n";
            bytes[random() % bytes.size()] =
                random() % 3 == 0 ? static_cast<std::uint8_t>(random())
                                  : static_cast<std::uint8_t>(kLikely[random() % (sizeof kLikely - 1)]);
        }
        if (random() % 8 == 0) bytes.resize(random() % bytes.size());
        const auto model = read_model_bytes(bytes, "");
        if (!model.ok()) {
            EXPECT_FALSE(model.error().message.empty());
            continue;
        }
        (void)find_material(*model);
        const auto asset = read_asset(bytes);
        if (!asset.ok()) continue;
        for (const Primitive& p : asset->primitives)
            for (const std::uint32_t i : p.indices) ASSERT_LT(i, p.positions.size() / 3);
    }
}

}  // namespace
}  // namespace burin
