// A pattern that somebody authored, to one binary glTF: all stages behind the pattern, in order.
//
//     Pattern         --[author_textures]--> AuthoredTextures
//     Pattern + Model --[author_asset]-----> Authored, with the bytes of OUT.glb
//
//     SVG, JSON, strokes in space, generators --> Pattern --[resolve -> grid -> pack -> bake -> glTF]
//
// Unlike convert.hpp nothing is traced, fitted or given up: what cannot be stored exactly as it was drawn is an error that names
// the path. The fallback is baked from the heights of the pattern itself.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <burin/bake.hpp>
#include <burin/grid.hpp>
#include <burin/model.hpp>
#include <burin/pack.hpp>
#include <burin/pattern.hpp>
#include <burin/resolve.hpp>
#include <burin/result.hpp>

namespace burin {

struct AuthorOptions {
    ResolveOptions resolve;
    GridOptions grid;
    PackOptions pack;
    FallbackOptions fallback;
    AttachOptions attach;
    // Texels along u of the heights that the fallback is baked from, [16, 4096].
    int fallback_heights = 512;
    int threads = 0;  // 0: all cores; the result does not depend on it
};

struct AuthorStats {
    int paths = 0, grooves = 0, ridges = 0, steps = 0;    // of the pattern
    int lines = 0, quadratics = 0, profiles = 0, cells = 0;  // as stored
    ResolveStats resolved;                                // what was tolerated
    std::size_t grid_bytes = 0, data_bytes = 0, file_bytes = 0;
    std::vector<std::pair<std::string, double>> seconds;  // per stage, in order
};

struct AuthoredTextures {
    PackedTextures textures;
    PathDetail detail;
    Fallback fallback;
    AuthorStats stats;
};

struct Authored : AuthoredTextures {
    std::vector<std::uint8_t> glb;
};

// Fails as resolve_pattern, build_grid and pack_textures do: the message names path, place and limit.
// Ensures: equal patterns give equal bytes, whatever the threads. Cost: about n log n in elements, and the fallback's heights.
Result<AuthoredTextures> author_textures(const Pattern& pattern, const AuthorOptions& options = {});

// The same on a material of the model. Fails as find_material and write_glb do, before the long work where the model is to blame.
Result<Authored> author_asset(const Pattern& pattern, const Model& model, const AuthorOptions& options = {});

}  // namespace burin
