// Patterns with more texels of elements than references of 16 bits can name, and those just below.
#include <cstdio>
#include <random>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <burin/format/validate.hpp>
#include <burin/pack.hpp>

namespace burin {
namespace {

constexpr std::uint32_t kMostNarrow = BURIN_MAX_NARROW_ELEMENT_TEXELS;

using Lists = std::vector<std::vector<std::uint32_t>>;

// `count` short lines of one texel each.
ResolvedPattern lines(std::uint32_t count) {
    ResolvedPattern pattern;
    pattern.materials = {Material{}};
    pattern.profiles = {{{{-0.0002, 0.0}, {0.0, -0.0001}, {0.0002, 0.0}}, 3u}};
    pattern.styles = {{0, 0, 0.0, false}};
    pattern.elements.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        ResolvedElement& e = pattern.elements[i];
        e.element.p0 = {i % 256 / 256.0, i / 256 / 512.0};
        e.element.p2 = e.element.p0 + Vec2{0.002, 0.001};
        e.start = e.end = {Priority::both, BURIN_END_HIP, 0.0};
        e.path = i;
    }
    return pattern;
}

// One row of cells with these lists.
CellGrid grid_of(const Lists& lists) {
    CellGrid grid;
    grid.cols = static_cast<int>(lists.size());
    grid.rows = 1;
    grid.first_ref.push_back(0);
    for (const std::vector<std::uint32_t>& list : lists) {
        grid.refs.insert(grid.refs.end(), list.begin(), list.end());
        grid.first_ref.push_back(static_cast<std::uint32_t>(grid.refs.size()));
    }
    grid.level.assign(lists.size(), 0.0);
    grid.highest = grid.lowest = grid.level;
    grid.skip.assign(lists.size(), 0);
    grid.start = grid.flags = grid.skip;
    return grid;
}

std::set<int> findings(const PackedTextures& textures, const PathDetail& detail) {
    std::set<int> numbers;
    validate_textures(textures, detail, [&numbers](const Issue& issue) { numbers.insert(issue.number); });
    return numbers;
}

struct Packed {
    PackedTextures textures;
    PathDetail detail;
    CellGrid back;  // unpacked again
};

Packed packed(const ResolvedPattern& pattern, const CellGrid& grid) {
    Result<PackedTextures> textures = pack_textures(pattern, grid);
    EXPECT_TRUE(textures.ok()) << (textures.ok() ? "" : textures.error().message);
    if (!textures.ok()) return {};
    const PathDetail detail = describe_pattern(pattern, *textures);
    const Result<UnpackedPattern> back = unpack_textures(*textures, detail);
    EXPECT_TRUE(back.ok()) << (back.ok() ? "" : back.error().message);
    return {std::move(*textures), detail, back.ok() ? back->grid : CellGrid{}};
}

Lists random_lists(std::uint32_t elements, std::mt19937& random) {
    Lists lists(2000);
    for (std::vector<std::uint32_t>& list : lists) {
        // Few places, so that lists are parts of others.
        const std::uint32_t first = random() % 8 * (elements / 8), count = random() % 20, skipped = random() % 20;
        for (std::uint32_t k = random() % 6; k < count; ++k)
            if (k != skipped) list.push_back(first + k);
    }
    lists.push_back({elements - 1});
    return lists;
}

TEST(PackWide, OnBothSidesOfTheBorderEveryListComesBack) {
    const std::uint32_t seed = std::random_device{}();
    std::printf("seed %u\n", seed);
    std::mt19937 random(seed);
    for (const std::uint32_t count : {kMostNarrow, kMostNarrow + 1}) {
        const CellGrid grid = grid_of(random_lists(count, random));
        const Packed p = packed(lines(count), grid);
        EXPECT_EQ(p.textures.sections.wide(), count > kMostNarrow);
        EXPECT_EQ(p.textures.sections.element_texels, count);
        EXPECT_EQ(findings(p.textures, p.detail), std::set<int>{});
        EXPECT_EQ(p.back.refs, grid.refs) << count;
        EXPECT_EQ(p.back.first_ref, grid.first_ref) << count;
        EXPECT_LT(2 * p.textures.sections.references(), grid.refs.size());
    }
}

// Equal lists and those that begin on a texel of another take nothing; others begin on a texel of their own.
TEST(PackWide, ListsAreSharedWhereTheyBeginOnATexel) {
    const std::uint32_t last = kMostNarrow + 9;
    const Lists lists = {{1, 2}, {1, 2, 3, 4, last - 1, last}, {last - 1, last}, {last - 1}, {}, {1, 2}, {2, 3}, {last}};
    const Packed p = packed(lines(last + 1), grid_of(lists));
    const std::vector<std::uint32_t> first = {0, 0, 1, 1, 0, 0, 2, 3};
    for (std::uint32_t k = 0; k < first.size(); ++k) EXPECT_EQ(unpack_cell(cell_texel(p.textures, k)).first_reference, first[k]) << k;
    const std::vector<std::uint32_t> words = {1, 2, 3, 4, last - 1, last, 0, 0, 2, 3, 0, 0, last, 0, 0, 0};
    ASSERT_EQ(p.textures.sections.references(), words.size());
    for (std::uint32_t k = 0; k < words.size(); ++k) EXPECT_EQ(list_reference(p.textures, k), words[k]) << k;
}

TEST(PackWide, DamagedListsAreFound) {
    const std::uint32_t last = kMostNarrow;
    const Packed whole = packed(lines(last + 1), grid_of({{1, 2, 3, 4, last - 1, last}, {7, 9}}));
    const auto after = [&whole](const auto& change) {
        PackedTextures textures = whole.textures;
        const auto word = [&textures](std::uint32_t k) -> std::uint32_t& { return textures.data[std::size_t{4} * textures.sections.lists_begin() + k]; };
        change(textures, word);
        return findings(textures, whole.detail);
    };
    EXPECT_EQ(after([](auto&, auto&&) {}), std::set<int>{});
    EXPECT_EQ(after([](auto&, auto&& word) { word(6) = 5; }), std::set<int>{4052});   // fills the first list's last texel
    EXPECT_EQ(after([](auto&, auto&& word) { word(11) = 1u << 31; }), std::set<int>{4052});
    EXPECT_EQ(after([](auto&, auto&& word) { word(5) = 6; }), std::set<int>{4051});
    EXPECT_EQ(after([](auto&, auto&& word) { word(5) += 1; }), std::set<int>{4050});  // behind the last element
    EXPECT_EQ(after([](auto&, auto&& word) { word(5) = 0xffffffffu; }), std::set<int>{4050});
    // Two references from the last texel on are there, five are not; nor is any from the texel behind it.
    const auto cell = [](std::uint32_t first, std::uint32_t count) {
        return [first, count](PackedTextures& t, auto&&) {
            CellCode code = unpack_cell(cell_texel(t, 1));
            code.first_reference = first;
            code.count = count;
            const CellTexel texel = pack_cell(code);
            t.grid[2] = texel[0];
        };
    };
    EXPECT_EQ(after(cell(2, 2)), std::set<int>{});
    EXPECT_EQ(after(cell(2, 5)), (std::set<int>{3001, 4052}));
    EXPECT_EQ(after(cell(3, 2)), (std::set<int>{3001, 4052}));
    EXPECT_EQ(after(cell((1u << BURIN_CELL_FIRST_BITS) - 1, 63)), (std::set<int>{3001, 4052}));
}

// As few elements as may be: each takes three texels.
TEST(PackWide, TooManyElementsAreNamed) {
    const std::uint32_t fitting = BURIN_MAX_ELEMENT_TEXELS / 3;
    ResolvedPattern pattern = lines(fitting + 1);
    pattern.functions.push_back({});
    for (ResolvedElement& e : pattern.elements) {
        e.element.p0 = {0.1, 0.1}, e.element.p2 = {0.2, 0.1};
        e.element.width0 = 0.5;
        e.function = 0;
    }
    const Result<PackedTextures> textures = pack_textures(pattern, grid_of({{}}));
    ASSERT_FALSE(textures.ok());
    EXPECT_EQ(textures.error().code, ErrorCode::limit_exceeded);
    const std::string number = std::to_string(fitting);
    EXPECT_EQ(textures.error().message, "element " + number + " of " + std::to_string(fitting + 1) + " ends beyond texel 4194304, the limit; the first " +
                                            number + " would fit, and a larger error or a smaller tile would need fewer");
}

}  // namespace
}  // namespace burin
