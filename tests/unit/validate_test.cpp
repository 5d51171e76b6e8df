// For every number of the validator a file that breaks only it.
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <burin/format/validate.hpp>

#include "sample_file.hpp"

namespace burin {
namespace {

using nlohmann::json;
using test::SampleFile;
using Bytes = std::vector<std::uint8_t>;

std::set<int> numbers_of(const Bytes& bytes) {
    std::set<int> numbers;
    validate_glb(bytes, [&numbers](const Issue& issue) { numbers.insert(issue.number); });
    return numbers;
}

std::string text_of(const Bytes& bytes) {
    std::string text;
    validate_glb(bytes, [&text](const Issue& issue) {
        text += std::to_string(issue.number) + " " + issue.pointer + ": " + issue.message + "\n";
    });
    return text;
}

void put_word(Bytes& bytes, std::size_t at, std::uint32_t word) {
    for (std::size_t k = 0; k < 4; ++k) bytes[at + k] = static_cast<std::uint8_t>(word >> (8 * k));
}

std::uint32_t get_word(const Bytes& bytes, std::size_t at) {
    return words_from_bytes(std::span(bytes).subspan(at, 4))[0];
}

// A case breaks the file at one of three moments: as bytes, as document, as textures.
Bytes broken_bytes(const std::function<void(Bytes&)>& change) {
    const SampleFile file = test::make_sample_file();
    Bytes bytes = test::make_glb(test::make_document(file), test::make_bin(file));
    change(bytes);
    return bytes;
}

Bytes broken_document(const std::function<void(json&)>& change) {
    const SampleFile file = test::make_sample_file();
    json document = test::make_document(file);
    change(document);
    return test::make_glb(document, test::make_bin(file));
}

Bytes broken_extension(const std::function<void(json&)>& change) {
    return broken_document([&change](json& document) {
        change(document["materials"][0]["extensions"][std::string(kPathDetailExtension)]);
    });
}

Bytes broken_textures(const std::function<void(PackedTextures&)>& change) {
    SampleFile file = test::make_sample_file();
    change(file.textures);
    return test::make_glb(test::make_document(file), test::make_bin(file));
}

Bytes broken_cell(int i, int j, const std::function<void(CellCode&)>& change) {
    return broken_textures([&](PackedTextures& t) {
        CellCode cell = test::get_cell(t, i, j);
        change(cell);
        test::set_cell(t, i, j, cell);
    });
}

Bytes broken_element(std::uint32_t texel, const std::function<void(ElementCode&)>& change) {
    return broken_textures([&](PackedTextures& t) {
        ElementCode element = test::get_element(t, texel);
        change(element);
        test::set_element(t, texel, element);
    });
}

Bytes broken_style(std::uint32_t index, const std::function<void(StyleCode&)>& change) {
    return broken_textures([&](PackedTextures& t) {
        StyleCode style = test::get_style(t, index);
        change(style);
        test::set_style(t, index, style);
    });
}

Bytes broken_profile(std::uint32_t word, std::int32_t b, std::int32_t h) {
    return broken_textures([=](PackedTextures& t) {
        test::set_profile_word(t, word, pack_profile_point({b, h}));
    });
}

Bytes broken_data(std::uint32_t texel, std::size_t word, std::uint32_t value) {
    return broken_textures([=](PackedTextures& t) { t.data[4 * std::size_t{texel} + word] = value; });
}

constexpr std::uint32_t kScaledLine = 9, kLastLine = 11, kStepWithB = 3, kPaintedStyle = 2, kMaterials = 18,
                        kFunctions = 22, kPolynomial = 24, kLastFunction = 27, kTail = 28;

void add_container_cases(std::map<int, Bytes>& cases) {
    cases[1001] = {'g', 'l', 'T', 'F', 2, 0, 0, 0};
    cases[1002] = broken_bytes([](Bytes& b) { b[4] = 1; });
    cases[1003] = broken_bytes([](Bytes& b) { b.resize(b.size() + 4); });
    cases[1004] = broken_bytes([](Bytes& b) { put_word(b, 12, 0x7FFFFFFF); });
    cases[1005] = broken_bytes([](Bytes& b) {
        const std::size_t chunk = 20 + get_word(b, 12);
        b.resize(b.size() + 2);
        put_word(b, 8, static_cast<std::uint32_t>(b.size()));
        put_word(b, chunk, get_word(b, chunk) + 2);
    });
    cases[1006] = broken_bytes([](Bytes& b) { put_word(b, 16, 0x004E4942); });
    cases[1007] = broken_bytes([](Bytes& b) { b[20] = 'x'; });
    cases[1008] = broken_document([](json& d) { d["asset"]["version"] = "1.0"; });
    cases[1009] = broken_document([](json& d) { d["buffers"][0]["uri"] = "missing.bin"; });
    cases[1010] = broken_document([](json& d) { d["meshes"] = 5; });
    cases[1011] = broken_document([](json& d) { d["buffers"][0]["byteLength"] = 100000; });
}

void add_extension_cases(std::map<int, Bytes>& cases) {
    const std::string name(kPathDetailExtension);
    cases[2001] = broken_document([](json& d) { d.erase("extensionsUsed"); });
    cases[2002] = broken_document([&](json& d) { d["extensionsRequired"] = json::array({name}); });
    cases[2003] = broken_extension([](json& e) { e = 5; });
    cases[2004] = broken_extension([](json& e) { e.erase("depth"); });
    cases[2005] = broken_extension([](json& e) { e["depth"] = "deep"; });
    cases[2006] = broken_extension([](json& e) { e["version"] = 2; });
    cases[2007] = broken_extension([](json& e) { e["size"][0] = 0.0; });
    cases[2008] = broken_extension([](json& e) { e["depth"] = 0.0; });
    cases[2009] = broken_extension([](json& e) { e["baseOffset"] = -1.0; });
    cases[2010] = broken_extension([](json& e) { e["outerLevel"] = 1.0; });
    cases[2011] = broken_extension([](json& e) { e["wrap"] = "mirror"; });
    cases[2012] = broken_extension([](json& e) { e["texCoord"] = -1; });
    cases[2013] = broken_extension([](json& e) { e["grid"]["width"] = 4097; });
    cases[2014] = broken_extension([](json& e) { e["data"]["lists"] = 1000; });
    cases[2015] = broken_extension([](json& e) { e["data"]["elements"] = BURIN_MAX_ELEMENT_TEXELS + 1; });
    cases[2016] = broken_extension([](json& e) { e["grid"]["bufferView"] = 9; });
}

void add_view_cases(std::map<int, Bytes>& cases) {
    const std::string name(kPathDetailExtension);
    cases[2017] = broken_document([](json& d) { d["bufferViews"][0]["byteLength"] = 64; });
    const SampleFile file = test::make_sample_file();
    cases[2018] = test::make_glb(test::make_document(file, 2), test::make_bin(file, 2));
    cases[2019] = broken_document([](json& d) { d["bufferViews"][0]["target"] = 34962; });
    cases[2020] = broken_document([](json& d) { d["bufferViews"][1]["byteOffset"] = 100000; });
    cases[2021] = broken_document([](json& d) { d["materials"][0].erase("extensions"); });
    cases[2022] =
        broken_document([](json& d) { d["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0"); });
}

// A document with a residual that is right, changed by `change`.
Bytes broken_residual(const std::function<void(json& document, json& residual)>& change) {
    return broken_document([&](json& d) {
        d["images"] = json::array({{{"uri", "residual.png"}}});
        d["samplers"] = json::array({{{"wrapS", 10497}}});
        d["textures"] = json::array({{{"source", 0}, {"sampler", 0}}});
        json& residual = d["materials"][0]["extensions"][std::string(kPathDetailExtension)]["residualTexture"];
        residual = {{"index", 0}, {"scale", 0.5}, {"texCoord", 0}};
        change(d, residual);
    });
}

void add_residual_cases(std::map<int, Bytes>& cases) {
    cases[2023] = broken_residual([](json&, json& r) { r["index"] = 1; });
    cases[2024] = broken_residual([](json& d, json&) { d["textures"][0]["source"] = 1; });
    cases[2025] = broken_residual([](json&, json& r) { r["scale"] = 0.0; });
    cases[2026] = broken_residual([](json&, json& r) { r["texCoord"] = 1; });
    cases[2027] = broken_residual([](json& d, json&) { d["samplers"][0]["wrapS"] = 33071; });
}

// A document whose first primitive has the derivatives of its positions, changed by `change`.
Bytes broken_frames(const std::function<void(json& document, json& attributes)>& change) {
    return broken_document([&](json& d) {
        json& attributes = d["meshes"][0]["primitives"][0]["attributes"];
        d["accessors"] = json::array();
        for (const char* name : {"POSITION", "_BURIN_DU", "_BURIN_DV", "_BURIN_DUU", "_BURIN_DUV", "_BURIN_DVV"}) {
            attributes[name] = d["accessors"].size();
            d["accessors"].push_back({{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}});
        }
        change(d, attributes);
    });
}

void add_frame_cases(std::map<int, Bytes>& cases) {
    cases[2040] = broken_frames([](json&, json& attributes) { attributes.erase("_BURIN_DUV"); });
    cases[2041] = broken_frames([](json& d, json&) { d["accessors"].back()["type"] = "VEC4"; });
}

std::string base64(const Bytes& bytes) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {  // the sizes here are multiples of three
        const std::uint32_t three = std::uint32_t{bytes[i]} << 16 | std::uint32_t{bytes[i + 1]} << 8 | bytes[i + 2];
        for (int shift = 18; shift >= 0; shift -= 6) text += digits[three >> shift & 63];
    }
    return text;
}

// A document with one border in one cell, changed by `change`.
Bytes broken_charts(const std::function<void(json& document, json& charts, std::vector<std::uint32_t>& words)>& change) {
    return broken_document([&](json& d) {
        std::vector<std::uint32_t> words(6 * 4, 0);
        words[12] = 0x3f800000u;  // its scale
        words[17] = 1;            // one reference, to border 0
        json& charts = d["materials"][0]["extensions"][std::string(kPathDetailExtension)]["charts"];
        charts = {{"bufferView", d["bufferViews"].size()}, {"width", 6}, {"height", 1}, {"borders", 1}, {"columns", 1}, {"rows", 1},
                  {"origin", {0.0, 0.0}}, {"cell", {1.0, 1.0}}};
        d["accessors"] = json::array({{{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}}, {{"componentType", 5126}, {"type", "SCALAR"}, {"count", 3}}});
        json& attributes = d["meshes"][0]["primitives"][0]["attributes"];
        attributes["POSITION"] = 0, attributes["_BURIN_CHART"] = 1;
        change(d, charts, words);
        d["buffers"].push_back({{"byteLength", 96}, {"uri", "data:application/octet-stream;base64," + base64(bytes_from_words(words))}});
        d["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 0}, {"byteLength", 96}});
    });
}

void add_chart_cases(std::map<int, Bytes>& cases) {
    using Words = std::vector<std::uint32_t>;
    cases[2042] = broken_charts([](json& d, json&, Words&) { d["meshes"][0]["primitives"][0]["attributes"].erase("_BURIN_CHART"); });
    cases[2043] = broken_charts([](json&, json& charts, Words&) { charts["cell"][1] = 0.0; });
    cases[2044] = broken_charts([](json&, json& charts, Words&) { charts["borders"] = 2; });
    cases[2045] = broken_charts([](json&, json&, Words& words) { words[20] = 1; });
    cases[2046] = broken_charts([](json&, json&, Words& words) { words[13] = 0x7fc00000u; });
}

void add_grid_cases(std::map<int, Bytes>& cases) {
    cases[3001] = broken_cell(0, 1, [](CellCode& c) { c.first_reference = 500; });
    cases[3002] = broken_cell(4, 3, [](CellCode& c) { c.first_reference = 1; });
    cases[3003] = broken_cell(4, 3, [](CellCode& c) { c.flags = BURIN_CELL_FLAG_STEP; });
    cases[3004] = broken_cell(0, 1, [](CellCode& c) { c.skip = 1; });
    cases[3005] = broken_cell(4, 3, [](CellCode& c) { c.skip = 2; });
    cases[3006] = broken_cell(4, 3, [](CellCode& c) { c.highest = 254; });
    cases[3007] = broken_cell(0, 1, [](CellCode& c) { c.flags |= BURIN_CELL_FLAG_STEP; });
    cases[3008] = broken_cell(5, 5, [](CellCode& c) { c.flags |= BURIN_CELL_FLAG_ISOLATED; });
    cases[3009] = broken_cell(4, 3, [](CellCode& c) { c.level = 254 * 257, c.lowest = 254; });
    cases[3010] = broken_cell(5, 5, [](CellCode& c) { c.flags = 0, c.skip = 0; });
}

void add_element_cases(std::map<int, Bytes>& cases) {
    cases[4001] = broken_textures([](PackedTextures& t) { t.data[4 * kLastLine + 2] |= 1u << 29; });
    cases[4002] = broken_element(kLastLine, [](ElementCode& e) { e.unused = 1; });
    cases[4003] = broken_textures([](PackedTextures& t) { t.data[4 * kLastLine + 2] |= 1u << 28; });
    cases[4004] = broken_element(kScaledLine, [](ElementCode& e) { e.p1.u = 5; });
    cases[4005] = broken_element(kLastLine, [](ElementCode& e) { e.start = {BURIN_PRIORITY_LEFT, BURIN_END_TEE, 0}; });
    cases[4006] = broken_element(kLastLine, [](ElementCode& e) { e.end.clip_angle = 7; });
    cases[4007] = broken_element(kLastLine, [](ElementCode& e) { e.style = 3; });
    cases[4008] = broken_element(kLastLine, [](ElementCode& e) { e.p2 = e.p0; });
    cases[4009] = broken_element(kLastLine, [](ElementCode& e) { e.p2.u = e.p0.u + 524289; });
    cases[4010] = broken_element(kStepWithB, [](ElementCode& e) { e.height1 = 16000; });
    cases[4011] = broken_element(kStepWithB, [](ElementCode& e) { e.height0 = e.height1 = 16000; });
    cases[4012] = broken_element(kLastLine, [](ElementCode& e) { e.function = 3; });
    cases[4013] = broken_element(kLastLine, [](ElementCode& e) { e.argument0 = e.argument1 + 1; });
    cases[4014] = broken_element(kStepWithB, [](ElementCode& e) { e.function = 0; });
}

void add_data_cases(std::map<int, Bytes>& cases) {
    cases[4020] = broken_style(kPaintedStyle, [](StyleCode& s) { s.profile_texel = 2; });
    cases[4021] = broken_style(kPaintedStyle, [](StyleCode& s) { s.point_count = 1; });
    cases[4022] = broken_style(kPaintedStyle, [](StyleCode& s) { s.material = 2; });
    cases[4023] =
        broken_style(kPaintedStyle, [](StyleCode& s) { s.reach = std::numeric_limits<float>::quiet_NaN(); });
    cases[4024] = broken_style(kPaintedStyle, [](StyleCode& s) { s.internal_mask |= 4; });
    cases[4025] = broken_style(kPaintedStyle, [](StyleCode& s) { s.level_right = 65000; });
    cases[4030] = broken_profile(5, 0, -32768);
    cases[4031] = broken_textures([](PackedTextures& t) {
        test::set_profile_word(t, 4, pack_profile_point({32767, 0}));
        test::set_profile_word(t, 6, pack_profile_point({-32767, 0}));
    });
    cases[4032] = broken_profile(5, -32767, 0);
    cases[4033] = broken_profile(0, -5, 0);
    cases[4034] = broken_profile(6, 32767, 100);
    cases[4035] = broken_profile(7, 1, 0);
    cases[4040] = broken_data(kMaterials, 1, 1u << 16);
    cases[4041] = broken_data(kMaterials + 1, 3, 1);
    cases[4050] = broken_textures([](PackedTextures& t) { test::set_reference(t, 8, 10); });
    cases[4051] = broken_textures([](PackedTextures& t) {
        test::set_reference(t, 4, 3);
        test::set_reference(t, 5, 0);
    });
    cases[4052] = broken_textures([](PackedTextures& t) { test::set_reference(t, 12, 1); });
    cases[4053] = broken_data(kTail, 2, 1);
    cases[4060] = broken_data(kLastFunction, 0, 3);
    cases[4061] = broken_data(kLastFunction, 2, 1);
    cases[4062] = broken_data(kLastFunction, 1, 0x8000u);
    cases[4063] = broken_data(kPolynomial + 1, 0, 0x40800000u);
}

std::map<int, Bytes> all_cases() {
    std::map<int, Bytes> cases;
    add_container_cases(cases);
    add_extension_cases(cases);
    add_view_cases(cases);
    add_frame_cases(cases);
    add_chart_cases(cases);
    add_residual_cases(cases);
    add_grid_cases(cases);
    add_element_cases(cases);
    add_data_cases(cases);
    return cases;
}

TEST(Validate, SampleIsValid) {
    const Bytes bytes = broken_bytes([](Bytes&) {});
    EXPECT_EQ(text_of(bytes), "");
}

TEST(Validate, ResidualIsCheckedPartByPart) {
    const auto numbers = [](const std::function<void(json&, json&)>& change) { return numbers_of(broken_residual(change)); };
    const std::set<int> none, type{2005}, missing{2004}, no_texture{2023}, no_image{2024};
    EXPECT_EQ(numbers([](json&, json&) {}), none);
    EXPECT_EQ(numbers([](json&, json& r) { r.erase("scale"), r.erase("texCoord"); }), none);
    EXPECT_EQ(numbers([](json&, json& r) { r = "none"; }), type);
    EXPECT_EQ(numbers([](json&, json& r) { r["index"] = "first"; }), type);
    EXPECT_EQ(numbers([](json&, json& r) { r["scale"] = "much"; }), type);
    EXPECT_EQ(numbers([](json&, json& r) { r.erase("index"); }), missing);
    EXPECT_EQ(numbers([](json&, json& r) { r["index"] = -1; }), no_texture);
    EXPECT_EQ(numbers([](json& d, json&) { d.erase("textures"); }), no_texture);
    EXPECT_EQ(numbers([](json& d, json&) { d["textures"][0] = 5; }), no_texture);
    EXPECT_EQ(numbers([](json& d, json&) { d["images"][0] = {{"bufferView", 0}, {"mimeType", "image/gif"}}; }), no_image);
    EXPECT_EQ(numbers([](json& d, json&) { d["images"][0] = {{"bufferView", 9}, {"mimeType", "image/png"}}; }), no_image);
    EXPECT_EQ(numbers([](json& d, json&) { d["images"][0] = {{"bufferView", 0}, {"mimeType", "image/png"}}; }), none);
}

TEST(Validate, ChartsAreCheckedPartByPart) {
    using Words = std::vector<std::uint32_t>;
    const auto numbers = [](const std::function<void(json&, json&, Words&)>& change) { return numbers_of(broken_charts(change)); };
    const std::set<int> none, type{2005}, missing{2004}, range{2043}, side{2013}, vertices{2042}, list{2045};
    EXPECT_EQ(numbers([](json&, json&, Words&) {}), none);
    EXPECT_EQ(numbers([](json&, json& c, Words&) { c["origin"] = 5; }), type);
    EXPECT_EQ(numbers([](json&, json& c, Words&) { c.erase("cell"); }), missing);
    EXPECT_EQ(numbers([](json&, json& c, Words&) { c["columns"] = 0; }), range);
    EXPECT_EQ(numbers([](json&, json& c, Words&) { c["height"] = 0; }), side);
    EXPECT_EQ(numbers([](json& d, json&, Words&) { d["accessors"][1]["type"] = "VEC2"; }), vertices);
    EXPECT_EQ(numbers([](json& d, json&, Words&) { d["accessors"][1]["count"] = 2; }), vertices);
    EXPECT_EQ(numbers([](json&, json&, Words& w) { w[12] = 0; }), (std::set<int>{2046}));
    EXPECT_EQ(numbers([](json&, json&, Words& w) { w[13] = 0x40490fdbu; }), (std::set<int>{2046}));
    // Lines have no charts.
    EXPECT_EQ(numbers([](json& d, json&, Words&) {
                  json& primitive = d["meshes"][0]["primitives"][0];
                  primitive["mode"] = 1;
                  primitive["attributes"].erase("_BURIN_CHART");
              }), none);
    EXPECT_EQ(numbers([](json&, json&, Words& w) { w[16] = 0xffffffffu; }), list);
    EXPECT_EQ(numbers([](json&, json&, Words& w) { w[17] = 5; }), list);
}

TEST(Validate, EveryNumberHasAFileThatBreaksOnlyIt) {
    const std::map<int, Bytes> cases = all_cases();
    for (const IssueKind& kind : issue_kinds()) {
        if (kind.number == 9001) continue;
        ASSERT_TRUE(cases.count(kind.number) == 1) << kind.number << " has no case";
        EXPECT_EQ(numbers_of(cases.at(kind.number)), std::set<int>{kind.number})
            << kind.summary << "\n"
            << text_of(cases.at(kind.number));
    }
    EXPECT_EQ(cases.size() + 1, issue_kinds().size());
}

// The other ways to break what a case of 4001, 4002, 4013 or 4060 to 4063 breaks.
TEST(Validate, FunctionsAreCheckedPartByPart) {
    const auto texel = [](std::uint32_t at, std::size_t word, std::uint32_t value) {
        return numbers_of(broken_data(at, word, value));
    };
    EXPECT_EQ(texel(kLastLine + 1, 1, 3 * 65536 + 1), std::set<int>{4013});  // past the period
    EXPECT_EQ(texel(kLastLine + 1, 2, 1u << 16), std::set<int>{4002});
    EXPECT_EQ(texel(kLastLine + 1, 3, 1), std::set<int>{4002});
    EXPECT_EQ(texel(kLastFunction, 0, 1), std::set<int>{4060});              // a polynomial of one texel
    EXPECT_EQ(texel(kFunctions, 0, 2), std::set<int>{4062});                 // noise of no octave
    EXPECT_EQ(texel(kFunctions, 0, 2u | 9u << 2), std::set<int>{4062});      // or of nine
    EXPECT_EQ(texel(kFunctions, 3, 65537), std::set<int>{4062});
    EXPECT_EQ(texel(kPolynomial, 1, 1), std::set<int>{4061});                // an amplitude that nothing uses
    EXPECT_EQ(texel(kPolynomial + 2, 0, 0x7FC00000u), std::set<int>{4063});  // NaN
    EXPECT_EQ(texel(kPolynomial + 2, 3, 0xC0000000u), std::set<int>{4063});  // below 0 at the end
    EXPECT_EQ(numbers_of(broken_extension([](json& e) { e["data"].erase("functions"); })), std::set<int>({4012, 4053}));
    EXPECT_EQ(numbers_of(broken_extension([](json& e) { e["data"]["functions"] = 65537; })), std::set<int>{2015});
}

// A list section may be as long as a wide pattern's in a wide pattern alone.
TEST(Validate, ListsAreAsLongAsTheirReferencesAllow) {
    const auto lists = [](std::uint32_t elements, std::uint32_t texels) {
        return numbers_of(broken_extension([=](json& e) { e["data"]["elements"] = elements, e["data"]["lists"] = texels; }));
    };
    EXPECT_EQ(lists(BURIN_MAX_NARROW_ELEMENT_TEXELS, BURIN_MAX_NARROW_LIST_TEXELS), std::set<int>{2014});
    EXPECT_EQ(lists(BURIN_MAX_NARROW_ELEMENT_TEXELS, BURIN_MAX_NARROW_LIST_TEXELS + 1), (std::set<int>{2014, 2015}));
    EXPECT_EQ(lists(BURIN_MAX_NARROW_ELEMENT_TEXELS + 1, BURIN_MAX_LIST_TEXELS), std::set<int>{2014});
}

TEST(Validate, SeverityIsThatOfTheKind) {
    for (const auto& [number, bytes] : all_cases()) {
        validate_glb(bytes, [number = number](const Issue& issue) {
            EXPECT_EQ(issue.severity, find_issue_kind(number)->severity);
            EXPECT_FALSE(issue.message.empty());
        });
    }
}

TEST(Validate, FloodOfFindingsIsCounted) {
    const Bytes bytes = broken_textures([](PackedTextures& t) {
        for (int j = 0; j < t.grid_height; ++j) {
            for (int i = 0; i < t.grid_width; ++i) {
                CellCode cell = test::get_cell(t, i, j);
                if (cell.count == 0) cell.first_reference = 1;
                test::set_cell(t, i, j, cell);
            }
        }
    });
    int listed = 0;
    std::string closing;
    validate_glb(bytes, [&](const Issue& issue) {
        if (issue.number == 3002) ++listed;
        if (issue.number == 9001) closing = issue.message;
    });
    EXPECT_EQ(listed, 20);
    EXPECT_EQ(closing, "30 further findings of number 3002 are not listed");
}

TEST(Validate, NumbersGrow) {
    int previous = 0;
    for (const IssueKind& kind : issue_kinds()) {
        EXPECT_GT(kind.number, previous);
        EXPECT_EQ(find_issue_kind(kind.number), &kind);
        previous = kind.number;
    }
    EXPECT_EQ(find_issue_kind(1), nullptr);
    EXPECT_EQ(find_issue_kind(9999), nullptr);
}

TEST(Validate, DataUriAndResourceReaderServeBuffers) {
    const SampleFile file = test::make_sample_file();
    json document = test::make_document(file);
    document["buffers"][0]["uri"] = "detail.bin";
    const std::string text = document.dump();
    ValidateOptions options;
    options.read_resource = [&file](std::string_view uri) -> std::optional<Bytes> {
        EXPECT_EQ(uri, "detail.bin");
        return test::make_bin(file);
    };
    int count = 0;
    validate_glb(
        Bytes(text.begin(), text.end()), [&count](const Issue&) { ++count; }, options);
    EXPECT_EQ(count, 0);

    // Base64 of an all-zero buffer of the right size: readable, and wrong in content only.
    const std::size_t size = document["buffers"][0]["byteLength"].get<std::size_t>();
    std::string uri = "data:application/octet-stream;base64," + std::string((size * 8 + 5) / 6, 'A');
    document["buffers"][0]["uri"] = uri;
    const std::string inlined = document.dump();
    for (const int number : numbers_of(Bytes(inlined.begin(), inlined.end()))) EXPECT_GE(number, 3000);
}

TEST(Validate, DeepNestingDoesNotOverflow) {
    const SampleFile file = test::make_sample_file();
    std::string text = test::make_document(file).dump();
    const std::string deep(200000, '[');
    const std::size_t at = text.find("\"size\":") + 7;
    text = text.substr(0, at) + deep + std::string(200000, ']') + "," + "\"x\":" + text.substr(at);
    EXPECT_TRUE(numbers_of(Bytes(text.begin(), text.end())).count(2005) == 1);
}

}  // namespace
}  // namespace burin
