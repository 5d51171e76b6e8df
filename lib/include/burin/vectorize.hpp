// Stage vectorize: turns a height map into paths with cross-sections.
//
//     HeightMap --[separate_ground]--> SoftGround: ramps and vignettes, and the map without them
//     HeightMap --[trace_map]--> TracedMap --[fit_traced_map]--> Vectorized (a Pattern and what is known about it)
//     HeightMap --[vectorize_map]--> Vectorized, both in one
//
// Grooves and ridges become centre lines with a symmetric or asymmetric profile; plateaus become closed step paths, or
// step paths that end on each other. A groove that crosses another stays one path. Chains are fitted by `fit_curve`,
// profiles are measured across the whole path, averaged robustly, and shared between paths of equal section. Where a line
// swells, fades or tapers, its elements carry width and height scales instead of other profiles. Bolts, dots and short
// slots are lines next to no length, whose ends carry the profile round (caps `round`, or the hip for square ones).
// What the paths do not explain is left to the fallback maps.
//
// Source: [2010] 4.1 and 6 (vectorizing an artist's displacement map); DESIGN 3.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

#include <burin/heightmap.hpp>
#include <burin/pattern.hpp>
#include <burin/result.hpp>

namespace burin {

// Called with a stage's name and the fraction done; returning false stops the work with `invalid_argument`.
using Progress = std::function<bool(std::string_view stage, double fraction)>;

// Largest map that is vectorized, in texels: 8192 x 8192. Larger ones are refused, since they would take minutes.
inline constexpr std::size_t kMaxVectorizedTexels = std::size_t{8192} * 8192;

// Of curves, where neither grain nor a byte budget asks for a looser one; texels.
inline constexpr double kUsualTolerance = 0.3;

enum class WrapChoice : std::uint8_t { automatic, repeat, clamp };  // automatic: repeat when opposite borders match

struct VectorizeOptions {
    Vec2 size{1.0, 1.0};   // metres per uv unit, both > 0; size.x / size.y equals width / height of the map within 1 %
    double depth = 0.01;   // metres from white to black, > 0
    WrapChoice wrap = WrapChoice::automatic;
    // Greatest distance of a fitted curve from the traced points, texels; 0 chooses it from the map's grain and the
    // byte budget. Range [0, 8].
    double tolerance = 0.0;
    // Elements the paths may have, 0: about as many as fit into `most_bytes`.
    int most_elements = 0;
    // Both textures together, 0: 1/16 of the map's 8-bit size, at least 16 KiB.
    std::size_t most_bytes = 0;
    // Whether step paths follow the levels that soft ground passes. On rounded pipes they draw the shading; on a plate
    // that is darker at its rim they are lines where nobody sees one.
    bool shading = true;
    // Whether step paths also follow borders that rise gently, by less than a third of their height within seven texels:
    // the half height of domes and cushions. On terrain they are contour lines.
    bool gentle = false;
    int threads = 0;  // 0: all cores; the result does not depend on it
};

struct Vectorized {
    Pattern pattern;
    double noise = 0.0;               // standard deviation of the grain, of the map's range
    double damage = 0.0;              // the grain, or what JPEG left beside walls, whichever is greater; of the range
    double energy = 0.0;              // the map's detail: variance of HP(map) (DESIGN 7) times its texels
    double tolerance = 0.0;           // used for fitting, texels
    double path_length_texels = 0.0;  // of all paths together
    bool is_short = false;            // paths were given up, or follow the map more loosely, for the sake of `most_bytes`
    bool shaded = false;              // some steps follow soft ground; without `shading` they would not be
};

// The part of a map that no path should follow.
struct SoftGround {
    HeightMap detail;        // the map without its soft ground: what to vectorize and refine against; values in [0, 1]
    double deviation = 0.0;  // standard deviation of what was taken off, of the map's range
};

// Slopes gentler than any wall, wider than a sixteenth of the map's shorter side, are taken off: there
// `explained` (DESIGN 7) looks away from anyway. Plateaus keep their levels. What walls are made of, too, stays.
// A pattern made from `detail` lies on level ground; the ground itself is left to the fallback maps.
// Requires, and fails on: as vectorize_map.
// Cost: about 30 ns a texel.
Result<SoftGround> separate_ground(const HeightMap& map, const VectorizeOptions& options = {});

namespace vectorizing {
struct Traced;
}

// Centre lines and step contours as rows of sub-texel points, and the plateaus between them; nothing is fitted yet.
// Tracing is the greater part of the work, and does not depend on tolerance and most_elements: who looks for the right
// number of elements traces once and fits several times.
struct TracedMap {
    std::shared_ptr<const vectorizing::Traced> found;
};

// Both fail, and what they need of map and options, as vectorize_map; the map and the wrap are the same in both.
Result<TracedMap> trace_map(const HeightMap& map, const VectorizeOptions& options = {}, const Progress& progress = {});
Result<Vectorized> fit_traced_map(const TracedMap& traced, const HeightMap& map, const VectorizeOptions& options = {},
                                  const Progress& progress = {});

// Requires: a map of at least 1 x 1 texels with values in [0, 1].
// Ensures: a map without features, or one that is not path-like, gives a pattern that `resolve_pattern` accepts, with no
// path or few; the result is the same for any number of threads.
// Fails with invalid_argument when an option is out of its range, and with limit_exceeded when the map is larger than
// kMaxVectorizedTexels.
// Cost: about linear in texels; 1 to 3 seconds for 1024 x 1024 on two cores.
Result<Vectorized> vectorize_map(const HeightMap& map, const VectorizeOptions& options = {},
                                 const Progress& progress = {});

}  // namespace burin
