// Random patterns through resolve, grid and pack: the textures are valid, and a reader written from the
// specification alone finds in their bytes the surface that the truth finds in the pattern.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include <burin/evaluate.hpp>
#include <burin/format/validate.hpp>
#include <burin/pack.hpp>

#include "perturbed.hpp"
#include "random_pattern.hpp"
#include "specification_reader.hpp"
#include "wide_pattern.hpp"

namespace burin {
namespace {

using testing::Random;
using testing::SpecificationReader;

struct Packed {
    bool ok = false;
    ResolvedPattern pattern;
    CellGrid grid;
    PackedTextures textures;
    PathDetail detail;
};

Packed packed(const Pattern& pattern, int threads = 0) {
    Packed p;
    Result<ResolvedPattern> resolved = resolve_pattern(pattern, {.lenient = true});
    EXPECT_TRUE(resolved.ok()) << (resolved.ok() ? "" : resolved.error().message);
    if (!resolved.ok()) return p;
    p.pattern = std::move(*resolved);
    Result<CellGrid> grid = build_grid(p.pattern, {.threads = threads});
    EXPECT_TRUE(grid.ok()) << (grid.ok() ? "" : grid.error().message);
    if (!grid.ok()) return p;
    p.grid = std::move(*grid);
    Result<PackedTextures> textures = pack_textures(p.pattern, p.grid);
    EXPECT_TRUE(textures.ok()) << (textures.ok() ? "" : textures.error().message);
    if (!textures.ok()) return p;
    p.textures = std::move(*textures);
    p.detail = describe_pattern(p.pattern, p.textures);
    p.ok = true;
    return p;
}

Packed packed(std::uint64_t seed, Wrap wrap) {
    testing::RandomPatternOptions options;
    options.wrap = wrap;
    if (seed % 3 == 0) options.size = {2.0, 1.0};
    // Every other one is perturbed as well.
    return packed(seed % 2 == 0 ? testing::perturbed_pattern(seed, options) : testing::random_pattern(seed, options));
}

SpecificationReader reader_of(const Packed& p) {
    SpecificationReader::Properties q;
    q.size[0] = p.detail.size_u;
    q.size[1] = p.detail.size_v;
    q.depth = p.detail.depth;
    q.base_offset = p.detail.base_offset;
    q.outer_level = p.detail.outer_level;
    q.repeat = p.detail.repeat;
    q.grid_width = p.detail.grid_width;
    q.grid_height = p.detail.grid_height;
    q.elements = p.detail.sections.element_texels;
    q.styles = p.detail.sections.style_texels;
    q.profiles = p.detail.sections.profile_texels;
    q.materials = p.detail.sections.material_texels;
    q.lists = p.detail.sections.list_texels;
    return {q, bytes_from_words(p.textures.grid), bytes_from_words(p.textures.data)};
}

// A point anywhere in and around the tile, or, every other time, near an element: half of those near one of
// its ends.
Vec2 aimed_point(const ResolvedPattern& pattern, Random& random, int turn) {
    if (turn % 2 == 0) return {random.between(-0.2, 1.2), random.between(-0.2, 1.2)};
    const Element& e =
        pattern.elements[static_cast<std::size_t>(random.below(static_cast<int>(pattern.elements.size())))]
            .element;
    const double s = turn % 4 == 1 ? random.uniform() : std::floor(random.uniform() + 0.5);
    const Vec2 middle = e.kind == ElementKind::line ? lerp(e.p0, e.p2, 0.5) : e.p1;
    const Vec2 on = lerp(lerp(e.p0, middle, s), lerp(middle, e.p2, s), s) +
                    random.direction() * random.between(0.0, 0.03);
    return {on.x / pattern.size.x, on.y / pattern.size.y};
}

class PackProperty : public ::testing::TestWithParam<Wrap> {};

TEST_P(PackProperty, TexturesAreValid) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Packed p = packed(seed, GetParam());
        if (!p.ok) continue;
        validate_textures(p.textures, p.detail, [](const Issue& issue) {
            ADD_FAILURE() << issue.number << " " << issue.pointer << ": " << issue.message;
        });
    }
}

struct Compared {
    std::size_t asked = 0, compared = 0, wrong = 0, features = 0;
};

// Where the surface is smooth, heights agree to quantization. Quantization moves borders by up to two
// coordinate steps, so points nearer than that to a border are left out; they are counted, so that the test
// cannot starve.
void compare_heights(const Packed& p, const ResolvedPattern& expected_of, std::uint64_t seed, int points, Compared& counts) {
    const SpecificationReader reader = reader_of(p);
    const Truth truth(expected_of);
    Random random(seed);
    for (int k = 0; k < points; ++k) {
        const Vec2 uv = aimed_point(p.pattern, random, k);
        const double u = uv.x, v = uv.y;
        ++counts.asked;
        const SpecificationReader::Answer answer = reader.height_at(u, v);
        // Every point, also those on a border, lies within the bounds of its cell.
        const double slack = 1e-9 * p.pattern.depth;
        EXPECT_TRUE(answer.lowest - slack <= answer.height && answer.height <= answer.highest + slack)
            << "uv (" << u << ", " << v << "): " << answer.height << " outside of " << answer.lowest
            << " to " << answer.highest;
        const double border = 8.0 * std::ldexp(std::max(p.pattern.size.x, p.pattern.size.y), -20);
        const double edge = std::min({std::abs(u), std::abs(v), std::abs(u - 1), std::abs(v - 1)});
        if (answer.clearance < border || edge < 1e-5) continue;
        ++counts.compared;
        const SurfacePoint expected = truth.surface_at({u * p.pattern.size.x, v * p.pattern.size.y});
        if (expected.element != kGround) ++counts.features;
        if (std::abs(answer.height - expected.height) <= 5e-4 * p.pattern.depth) continue;
        if (++counts.wrong <= 10) {
            ADD_FAILURE() << "uv (" << u << ", " << v << "): reader " << answer.height << " on ground "
                          << answer.ground << ", truth " << expected.height << " on ground "
                          << expected.ground;
        }
    }
}

TEST_P(PackProperty, ReaderFromTheSpecificationFindsTheSurface) {
    Compared counts;
    for (std::uint64_t seed = 100; seed < 160; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Packed p = packed(seed, GetParam());
        if (p.ok) compare_heights(p, p.pattern, seed, 1500, counts);
    }
    EXPECT_GT(counts.compared, counts.asked * 9 / 10);
    EXPECT_GT(counts.features, counts.asked / 5);
    EXPECT_EQ(counts.wrong, 0u) << "of " << counts.compared;
    std::printf("%zu points compared, %zu on features\n", counts.compared, counts.features);
}

// References of 32 bits: the same bytes for any number of threads, valid, and the surface is the pattern's.
TEST(PackWide, ReaderFromTheSpecificationFindsTheSurface) {
    constexpr std::uint64_t kSeed = 70000;
    const Pattern pattern = testing::wide_pattern(kSeed);
    const Packed one = packed(pattern, 1), four = packed(pattern, 4);
    ASSERT_TRUE(one.ok && four.ok);
    EXPECT_GT(one.detail.sections.element_texels, 70000u);
    EXPECT_TRUE(one.textures.grid == four.textures.grid && one.textures.data == four.textures.data);
    validate_textures(one.textures, one.detail, [](const Issue& issue) {
        ADD_FAILURE() << issue.number << " " << issue.pointer << ": " << issue.message;
    });
    const Result<UnpackedPattern> stored = unpack_textures(one.textures, one.detail);
    ASSERT_TRUE(stored.ok()) << stored.error().message;
    EXPECT_EQ(stored->grid.refs, one.grid.refs);
    // What the grid reckons with is what is stored, but for lists that are shared.
    const std::size_t stored_bytes = 4 * one.textures.grid.size() + 16 * std::size_t{one.detail.sections.list_texels};
    EXPECT_GE(grid_bytes(one.grid, true), stored_bytes);
    EXPECT_LT(grid_bytes(one.grid, true), stored_bytes * 2);
    // The scratches are so fine that a step of a coordinate is seen in their flanks: they are asked where they are stored.
    Compared counts;
    compare_heights(one, stored->pattern, kSeed, 2000, counts);
    EXPECT_EQ(counts.wrong, 0u) << "seed " << kSeed << ", of " << counts.compared;
    EXPECT_GT(counts.features, counts.asked / 20);
    std::printf("%zu points of %zu compared, %zu on features\n", counts.compared, counts.asked, counts.features);
}

// A groove around the tile is a loop of two elements; the one that crosses it makes the cell a special one.
TEST(Pack, LoopAroundTheTileDoesNotHideACrossing) {
    Pattern pattern;
    pattern.profiles.push_back({{{-0.01, 0.0}, {0.0, -0.005}, {0.01, 0.0}}, {}});
    Path loop, crossing;
    Element e;
    e.p0 = {0.1, 0.5}, e.p2 = {0.6, 0.5};
    loop.elements.push_back(e);
    e.p0 = {0.6, 0.5}, e.p2 = {1.1, 0.5};
    loop.elements.push_back(e);
    loop.closed = true;
    e.p0 = {0.12, 0.3}, e.p2 = {0.13, 0.7};
    crossing.elements.push_back(e);
    pattern.paths = {loop, crossing};
    const Result<ResolvedPattern> resolved = resolve_pattern(pattern);
    ASSERT_TRUE(resolved.ok()) << resolved.error().message;
    for (const double side : {0.03, 0.06, 0.1, 0.2}) {
        GridOptions options;
        options.cell_size = side;
        const Result<CellGrid> grid = build_grid(*resolved, options);
        ASSERT_TRUE(grid.ok()) << grid.error().message;
        const Result<PackedTextures> textures = pack_textures(*resolved, *grid);
        ASSERT_TRUE(textures.ok()) << textures.error().message;
        validate_textures(*textures, describe_pattern(*resolved, *textures), [side](const Issue& issue) {
            ADD_FAILURE() << "cells of " << side << ": " << issue.number << " " << issue.pointer << ": "
                          << issue.message;
        });
    }
}

INSTANTIATE_TEST_SUITE_P(Wraps, PackProperty, ::testing::Values(Wrap::repeat, Wrap::clamp));

}  // namespace
}  // namespace burin
