// Random patterns through their JSON: what is read is what was written, to the last bit; and what is damaged is an error, never worse.
#include <string>

#include <gtest/gtest.h>

#include <burin/pattern_json.hpp>

#include "../unit/pattern_equal.hpp"
#include "perturbed.hpp"

namespace burin {
namespace {

// What random_pattern leaves plain: flags, levels, materials whose floats take all their bits.
Pattern odd_pattern(std::uint64_t seed) {
    testing::Random random(seed ^ 0x6a736f6eull);
    testing::RandomPatternOptions options;
    options.wrap = seed % 2 == 0 ? Wrap::repeat : Wrap::clamp;
    options.size = {random.between(1e-3, 10.0), random.between(1e-3, 10.0)};
    Pattern pattern = testing::perturbed_pattern(seed, options);
    pattern.outer_level = random.between(-1e-3, 1e-3);
    for (int i = random.below(4); i > 0; --i) {
        Material material{random.chance(0.8), {}, float(random.uniform()), float(random.uniform())};
        for (float& channel : material.base_color) channel = float(random.uniform());
        pattern.materials.push_back(material);
    }
    for (Profile& profile : pattern.profiles)
        if (random.chance(0.3)) profile.facets.assign(profile.points.size() - 1, static_cast<FacetClass>(random.below(3)));
    for (Path& path : pattern.paths) {
        path.material = static_cast<std::uint32_t>(random.below(static_cast<int>(pattern.materials.size())));
        if (random.chance(0.3)) path.level = random.between(-0.01, 0.01);
        // Not all bits of a coordinate are those of a short decimal, and a closed path need not be called one.
        if (path.closed && random.chance(0.2)) path.closed = false;
    }
    return pattern;
}

TEST(PatternJsonProperty, reading_gives_what_was_written) {
    std::size_t elements = 0, closed = 0, around = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Pattern pattern = odd_pattern(seed);
        const std::string text = write_pattern_json(pattern);
        const auto read = read_pattern_json(text, "pattern.json");
        ASSERT_TRUE(read.ok()) << read.error().message;
        testing::expect_equal(pattern, *read);
        if (HasFailure()) return;
        ASSERT_EQ(write_pattern_json(*read), text);
        for (const Path& path : pattern.paths) {
            elements += path.elements.size();
            closed += path.closed;
            around += path.closed && !(path.elements.front().p0 == path.elements.back().p2);
        }
    }
    // The seeds do hold what is hard.
    EXPECT_GT(elements, 5000u);
    EXPECT_GT(closed, 100u);
    EXPECT_GT(around, 5u);
}

// A letter changed, left out or doubled: an error with file and line, or another pattern that can be written and read.
TEST(PatternJsonProperty, damaged_text_is_an_error_or_a_pattern) {
    testing::RandomPatternOptions small;
    small.motifs = 2, small.step_loops = 1;
    int refused = 0, taken = 0;
    for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        testing::Random random(seed);
        std::string text = write_pattern_json(testing::perturbed_pattern(seed % 7, small));
        for (int i = 1 + random.below(3); i > 0; --i) {
            const auto at = static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
            const char letters[] = "{}[]\",:.-+eE0123456789MLQZ \n\\tfn\x80\xff";
            switch (random.below(4)) {
                case 0: text[at] = letters[random.below(static_cast<int>(sizeof letters - 1))]; break;
                case 1: text.erase(at, 1); break;
                case 2: text.insert(at, text.substr(at, 12)); break;
                default: text.resize(at); break;
            }
            if (text.empty()) text.push_back('?');
        }
        const auto read = read_pattern_json(text, "damaged.json");
        if (read) {
            const auto again = read_pattern_json(write_pattern_json(*read), "again.json");
            ASSERT_TRUE(again.ok()) << again.error().message;
            testing::expect_equal(*read, *again);
            if (HasFailure()) return;
            ++taken;
        } else {
            ASSERT_EQ(read.error().message.substr(0, 13), "damaged.json:") << read.error().message;
            ++refused;
        }
    }
    EXPECT_GT(refused, 500);
    EXPECT_GT(taken, 100);
}

}  // namespace
}  // namespace burin
