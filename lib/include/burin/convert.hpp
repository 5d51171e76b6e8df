// All stages in order: a height map and a model become one binary glTF.
//
//     HeightMap         --[find_pattern]--> FoundPattern, and what was measured on the way
//     HeightMap + Model --[convert_map]---> the same, and the bytes of OUT.glb
//
//     coarsen -> vectorize -> resolve -> grid -> pack -> measure -> refine -> (again from resolve) | -> bake -> glTF
//                                                                                     find_pattern | convert_map
//     (bake: the fallback of the core material, and the residual)
//
// The figures are measured on the bytes that are written: the textures are unpacked again, rasterized by the evaluator
// and compared with the map (DESIGN 7). Nothing a stage estimates stands in for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <burin/bake.hpp>
#include <burin/coarsen.hpp>
#include <burin/grid.hpp>
#include <burin/heightmap.hpp>
#include <burin/model.hpp>
#include <burin/pack.hpp>
#include <burin/refine.hpp>
#include <burin/residual.hpp>
#include <burin/resolve.hpp>
#include <burin/result.hpp>
#include <burin/vectorize.hpp>

namespace burin {

// The options of every stage. `threads` goes to all of them and replaces what they hold.
struct ConvertOptions {
    // What is vectorized and refined; figures, fallback maps and residual are of the map itself. Not with max_error.
    CoarsenOptions coarsen;
    VectorizeOptions vectorize;
    bool refine = true;  // least squares against the map after vectorizing
    RefineOptions refinement;
    ResolveOptions resolve{.lenient = true};  // a traced path that cannot be resolved is dropped and counted
    GridOptions grid;
    PackOptions pack;
    FallbackOptions fallback;
    // Of convert_map. `most_texels` left at its default: at most 1/64 of the map's texels where the paths explain
    // kWellExplained or more, unless normals of a map of up to 2^20 would then be off by more than `tolerance`. Without any
    // path the residual is the core material's normal map too, and always worthwhile.
    ResidualOptions residual;
    AttachOptions attach;
    // Bound on both textures together, as uploaded, and the residual, as the PNG in the file: elements are given up until
    // the textures fit, and the residual is one that fits into what they leave. 0: no bound, but elements are given up, as
    // far as that goes, beyond a sixteenth of the map's 8-bit size (16 KiB for small maps, 63 KiB up to 2048 x 2048), or
    // beyond twice or four times that where a doubling explains 0.04 more of the map by paths and not by sheer number.
    // Maps that come near 1/40 of their 8-bit size reach it by larger cells.
    std::size_t max_texture_bytes = 0;
    // Bound on the 99.9th percentile of the height error (ConvertStats::p999), a share of the range: until at most 1 texel
    // in 1000 errs by more, curves of other tolerances are fitted and refined, and the best of them kept. 0: no bound.
    // Range [0, 1]; without effect on `vectorize.tolerance`, with which the search begins. Without max_texture_bytes the
    // textures may then grow to the map's own 8-bit size, and to 16 KiB on small maps.
    double max_error = 0.0;
    int threads = 0;  // 0: all cores; the result does not depend on it
};

inline constexpr double kWellExplained = 0.97;

// Why the pattern was not refined, or the refined one not kept.
enum class Unrefined {
    no,             // it was refined
    not_asked,      // ConvertOptions::refine is false
    no_paths,       // there is nothing to move
    not_path_like,  // the paths are not what the map is made of: their exact place shows nothing
    too_much_work,  // wide profiles on long paths
    no_gain,        // the refined pattern explained less, or could not be stored
};

// What each class of paths explains (DESIGN 7). steps + lines + left = 1.
//
// The map is first drawn with its step paths and the levels between them alone: that explains `steps`. Grooves and
// ridges are then added: `lines` is what they explain on top, below 0 where they do harm. A groove that runs along a
// wall and hides a mistake of its step counts with the lines. What is left is exact; the border between the two others
// is measured with fewer samples, within 0.0005.
struct ExplainedShares {
    double steps = 0.0, lines = 0.0;
    double left = 1.0;  // by neither; the normal maps carry it
};

struct ConvertStats {
    // The pattern as stored: elements after splitting at steps and borders.
    int paths = 0, lines = 0, quadratics = 0, profiles = 0, cells = 0;
    int dropped_paths = 0;                // could not be resolved
    std::size_t grid_bytes = 0, data_bytes = 0, file_bytes = 0;
    Unrefined unrefined = Unrefined::no;  // whether the refinement ran and was kept, and why not
    int halvings = 0;                     // of the map's sides before it was traced; see coarsen_map
    double noise = 0.0;                   // standard deviation of the map's grain, of its range
    double tolerance = 0.0;               // of the fit, texels
    double path_length_texels = 0.0;      // of all stored elements together
    bool repeat = true;                   // the pattern tiles
    bool path_like = true;                // false: the paths carry only a little of the map
    double explained = 0.0;               // DESIGN 7, paths alone
    double traced_explained = 0.0;        // before refining, and before paths that explain next to nothing were given up
    ExplainedShares shares;               // of `explained`, by class
    int steps = 0, grooves = 0, ridges = 0;  // of `paths`
    // Height errors of what is stored, as shares of the range; p999: at most 1 texel in 1000 errs by more.
    double rms = 0.0, p999 = 0.0, max = 0.0;
    double p999_without_smooth = 0.0;     // the same after the smooth part of the error is taken away
    std::vector<std::pair<std::string, double>> seconds;  // per stage, in order
};

// The paths of a map, and their textures: all of a conversion that needs no model.
struct FoundPattern {
    Pattern pattern;          // as traced and refined, in metres; without paths that could not be resolved
    PackedTextures textures;  // as stored
    PathDetail detail;
    ConvertStats stats;
};

struct Converted : FoundPattern {
    Residual residual;  // as stored in the glb
    std::vector<std::uint8_t> glb;
};

// Ensures: the result depends on map and options alone, not on `threads`; the time in `stats` is the only thing that
// differs between runs.
// Fails with the error of the stage that failed, with invalid_argument when `progress` returns false, and with
// invalid_argument when max_texture_bytes or max_error cannot be kept; the message holds a value that
// can, tried out: of bytes about the least.
// Throws std::logic_error when what was packed breaks the format, a bug.
// Cost: that of vectorizing and refining, up to six times with max_error; the other stages together stay below a few
// seconds for 2048 x 2048.
Result<FoundPattern> find_pattern(const HeightMap& map, const ConvertOptions& options = {},
                                  const Progress& progress = {});

// Requires: the model was checked with find_material, or its error is welcome late.
// Ensures, fails: as find_pattern; the bytes depend on map, model and options alone.
// Cost: find_pattern, and the fallback maps and the residual: a few percent on top.
Result<Converted> convert_map(const HeightMap& map, const Model& model, const ConvertOptions& options = {},
                              const Progress& progress = {});

}  // namespace burin
