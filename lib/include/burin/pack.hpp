// Stage pack: a resolved pattern and its grid become the two textures of format/SPECIFICATION.md, and back.
//
//     ResolvedPattern + CellGrid --[pack_textures]--> PackedTextures     --[describe_pattern]--> PathDetail
//     PackedTextures + PathDetail --[unpack_textures]--> ResolvedPattern + CellGrid
//
// Source: [2010] 4.2; DESIGN 4. Errors of quantization: burin/format/texels.hpp.
#pragma once

#include <cstddef>

#include <burin/format/extension.hpp>
#include <burin/format/texels.hpp>
#include <burin/grid.hpp>
#include <burin/resolve.hpp>
#include <burin/result.hpp>

namespace burin {

struct PackOptions {
    // Levels nearer to each other than this are one level and get one code: a fraction of depth, [0, 0.01].
    // It must exceed the rounding noise of levels that were computed in different ways, and stay below any
    // real difference.
    double same_level = 0.25 / 65535.0;
};

// What packing shared and left out. Nothing is left out silently.
struct PackStatistics {
    std::size_t dropped_elements =
        0;                     // elements shorter than a coordinate step; their neighbours meet without them
    std::size_t styles = 0;    // texels; equal ones are stored once
    std::size_t profiles = 0;  // distinct profiles
    std::size_t references_listed = 0;  // sum of all cells' counts
    std::size_t references_stored = 0;  // after sharing of equal and contained lists
};

// Requires: `grid` was built from `pattern`.
// Ensures: the textures pass validate_textures (burin/format/validate.hpp) with no error; ends that coincide
// get equal codes, also across the border of the tile; equal levels get equal codes; identical and contained
// lists are stored once, contained ones of a wide pattern (more than BURIN_MAX_NARROW_ELEMENT_TEXELS texels of elements) where they begin on
// a texel of the other; no whole row of the data texture is empty. Deterministic. Fails with limit_exceeded,
// naming limit, place and value: elements, lists, a cell's list, an element's coordinate or scale, styles, profile points,
// texture sides; invalid_input: a height outside [base_offset - depth, base_offset] where a level is meant,
// an index out of range, sizes of the grid's arrays that do not agree.
// Cost: linear in elements and cells, plus the sharing of lists, about n log n.
Result<PackedTextures> pack_textures(const ResolvedPattern& pattern, const CellGrid& grid,
                                     const PackOptions& options = {}, PackStatistics* statistics = nullptr);

// The extension's properties for these textures; the bufferView indices are left at -1.
PathDetail describe_pattern(const ResolvedPattern& pattern, const PackedTextures& textures);

// Bounds the memory of unpack_textures: sum of all cells' counts.
inline constexpr std::uint64_t kMaxUnpackedReferences = std::uint64_t{1} << 26;

struct UnpackedPattern {
    ResolvedPattern pattern;  // junctions are not stored in the textures and stay empty
    CellGrid grid;
};

// Safe on untrusted input: everything is checked as validate_textures does before anything is followed.
// Ensures: element order is the file's; elements whose ends coincide and that share a style are given one
// path number. Fails with invalid_input: the first error that validate_textures finds, with its number. Cost:
// linear in the size of the textures.
Result<UnpackedPattern> unpack_textures(const PackedTextures& textures, const PathDetail& detail);

}  // namespace burin
