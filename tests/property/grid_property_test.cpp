// The grid against brute force: nothing that acts is missing from a cell's list, little is listed in vain,
// bounds hold, ground follows from the cell alone, and threads change nothing. Patterns at random; a failure
// names the seed.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include <burin/evaluate.hpp>
#include <burin/grid.hpp>

#include "layout.h"
#include "perturbed.hpp"
#include "random_pattern.hpp"

namespace burin {
namespace {

using testing::Random;

constexpr double kMargin = 0.0625;

ResolvedPattern resolved(std::uint64_t seed, Wrap wrap) {
    testing::RandomPatternOptions options;
    options.wrap = wrap;
    if (seed % 3 == 0) options.size = {2.0, 1.0};
    // Every third is perturbed as well.
    const Pattern pattern = seed % 3 == 1 ? testing::perturbed_pattern(seed, options) : testing::random_pattern(seed, options);
    Result<ResolvedPattern> result = resolve_pattern(pattern, {.lenient = true});
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return result.ok() ? *result : ResolvedPattern{};
}

struct Cell {
    int col, row;
    std::size_t index;
    Vec2 centre, side;
};

Cell cell_of(const ResolvedPattern& pattern, const CellGrid& grid, int col, int row) {
    const Vec2 side = {pattern.size.x / grid.cols, pattern.size.y / grid.rows};
    return {
        col,
        row,
        static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.cols) + static_cast<std::size_t>(col),
        {(col + 0.5) * side.x, (row + 0.5) * side.y},
        side};
}

// What a decoder knows in a cell: the listed elements, each the one copy that grid.hpp names, and nothing
// else.
ResolvedPattern decoded(const ResolvedPattern& pattern, const CellGrid& grid, const Cell& cell) {
    ResolvedPattern local = pattern;
    local.wrap = Wrap::clamp;
    local.elements.clear();
    local.outer_level = grid.level[cell.index];
    // The margin of a cell on the border reaches over it; clamping would cut it, so everything moves one tile
    // in.
    const Vec2 in = pattern.wrap == Wrap::repeat ? pattern.size : Vec2{0.0, 0.0};
    if (pattern.wrap == Wrap::repeat) local.size = pattern.size * 3.0;
    for (std::uint32_t i = grid.first_ref[cell.index]; i < grid.first_ref[cell.index + 1]; ++i) {
        ResolvedElement element = pattern.elements[grid.refs[i]];
        Vec2 by = in;
        if (pattern.wrap == Wrap::repeat) {
            const Vec2 middle = lerp(element.element.p0, element.element.p2, 0.5);
            by.x += pattern.size.x * std::floor((cell.centre.x - middle.x) / pattern.size.x + 0.5);
            by.y += pattern.size.y * std::floor((cell.centre.y - middle.y) / pattern.size.y + 0.5);
        }
        element.element.p0 = element.element.p0 + by;
        element.element.p1 = element.element.p1 + by;
        element.element.p2 = element.element.p2 + by;
        local.elements.push_back(element);
    }
    return local;
}

Vec2 arc_point(const Element& e, double s) {
    return e.kind == ElementKind::line ? lerp(e.p0, e.p2, s)
                                       : lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s);
}

std::vector<std::uint32_t> all_of(const ResolvedPattern& pattern) {
    std::vector<std::uint32_t> all(pattern.elements.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    return all;
}

// The rule of grid.hpp: the step whose arc is crossed last on the way from the centre to p gives the level.
// Arcs are followed in small chords, which is why points next to an arc are not asked.
double ground_by_way(const ResolvedPattern& local, Vec2 p, Vec2 centre, double level) {
    double last = -1.0;
    for (const ResolvedElement& e : local.elements) {
        const Style& style = local.styles[e.style];
        if (!style.step) continue;
        const auto& points = local.profiles[style.profile].points;
        const double right = style.level + (points.back().h - points.front().h) * e.element.height0;
        constexpr int kChords = 512;
        const int chords = e.element.kind == ElementKind::line ? 1 : kChords;
        for (int i = 0; i < chords; ++i) {
            const Vec2 a = arc_point(e.element, static_cast<double>(i) / chords),
                       b = arc_point(e.element, (i + 1.0) / chords);
            const double det = cross(p - centre, b - a);
            if (det == 0.0) continue;
            const double t = cross(a - centre, b - a) / det, u = cross(a - centre, p - centre) / det;
            if (t < 0.0 || t > 1.0 || u < 0.0 || u > 1.0 || t < last) continue;
            last = t;
            level = cross(b - a, p - a) < 0.0 ? style.level : right;
        }
    }
    return level;
}

bool is_near_step(const Truth& truth, Vec2 p, double ground) {
    constexpr double kNear = 2e-6;
    for (const Vec2 d : {Vec2{kNear, 0.0}, Vec2{-kNear, 0.0}, Vec2{0.0, kNear}, Vec2{0.0, -kNear}})
        if (truth.ground_at(p + d) != ground) return true;
    return false;
}

// Random points of a cell's margin rectangle.
void check_cell(const ResolvedPattern& pattern, const Truth& truth, const CellGrid& grid, const Cell& cell,
                Random& random, int points) {
    const ResolvedPattern local = decoded(pattern, grid, cell);
    const Truth cell_truth(local);
    const std::vector<std::uint32_t> listed = all_of(local);
    const Vec2 in = pattern.wrap == Wrap::repeat ? pattern.size : Vec2{0.0, 0.0};
    const double slack = 1e-9 * pattern.depth;
    const Vec2 away = cell_start(grid.start[cell.index]);
    const Vec2 start = cell.centre + Vec2{away.x * cell.side.x, away.y * cell.side.y};
    for (int i = 0; i < points; ++i) {
        const double reach = 0.5 + kMargin;
        const Vec2 p = cell.centre + Vec2{random.between(-reach, reach) * cell.side.x,
                                          random.between(-reach, reach) * cell.side.y};
        if (pattern.wrap == Wrap::clamp &&
            (p.x <= 0.0 || p.y <= 0.0 || p.x >= pattern.size.x || p.y >= pattern.size.y))
            continue;
        const SurfacePoint whole = truth.surface_at(p);
        const SurfacePoint here = cell_truth.surface_at(p + in, listed, whole.ground);
        EXPECT_NEAR(here.height, whole.height, slack)
            << "at (" << p.x << ", " << p.y << "), cell (" << cell.col << ", " << cell.row << ")";
        EXPECT_LE(whole.height, grid.highest[cell.index] + slack);
        EXPECT_GE(whole.height, grid.lowest[cell.index] - slack);
        if (is_near_step(truth, p, whole.ground)) continue;
        const bool step = (grid.flags[cell.index] & BURIN_CELL_FLAG_STEP) != 0;
        EXPECT_NEAR(step ? ground_by_way(local, p + in, start + in, grid.level[cell.index])
                         : grid.level[cell.index],
                    whole.ground, slack)
            << "ground at (" << p.x << ", " << p.y << "), cell (" << cell.col << ", " << cell.row << ")";
    }
}

void check_pattern(std::uint64_t seed, Wrap wrap, double cell_size) {
    SCOPED_TRACE("seed " + std::to_string(seed) + (wrap == Wrap::repeat ? ", repeat" : ", clamp") +
                 ", cell size " + std::to_string(cell_size));
    const ResolvedPattern pattern = resolved(seed, wrap);
    const Result<CellGrid> built = build_grid(pattern, {.cell_size = cell_size, .margin = kMargin});
    ASSERT_TRUE(built.ok()) << built.error().message;
    const CellGrid& grid = *built;
    const Truth truth(pattern);
    Random random(seed + 77);
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const Cell cell = cell_of(pattern, grid, col, row);
            const bool empty = grid.first_ref[cell.index] == grid.first_ref[cell.index + 1];
            check_cell(pattern, truth, grid, cell, random, empty ? 1 : 6);
            if (::testing::Test::HasFailure()) return;
        }
}

TEST(GridProperty, ListsEverythingThatActsAndBoundsIt) {
    const double sizes[] = {0.0, 0.012, 0.05};
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        check_pattern(seed, seed % 4 == 3 ? Wrap::clamp : Wrap::repeat, sizes[seed % 3]);
        if (HasFailure()) return;
    }
}

// Whether an element acts anywhere in a rectangle, asked on a lattice of points; the element is alone and its
// ground is that of its own side.
bool acts_in(const ResolvedPattern& pattern, std::uint32_t e, Vec2 low, Vec2 high) {
    ResolvedPattern alone = pattern;
    alone.elements = {pattern.elements[e]};
    const Truth truth(alone);
    constexpr int kPoints = 24;
    const std::vector<std::uint32_t> only{0};
    for (int i = 0; i <= kPoints; ++i)
        for (int k = 0; k <= kPoints; ++k) {
            const Vec2 p{low.x + (high.x - low.x) * i / kPoints, low.y + (high.y - low.y) * k / kPoints};
            // A step is looked for on both sides; a groove on its own level.
            const double left = pattern.styles[alone.elements[0].style].level;
            const auto& points = pattern.profiles[pattern.styles[alone.elements[0].style].profile].points;
            const double right =
                left + (points.back().h - points.front().h) * alone.elements[0].element.height0;
            for (const double ground : {left, right})
                if (truth.surface_at(p, only, ground).element != kGround) return true;
        }
    return false;
}

TEST(GridProperty, ListsLittleInVain) {
    int listed = 0, in_vain = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const ResolvedPattern pattern = resolved(seed, Wrap::repeat);
        const Result<CellGrid> grid = build_grid(pattern, {.margin = kMargin});
        ASSERT_TRUE(grid.ok());
        Random random(seed);
        for (int i = 0; i < 150; ++i) {
            const Cell cell = cell_of(pattern, *grid, random.below(grid->cols), random.below(grid->rows));
            const Vec2 reach = cell.side * (0.5 + kMargin);
            for (std::uint32_t k = grid->first_ref[cell.index]; k < grid->first_ref[cell.index + 1]; ++k) {
                const ResolvedElement& e = pattern.elements[grid->refs[k]];
                // A plain wall has no width: nothing acts, but its line must be listed.
                if (pattern.styles[e.style].step) continue;
                ++listed;
                if (!acts_in(pattern, grid->refs[k], cell.centre - reach, cell.centre + reach)) ++in_vain;
            }
        }
    }
    // The lattice misses strips that only graze a corner, and flat parts of profiles count as not acting.
    EXPECT_GT(listed, 400);
    RecordProperty("listed", listed);
    RecordProperty("in_vain", in_vain);
    EXPECT_LT(in_vain, listed / 20) << listed << " listed";
}

bool equal_grids(const CellGrid& a, const CellGrid& b) {
    return a.cols == b.cols && a.rows == b.rows && a.first_ref == b.first_ref && a.refs == b.refs &&
           a.level == b.level && a.highest == b.highest && a.lowest == b.lowest && a.skip == b.skip &&
           a.start == b.start && a.flags == b.flags;
}

TEST(GridProperty, ThreadsChangeNothing) {
    testing::RandomPatternOptions options;
    options.motifs = 400;
    const Result<ResolvedPattern> pattern =
        resolve_pattern(testing::random_pattern(5, options), {.lenient = true});
    ASSERT_TRUE(pattern.ok());
    ASSERT_GT(pattern->elements.size(), 512u);
    const Result<CellGrid> one = build_grid(*pattern, {.threads = 1}),
                           two = build_grid(*pattern, {.threads = 2}),
                           many = build_grid(*pattern, {.threads = 7});
    ASSERT_TRUE(one.ok() && two.ok() && many.ok()) << (one.ok() ? "" : one.error().message);
    EXPECT_TRUE(equal_grids(*one, *two));
    EXPECT_TRUE(equal_grids(*one, *many));
}

// A ray that starts anywhere in a cell may pass the whole square around it.
TEST(GridProperty, SkippedSquaresAreEmptyAndLevel) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const bool repeats = seed % 2 == 0;
        const ResolvedPattern pattern = resolved(seed, repeats ? Wrap::repeat : Wrap::clamp);
        const Result<CellGrid> grid = build_grid(pattern, {.cell_size = 0.02});
        ASSERT_TRUE(grid.ok());
        int longest = 0;
        for (int row = 0; row < grid->rows; ++row)
            for (int col = 0; col < grid->cols; ++col) {
                const std::size_t k = static_cast<std::size_t>(row * grid->cols + col);
                const int skip = grid->skip[k];
                longest = std::max(longest, skip);
                for (int dy = -skip; dy <= skip; ++dy)
                    for (int dx = -skip; dx <= skip; ++dx) {
                        const int x = col + dx, y = row + dy;
                        const bool out = x < 0 || y < 0 || x >= grid->cols || y >= grid->rows;
                        ASSERT_TRUE(repeats || !out);
                        const std::size_t n = static_cast<std::size_t>(
                            (y + grid->rows) % grid->rows * grid->cols + (x + grid->cols) % grid->cols);
                        if (skip > 0) {
                            ASSERT_EQ(grid->first_ref[n], grid->first_ref[n + 1]);
                            ASSERT_EQ(grid->level[n], grid->level[k]);
                        }
                    }
            }
        EXPECT_GT(longest, 1);
    }
}

}  // namespace
}  // namespace burin
