// Generators with parameters drawn at random: what comes out resolves and packs, is the same with any number of threads, and has the
// statistics that were asked for. Seeds are printed; BURIN_SEED begins at another one.
#include <burin/generate.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <burin/evaluate.hpp>
#include <burin/grid.hpp>
#include <burin/pack.hpp>
#include <burin/resolve.hpp>
#include <burin/svg.hpp>

#include "random_pattern.hpp"

namespace burin {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::uint64_t first_seed() {
    const char* text = std::getenv("BURIN_SEED");
    return text ? std::strtoull(text, nullptr, 10) : 2006;
}

// Lengths near the usual ones, as the tile is near the usual one; shares and angles anywhere in their range; densities low enough
// for cells, whose lists are limited, however long and wide what lies in them becomes.
double drawn_value(const Parameter& parameter, testing::Random& random) {
    const bool length = std::strcmp(parameter.unit, "m") == 0, many = std::strcmp(parameter.unit, "per cm2") == 0;
    if (many) return 0.1 * parameter.usual * random.between(0.0, 1.0);
    if (length) return std::clamp(parameter.usual * std::exp(random.between(-0.7, 0.7)), parameter.low, parameter.high);
    const double high = std::min(parameter.high, std::max(4.0 * parameter.usual, parameter.whole ? 2.0 : 360.0));
    const double value = random.between(parameter.low, high);
    return parameter.whole ? std::floor(std::min(value + 0.5, high)) : value;
}

GenerateSpec drawn_spec(const GeneratorEntry& entry, std::uint64_t seed) {
    testing::Random random(seed);
    GenerateSpec spec;
    spec.kind = entry.name;
    spec.seed = seed;
    spec.wrap = seed % 2 == 0 ? Wrap::repeat : Wrap::clamp;
    spec.size = {0.2, seed % 3 == 0 ? 0.13 : 0.2};
    for (const Parameter& parameter : entry.parameters)
        if (random.between(0.0, 1.0) < 0.5 || std::strcmp(parameter.name, "density") == 0) spec.parameters[parameter.name] = drawn_value(parameter, random);
    return spec;
}

std::string text_of(const GenerateSpec& spec) {
    std::string text = spec.kind + " seed " + std::to_string(spec.seed) + (spec.wrap == Wrap::repeat ? " repeat" : " clamp");
    for (const auto& [name, value] : spec.parameters) text += " " + name + "=" + parameter_text(value);
    return text;
}

// The first error on the way to textures; "" where there is none.
std::string fault_of(const Pattern& pattern) {
    const auto resolved = resolve_pattern(pattern);
    if (!resolved) return resolved.error().message;
    const auto grid = build_grid(*resolved);
    if (!grid) return grid.error().message;
    const auto packed = pack_textures(*resolved, *grid);
    return packed ? "" : packed.error().message;
}

TEST(Generators, what_comes_out_resolves_and_packs) {
    const std::uint64_t first = first_seed();
    std::printf("seeds from %llu\n", static_cast<unsigned long long>(first));
    for (const GeneratorEntry& entry : generator_table()) {
        int made = 0, refused = 0;
        for (std::uint64_t seed = first; seed < first + 24; ++seed) {
            const GenerateSpec spec = drawn_spec(entry, seed);
            const auto pattern = generate_pattern(spec);
            if (!pattern) {
                // Numbers that leave each other no room are named.
                EXPECT_EQ(pattern.error().code, ErrorCode::invalid_argument);
                EXPECT_EQ(pattern.error().message.find(spec.kind), 0u) << pattern.error().message;
                ++refused;
                continue;
            }
            ++made;
            EXPECT_EQ(fault_of(*pattern), "") << text_of(spec);
        }
        EXPECT_GE(made, 12) << entry.name << ": " << refused << " of " << made + refused << " refused";
    }
}

TEST(Generators, usual_ones_resolve_in_both_wraps) {
    for (const GeneratorEntry& entry : generator_table())
        for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
            GenerateSpec spec;
            spec.kind = entry.name;
            spec.wrap = wrap;
            const auto pattern = generate_pattern(spec);
            ASSERT_TRUE(pattern) << pattern.error().message;
            EXPECT_FALSE(pattern->paths.empty()) << entry.name;
            EXPECT_EQ(fault_of(*pattern), "") << text_of(spec);
        }
}

TEST(Generators, same_seed_same_bytes_whatever_the_threads) {
    for (const GeneratorEntry& entry : generator_table()) {
        GenerateSpec spec = drawn_spec(entry, first_seed());
        spec.parameters.clear();
        if (spec.kind == "scratches") spec.parameters["density"] = 40.0;  // several pieces of work
        spec.threads = 1;
        const std::string one = write_svg(*generate_pattern(spec));
        spec.threads = 4;
        EXPECT_EQ(write_svg(*generate_pattern(spec)), one) << entry.name;
        spec.seed += 1;
        const bool chancy = entry.masked || spec.kind == "bricks" || spec.kind == "tiles" || spec.kind == "hatch" || spec.kind == "vinyl" || spec.kind == "knurl";
        EXPECT_EQ(write_svg(*generate_pattern(spec)) != one, chancy) << entry.name;
    }
}

// A repeating pattern is the same surface when it is moved by a whole tile.
TEST(Generators, patterns_tile) {
    for (const GeneratorEntry& entry : generator_table()) {
        GenerateSpec spec;
        spec.kind = entry.name;
        if (entry.masked && spec.kind != "cracks") spec.parameters["density"] = 0.5;
        const auto pattern = generate_pattern(spec);
        ASSERT_TRUE(pattern);
        const Truth truth(*resolve_pattern(*pattern));
        testing::Random random(first_seed());
        for (int i = 0; i < 50; ++i) {
            // On the border, from both sides.
            const double along = random.between(0.0, 0.2), off = 1e-9;
            EXPECT_NEAR(truth.surface_at({along, off}).height, truth.surface_at({along, 0.2 - off}).height, 1e-4 * pattern->depth + 1e-7) << entry.name;
            EXPECT_NEAR(truth.surface_at({off, along}).height, truth.surface_at({0.2 - off, along}).height, 1e-4 * pattern->depth + 1e-7) << entry.name;
        }
    }
}

struct Statistics {
    double count = 0.0, length = 0.0, mean_direction = 0.0, spread = 0.0, width = 0.0, depth = 0.0, turn = 0.0;
};

double arc_length(const Element& e) {
    if (e.kind == ElementKind::line) return length(e.p2 - e.p0);
    double sum = 0.0;
    Vec2 from = e.p0;
    for (int i = 1; i <= 32; ++i) {
        const double s = i / 32.0;
        const Vec2 to = lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s);
        sum += length(to - from);
        from = to;
    }
    return sum;
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
    return values[values.size() / 2];
}

Statistics statistics_of(const Pattern& pattern) {
    const Profile& profile = pattern.profiles.front();
    double deep = 0.0;
    for (const ProfilePoint& p : profile.points) deep = std::min(deep, p.h);
    std::vector<double> lengths, widths, depths;
    double sum = 0.0, squares = 0.0, turns = 0.0;
    for (const Path& path : pattern.paths) {
        double along = 0.0, wide = 0.0, high = 0.0;
        for (const Element& e : path.elements) along += arc_length(e), wide = std::max(wide, e.width0), high = std::max(high, e.height0);
        lengths.push_back(along);
        widths.push_back(wide * (profile.points.back().b - profile.points.front().b));
        depths.push_back(-high * deep);
        const Vec2 chord = path.elements.back().p2 - path.elements.front().p0;
        const double angle = std::atan2(chord.y, chord.x) * 180.0 / kPi;
        sum += angle, squares += angle * angle;
        const Element &a = path.elements.front(), &b = path.elements.back();
        const Vec2 out = (a.kind == ElementKind::line ? a.p2 : a.p1) - a.p0, in = b.p2 - (b.kind == ElementKind::line ? b.p0 : b.p1);
        turns += std::pow(std::atan2(cross(out, in), dot(out, in)) * 180.0 / kPi, 2.0);
    }
    const double n = double(pattern.paths.size()), mean = sum / n;
    return {n, median(lengths), mean, std::sqrt(squares / n - mean * mean), median(widths), median(depths), std::sqrt(turns / n)};
}

TEST(Scratches, statistics_follow_what_was_asked) {
    testing::Random random(first_seed());
    for (int i = 0; i < 6; ++i) {
        GenerateSpec spec;
        spec.kind = "scratches";
        spec.seed = first_seed() + std::uint64_t(i);
        spec.size = {0.3, 0.2};
        const double density = random.between(10.0, 30.0), along = random.between(0.002, 0.02), direction = random.between(-50.0, 50.0), spread = random.between(0.0, 20.0);
        const double bend = random.between(2.0, 40.0), width = random.between(1e-4, 1e-3), depth = random.between(1e-4, 1e-3);
        spec.parameters = {{"density", density}, {"length", along}, {"direction", direction}, {"spread", spread},
                           {"bend", bend}, {"width", width}, {"depth", depth}, {"clustered", 0.0}};
        const auto pattern = generate_pattern(spec);
        ASSERT_TRUE(pattern) << pattern.error().message;
        const Statistics found = statistics_of(*pattern);
        EXPECT_EQ(found.count, std::round(density * 600.0)) << text_of(spec);
        EXPECT_NEAR(found.length, along, 0.03 * along) << text_of(spec);
        EXPECT_NEAR(found.mean_direction, direction, 0.6) << text_of(spec);
        EXPECT_NEAR(found.spread, spread, 0.03 * spread + 0.05) << text_of(spec);
        EXPECT_NEAR(found.turn, bend, 0.04 * bend) << text_of(spec);
        EXPECT_NEAR(found.width, width, 0.03 * width) << text_of(spec);
        EXPECT_NEAR(found.depth, depth, 0.03 * depth) << text_of(spec);
    }
}

double nearest_distance(const Pattern& pattern) {
    std::vector<double> nearest;
    for (std::size_t i = 0; i < pattern.paths.size(); i += 8) {
        double best = 1.0;
        for (std::size_t k = 0; k < pattern.paths.size(); ++k)
            if (k != i) best = std::min(best, length(pattern.paths[k].elements.front().p2 - pattern.paths[i].elements.front().p2));
        nearest.push_back(best);
    }
    return median(nearest);
}

TEST(Scratches, clusters_lie_close) {
    GenerateSpec spec;
    spec.kind = "scratches";
    spec.parameters = {{"clustered", 0.0}, {"cluster_radius", 0.001}};
    const double alone = nearest_distance(*generate_pattern(spec));
    spec.parameters["clustered"] = 1.0;
    EXPECT_LT(nearest_distance(*generate_pattern(spec)), 0.6 * alone);
}

TEST(Scratches, mask_says_where) {
    // Left third untouched, middle half worn, right third worn.
    Image mask(3, 1);
    mask.texels = {0.0f, 0.5f, 1.0f};
    for (const char* kind : {"scratches", "brushed"}) {
        GenerateSpec spec;
        spec.kind = kind;
        spec.size = {0.3, 0.2};
        spec.mask = &mask;
        spec.parameters = {{"density", 20.0}, {"bend", 0.0}, {"taper", 0.0}, {"clustered", 0.0}};
        const auto pattern = generate_pattern(spec);
        ASSERT_TRUE(pattern);
        double counts[3] = {0, 0, 0};
        for (const Path& path : pattern->paths) ++counts[int(std::clamp(0.5 * (path.elements.front().p0.x + path.elements.front().p2.x) / 0.1, 0.0, 2.0))];
        EXPECT_EQ(counts[0], 0.0) << kind;
        EXPECT_NEAR(counts[1], 2000.0, 140.0) << kind;
        EXPECT_NEAR(counts[2], 4000.0, 200.0) << kind;
    }
}

}  // namespace
}  // namespace burin
