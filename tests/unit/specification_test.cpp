// SPECIFICATION.md and the code say the same: numbers, limits, the example's bytes.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burin/format/validate.hpp>

namespace burin {
namespace {

std::string read_text(const std::string& path) {
    std::ifstream file(std::string(BURIN_SOURCE_DIR) + "/format/" + path, std::ios::binary);
    EXPECT_TRUE(file.good()) << path;
    return {std::istreambuf_iterator<char>(file), {}};
}

std::string both_texts() {
    return read_text("SPECIFICATION.md") + "\n\n" + read_text("BURIN_materials_path_detail/README.md");
}

TEST(Specification, EveryNumberIsNamedAndEveryNameIsANumber) {
    const std::string text = both_texts();
    std::set<int> named;
    const std::regex number(R"(\[(\d{4})\])");
    for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it)
        named.insert(std::stoi((*it)[1]));
    for (const IssueKind& kind : issue_kinds()) {
        if (kind.number == 9001) continue;
        EXPECT_EQ(named.erase(kind.number), 1u) << kind.number << " is not in the text";
    }
    for (const int left : named) ADD_FAILURE() << left << " is in the text, the validator does not know it";
}

// Sentences, roughly: split at full stops, semicolons and list items. A sentence that demands carries a
// number, or is one of those that say what the words mean or refer to the other page.
TEST(Specification, EveryDemandCarriesANumber) {
    std::string text = both_texts();
    std::replace(text.begin(), text.end(), '\n', ' ');
    text = std::regex_replace(text, std::regex(R"(\. |; | - )"), "\n");
    std::istringstream lines(text);
    int demands = 0;
    for (std::string line; std::getline(lines, line);) {
        if (line.find("MUST") == std::string::npos) continue;
        const bool meta = line.find("RFC 2119") != std::string::npos ||
                          line.find("Every MUST") != std::string::npos ||
                          line.find("SPECIFICATION.md") != std::string::npos;
        ++demands;
        EXPECT_TRUE(meta || std::regex_search(line, std::regex(R"(\[\d{4}\])"))) << line;
    }
    EXPECT_GT(demands, 40);
}

TEST(Specification, LimitsAreThoseOfTheLayout) {
    const std::string text = read_text("SPECIFICATION.md");
    const struct {
        const char* name;
        int value;
    } limits[] = {{"BURIN_MAX_TEXTURE_SIDE", BURIN_MAX_TEXTURE_SIDE},
                  {"BURIN_MAX_REFS_PER_CELL", BURIN_MAX_REFS_PER_CELL},
                  {"BURIN_MAX_PROFILE_POINTS", BURIN_MAX_PROFILE_POINTS},
                  {"BURIN_MAX_ELEMENT_TEXELS", BURIN_MAX_ELEMENT_TEXELS},
                  {"BURIN_MAX_NARROW_ELEMENT_TEXELS", BURIN_MAX_NARROW_ELEMENT_TEXELS},
                  {"BURIN_MAX_STYLES", BURIN_MAX_STYLES},
                  {"BURIN_MAX_PROFILE_TEXELS", BURIN_MAX_PROFILE_TEXELS},
                  {"BURIN_MAX_MATERIALS", BURIN_MAX_MATERIALS},
                  {"BURIN_MAX_LIST_TEXELS", BURIN_MAX_LIST_TEXELS},
                  {"BURIN_MAX_NARROW_LIST_TEXELS", BURIN_MAX_NARROW_LIST_TEXELS},
                  {"BURIN_MAX_FUNCTION_TEXELS", BURIN_MAX_FUNCTION_TEXELS},
                  {"BURIN_MAX_OCTAVES", BURIN_MAX_OCTAVES},
                  {"BURIN_MAX_NOISE_PERIOD", BURIN_MAX_NOISE_PERIOD}};
    for (const auto& limit : limits) {
        const std::string row = "| " + std::to_string(limit.value) + " | `" + limit.name + "` |";
        EXPECT_NE(text.find(row), std::string::npos) << row;
    }
}

nlohmann::json schema(const std::string& part) {
    return nlohmann::json::parse(read_text(
        "BURIN_materials_path_detail/schema/material.BURIN_materials_path_detail" + part + ".schema.json"));
}

// Without a property that the schema requires the extension is refused, without any other one it is read.
void expect_required(const nlohmann::json& extension, const std::string& object,
                     const nlohmann::json& schema) {
    for (const auto& [name, property] : schema["properties"].items()) {
        nlohmann::json changed = extension;
        nlohmann::json& holder = object.empty() ? changed : changed[object];
        if (holder.erase(name) == 0) {
            EXPECT_TRUE(name == "extensions" || name == "extras") << name;
            continue;
        }
        const auto& required = schema["required"];
        const bool needed = std::find(required.begin(), required.end(), name) != required.end();
        EXPECT_EQ(parse_extension(changed.dump()).ok(), !needed) << object << "/" << name;
    }
    const nlohmann::json& holder = object.empty() ? extension : extension[object];
    for (const auto& [name, value] : holder.items()) EXPECT_TRUE(schema["properties"].contains(name)) << name;
}

TEST(Specification, SchemasRequireWhatTheReaderRequires) {
    PathDetail detail;
    detail.grid_view = detail.data_view = 0;
    detail.grid_width = detail.grid_height = detail.data_width = detail.data_height = 1;
    detail.data_width = 2;
    detail.sections.material_texels = detail.sections.function_texels = 1;
    detail.residual_texture = 0;
    detail.charts = {0, 6, 1, 1, 1, 1, {0.0, 0.0}, {1.0, 1.0}};
    const nlohmann::json extension = nlohmann::json::parse(write_extension(detail));
    expect_required(extension, "", schema(""));
    expect_required(extension, "grid", schema(".grid"));
    expect_required(extension, "data", schema(".data"));
    expect_required(extension, "residualTexture", schema(".residual"));
    expect_required(extension, "charts", schema(".charts"));
    EXPECT_EQ(schema(".charts")["properties"]["borders"]["maximum"].get<int>(), BURIN_MAX_BORDERS);
    EXPECT_EQ(schema(".charts")["properties"]["columns"]["maximum"].get<int>(), BURIN_MAX_CHART_CELLS);
    const auto limit = [](const char* name) {
        return schema(".data")["properties"][name]["maximum"].get<int>();
    };
    EXPECT_EQ(limit("elements"), BURIN_MAX_ELEMENT_TEXELS);
    EXPECT_EQ(limit("styles"), BURIN_MAX_STYLES);
    EXPECT_EQ(limit("profiles"), BURIN_MAX_PROFILE_TEXELS);
    EXPECT_EQ(limit("materials"), BURIN_MAX_MATERIALS);
    EXPECT_EQ(limit("lists"), BURIN_MAX_LIST_TEXELS);
    EXPECT_EQ(limit("functions"), BURIN_MAX_FUNCTION_TEXELS);
    EXPECT_EQ(limit("width"), BURIN_MAX_TEXTURE_SIDE);
}

std::string hex_rows(const std::vector<std::uint8_t>& bytes, std::size_t per_row) {
    static const char digits[] = "0123456789abcdef";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        if (i > 0 && i % 4 == 0) out += i % per_row == 0 ? '\n' : ' ';
        out += digits[bytes[i] >> 4];
        out += digits[bytes[i] & 15];
    }
    return out;
}

TEST(Specification, ExampleIsValidAndItsBytesArePrinted) {
    const std::string gltf = read_text("examples/minimal.gltf");
    validate_glb(std::span(reinterpret_cast<const std::uint8_t*>(gltf.data()), gltf.size()),
                 [](const Issue& issue) {
                     ADD_FAILURE() << issue.number << " " << issue.pointer << ": " << issue.message;
                 });
    const nlohmann::json document = nlohmann::json::parse(gltf);
    const auto& extension = document["materials"][0]["extensions"][std::string(kPathDetailExtension)];
    const Result<PathDetail> detail = parse_extension(extension.dump());
    ASSERT_TRUE(detail.ok());
    // The README prints the same extension.
    const std::string readme = read_text("BURIN_materials_path_detail/README.md");
    const std::size_t begin = readme.find("```json") + 7;
    const nlohmann::json printed =
        nlohmann::json::parse(readme.substr(begin, readme.find("```", begin) - begin));
    EXPECT_EQ(printed["materials"][0]["extensions"][std::string(kPathDetailExtension)], extension);

    const std::string uri = document["buffers"][0]["uri"];
    const auto view = [&](int index) {
        const auto& v = document["bufferViews"][static_cast<std::size_t>(index)];
        // Base64 digits of whole triples; the views begin at multiples of 12 bytes.
        std::vector<std::uint8_t> all;
        std::uint32_t bits = 0;
        int count = 0;
        for (const char c : uri.substr(uri.find(',') + 1)) {
            const auto digit =
                std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/").find(c);
            if (digit == std::string::npos) break;
            bits = bits << 6 | static_cast<std::uint32_t>(digit);
            if ((count += 6) >= 8) all.push_back(static_cast<std::uint8_t>(bits >> (count -= 8)));
        }
        const auto first = all.begin() + v["byteOffset"].get<std::ptrdiff_t>();
        return std::vector<std::uint8_t>(first, first + v["byteLength"].get<std::ptrdiff_t>());
    };
    const std::string text = read_text("SPECIFICATION.md");
    const auto expect_rows = [&text](const std::vector<std::uint8_t>& bytes, std::size_t per_row) {
        std::istringstream rows(hex_rows(bytes, per_row));
        for (std::string row; std::getline(rows, row);) {
            EXPECT_NE(text.find("\n" + row + "    "), std::string::npos) << row;
        }
    };
    expect_rows(view(detail->grid_view), 8);
    expect_rows(view(detail->data_view), 16);
}

}  // namespace
}  // namespace burin
