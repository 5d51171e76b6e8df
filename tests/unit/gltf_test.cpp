#include <burin/bake.hpp>
#include <burin/format/validate.hpp>
#include <burin/image_io.hpp>
#include <burin/model.hpp>

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <map>
#include <set>
#include <string>

#include <nlohmann/json.hpp>
// An independent reader of what is written here.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include "temporary_folder.hpp"

namespace burin {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

// The smallest textures: one empty cell, one material.
PackedTextures small_textures() {
    PackedTextures t;
    t.grid_width = t.grid_height = t.data_width = t.data_height = 1;
    t.grid = {0, 0xffffffffu};
    t.data = {0, 0, 0, 0};
    t.sections.material_texels = 1;
    return t;
}

PathDetail small_detail() {
    PathDetail d;
    d.grid_width = d.grid_height = d.data_width = d.data_height = 1;
    d.sections.material_texels = 1;
    return d;
}

Fallback small_fallback() {
    Fallback f;
    f.normal = {2, 2, {}};
    f.occlusion = {2, 2, {}};
    for (int i = 0; i < 4; ++i) {
        f.normal.texels.insert(f.normal.texels.end(), {128, static_cast<std::uint8_t>(100 + i), 255, 255});
        f.occlusion.texels.insert(f.occlusion.texels.end(), {200, 200, 200, 255});
    }
    return f;
}

Json json_of(const Bytes& glb) {
    std::uint32_t size = 0;
    std::memcpy(&size, glb.data() + 12, 4);
    return Json::parse(glb.begin() + 20, glb.begin() + 20 + size);
}

// Where the binary chunk's content begins.
std::ptrdiff_t view_begin(const Bytes& glb) {
    std::uint32_t size = 0;
    std::memcpy(&size, glb.data() + 12, 4);
    return 28 + static_cast<std::ptrdiff_t>(size);
}

Bytes view_bytes(const Bytes& glb, const Json& document, std::size_t view) {
    const Json& v = document["bufferViews"][view];
    const auto begin = glb.begin() + view_begin(glb) + v.value("byteOffset", 0);
    return {begin, begin + v["byteLength"].get<int>()};
}

// The same file with another document.
Bytes with_json(const Bytes& glb, const Json& document) {
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::ptrdiff_t old_size = view_begin(glb) - 28;
    const auto chunk = static_cast<std::uint32_t>(text.size());
    Bytes out(20 + text.size());
    std::memcpy(out.data(), glb.data(), 20);
    std::memcpy(out.data() + 12, &chunk, 4);
    std::memcpy(out.data() + 20, text.data(), text.size());
    out.insert(out.end(), glb.begin() + 20 + old_size, glb.end());
    const auto total = static_cast<std::uint32_t>(out.size());
    std::memcpy(out.data() + 8, &total, 4);
    return out;
}

Bytes attach(const Model& model, const AttachOptions& options = {},
             const PathDetail& detail = small_detail()) {
    auto glb = write_glb(model, small_textures(), detail, small_fallback(), options);
    EXPECT_TRUE(glb.ok()) << (glb.ok() ? "" : glb.error().message);
    return glb.ok() ? *glb : Bytes{};
}

bool decode_nothing(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*,
                    int, void*) {
    return true;
}

TEST(Gltf, AnIndependentReaderSeesTheWholePlane) {
    const Bytes glb = attach(make_plane({1, 2}));
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(decode_nothing, nullptr);
    tinygltf::Model model;
    std::string error, warning;
    ASSERT_TRUE(
        loader.LoadBinaryFromMemory(&model, &error, &warning, glb.data(), static_cast<unsigned>(glb.size())))
        << error;
    EXPECT_EQ(error, "");
    ASSERT_EQ(model.materials.size(), 1u);
    EXPECT_EQ(model.extensionsUsed, std::vector<std::string>{std::string(kPathDetailExtension)});
    EXPECT_TRUE(model.extensionsRequired.empty());
    EXPECT_EQ(model.materials[0].extensions.count(std::string(kPathDetailExtension)), 1u);
    const int normal = model.materials[0].normalTexture.index;
    ASSERT_GE(normal, 0);
    EXPECT_EQ(
        model.samplers[static_cast<std::size_t>(model.textures[static_cast<std::size_t>(normal)].sampler)]
            .wrapS,
        10497);
    EXPECT_GE(model.materials[0].occlusionTexture.index, 0);
    for (const char* name : {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_0"})
        EXPECT_EQ(model.meshes[0].primitives[0].attributes.count(name), 1u) << name;
}

TEST(Gltf, TexturesComeBackWordForWord) {
    PackedTextures textures = small_textures();
    textures.grid_width = 3;
    textures.grid = {0, 0xffffffffu, 0, 0xffffffffu, 0, 0xffffffffu};
    PathDetail detail = small_detail();
    detail.grid_width = 3;
    detail.size_u = 0.3;
    detail.repeat = false;
    const auto glb = write_glb(make_plane({1, 1}), textures, detail, small_fallback());
    ASSERT_TRUE(glb.ok()) << glb.error().message;
    const auto asset = read_asset(*glb);
    ASSERT_TRUE(asset.ok()) << asset.error().message;
    const MaterialInfo& info = asset->materials[0];
    ASSERT_TRUE(info.has_detail);
    EXPECT_EQ(info.textures.grid, textures.grid);
    EXPECT_EQ(info.textures.data, textures.data);
    EXPECT_EQ(info.textures.sections.material_texels, 1u);
    EXPECT_EQ(info.detail.size_u, 0.3);
    EXPECT_FALSE(info.detail.repeat);
    const Json document = json_of(*glb);
    EXPECT_EQ(document["samplers"][0]["wrapS"], 33071);
    for (const Json& view : document["bufferViews"]) EXPECT_EQ(view.value("byteOffset", 0) % 4, 0);
    EXPECT_EQ(glb->size() % 4, 0u);
}

TEST(Gltf, OwnValidatorFindsNothing) {
    const Bytes glb = attach(make_plane({1, 1}));
    validate_glb(glb, [](const Issue& issue) {
        EXPECT_NE(issue.severity, Severity::error)
            << issue.number << " " << issue.message << " " << issue.pointer;
    });
}

TEST(Gltf, EqualInputGivesEqualBytes) { EXPECT_EQ(attach(make_plane({1, 1})), attach(make_plane({1, 1}))); }

// A document with a bit of everything that burin does not know, in three buffers.
Json rich_document() {
    return Json::parse(
        R"({"asset":{"version":"2.0","generator":"a tool","copyright":"someone","extras":{"k":1}},
        "extensionsUsed":["KHR_lights_punctual","VENDOR_thing"],
        "extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}},
        "scene":0,"scenes":[{"name":"s","nodes":[0,1]}],
        "nodes":[{"mesh":0,"name":"body","extras":[1,2]},{"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}}],
        "cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.01}}],
        "animations":[{"name":"spin","channels":[{"sampler":0,"target":{"node":0,"path":"scale"}}],"samplers":[{"input":2,"output":3}]}],
        "meshes":[{"name":"m","primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,"_CUSTOM":1},"material":0}]}],
        "materials":[{"name":"skin","extras":"note","normalTexture":{"index":0,"scale":0.5},
                      "extensions":{"VENDOR_thing":{"a":[1.5,true,null]}}}],
        "textures":[{"source":0}],
        "images":[{"uri":"data:image/png;base64,iVBORw0KGgo="}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
                     {"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},
                     {"bufferView":2,"componentType":5126,"count":1,"type":"SCALAR","min":[0],"max":[0]},
                     {"bufferView":3,"componentType":5126,"count":1,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":1,"byteLength":24},{"buffer":2,"byteLength":4},
                       {"buffer":2,"byteOffset":4,"byteLength":12,"name":"scales"}],
        "buffers":[{"byteLength":36,"name":"first","uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"},
                   {"byteLength":24,"name":"second","uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"},
                   {"byteLength":16,"uri":"data:application/octet-stream;base64,AAAAAAAAgD8AAIA/AACAPw=="}]})");
}

TEST(Gltf, NothingOfTheModelIsLost) {
    const Json before = rich_document();
    const std::string text = before.dump();
    const auto model = read_model_bytes(Bytes(text.begin(), text.end()), "");
    ASSERT_TRUE(model.ok()) << model.error().message;
    const Bytes glb = attach(*model);
    const Json after = json_of(glb);
    for (const char* key :
         {"asset", "extensions", "scene", "scenes", "nodes", "cameras", "animations", "meshes", "accessors"})
        EXPECT_EQ(after[key], before[key]) << key;
    EXPECT_EQ(after["extensionsUsed"], (Json{"KHR_lights_punctual", "VENDOR_thing", kPathDetailExtension}));
    EXPECT_EQ(after["materials"][0]["extensions"]["VENDOR_thing"],
              before["materials"][0]["extensions"]["VENDOR_thing"]);
    // The normal texture gave way, and is told.
    EXPECT_EQ(after["materials"][0]["extras"]["burin_replaced_normal_texture"],
              before["materials"][0]["normalTexture"]);
    EXPECT_EQ(after["materials"][0]["extras"]["value"], "note");
    EXPECT_NE(after["materials"][0]["normalTexture"]["index"], 0);
    EXPECT_EQ(after["textures"][0], before["textures"][0]);
    EXPECT_EQ(view_bytes(glb, after, after["images"][0]["bufferView"]).size(), 8u);
    ASSERT_EQ(after["buffers"].size(), 1u);
    EXPECT_EQ(after["buffers"][0]["name"], "first");
    EXPECT_EQ(after["buffers"][0]["extras"]["burin_merged_buffers"][0]["name"], "second");
    const Bytes scales = view_bytes(glb, after, 3);
    EXPECT_EQ(scales, (Bytes{0, 0, 128, 63, 0, 0, 128, 63, 0, 0, 128, 63}));
    EXPECT_EQ(after["bufferViews"][3]["name"], "scales");
    const auto target = find_material(*model);
    ASSERT_TRUE(target.ok());
    EXPECT_TRUE(target->replaces_normal_texture);
}

TEST(Gltf, AttachingAgainReplacesThePattern) {
    const Bytes once = attach(make_plane({1, 1}));
    const auto model = read_model_bytes(once, "");
    ASSERT_TRUE(model.ok()) << model.error().message;
    PathDetail other = small_detail();
    other.depth = 0.25;
    const Bytes twice = attach(*model, {}, other);
    const auto asset = read_asset(twice);
    ASSERT_TRUE(asset.ok());
    EXPECT_EQ(asset->materials[0].detail.depth, 0.25);
    const Json document = json_of(twice);
    EXPECT_EQ(document["extensionsUsed"].size(), 1u);
    // The first fallback was no normal texture of the model's own.
    EXPECT_FALSE(document["materials"][0].contains("extras"));
}

// Every view, image, texture and sampler has a use, and views lie in the binary chunk without overlap.
void expect_no_leftovers(const Bytes& glb) {
    const Json document = json_of(glb);
    std::map<std::string, std::set<std::size_t>> used;
    const std::function<void(const Json&)> look = [&](const Json& json) {
        if (json.is_object())
            for (const auto& [key, array] : std::map<std::string, std::string>{{"index", "textures"},
                                                                               {"source", "images"},
                                                                               {"sampler", "samplers"},
                                                                               {"bufferView", "bufferViews"}})
                if (json.contains(key) && json[key].is_number())
                    used[array].insert(json[key].get<std::size_t>());
        if (json.is_structured())
            for (const Json& item : json) look(item);
    };
    look(document);
    std::size_t bytes = 0;
    for (const char* array : {"textures", "images", "samplers", "bufferViews"}) {
        EXPECT_EQ(used[array].size(), document.value(array, Json::array()).size()) << array;
        if (!used[array].empty()) {
            EXPECT_LT(*used[array].rbegin(), document[array].size()) << array;
        }
    }
    for (const Json& view : document["bufferViews"])
        bytes += (view["byteLength"].get<std::size_t>() + 15) / 16 * 16;
    EXPECT_LE(document["buffers"][0]["byteLength"].get<std::size_t>(), bytes);
    validate_glb(glb, [](const Issue& issue) {
        EXPECT_NE(issue.severity, Severity::error)
            << issue.number << " " << issue.message << " " << issue.pointer;
    });
}

Model model_of(const Bytes& bytes) {
    auto model = read_model_bytes(bytes, "");
    EXPECT_TRUE(model.ok()) << (model.ok() ? "" : model.error().message);
    return *model;
}

TEST(Gltf, AttachingTwiceGivesTheBytesOfAttachingOnce) {
    const std::string text = rich_document().dump();
    for (const Model& model : {make_plane({1, 1}), model_of(Bytes(text.begin(), text.end()))}) {
        const Bytes once = attach(model);
        PathDetail other = small_detail();
        other.depth = 0.25;
        other.repeat = false;
        const Bytes between = attach(model_of(once), {}, other);
        expect_no_leftovers(between);
        EXPECT_EQ(json_of(between)["bufferViews"].size(), json_of(once)["bufferViews"].size());
        EXPECT_EQ(attach(model_of(between)), once);
    }
}

// An eighth of a cylinder around y, two metres in diameter, below a node that doubles it.
Model round_model() {
    std::string obj;
    for (int i = 0; i <= 8; ++i)
        for (const int y : {0, 1}) {
            const double a = 0.1 * i;
            obj += "v " + std::to_string(std::sin(a)) + " " + std::to_string(y) + " " + std::to_string(std::cos(a)) + "\n";
            obj += "vt " + std::to_string(0.1 * i) + " " + std::to_string(y) + "\n";
            obj += "vn " + std::to_string(std::sin(a)) + " 0 " + std::to_string(std::cos(a)) + "\n";
        }
    const auto corner = [](int i) { return " " + std::to_string(i) + "/" + std::to_string(i) + "/" + std::to_string(i); };
    for (int i = 1; i < 16; i += 2) obj += "f" + corner(i) + corner(i + 2) + corner(i + 3) + corner(i + 1) + "\n";
    return model_of(Bytes(obj.begin(), obj.end()));
}

TEST(Gltf, RoundPrimitivesBringTheirDerivatives) {
    const Bytes glb = attach(round_model());
    Json document = json_of(glb);
    EXPECT_FALSE(json_of(attach(make_plane({1, 1})))["meshes"][0]["primitives"][0]["attributes"].contains("_BURIN_DU"));
    document["nodes"][0]["scale"] = {2.0, 2.0, 2.0};
    const auto asset = read_asset(with_json(glb, document));
    ASSERT_TRUE(asset.ok());
    const Primitive& primitive = asset->primitives[0];
    ASSERT_EQ(primitive.frames.size(), primitive.positions.size() / 3);
    for (std::size_t i = 0; i < primitive.frames.size(); ++i) {
        const SurfaceFrame& f = primitive.frames[i];
        const float* n = &primitive.normals[3 * i];
        const double curvature = double(f.duu[0] * n[0] + f.duu[1] * n[1] + f.duu[2] * n[2]);
        EXPECT_NEAR(std::hypot(f.du[0], f.du[1], f.du[2]), 2.0, 0.02);
        EXPECT_NEAR(curvature, -2.0, 0.02);
        EXPECT_NEAR(std::abs(f.dv[1]), 2.0, 1e-3);
    }
    expect_no_leftovers(glb);
    // Attached again, with another pattern between.
    PathDetail other = small_detail();
    other.depth = 0.25;
    EXPECT_EQ(attach(model_of(attach(model_of(glb), {}, other))), glb);
}

// Two quads that meet in a right angle, their uvs apart.
Model folded_model() {
    const std::string obj =
        "v -1 0 0\nv 0 0 0\nv -1 0 1\nv 0 0 1\nv 0 -1 0\nv 0 -1 1\n"
        "vt 0 1\nvt 0.3 1\nvt 0 0.7\nvt 0.3 0.7\nvt 0.5 0.5\nvt 0.5 0.2\nvt 0.8 0.2\nvt 0.8 0.5\nvn 0 1 0\nvn 1 0 0\n"
        "f 1/1/1 3/3/1 4/4/1 2/2/1\nf 2/5/2 4/6/2 6/7/2 5/8/2\n";
    return model_of(Bytes(obj.begin(), obj.end()));
}

TEST(Gltf, CutTextureCoordinatesBringBorders) {
    const Bytes glb = attach(folded_model());
    const auto asset = read_asset(glb);
    ASSERT_TRUE(asset.ok());
    const MaterialInfo& material = asset->materials[0];
    EXPECT_EQ(material.detail.charts.borders, 2);
    EXPECT_EQ(material.charts.size(), 4u * std::size_t(material.detail.charts.width) * std::size_t(material.detail.charts.height));
    EXPECT_EQ(std::set<float>(asset->primitives[0].charts.begin(), asset->primitives[0].charts.end()), (std::set<float>{0.0f, 1.0f}));
    EXPECT_FALSE(asset->primitives[0].mirrored);
    expect_no_leftovers(glb);
    PathDetail other = small_detail();
    other.depth = 0.25;
    EXPECT_EQ(attach(model_of(attach(model_of(glb), {}, other))), glb);
    // A mirrored node winds the triangles anew; a model without cuts has no table.
    Json document = json_of(glb);
    document["nodes"][0]["scale"] = {-1.0, 1.0, 1.0};
    const auto mirrored = read_asset(with_json(glb, document));
    ASSERT_TRUE(mirrored.ok());
    EXPECT_TRUE(mirrored->primitives[0].mirrored);
    const auto plane = read_asset(attach(make_plane({1, 1})));
    EXPECT_EQ(plane->materials[0].detail.charts.borders, 0);
    EXPECT_TRUE(plane->primitives[0].charts.empty());
}

TEST(Gltf, AttachingWithoutFallbackTakesTheOldOneAway) {
    const std::string text = rich_document().dump();
    const Model model = model_of(Bytes(text.begin(), text.end()));
    const auto bare = write_glb(model, small_textures(), small_detail(), Fallback{});
    const auto replaced = write_glb(model_of(attach(model)), small_textures(), small_detail(), Fallback{});
    ASSERT_TRUE(bare.ok() && replaced.ok());
    const Json document = json_of(*replaced);
    EXPECT_EQ(document["materials"][0]["normalTexture"], rich_document()["materials"][0]["normalTexture"]);
    EXPECT_FALSE(document["materials"][0].contains("occlusionTexture"));
    for (const char* array : {"textures", "images", "bufferViews", "buffers"})
        EXPECT_EQ(document[array], json_of(*bare)[array]) << array;
    EXPECT_FALSE(document.contains("samplers"));
}

Residual small_residual() {
    Residual residual;
    residual.picture = {2, 1, {100, 140, 255, 255, 30, 220, 255, 255}};
    residual.scale = 0.375;
    auto png = encode_png(residual.picture);
    EXPECT_TRUE(png.ok());
    residual.png = *png;
    return residual;
}

Bytes attach_residual(const Model& model, const Fallback& fallback, bool repeat = true, const AttachOptions& options = {}) {
    PathDetail detail = small_detail();
    detail.repeat = repeat;
    auto glb = write_glb(model, small_textures(), detail, fallback, options, small_residual());
    EXPECT_TRUE(glb.ok()) << (glb.ok() ? "" : glb.error().message);
    return glb.ok() ? *glb : Bytes{};
}

const Json& residual_of(const Json& document) {
    return document["materials"][0]["extensions"][std::string(kPathDetailExtension)]["residualTexture"];
}

TEST(Gltf, ResidualComesBackTexelForTexel) {
    for (const bool repeat : {true, false}) {
        const Bytes glb = attach_residual(make_plane({1, 1}), small_fallback(), repeat);
        const auto asset = read_asset(glb);
        ASSERT_TRUE(asset.ok()) << asset.error().message;
        EXPECT_EQ(asset->materials[0].residual.texels, small_residual().picture.texels);
        EXPECT_EQ(asset->materials[0].residual.width, 2);
        EXPECT_EQ(asset->materials[0].detail.residual_scale, 0.375);
        validate_glb(glb, [](const Issue& issue) { ADD_FAILURE() << issue.number << " " << issue.message; });
        const Json document = json_of(glb);
        // A texture of its own, beside the fallback's.
        EXPECT_NE(residual_of(document)["index"], document["materials"][0]["normalTexture"]["index"]);
        EXPECT_EQ(document["textures"].size(), 3u);
        EXPECT_EQ(document["samplers"].size(), 1u);
    }
    const auto bare = read_asset(attach(make_plane({1, 1})));
    ASSERT_TRUE(bare.ok());
    EXPECT_EQ(bare->materials[0].residual.width, 0);
    EXPECT_EQ(bare->materials[0].detail.residual_texture, -1);
}

TEST(Gltf, ResidualStandsInForAFallbackWithoutNormals) {
    Fallback fallback = small_fallback();
    fallback.normal = {};
    const Json document = json_of(attach_residual(make_plane({1, 1}), fallback, true));
    const Json& normal = document["materials"][0]["normalTexture"];
    EXPECT_EQ(normal["index"], residual_of(document)["index"]);
    EXPECT_EQ(normal["scale"], residual_of(document)["scale"]);
    EXPECT_EQ(document["images"].size(), 2u);  // with the occlusion
}

TEST(Gltf, ResidualIsReplacedAndTakenAway) {
    Fallback shared = small_fallback();
    shared.normal = {};
    const std::string text = rich_document().dump();
    const Model model = model_of(Bytes(text.begin(), text.end()));
    for (const Fallback& fallback : {small_fallback(), shared, Fallback{}}) {
        const Bytes once = attach_residual(model, fallback);
        EXPECT_EQ(attach_residual(model_of(once), fallback), once);
        expect_no_leftovers(once);
        // Without a residual nothing of it is left.
        EXPECT_EQ(attach(model_of(once)), attach(model));
    }
    EXPECT_EQ(attach_residual(model_of(attach_residual(model, shared)), small_fallback()), attach_residual(model, small_fallback()));
}

TEST(Gltf, BrokenResidualsAreRefusedOnReading) {
    const Bytes glb = attach_residual(make_plane({1, 1}), small_fallback());
    const auto reads = [&](const std::function<void(Json&, Json&)>& change) {
        Json document = json_of(glb);
        change(document, document["materials"][0]["extensions"][std::string(kPathDetailExtension)]["residualTexture"]);
        return read_asset(with_json(glb, document)).ok();
    };
    EXPECT_TRUE(reads([](Json&, Json&) {}));
    EXPECT_FALSE(reads([](Json&, Json& r) { r["index"] = 9; }));
    EXPECT_FALSE(reads([](Json&, Json& r) { r["scale"] = -1.0; }));
    EXPECT_FALSE(reads([](Json& d, Json& r) { d["textures"][r["index"].get<std::size_t>()].erase("source"); }));
    // Words of the grid are no picture.
    EXPECT_FALSE(reads([](Json& d, Json& r) {
        d["images"][d["textures"][r["index"].get<std::size_t>()]["source"].get<std::size_t>()]["bufferView"] = 0;
    }));
}

// Two materials with patterns: replacing the first moves nothing of the second, nor of what refers to its
// textures.
TEST(Gltf, ReplacingThePatternOfOneMaterialKeepsTheOthers) {
    Json two = rich_document();
    two["meshes"][0]["primitives"].push_back(two["meshes"][0]["primitives"][0]);
    two["meshes"][0]["primitives"][1]["material"] = 1;
    two["materials"].push_back({{"name", "cloth"}});
    const std::string text = two.dump();
    const Bytes first = attach(model_of(Bytes(text.begin(), text.end())), {.material = "skin"});
    const Bytes both = attach(model_of(first), {.material = "cloth"});
    Json shared = json_of(both);
    PackedTextures larger = small_textures();
    larger.grid_width = 9;
    for (int cell = 1; cell < 9; ++cell) larger.grid.insert(larger.grid.end(), {0, 0xffffffffu});
    PathDetail detail = small_detail();
    detail.grid_width = 9;
    const auto again = write_glb(model_of(both), larger, detail, small_fallback(), {.material = "skin"});
    ASSERT_TRUE(again.ok());
    expect_no_leftovers(*again);
    const Json after = json_of(*again);
    EXPECT_EQ(after["materials"][1], shared["materials"][1]);
    for (std::size_t i = 0; i < shared["bufferViews"].size(); ++i) {
        const bool replaced =
            i ==
            shared["materials"][0]["extensions"][std::string(kPathDetailExtension)]["grid"]["bufferView"];
        if (!replaced) {
            EXPECT_EQ(view_bytes(*again, after, i), view_bytes(both, shared, i)) << i;
        }
    }
    const auto asset = read_asset(*again);
    ASSERT_TRUE(asset.ok()) << asset.error().message;
    EXPECT_EQ(asset->materials[0].textures.grid, larger.grid);
    EXPECT_EQ(asset->materials[1].textures.grid, small_textures().grid);
}

// What something else refers to stays, wherever burin put it.
TEST(Gltf, ReplacingKeepsWhatOthersShare) {
    const Bytes once = attach(make_plane({1, 1}));
    Json document = json_of(once);
    const Json normal = document["materials"][0]["normalTexture"];
    document["materials"].push_back({{"name", "second"}, {"emissiveTexture", normal}});
    const Bytes glb = with_json(once, document);
    const Bytes again = attach(model_of(glb), {.material = "plane"});
    const Json after = json_of(again);
    const auto index = normal["index"].get<std::size_t>();
    EXPECT_EQ(after["materials"][1]["emissiveTexture"], normal);
    EXPECT_NE(after["materials"][0]["normalTexture"]["index"], index);
    const auto view = [](const Json& d, std::size_t texture) {
        return d["images"][d["textures"][texture]["source"].get<std::size_t>()]["bufferView"]
            .get<std::size_t>();
    };
    EXPECT_EQ(view_bytes(again, after, view(after, index)),
              view_bytes(once, document, view(document, index)));
}

TEST(Gltf, OtherMaterialsAndUvSetsStayAsTheyAre) {
    Json document = rich_document();
    document["meshes"][0]["primitives"].push_back(document["meshes"][0]["primitives"][0]);
    document["meshes"][0]["primitives"][1].erase("material");
    document["meshes"][0]["primitives"][1]["attributes"]["TEXCOORD_1"] = 1;
    const std::string text = document.dump();
    const auto model = read_model_bytes(Bytes(text.begin(), text.end()), "");
    ASSERT_TRUE(model.ok()) << model.error().message;
    EXPECT_FALSE(find_material(*model).ok());
    const Json after = json_of(attach(*model, {.material = "default", .tex_coord = 1}));
    EXPECT_EQ(after["materials"][0], document["materials"][0]);
    ASSERT_EQ(after["materials"].size(), 2u);
    EXPECT_EQ(after["meshes"][0]["primitives"][1]["material"], 1);
    EXPECT_EQ(after["materials"][1]["normalTexture"]["texCoord"], 1);
    EXPECT_EQ(after["materials"][1]["extensions"][std::string(kPathDetailExtension)]["texCoord"], 1);
}

TEST(Gltf, AConstantMapNeedsNoFallback) {
    const auto glb = write_glb(make_plane({1, 1}), small_textures(), small_detail(), Fallback{});
    ASSERT_TRUE(glb.ok());
    const Json document = json_of(*glb);
    EXPECT_FALSE(document.contains("images"));
    EXPECT_FALSE(document["materials"][0].contains("normalTexture"));
}

TEST(Gltf, DamagedPatternsAreErrorsNotCrashes) {
    const Bytes glb = attach(make_plane({1, 1}));
    const struct {
        const char *from, *to;
    } changes[] = {{"\"bufferView\":5", "\"bufferView\":9"},
                   {"\"version\":1", "\"version\":9"},
                   {"\"wrap\":\"repeat\"", "\"wrap\":\"repeal\""},
                   {"\"depth\":0.01", "\"depth\":-1.1"}};
    for (const auto& change : changes) {
        std::string text(glb.begin(), glb.end());
        const auto at = text.find(change.from);
        if (at == std::string::npos) continue;  // another way to write the same number
        text.replace(at, std::strlen(change.from), change.to);
        const auto asset = read_asset(Bytes(text.begin(), text.end()));
        EXPECT_FALSE(asset.ok()) << change.to;
    }
}

}  // namespace
}  // namespace burin
