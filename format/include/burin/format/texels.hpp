// The two textures in memory, and pack/unpack of one texel of each kind. Pure functions, no allocation.
//
// Two layers, each with an exact round trip of its own:
//   words <-> codes   pack_cell, unpack_cell, pack_element, ... lose nothing: unpack(pack(c)) == c when c is
//   in range codes <-> values  encode_..., decode_... quantize: |decode(encode(v)) - v| <= the bound stated
//   at each
// The bit layout stands in layout.h, the prose in SPECIFICATION.md. Words are those of the host's integers;
// in a file they are little-endian.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "layout.h"

namespace burin {

// Lengths of the data texture's sections in texels. They follow each other in this order from texel 0.
struct Sections {
    std::uint32_t element_texels = 0;
    std::uint32_t style_texels = 0;
    std::uint32_t profile_texels = 0;
    std::uint32_t material_texels = 0;
    std::uint32_t list_texels = 0;
    std::uint32_t function_texels = 0;

    std::uint32_t styles_begin() const { return element_texels; }
    std::uint32_t profiles_begin() const { return styles_begin() + style_texels; }
    std::uint32_t materials_begin() const { return profiles_begin() + profile_texels; }
    std::uint32_t lists_begin() const { return materials_begin() + material_texels; }
    std::uint32_t functions_begin() const { return lists_begin() + list_texels; }
    std::uint32_t end() const { return functions_begin() + function_texels; }

    // Whether references are too large for 16 bits and take 32, each list from a texel on.
    bool wide() const { return element_texels > BURIN_MAX_NARROW_ELEMENT_TEXELS; }
    std::uint32_t references_per_texel() const { return wide() ? BURIN_WIDE_REFS_PER_TEXEL : BURIN_REFS_PER_TEXEL; }
    std::uint32_t max_list_texels() const { return wide() ? BURIN_MAX_LIST_TEXELS : BURIN_MAX_NARROW_LIST_TEXELS; }
    // References that the list section has room for.
    std::uint32_t references() const { return list_texels * references_per_texel(); }
};

// Both textures as integer words, ready for upload as RG32UI and RGBA32UI. Row-major; texel i of a texture of
// width w lies at (i % w, i / w).
struct PackedTextures {
    int grid_width = 0, grid_height = 0;
    std::vector<std::uint32_t> grid;  // 2 words per cell
    int data_width = 0, data_height = 0;
    std::vector<std::uint32_t> data;  // 4 words per texel
    Sections sections;
};

using Texel = std::array<std::uint32_t, 4>;      // words x, y, z, w of a data texel
using CellTexel = std::array<std::uint32_t, 2>;  // words x, y of a grid texel

// ---- codes: every member is the integer that stands in the file
// ------------------------------------------------

struct CellCode {
    std::uint32_t first_reference = 0;  // [0, 2^20): a reference's index, of a wide pattern its texel; list_begin() knows
    std::uint32_t count = 0;            // [0, 63]
    std::uint32_t skip = 0;             // [0, 15] cells; with BURIN_CELL_FLAG_STEP: the start of the walk
    std::uint32_t flags = 0;            // BURIN_CELL_FLAG_*
    std::uint32_t level = 0;            // UNORM16
    std::uint32_t highest = 0;          // UNORM8, rounded up
    std::uint32_t lowest = 0;           // UNORM8, rounded down

    bool operator==(const CellCode&) const = default;
};

struct EndCode {
    std::uint32_t priority = 0;    // BURIN_PRIORITY_*
    std::uint32_t shape = 0;       // BURIN_CORNER_* or BURIN_END_*, by priority
    std::uint32_t clip_angle = 0;  // [0, 4096)

    bool operator==(const EndCode&) const = default;
};

struct PointCode {
    std::uint32_t u = 0, v = 0;  // [0, 2^20)

    bool operator==(const PointCode&) const = default;
};

struct ElementCode {
    PointCode p0, p1, p2;  // p1 is 0 for a line
    EndCode start, end;
    bool quadratic = false;
    bool has_texel_b = false;  // true for every quadratic
    std::uint32_t unused = 0;  // the bits that have no meaning, gathered: not 0 only in a damaged file
    std::uint32_t style = 0;   // [0, 4096)
    std::uint32_t width0 = 16384, width1 = 16384, height0 = 16384, height1 = 16384;  // 16384 is 1
    bool has_texel_c = false;
    std::uint32_t argument0 = 0, argument1 = 0;  // 65536 is 1
    std::uint32_t function = 0;                  // [0, 65536), from the start of the function section
    bool unused_c = false;                       // as `unused`, of texel C

    bool operator==(const ElementCode&) const = default;
};

struct StyleCode {
    std::uint32_t profile_texel = 0;  // [0, 65536), from the start of the profile section
    std::uint32_t point_count = 0;    // [2, 32]
    bool step = false;
    std::uint32_t material = 0;     // [0, 512)
    std::uint32_t level_left = 0;   // UNORM16
    std::uint32_t level_right = 0;  // UNORM16, equal to level_left unless a step
    float reach = 0.0f;             // metres
    std::uint32_t internal_mask = 0;

    bool operator==(const StyleCode&) const = default;
};

struct ProfilePointCode {
    std::int32_t b = 0, h = 0;  // SNORM16, [-32768, 32767]; -32768 only in a damaged file

    bool operator==(const ProfilePointCode&) const = default;
};

struct MaterialCode {
    std::array<std::uint32_t, 4> base_color{};  // UNORM8 R, G, B, A, linear
    std::uint32_t metallic = 0, roughness = 0;  // UNORM8
    bool overrides = false;
    std::uint32_t unused = 0;  // as in ElementCode

    bool operator==(const MaterialCode&) const = default;
};

struct FunctionCode {
    std::uint32_t kind = 0;             // BURIN_FUNCTION_*; 3 only in a damaged file
    std::uint32_t octaves = 0;          // [1, 8] for noise
    std::int32_t width = 0, height = 0;  // amplitudes, SNORM16
    std::uint32_t seed = 0, period = 0;
    std::array<float, 8> coefficients{};  // of a polynomial: c0 to c3 of width, then of height
    std::uint32_t unused = 0;             // as in ElementCode, bits 6 to 31 of x

    bool operator==(const FunctionCode&) const = default;
};

// ---- words <-> codes. Requires (asserted) of every pack function: members within the ranges above
// -----------------

CellTexel pack_cell(const CellCode& cell);
CellCode unpack_cell(const CellTexel& texel);

// Texels A, B and C; those that there are not are all zero.
std::array<Texel, 3> pack_element(const ElementCode& element);
// `b` and `c` are not looked at unless texel A says that there is one.
ElementCode unpack_element(const Texel& a, const Texel& b, const Texel& c = {});
// Whether texel A announces a texel B or a texel C; reads nothing else.
bool element_has_texel_b(const Texel& a);
bool element_has_texel_c(const Texel& a);
// Texels that the element takes, by texel A: 1 to 3.
std::uint32_t element_texel_count(const Texel& a);

Texel pack_style(const StyleCode& style);
StyleCode unpack_style(const Texel& texel);

std::uint32_t pack_profile_point(const ProfilePointCode& point);
ProfilePointCode unpack_profile_point(std::uint32_t word);

Texel pack_material(const MaterialCode& material);
MaterialCode unpack_material(const Texel& texel);

// Texels that a function takes, by its head texel: 3 for a polynomial, else 1; the others are all zero.
std::array<Texel, 3> pack_function(const FunctionCode& function);
FunctionCode unpack_function(const std::array<Texel, 3>& texels);
std::uint32_t function_texel_count(const Texel& head);

// ---- texture access. Requires: index within the texture
// ---------------------------------------------------------

CellTexel cell_texel(const PackedTextures& textures, std::uint32_t index);
Texel data_texel(const PackedTextures& textures, std::uint32_t index);
// Index of a list's first reference; that of the reference that is `first_reference` in a cell's code, and back.
// Requires for the way back: in a wide pattern a multiple of BURIN_WIDE_REFS_PER_TEXEL.
std::uint32_t list_begin(const Sections& sections, const CellCode& cell);
std::uint32_t first_reference_code(const Sections& sections, std::uint32_t index);
// Reference `index` of the list section: an element's texel, counted from the start of the element section.
std::uint32_t list_reference(const PackedTextures& textures, std::uint32_t index);
// The element at a texel of the data texture, the function at one of the function section.
// Requires: all of its texels within the texture.
ElementCode element_at(const PackedTextures& textures, std::uint32_t texel);
FunctionCode function_at(const PackedTextures& textures, std::uint32_t texel);

// ---- codes <-> values. An encoder returns false, and leaves `code` alone, where the value is out of range
// or not finite; nothing is clamped.
// ------------------------------------------------------------------------------------------

// uv coordinate, [-0.5, 1.5) less half a step. Worst error 2^-20 (0.95e-6 of the tile). Values that differ by
// a whole tile get codes that differ by exactly 524288, also when the addition of the tile cost the last
// bits.
bool encode_coordinate(double uv, std::uint32_t& code);
double decode_coordinate(std::uint32_t code);

// Angle of an undirected line in radians; any finite value, taken modulo pi. Worst error pi / 8192 (3.8e-4
// rad).
bool encode_clip_angle(double radians, std::uint32_t& code);
double decode_clip_angle(std::uint32_t code);

// Width or height scale, [0, 4) less half a step. Worst error 2^-15. 0, 1, 2 and 3 are exact.
bool encode_scale(double scale, std::uint32_t& code);
double decode_scale(std::uint32_t code);

// Argument of a function, [0, 65536) less half a step. Worst error 2^-17. Whole numbers are exact.
bool encode_argument(double argument, std::uint32_t& code);
double decode_argument(std::uint32_t code);

// Value in [0, 1]. Worst error 1 / 131070 and 1 / 510. 0 and 1 are exact.
bool encode_unorm16(double value, std::uint32_t& code);
double decode_unorm16(std::uint32_t code);
bool encode_unorm8(double value, std::uint32_t& code);
double decode_unorm8(std::uint32_t code);
// The same with the error on one side: floor decodes to at most `value` + 1e-9, ceil to at least `value` -
// 1e-9.
bool encode_unorm8_floor(double value, std::uint32_t& code);
bool encode_unorm8_ceil(double value, std::uint32_t& code);

// Value in [-1, 1]. Worst error 1 / 65534. -1, 0 and 1 are exact.
bool encode_snorm16(double value, std::int32_t& code);
double decode_snorm16(std::int32_t code);

// Height in metres above ground level 0 <-> value of the height range: 1 at base_offset, 0 at base_offset -
// depth.
inline double height_to_unit(double height, double depth, double base_offset) {
    return 1.0 + (height - base_offset) / depth;
}
inline double unit_to_height(double unit, double depth, double base_offset) {
    return base_offset - depth * (1.0 - unit);
}

}  // namespace burin
