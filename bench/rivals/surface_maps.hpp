// What a displacement map holds of a pattern: heights, normals and materials of the surface as seen from above, by the truth.
//
//     ResolvedPattern --[map_surface]--> SurfaceMaps (a pyramid; a map of half the size is the pyramid without its first level)
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <burin/evaluate.hpp>

namespace burin::rivals {

// Linear colour, metallic, roughness of one material.
struct MapPaint {
    std::array<float, 3> albedo{1, 1, 1};
    float metallic = 0.0f, roughness = 1.0f;
    bool operator==(const MapPaint&) const = default;
};

// Of the pattern's materials those that some style uses, the base first.
struct Paints {
    std::vector<MapPaint> list;
    std::vector<std::uint8_t> of_style;
};
Paints paints_of(const ResolvedPattern& pattern, const MapPaint& base);

// size x size texels; row 0 lies at v = 0. Each is the mean of those that it covers in the level before.
struct MapLevel {
    int size = 0;
    std::vector<std::uint16_t> heights;  // 0: the lowest place of the map, 65535 the highest
    std::vector<std::int16_t> normals;   // x and y of unit length, in 1 / 32767; x along u, y along v
    std::vector<std::uint8_t> shares;    // of materials 1, 2, ... in 1 / 255, `SurfaceMaps::channels()` of them
};

inline constexpr std::size_t kMostPaints = 5;

struct SurfaceMaps {
    Vec2 metres;                 // of the tile
    bool repeat = true;
    double highest = 0.0, lowest = 0.0;  // metres below the object surface
    double outer = 0.0;                  // the same of what lies around a map that ends, ground
    std::vector<MapPaint> paints;        // at least one, at most kMostPaints
    std::vector<MapLevel> levels;        // the finest first, the last one texel

    std::size_t channels() const { return paints.size() - 1; }
    // Index of the level of that size. Requires: a power of two up to that of the first.
    std::size_t level_of(int size) const;
};

// `size`: texels per side of the finest level, a power of two; one sample of the truth in each. `base`: what the ground is made
// of. `cache`: folder that keeps the samples, "" for none; `key` must say all that they depend on. Cost: about a microsecond per texel
// and core near features.
SurfaceMaps map_surface(const ResolvedPattern& pattern, const MapPaint& base, int size, const std::string& cache, const std::string& key);

}  // namespace burin::rivals
