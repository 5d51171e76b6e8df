// What the forward model knows before it looks at a texel: elements by tile, and the ground between the steps.
#pragma once

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
    // Ground of texels that no step comes near; kNearStep elsewhere. Empty when the pattern has no step.
    std::vector<float> ground;
    double outer_level = 0.0;
    bool repeat = false;

    Vec2 centre(int x, int y) const { return {(x + 0.5) * side.x, (y + 0.5) * side.y}; }
    double half_diagonal() const { return 0.5 * length(side); }
};
constexpr float kNearStep = -1e30f;

// The step whose line is nearest to p, of those listed in a tile.
struct NearestStep {
    int instance = -1;
    double level = 0.0;  // ground at p
    double distance = 1e300;
};
NearestStep nearest_step(const Layout& layout, std::size_t tile, Vec2 p);

Layout lay_out(const ResolvedPattern& pattern, int width, int height, Vec2 side);

}  // namespace burin::refinement
