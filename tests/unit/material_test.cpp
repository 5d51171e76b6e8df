// Textures of glTF's own: found, decoded, and refused by name.
#include <burin/image_io.hpp>
#include <burin/model.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include <nlohmann/json.hpp>

#include "temporary_folder.hpp"

namespace burin {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

RgbaImage small_picture() { return {2, 1, {255, 0, 0, 255, 0, 200, 90, 255}}; }

// A document of one material that shows a picture beside it.
Json textured() {
    return Json::parse(R"({"asset": {"version": "2.0"},
        "images": [{"uri": "a.png"}],
        "samplers": [{"minFilter": 9728, "magFilter": 9728, "wrapS": 33071, "wrapT": 33648}],
        "textures": [{"source": 0, "sampler": 0}, {"source": 0}],
        "materials": [{"emissiveFactor": [1, 0.5, 0.25],
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform":
                    {"offset": [0.25, 0.5], "rotation": 1.5707963267948966, "scale": [2, 3]}}},
                "metallicRoughnessTexture": {"index": 1}},
            "occlusionTexture": {"index": 1, "strength": 0.5}, "emissiveTexture": {"index": 1}}]})");
}

class MaterialTextures : public ::testing::Test {
  protected:
    void SetUp() override {
        std::filesystem::create_directories(folder_.file("in"));
        ASSERT_TRUE(write_png(folder_.file("in/a.png"), small_picture()).ok());
        ASSERT_TRUE(write_png(folder_.file("outside.png"), small_picture()).ok());
    }
    Result<Asset> read(const Json& document, bool pictures = true) {
        return read_asset(bytes_of(document.dump()), folder_.file("in"), {.pictures = pictures});
    }
    void expect_error(const Json& document, ErrorCode code, const std::string& words) {
        const auto asset = read(document);
        ASSERT_FALSE(asset.ok()) << words;
        EXPECT_EQ(asset.error().code, code) << asset.error().message;
        EXPECT_NE(asset.error().message.find(words), std::string::npos) << asset.error().message;
    }
    test::TemporaryFolder folder_;
};

TEST_F(MaterialTextures, AreReadWithSamplersAndTransforms) {
    const auto asset = read(textured());
    ASSERT_TRUE(asset.ok()) << asset.error().message;
    const MaterialInfo& m = asset->materials[0];
    ASSERT_NE(m.base_color_texture.image, nullptr);
    EXPECT_EQ(m.base_color_texture.image->texels, small_picture().texels);
    // One image, decoded once.
    EXPECT_EQ(m.emissive_texture.image, m.base_color_texture.image);
    EXPECT_EQ(m.base_color_texture.tex_coord, 1);
    EXPECT_EQ(m.base_color_texture.minification, 9728);
    EXPECT_EQ(m.base_color_texture.wrap_u, 33071);
    EXPECT_EQ(m.base_color_texture.wrap_v, 33648);
    EXPECT_EQ(m.metallic_roughness_texture.minification, 9987);
    EXPECT_EQ(m.metallic_roughness_texture.wrap_u, 10497);
    EXPECT_FLOAT_EQ(m.occlusion_strength, 0.5f);
    EXPECT_FLOAT_EQ(m.emissive[2], 0.25f);
    // Counter-clockwise as seen, v being down: (1, 0), doubled, turns to (0, -2).
    const auto& t = m.base_color_texture.transform;
    EXPECT_NEAR(t[0], 0.0f, 1e-6);
    EXPECT_NEAR(t[3], -2.0f, 1e-6);
    EXPECT_NEAR(t[1], 3.0f, 1e-6);
    EXPECT_NEAR(t[2], 0.25f, 1e-6);
    EXPECT_NEAR(t[5], 0.5f, 1e-6);
}

TEST_F(MaterialTextures, GlassIsReadWithinItsRanges) {
    Json document = textured();
    EXPECT_EQ(read(document)->materials[0].transmission, 0.0f);
    document["materials"][0]["extensions"] = Json::parse(R"({"KHR_materials_transmission": {"transmissionFactor": 0.75}, "KHR_materials_ior": {"ior": 1.33},
        "KHR_materials_volume": {"thicknessFactor": 0.02, "attenuationDistance": 0.5, "attenuationColor": [0.5, 1, 0.25]}})");
    auto asset = read(document);
    ASSERT_TRUE(asset.ok()) << asset.error().message;
    const MaterialInfo glass = asset->materials[0];
    EXPECT_FLOAT_EQ(glass.transmission, 0.75f);
    EXPECT_FLOAT_EQ(glass.ior, 1.33f);
    EXPECT_FLOAT_EQ(glass.thickness, 0.02f);
    EXPECT_FLOAT_EQ(glass.attenuation_distance, 0.5f);
    EXPECT_FLOAT_EQ(glass.attenuation_color[2], 0.25f);
    document["materials"][0]["extensions"] = Json::parse(R"({"KHR_materials_transmission": {"transmissionFactor": 7}, "KHR_materials_ior": {"ior": -2},
        "KHR_materials_volume": {"thicknessFactor": "thick", "attenuationDistance": -1}})");
    asset = read(document);
    ASSERT_TRUE(asset.ok()) << asset.error().message;
    EXPECT_EQ(asset->materials[0].transmission, 1.0f);
    EXPECT_EQ(asset->materials[0].ior, 1.0f);
    EXPECT_EQ(asset->materials[0].thickness, 0.0f);
    EXPECT_TRUE(std::isinf(asset->materials[0].attenuation_distance));
}

TEST_F(MaterialTextures, AreLeftAloneUnlessAskedFor) {
    Json document = textured();
    auto png = encode_png(small_picture());
    ASSERT_TRUE(png.ok());
    png->resize(png->size() / 2);
    ASSERT_TRUE(write_file(folder_.file("in/b.png"), *png).ok());
    document["images"][0]["uri"] = "b.png";
    const auto asset = read(document, false);
    ASSERT_TRUE(asset.ok()) << asset.error().message;
    EXPECT_EQ(asset->materials[0].base_color_texture.image, nullptr);
    expect_error(document, ErrorCode::invalid_input, "materials[0].baseColorTexture");
}

TEST_F(MaterialTextures, MissingAndBrokenPicturesAreNamed) {
    Json document = textured();
    document["images"][0]["uri"] = "none.png";
    expect_error(document, ErrorCode::io_failed, "none.png");
    for (const std::string uri : {"../outside.png", "%2e%2e/outside.png"}) {
        document["images"][0]["uri"] = uri;
        expect_error(document, ErrorCode::invalid_input, "leaves the model's folder");
    }
    auto png = encode_png(small_picture());
    ASSERT_TRUE(png.ok());
    png->resize(png->size() / 2);
    ASSERT_TRUE(write_file(folder_.file("in/half.png"), *png).ok());
    document["images"][0]["uri"] = "half.png";
    expect_error(document, ErrorCode::invalid_input, "materials[0].baseColorTexture: PNG");
    document = textured();
    document["textures"][1].erase("source");
    expect_error(document, ErrorCode::unsupported, "metallicRoughnessTexture: its texture has no source");
    document = textured();
    document["materials"][0]["emissiveTexture"]["texCoord"] = 2;
    expect_error(document, ErrorCode::unsupported, "emissiveTexture: texCoord is 2");
    document = textured();
    document["materials"][0]["occlusionTexture"]["index"] = 9;
    expect_error(document, ErrorCode::invalid_input, "occlusionTexture");
}

// What burin baked from a pattern is for viewers that do not draw it; an occlusion of any other name is the material's own.
TEST_F(MaterialTextures, BakedOcclusionIsLeftOut) {
    PackedTextures textures;
    textures.grid_width = textures.grid_height = textures.data_width = textures.data_height = 1;
    textures.grid = {0, 0xffffffffu};
    textures.data = {0, 0, 0, 0};
    textures.sections.material_texels = 1;
    PathDetail detail;
    detail.grid_width = detail.grid_height = detail.data_width = detail.data_height = 1;
    detail.sections = textures.sections;
    Fallback fallback;
    fallback.occlusion = small_picture();
    auto glb = write_glb(make_plane({1, 1}), textures, detail, fallback);
    ASSERT_TRUE(glb.ok()) << glb.error().message;
    const auto baked = read_asset(*glb, "", {.pictures = true});
    ASSERT_TRUE(baked.ok()) << baked.error().message;
    EXPECT_EQ(baked->materials[0].occlusion_texture.image, nullptr);
    const std::string_view name = "path detail, occlusion";
    int renamed = 0;
    for (auto at = glb->begin(); (at = std::search(at, glb->end(), name.begin(), name.end())) != glb->end(); ++renamed) at[0] = 'b';
    ASSERT_GE(renamed, 1);
    const auto own = read_asset(*glb, "", {.pictures = true});
    ASSERT_TRUE(own.ok()) << own.error().message;
    EXPECT_NE(own->materials[0].occlusion_texture.image, nullptr);
}

}  // namespace
}  // namespace burin
