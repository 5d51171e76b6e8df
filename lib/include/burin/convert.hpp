// All stages in order: a height map and a model become one binary glTF.
//
//     HeightMap + Model --[convert_map]--> bytes of OUT.glb, and what was measured on the way
//
//     vectorize -> resolve -> grid -> pack -> measure -> refine -> (again from resolve) -> bake -> glTF
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
#include <burin/grid.hpp>
#include <burin/heightmap.hpp>
#include <burin/model.hpp>
#include <burin/pack.hpp>
#include <burin/refine.hpp>
#include <burin/resolve.hpp>
#include <burin/result.hpp>
#include <burin/vectorize.hpp>

namespace burin {

// The options of every stage. `threads` goes to all of them and replaces what they hold.
struct ConvertOptions {
    VectorizeOptions vectorize;
    bool refine = true;  // least squares against the map after vectorizing
    RefineOptions refinement;
    ResolveOptions resolve{.lenient = true};  // a traced path that cannot be resolved is dropped and counted
    GridOptions grid;
    PackOptions pack;
    FallbackOptions fallback;
    AttachOptions attach;
    // Both textures together; elements are given up until they fit, as far as that goes. 0: a sixteenth of the map's
    // 8-bit size, at least 8 KiB, and no more than 63 KiB up to 2048 x 2048.
    std::size_t max_texture_bytes = 0;
    int threads = 0;  // 0: all cores; the result does not depend on it
};

// Why the pattern was not refined, or the refined one not kept.
enum class Unrefined {
    no,             // it was refined
    not_asked,      // ConvertOptions::refine is false
    no_paths,       // there is nothing to move
    not_path_like,  // the paths are not what the map is made of: their exact place shows nothing
    too_much_work,  // wide profiles on long paths
    no_gain,        // the refined pattern explained less, or could not be stored
};

struct ConvertStats {
    // The pattern as stored: elements after splitting at steps and borders.
    int paths = 0, lines = 0, quadratics = 0, profiles = 0, cells = 0;
    int dropped_paths = 0;                // could not be resolved
    std::size_t grid_bytes = 0, data_bytes = 0, file_bytes = 0;
    Unrefined unrefined = Unrefined::no;  // whether the refinement ran and was kept, and why not
    double noise = 0.0;                   // standard deviation of the map's grain, of its range
    double tolerance = 0.0;               // of the fit, texels
    double path_length_texels = 0.0;      // of all stored elements together
    bool repeat = true;                   // the pattern tiles
    bool path_like = true;                // false: the paths carry only a little of the map
    double explained = 0.0;               // DESIGN 7, paths alone
    double traced_explained = 0.0;        // before refining, and before paths that explain next to nothing were given up
    double rms = 0.0, p999 = 0.0, max = 0.0;  // height errors as shares of the range
    std::vector<std::pair<std::string, double>> seconds;  // per stage, in order
};

struct Converted {
    std::vector<std::uint8_t> glb;
    ConvertStats stats;
};

// Requires: the model was checked with find_material, or its error is welcome late.
// Ensures: the bytes depend on map, model and options alone, not on `threads`; the time in `stats` is the only thing that
// differs between runs.
// Fails with the error of the stage that failed, and with invalid_argument when `progress` returns false. Throws
// std::logic_error when what was packed breaks the format, a bug.
// Cost: that of vectorizing and refining; the other stages together stay below a few seconds for 2048 x 2048.
Result<Converted> convert_map(const HeightMap& map, const Model& model, const ConvertOptions& options = {},
                              const Progress& progress = {});

}  // namespace burin
