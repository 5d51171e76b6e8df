// What the forward model knows before it looks at a texel: elements by tile, and the ground between the steps.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <burin/resolve.hpp>

#include "refine_element.hpp"
#include "refine_profile.hpp"

namespace burin::refinement {

constexpr int kTile = 8;              // texels per side of a tile
constexpr double kNearMargin = 2.0;   // texels around a feature that still count as near it
constexpr double kLevelTolerance = 1e-6;

struct Feature {
    ElementFrame frame;
    const SweptProfile* profile = nullptr;
    bool step = false;
    double level_left = 0.0, level_right = 0.0;
    double left = 0.0, right = 0.0;  // extent of the profile at its widest
};

// A copy of an element, moved by whole tiles of a repeating pattern.
struct Instance {
    std::uint32_t element = 0;
    Vec2 offset;
};

constexpr float kNearStep = -1e30f;

// Texels of a tile, half open.
struct TileSpan {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

// A step whose line may be the nearest one somewhere in a square.
struct StepLine {
    std::uint32_t instance = 0;
    double distance = 0.0;  // from the square's centre
    double offset = 0.0;    // of the centre
    double guess = -1.0;    // curve parameter near the feet of the square's points, or -1: see foot_of
    const Vec2* vertex = nullptr;  // the line's end when that is its nearest point to all of the square
    bool one_sided = false;        // the square lies on one side of the line
    double level = 0.0;            // of the ground on the centre's side
};

struct Layout {
    int width = 0, height = 0;  // texels
    Vec2 side;                  // of a texel
    int tile_columns = 0, tile_rows = 0;
    std::vector<SweptProfile> profiles;
    std::vector<Feature> features;  // one per resolved element
    std::vector<Instance> instances;
    std::vector<std::uint32_t> first;  // per tile, into listed; one more than there are tiles
    std::vector<std::uint32_t> listed;
    std::vector<std::uint8_t> tile_has_step;
    std::vector<std::uint8_t> tile_far;             // no step's walls come near the tile; empty as `ground`
    std::vector<std::vector<StepLine>> tile_steps;  // which may be the nearest somewhere in the tile; empty as `ground`
    // Ground of texels that no step comes near; kNearStep elsewhere. Empty when the pattern has no step.
    std::vector<float> ground;
    double outer_level = 0.0;
    bool repeat = false;

    Vec2 centre(int x, int y) const { return {(x + 0.5) * side.x, (y + 0.5) * side.y}; }
    TileSpan span(int column, int row) const {
        return {column * kTile, row * kTile, std::min((column + 1) * kTile, width), std::min((row + 1) * kTile, height)};
    }
    double half_diagonal() const { return 0.5 * length(side); }
    // Of a texel that no feature is near.
    double ground_at(std::size_t texel) const {
        return ground.empty() || ground[texel] == kNearStep ? outer_level : ground[texel];
    }
};

// The step whose line is nearest to p.
struct NearestStep {
    int instance = -1;
    double level = 0.0;  // ground at p
    double distance = 1e300;
    double offset = 0.0;
};
NearestStep nearest_step(const Layout& layout, const std::vector<StepLine>& steps, Vec2 p);

// Leaves only the steps that may be the nearest within `radius` of p. Requires: none that may be is missing.
void keep_nearest_steps(const Layout& layout, Vec2 p, double radius, std::vector<StepLine>& steps);

// Fills in `ground` and the steps of the tiles from the features by tile. The same for any number of threads.
void lay_ground(Layout& layout, int threads);

Layout lay_out(const ResolvedPattern& pattern, int width, int height, Vec2 side, int threads);

}  // namespace burin::refinement
