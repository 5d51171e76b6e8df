// The grid on patterns small enough to know every cell.
#include <gtest/gtest.h>

#include <burin/evaluate.hpp>
#include <burin/grid.hpp>

#include "layout.h"

namespace burin {
namespace {

Element line(Vec2 a, Vec2 b) {
    Element e;
    e.p0 = a;
    e.p2 = b;
    return e;
}

Path stroke(Vec2 a, Vec2 b, std::uint32_t profile = 0) {
    Path path;
    path.elements = {line(a, b)};
    path.profile = profile;
    return path;
}

Path plate(double low, double high) {
    Path path;
    path.elements = {line({low, low}, {high, low}), line({high, low}, {high, high}),
                     line({high, high}, {low, high}), line({low, high}, {low, low})};
    path.closed = true;
    path.profile = 1;
    return path;
}

// Profile 0: trapezium groove, half-width 0.01, 0.003 deep. Profile 1: bevel down by 0.002 over 0.01.
ResolvedPattern pattern_of(const std::vector<Path>& paths, Wrap wrap = Wrap::repeat) {
    Pattern pattern;
    pattern.wrap = wrap;
    pattern.base_offset = 0.002;
    pattern.profiles = {{{{-0.01, 0}, {-0.004, -0.003}, {0.004, -0.003}, {0.01, 0}}, {}},
                        {{{-0.005, 0}, {0.005, -0.002}}, {}}};
    pattern.paths = paths;
    Result<ResolvedPattern> resolved = resolve_pattern(pattern);
    EXPECT_TRUE(resolved.ok()) << (resolved.ok() ? "" : resolved.error().message);
    return resolved.ok() ? *resolved : ResolvedPattern{};
}

CellGrid grid_of(const ResolvedPattern& pattern, const GridOptions& options = {}) {
    Result<CellGrid> grid = build_grid(pattern, options);
    EXPECT_TRUE(grid.ok()) << (grid.ok() ? "" : grid.error().message);
    return grid.ok() ? *grid : CellGrid{};
}

std::size_t at(const CellGrid& grid, int col, int row) {
    return static_cast<std::size_t>(row * grid.cols + col);
}
std::uint32_t listed(const CellGrid& grid, int col, int row) {
    return grid.first_ref[at(grid, col, row) + 1] - grid.first_ref[at(grid, col, row)];
}

TEST(Grid, EmptyPatternIsOneEmptyCell) {
    const CellGrid grid = grid_of(pattern_of({}));
    EXPECT_EQ(grid.cols, 1);
    EXPECT_EQ(grid.rows, 1);
    EXPECT_TRUE(grid.refs.empty());
    EXPECT_EQ(grid.level[0], 0.0);
    EXPECT_EQ(grid.highest[0], 0.0);
    EXPECT_EQ(grid.lowest[0], 0.0);
    EXPECT_EQ(grid.flags[0], BURIN_CELL_FLAG_ISOLATED);
}

TEST(Grid, ListsExactlyTheRowsAGrooveReaches) {
    // Rows of 0.1; the groove spans y in [0.54, 0.56], within row 5 and far from its margin of 0.1 cell.
    const CellGrid grid =
        grid_of(pattern_of({stroke({0.25, 0.55}, {0.65, 0.55})}), {.cell_size = 0.1, .margin = 0.1});
    ASSERT_EQ(grid.cols, 10);
    ASSERT_EQ(grid.rows, 10);
    for (int row = 0; row < 10; ++row)
        for (int col = 0; col < 10; ++col) {
            const bool reached = row == 5 && col >= 2 && col <= 6;
            EXPECT_EQ(listed(grid, col, row), reached ? 1u : 0u) << col << ", " << row;
            EXPECT_EQ(grid.lowest[at(grid, col, row)], reached ? -0.003 : 0.0);
            EXPECT_EQ(grid.highest[at(grid, col, row)], 0.0);
        }
}

TEST(Grid, TheMarginReachesOver) {
    // The groove's edge at y = 0.505 lies 0.005 beyond the row below: within a margin of 0.1 cell, not of
    // 0.01 cell.
    const ResolvedPattern pattern = pattern_of({stroke({0.25, 0.515}, {0.65, 0.515})});
    EXPECT_EQ(listed(grid_of(pattern, {.cell_size = 0.1, .margin = 0.1}), 4, 4), 1u);
    EXPECT_EQ(listed(grid_of(pattern, {.cell_size = 0.1, .margin = 0.01}), 4, 4), 0u);
}

TEST(Grid, CellsAtTheBorderListWhatReachesAroundTheTile) {
    const CellGrid grid = grid_of(pattern_of({stroke({0.55, 0.995}, {0.65, 0.995})}), {.cell_size = 0.1});
    EXPECT_EQ(listed(grid, 5, 9), 1u);
    EXPECT_EQ(listed(grid, 5, 0), 1u);
    const CellGrid clamped =
        grid_of(pattern_of({stroke({0.55, 0.995}, {0.65, 0.995})}, Wrap::clamp), {.cell_size = 0.1});
    EXPECT_EQ(listed(clamped, 5, 9), 1u);
    EXPECT_EQ(listed(clamped, 5, 0), 0u);
}

TEST(Grid, LevelAndStepFlagFollowThePlate) {
    const CellGrid grid = grid_of(pattern_of({plate(0.33, 0.67)}), {.cell_size = 0.1});
    EXPECT_EQ(grid.level[at(grid, 1, 1)], 0.0);
    EXPECT_EQ(grid.level[at(grid, 5, 5)], -0.002);
    EXPECT_EQ(grid.flags[at(grid, 5, 5)] & BURIN_CELL_FLAG_STEP, 0u);
    EXPECT_NE(grid.flags[at(grid, 5, 3)] & BURIN_CELL_FLAG_STEP, 0u);
    const double start = 0.35 + 0.1 * cell_start(grid.start[at(grid, 5, 3)]).y;
    EXPECT_EQ(grid.level[at(grid, 5, 3)], start > 0.33 ? -0.002 : 0.0);
    EXPECT_EQ(grid.lowest[at(grid, 5, 3)], -0.002);
    EXPECT_EQ(grid.highest[at(grid, 5, 3)], 0.0);
}

TEST(Grid, TheWalkStartsClearOfSteps) {
    // Cells of 0.1 have their centres on the plate's edges.
    const CellGrid grid = grid_of(pattern_of({plate(0.35, 0.65)}), {.cell_size = 0.1});
    ASSERT_EQ(grid.cols, 10);
    for (int row = 0; row < grid.rows; ++row)
        for (int col = 0; col < grid.cols; ++col) {
            const std::size_t k = at(grid, col, row);
            const Vec2 away = cell_start(grid.start[k]);
            const Vec2 c{(col + 0.5 + away.x) / grid.cols, (row + 0.5 + away.y) / grid.rows};
            EXPECT_TRUE(std::abs(away.x) < 0.5 && std::abs(away.y) < 0.5);
            const bool inside = c.x > 0.35 && c.x < 0.65 && c.y > 0.35 && c.y < 0.65;
            EXPECT_NEAR(grid.level[k], inside ? -0.002 : 0.0, 1e-15);
            if ((grid.flags[k] & BURIN_CELL_FLAG_STEP) == 0) continue;
            EXPECT_NE(grid.start[k], 0);
            for (const double edge : {0.35, 0.65})
                EXPECT_GT(std::min(std::abs(c.x - edge), std::abs(c.y - edge)), 0.002);
        }
}

TEST(Grid, IsolatedMeansOneSmoothChain) {
    Path bent = stroke({0.25, 0.55}, {0.45, 0.55});
    bent.elements.push_back(line({0.45, 0.55}, {0.85, 0.558}));
    const CellGrid grid = grid_of(pattern_of({bent, stroke({0.75, 0.3}, {0.75, 0.8})}), {.cell_size = 0.1});
    const auto isolated = [&](int col, int row) {
        return (grid.flags[at(grid, col, row)] & BURIN_CELL_FLAG_ISOLATED) != 0;
    };
    EXPECT_TRUE(isolated(0, 0));  // nothing
    EXPECT_TRUE(isolated(3, 5));  // one element
    EXPECT_EQ(listed(grid, 4, 5), 2u);
    EXPECT_TRUE(isolated(4, 5));   // the joint
    EXPECT_FALSE(isolated(2, 5));  // the cap
    EXPECT_FALSE(isolated(7, 5));  // the crossing
}

TEST(Grid, SkipIsTheFreeSquare) {
    const CellGrid grid = grid_of(pattern_of({stroke({0.51, 0.55}, {0.59, 0.55})}), {.cell_size = 0.1});
    ASSERT_EQ(grid.cols, 10);
    EXPECT_EQ(grid.skip[at(grid, 5, 5)], 0);
    EXPECT_EQ(grid.skip[at(grid, 5, 1)], 3);
    EXPECT_EQ(grid.skip[at(grid, 0, 0)], 4);  // around the tile nothing is farther than this
    const CellGrid clamped =
        grid_of(pattern_of({stroke({0.51, 0.55}, {0.59, 0.55})}, Wrap::clamp), {.cell_size = 0.1});
    EXPECT_EQ(clamped.skip[at(clamped, 0, 0)], 0);
    EXPECT_EQ(clamped.skip[at(clamped, 2, 2)], 2);
}

TEST(Grid, CostModelStaysNearTheFeatureWidth) {
    std::vector<Path> paths;
    for (int i = 0; i < 12; ++i) paths.push_back(stroke({0.1, 0.04 + 0.08 * i}, {0.9, 0.04 + 0.08 * i}));
    const ResolvedPattern pattern = pattern_of(paths);
    const CellGrid grid = grid_of(pattern);
    const double cell = 1.0 / grid.cols;
    EXPECT_GE(cell, 0.02);
    EXPECT_LE(cell, 0.1);
    EXPECT_GT(grid_bytes(grid), 3000u);
}

TEST(Grid, BudgetIsKept) {
    std::vector<Path> even, crowded;
    for (int i = 0; i < 12; ++i) even.push_back(stroke({0.1, 0.04 + 0.08 * i}, {0.9, 0.04 + 0.08 * i}));
    for (int i = 0; i < 9; ++i)
        for (int k = 0; k < 12; ++k)
            crowded.push_back(
                stroke({0.31 + 0.03 * i, 0.33 + 0.03 * k}, {0.325 + 0.03 * i, 0.33 + 0.03 * k}));
    for (const auto& paths : {even, crowded})
        for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
            const ResolvedPattern pattern = pattern_of(paths, wrap);
            const std::size_t free = grid_bytes(grid_of(pattern));
            std::size_t before = free + 1;
            for (std::size_t budget = free; budget > free / 4 && budget > 900; budget = budget * 9 / 10) {
                const std::size_t bytes = grid_bytes(grid_of(pattern, {.max_bytes = budget}));
                EXPECT_LE(bytes, budget) << paths.size() << " paths";
                EXPECT_LE(bytes, before);
                before = bytes;
            }
        }
}

// 63 elements in a cell at most: a budget below that is missed, and not by more than it must be.
TEST(Grid, BudgetThatCannotBeKept) {
    std::vector<Path> paths;
    for (int i = 0; i < 10; ++i)
        for (int k = 0; k < 10; ++k)
            paths.push_back(stroke({0.05 + 0.1 * i, 0.03 + 0.1 * k}, {0.05 + 0.1 * i, 0.06 + 0.1 * k}));
    const ResolvedPattern pattern = pattern_of(paths, Wrap::clamp);
    const CellGrid grid = grid_of(pattern, {.max_bytes = 1});
    EXPECT_GE(grid_bytes(grid), 8u * 4 + 2u * 100);
    EXPECT_LE(grid_bytes(grid), 8u * 9 + 2u * 160);
    for (std::size_t k = 0; k + 1 < grid.first_ref.size(); ++k)
        EXPECT_LE(grid.first_ref[k + 1] - grid.first_ref[k], 63u);
}

TEST(Grid, FullCellIsRefusedWithTheSizeThatFits) {
    std::vector<Path> paths;
    for (int i = 0; i < 10; ++i)
        for (int k = 0; k < 10; ++k)
            paths.push_back(stroke({0.05 + 0.1 * i, 0.03 + 0.1 * k}, {0.05 + 0.1 * i, 0.06 + 0.1 * k}));
    const ResolvedPattern pattern = pattern_of(paths, Wrap::clamp);
    const Result<CellGrid> grid = build_grid(pattern, {.cell_size = 1.0});
    ASSERT_FALSE(grid.ok());
    EXPECT_EQ(grid.error().code, ErrorCode::limit_exceeded);
    EXPECT_NE(grid.error().message.find("cell (0,0) lists 100 elements, limit 63; cell_size 0.75"),
              std::string::npos)
        << grid.error().message;
    EXPECT_TRUE(build_grid(pattern).ok());
}

TEST(Grid, CellsTooManyAreRefusedWithTheSizeThatWorks) {
    const ResolvedPattern pattern = pattern_of({stroke({0.25, 0.55}, {0.65, 0.55})});
    const auto refused = build_grid(pattern, {.cell_size = 1e-9});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(refused.error().message.find("1e-09"), std::string::npos) << refused.error().message;
    EXPECT_NE(refused.error().message.find("0.000244143 m would work"), std::string::npos) << refused.error().message;
    EXPECT_TRUE(build_grid(pattern, {.cell_size = 0.000244143}).ok());
}

TEST(Grid, OptionsOutOfRangeAreRefused) {
    const ResolvedPattern pattern = pattern_of({});
    EXPECT_FALSE(build_grid(pattern, {.cell_size = -1.0}).ok());
    EXPECT_FALSE(build_grid(pattern, {.margin = 2.0}).ok());
    EXPECT_FALSE(build_grid(pattern, {.threads = -1}).ok());
}

}  // namespace
}  // namespace burin
