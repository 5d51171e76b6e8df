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

Packed packed(std::uint64_t seed, Wrap wrap) {
    Packed p;
    testing::RandomPatternOptions options;
    options.wrap = wrap;
    if (seed % 3 == 0) options.size = {2.0, 1.0};
    // Every other one is perturbed as well.
    Result<ResolvedPattern> resolved = resolve_pattern(
        seed % 2 == 0 ? testing::perturbed_pattern(seed, options) : testing::random_pattern(seed, options), {.lenient = true});
    EXPECT_TRUE(resolved.ok()) << (resolved.ok() ? "" : resolved.error().message);
    if (!resolved.ok()) return p;
    p.pattern = std::move(*resolved);
    Result<CellGrid> grid = build_grid(p.pattern);
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

// Where the surface is smooth, heights agree to quantization. Quantization moves borders by up to two
// coordinate steps, so points nearer than that to a border are left out; they are counted, so that the test
// cannot starve.
TEST_P(PackProperty, ReaderFromTheSpecificationFindsTheSurface) {
    std::size_t asked = 0, compared = 0, wrong = 0, features = 0;
    for (std::uint64_t seed = 100; seed < 160; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Packed p = packed(seed, GetParam());
        if (!p.ok) continue;
        const SpecificationReader reader = reader_of(p);
        const Truth truth(p.pattern);
        Random random(seed);
        for (int k = 0; k < 1500; ++k) {
            const Vec2 uv = aimed_point(p.pattern, random, k);
            const double u = uv.x, v = uv.y;
            ++asked;
            const SpecificationReader::Answer answer = reader.height_at(u, v);
            // Every point, also those on a border, lies within the bounds of its cell.
            const double slack = 1e-9 * p.pattern.depth;
            EXPECT_TRUE(answer.lowest - slack <= answer.height && answer.height <= answer.highest + slack)
                << "uv (" << u << ", " << v << "): " << answer.height << " outside of " << answer.lowest
                << " to " << answer.highest;
            const double border = 8.0 * std::ldexp(std::max(p.pattern.size.x, p.pattern.size.y), -20);
            const double edge = std::min({std::abs(u), std::abs(v), std::abs(u - 1), std::abs(v - 1)});
            if (answer.clearance < border || edge < 1e-5) continue;
            ++compared;
            const SurfacePoint expected = truth.surface_at({u * p.pattern.size.x, v * p.pattern.size.y});
            if (expected.element != kGround) ++features;
            if (std::abs(answer.height - expected.height) <= 5e-4 * p.pattern.depth) continue;
            if (++wrong <= 10) {
                ADD_FAILURE() << "uv (" << u << ", " << v << "): reader " << answer.height << " on ground "
                              << answer.ground << ", truth " << expected.height << " on ground "
                              << expected.ground;
            }
        }
    }
    EXPECT_GT(compared, asked * 9 / 10);
    EXPECT_GT(features, asked / 5);
    EXPECT_EQ(wrong, 0u) << "of " << compared;
    std::printf("%zu points compared, %zu on features\n", compared, features);
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
