// Patterns in JSON: what words mean. Which files are refused, and with which words, is in tests/cli/pattern_json.py.
#include <string>

#include <gtest/gtest.h>

#include <burin/json_text.hpp>
#include <burin/pattern_json.hpp>
#include <burin/profiles.hpp>
#include <burin/rasterize.hpp>
#include <burin/resolve.hpp>

namespace burin {
namespace {

Pattern read(const std::string& members, std::vector<std::string>* sources = nullptr) {
    const auto pattern = read_pattern_json("{\"size\": 10, \"depth\": 4, \"wrap\": \"clamp\", " + members + "}", "p.json", sources);
    EXPECT_TRUE(pattern.ok()) << pattern.error().message;
    return pattern.ok() ? *pattern : Pattern{};
}

std::string error_of(const std::string& text) {
    const auto pattern = read_pattern_json(text, "p.json");
    return pattern.ok() ? "" : pattern.error().message;
}

constexpr const char* kGroove = "{\"points\": [[-0.1, 0], [0, -0.2], [0.1, 0]]}";

Path one_path(const std::string& members) {
    const Pattern pattern = read("\"paths\": [{\"profile\": " + std::string(kGroove) + ", " + members + "}]");
    EXPECT_EQ(pattern.paths.size(), 1u);
    return pattern.paths.empty() ? Path{} : pattern.paths.front();
}

TEST(PatternJson, units_are_rounded_once) {
    const auto text = [](const std::string& units) {
        return "{\"units\": " + units + ", \"size\": [5, 7.3], \"depth\": 3, \"outer_level\": -0.7, \"paths\": [{\"profile\": "
               "{\"points\": [[-0.3, 0], [0.3, -0.1]]}, \"d\": \"M0.1 0.2 L3 4\"}]}";
    };
    const auto millimetres = read_pattern_json(text("\"mm\""), "p.json");
    ASSERT_TRUE(millimetres.ok()) << millimetres.error().message;
    EXPECT_EQ(millimetres->size.y, 0.0073);
    EXPECT_EQ(millimetres->depth, 0.003);
    EXPECT_EQ(millimetres->outer_level, -0.0007);
    EXPECT_EQ(millimetres->profiles[0].points[0].b, -0.0003);
    EXPECT_EQ(millimetres->paths[0].elements[0].p0.y, 0.0002);
    const auto both = read_pattern_json(text("{\"plane\": \"cm\", \"height\": \"um\"}"), "p.json");
    ASSERT_TRUE(both.ok());
    EXPECT_EQ(both->size.x, 0.05);
    EXPECT_EQ(both->depth, 3e-6);
    EXPECT_EQ(both->profiles[0].points[1].h, -0.1 / 1e6);
    EXPECT_EQ(both->profiles[0].points[1].b, 0.003);
    const auto inches = read_pattern_json(text("\"in\""), "p.json");
    ASSERT_TRUE(inches.ok());
    EXPECT_EQ(inches->size.x, 0.127);
}

TEST(PatternJson, scales_of_a_path) {
    const auto widths = [](const std::string& scale) {
        std::vector<double> all;
        for (const Element& e : one_path("\"points\": [[0, 0], [3, 0], [4, 0]], \"width_scale\": " + scale).elements)
            all.insert(all.end(), {e.width0, e.width1});
        return all;
    };
    EXPECT_EQ(widths("0.5"), (std::vector<double>{0.5, 0.5, 0.5, 0.5}));
    EXPECT_EQ(widths("[1, 0]"), (std::vector<double>{1.0, 0.25, 0.25, 0.0}));  // by length
    EXPECT_EQ(widths("[1, 2, 3]"), (std::vector<double>{1.0, 2.0, 2.0, 3.0}));
    EXPECT_EQ(widths("[[1, 2], [3, 0]]"), (std::vector<double>{1.0, 2.0, 3.0, 0.0}));
    const Path path = one_path("\"points\": [[0, 0], [3, 0], [4, 0]], \"height_scale\": 0.5");
    EXPECT_EQ(path.elements[1].height1, 0.5);
    EXPECT_EQ(path.elements[1].width1, 1.0);
}

TEST(PatternJson, closed_paths) {
    EXPECT_FALSE(one_path("\"d\": \"M0 0 H4 V4\"").closed);
    EXPECT_TRUE(one_path("\"d\": \"M0 0 H4 V4 Z\"").closed);
    EXPECT_TRUE(one_path("\"points\": [[0, 0], [4, 0], [4, 4], [0, 0]]").closed);
    const Path led_back = one_path("\"points\": [[0, 0], [4, 0], [4, 4]], \"closed\": true");
    ASSERT_EQ(led_back.elements.size(), 3u);
    EXPECT_EQ(led_back.elements.back().p2, led_back.elements.front().p0);
    EXPECT_FALSE(one_path("\"d\": \"M0 0 H4 V4 Z\", \"closed\": false").closed);
    // The other side of the tile is the start again, where the pattern repeats.
    const auto around = read_pattern_json("{\"size\": 10, \"depth\": 1, \"paths\": [{\"profile\": " + std::string(kGroove) +
                                          ", \"d\": \"M0 3 H10\", \"closed\": true}]}", "p.json");
    ASSERT_TRUE(around.ok()) << around.error().message;
    EXPECT_EQ(around->paths[0].elements.size(), 1u);
}

TEST(PatternJson, entries_by_name_by_index_and_in_place) {
    const Pattern pattern = read(
        "\"profiles\": [{\"points\": [[-1, 0], [0, -1], [1, 0]]}, {\"name\": \"vee\", \"shape\": \"vee\", \"width\": 2, \"height\": 1}], "
        "\"materials\": [{\"name\": \"steel\", \"metallic\": 1}], "
        "\"paths\": [{\"profile\": \"vee\", \"d\": \"M1 1H2\", \"material\": \"steel\"}, {\"profile\": 0, \"d\": \"M1 2H2\", \"material\": 1}, "
        "{\"profile\": {\"shape\": \"vee\", \"width\": 3, \"height\": 1}, \"d\": \"M1 3H2 M1 4H2\", \"caps\": [\"butt\", \"taper\"]}, "
        "{\"profile\": {\"shape\": \"vee\", \"width\": 3, \"height\": 1}, \"d\": \"M1 5H2\"}]");
    ASSERT_EQ(pattern.paths.size(), 5u);
    EXPECT_EQ(pattern.paths[0].profile, 1u);
    EXPECT_EQ(pattern.paths[1].profile, 0u);
    EXPECT_EQ(pattern.paths[0].material, 1u);
    EXPECT_EQ(pattern.paths[1].material, 1u);
    EXPECT_EQ(pattern.paths[3].start_cap, CapKind::butt);
    EXPECT_EQ(pattern.paths[3].end_cap, CapKind::taper);
    // Equal ones are stored once.
    ASSERT_EQ(pattern.profiles.size(), 3u);
    EXPECT_EQ(pattern.paths[4].profile, 2u);
    const auto vee = make_profile({"vee", {}}, 3.0, 1.0);
    ASSERT_TRUE(vee.ok());
    EXPECT_EQ(pattern.profiles[2].points.size(), vee->points.size());
}

// Heights of the truth, texels of 0.5.
Image heights_of(const Pattern& pattern) {
    const auto resolved = resolve_pattern(pattern);
    EXPECT_TRUE(resolved.ok()) << resolved.error().message;
    if (resolved.ok()) return rasterize_height(*resolved, 20, 20, {.samples = 1, .threads = 1});
    Image nothing;
    nothing.texels.resize(400);
    return nothing;
}

// A map's value to metres.
double height_at(const Pattern& pattern, const Image& image, double x, double y) {
    const double value = image.texels[static_cast<std::size_t>(y * 2.0) * 20 + static_cast<std::size_t>(x * 2.0)];
    return highest(pattern) - (1.0 - value) * pattern.depth;
}

TEST(PatternJson, regions_lie_at_their_levels_whatever_way_they_are_drawn) {
    for (const char* outline : {"M1 1H9V9H1Z M3 3H7V7H3Z", "M1 1V9H9V1Z M3 3H7V7H3Z", "M3 3V7H7V3Z M1 1H9V9H1Z"}) {
        const Pattern pattern = read("\"outer_level\": -1, \"regions\": [{\"level\": -3, \"outline\": \"" + std::string(outline) +
                                     "\", \"edge\": 0.2, \"regions\": [{\"level\": -0.5, \"outline\": [[1.5, 1.5], [2.5, 1.5], [2.5, 2.5]], \"at\": [[0, 0], [0, 6]]}]}]");
        ASSERT_EQ(pattern.paths.size(), 4u);
        const Image image = heights_of(pattern);
        EXPECT_NEAR(height_at(pattern, image, 0.25, 5.25), -1.0, 1e-6) << outline;  // around
        EXPECT_NEAR(height_at(pattern, image, 2.25, 5.25), -3.0, 1e-6) << outline;  // in the region
        EXPECT_NEAR(height_at(pattern, image, 5.25, 5.25), -1.0, 1e-6) << outline;  // in its hole
        EXPECT_NEAR(height_at(pattern, image, 2.25, 1.75), -0.5, 1e-6) << outline;  // on the plates within
        EXPECT_NEAR(height_at(pattern, image, 2.25, 7.75), -0.5, 1e-6) << outline;
    }
}

TEST(PatternJson, what_stands_in_a_region_is_on_its_level_and_copied_with_it) {
    std::vector<std::string> sources;
    const Pattern pattern = read("\"regions\": [{\"name\": \"tile\", \"level\": -1, \"outline\": \"M0 0H1V1H0Z\", \"at\": {\"start\": [1, 1], \"step\": [2, 3], "
                                 "\"count\": [3, 2]},\n\"paths\": [{\"profile\": " + std::string(kGroove) + ", \"points\": [[0.3, 0.5], [0.7, 0.5]]}]}]", &sources);
    ASSERT_EQ(pattern.paths.size(), 12u);
    EXPECT_EQ(pattern.paths[6].level, -1.0);
    EXPECT_EQ(pattern.paths[11].elements[0].p0, (Vec2{5.3, 4.5}));
    ASSERT_EQ(sources.size(), 12u);
    EXPECT_EQ(sources[0], "line 1, 'tile'");
    EXPECT_EQ(sources[11], "line 2");
}

TEST(PatternJson, curves_keep_to_the_tolerance) {
    for (const double tolerance : {1e-2, 1e-4}) {
        const Pattern pattern = read("\"tolerance\": " + std::to_string(tolerance) + ", \"paths\": [{\"profile\": " + kGroove +
                                     ", \"d\": \"M2 5 A3 3 0 0 1 8 5 A3 3 0 0 1 2 5 Z\"}]");
        double farthest = 0.0;
        for (const Element& e : pattern.paths[0].elements)
            for (double s = 0.0; s <= 1.0; s += 0.05) {
                const Vec2 p = lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s);
                farthest = std::max(farthest, std::abs(length(p - Vec2{5, 5}) - 3.0));
            }
        EXPECT_LE(farthest, tolerance);
        EXPECT_GT(farthest, 0.0);
    }
}

TEST(PatternJson, limits_are_named) {
    EXPECT_NE(error_of(std::string(1 << 20, '[')).find("nested deeper than 64 levels"), std::string::npos);
    std::string many = "[0";
    for (std::size_t i = 0; i < kMaxJsonTextValues; ++i) many += ",0";
    EXPECT_NE(error_of(many + "]").find("more than 16777216 values"), std::string::npos);
    // Copies of copies are counted before they are made.
    std::string nested = "{\"size\": 1, \"depth\": 1, \"regions\": [";
    const std::string at = "\"at\": {\"step\": [0, 0], \"count\": [1024, 1024]}, ";
    for (int i = 1; i <= 3; ++i)
        nested += "{\"outline\": \"M0 0H1V1Z\", " + at + "\"level\": -0." + std::to_string(i) + (i < 3 ? ", \"regions\": [" : "");
    EXPECT_NE(error_of(nested + "}]}]}]}").find("limit 4194304"), std::string::npos);
}

TEST(JsonText, knows_the_line_of_every_value) {
    const auto root = parse_json_text("{\n\"a\": 1\n,\"b\": [2,\n\n3\n], \"c\":\n\"x\"}", "p.json");
    ASSERT_TRUE(root.ok()) << root.error().message;
    JsonReader reader(*root, "p.json");
    JsonObject object(reader, *root);
    EXPECT_EQ(object.find("a")->line, 2u);
    EXPECT_EQ(object.find("b")->line, 3u);
    const auto list = reader.list(*object.find("b"), 2, 2);
    EXPECT_EQ(list[1].line, 5u);
    EXPECT_EQ(reader.place_of(list[1]), "b[1]");
    EXPECT_EQ(object.find("c")->line, 7u);
}

TEST(JsonText, nearest_name_is_near) {
    const std::vector<std::string> names{"profile", "points", "perturbation"};
    EXPECT_EQ(nearest_name("profil", names), "profile");
    EXPECT_EQ(nearest_name("pertubation", names), "perturbation");
    EXPECT_EQ(nearest_name("colour", names), "");
}

}  // namespace
}  // namespace burin
