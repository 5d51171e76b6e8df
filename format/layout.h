// Limits and bit widths of the two textures. The only place where they are written: valid C++ and valid GLSL
// (330 core, ES 300), so that packer, validator and shader read the same numbers. SPECIFICATION.md gives the prose.
//
// Bit 0 is the least significant. A "word" is one 32-bit channel of an unsigned integer texel: x, y, z, w.
#ifndef BURIN_LAYOUT_H
#define BURIN_LAYOUT_H

// ---- limits ----------------------------------------------------------------------------------------------
#define BURIN_MAX_TEXTURE_SIDE 4096
#define BURIN_MAX_REFS_PER_CELL 63
#define BURIN_MAX_PROFILE_POINTS 32
#define BURIN_MAX_ELEMENT_TEXELS 4194304
#define BURIN_MAX_NARROW_ELEMENT_TEXELS 65536  // with more a pattern is wide, see lists
#define BURIN_MAX_STYLES 4096
#define BURIN_MAX_PROFILE_TEXELS 65536
#define BURIN_MAX_MATERIALS 512
#define BURIN_MAX_LIST_TEXELS 1048576
#define BURIN_MAX_NARROW_LIST_TEXELS 131072
#define BURIN_MAX_FUNCTION_TEXELS 65536
#define BURIN_MAX_OCTAVES 8
#define BURIN_MAX_NOISE_PERIOD 65536
// Lengths in metres (size, depth, reach): within these their squares and quotients stay finite in 32-bit floats.
#define BURIN_MIN_LENGTH 1.0e-9
#define BURIN_MAX_LENGTH 1.0e9

// ---- grid texture: RG32UI, one texel per cell, row-major, cell (0,0) at uv (0,0) --------------------------
// x: bits 0-19 first reference (its index, or its texel in the list section of a wide pattern, see lists; 0 when count is 0),
//    20-25 count, 26-29 skip, or start with STEP, 30-31 flags
// y: bits 0-15 level at the cell's start (UNORM16 of the height range), 16-23 highest, 24-31 lowest (UNORM8)
// skip s: every cell (i + dx, j + dy) with |dx| <= s and |dy| <= s lists nothing and has this cell's level (indices wrap
// when the pattern repeats); 0 where the cell lists something. start: below.
#define BURIN_CELL_FIRST_BITS 20
#define BURIN_CELL_COUNT_BITS 6
#define BURIN_CELL_SKIP_BITS 4
// ISOLATED: the listed elements follow each other in one path and are joined smoothly (or nothing is listed).
// STEP: the path line of a step passes through the cell, so that its level varies.
#define BURIN_CELL_FLAG_ISOLATED 1u
#define BURIN_CELL_FLAG_STEP 2u
// Ground at p in a cell with STEP: walk from the cell's start to p; the step path line crossed last (of the cell's list)
// gives the level of the side walked to; none crossed: the cell's level. Without STEP: the cell's level.
// Start k, 0 to 15, is one of 16 points spread over the cell, 0 its centre; the writer takes one that no step is near.
// It lies ((k * FACTOR + HALF) mod STEPS - HALF) / SPREAD cell sides from the centre, along u and along v.
#define BURIN_START_FACTOR_U 771
#define BURIN_START_FACTOR_V 582
#define BURIN_START_HALF 510
#define BURIN_START_STEPS 1021
#define BURIN_START_SPREAD 1361.0

// ---- table of chart borders, RGBA32UI: borders of BORDER_TEXELS each, then two words per cell (first reference, count), then one
// word per reference; each part starts on a texel. Numbers are the bits of 32-bit floats.
//   begin, end | the other side's place of begin, step there per metre away from the edge | step to step, row by row |
//   metres per metre away from the edge, angle, chart, chart beyond (the last two are integers)
#define BURIN_BORDER_TEXELS 4
#define BURIN_MAX_BORDERS 1048576
#define BURIN_MAX_CHART_CELLS 1024  // per side
#define BURIN_MOST_EDGE_ANGLE 2.9    // radians

// ---- data texture: RGBA32UI; sections elements, styles, profiles, materials, lists, functions, each from a texel on
// Element, texel A:
//   x: 0-19 p0.u, 20-31 clip angle at the start      y: 0-19 p0.v, 20-31 clip angle at the end
//   z: 0-19 p2.u, 20-23 start end-kind, 24-27 end end-kind, 28 quadratic, 29 has texel B,
//      30 has texel C
//   w: 0-19 p2.v, 20-31 style
// Element, texel B (when flagged; always for quadratics):
//   x: 0-19 p1.u, 20-31 unused (zero)                  y: 0-19 p1.v, 20-31 unused (zero)
//   z: 0-15 width scale at start, 16-31 at end           w: 0-15 height scale at start, 16-31 at end
//   (p1 is ignored, and zero, for a line.) Without texel B all four scales are 1.
// Element, texel C (when flagged; behind B, or behind A where there is no B): a function multiplies the scales
//   x: argument at start                               y: argument at end, not less than at the start
//   z: 0-15 the function's first texel (from the start of the function section), 16-31 unused (zero)    w: unused (zero)
// Arguments: value = code / 65536, range [0, 65536). Without texel C both factors are 1.
#define BURIN_ARGUMENT_BITS 16
#define BURIN_ARGUMENT_STEPS 65536.0
// Coordinates are uv: value = code / BURIN_COORDINATE_STEPS - 0.5, range [-0.5, 1.5).
#define BURIN_COORDINATE_BITS 20
#define BURIN_COORDINATE_STEPS 524288.0
// When the pattern repeats, a reference in a cell means one copy of the element: moved by the whole tiles that bring its
// chord's midpoint m = (p0 + p2) / 2 nearest to the cell's centre c, k = floor(c - m + 0.5) in u and in v.
// Clip angle of an undirected line: angle = code * pi / 4096, measured from +x (u) towards +y (v), in [0, pi).
#define BURIN_CLIP_ANGLE_BITS 12
#define BURIN_CLIP_ANGLE_STEPS 4096.0
// Scales: value = code / 16384, range [0, 4).
#define BURIN_SCALE_STEPS 16384.0

// End-kind: bits 0-1 priority (which sides of the profile are given material back beyond the end's normal),
// bits 2-3 shape.
#define BURIN_PRIORITY_NONE 0u   // butt: the element stops at the normal of its end
#define BURIN_PRIORITY_LEFT 1u   // corner, outer sector on the left (b < 0)
#define BURIN_PRIORITY_RIGHT 2u  // corner, outer sector on the right (b > 0)
#define BURIN_PRIORITY_BOTH 3u   // joint, T, or isolated end
// shape with LEFT or RIGHT:
#define BURIN_CORNER_MITRE 0u
#define BURIN_CORNER_BEVEL 1u
#define BURIN_CORNER_ROUND 2u
// shape with BOTH:
#define BURIN_END_CLIP 0u   // both sides run to the clip line: a smooth joint
#define BURIN_END_HIP 1u    // isolated end, profile at sign(b) max(|b|, t)
#define BURIN_END_ROUND 2u  // isolated end, profile at sign(b) hypot(b, t)
#define BURIN_END_TEE 3u    // as CLIP, and the path ends there: on another path's line, or on the border of a map

// Style texel: x: 0-15 profile's first texel (from the start of the profile section), 16-21 number of points,
//                 22 step (its two levels differ), 23-31 material
//              y: 0-15 level on the left: the height that h = 0 means; 16-31 level on the right, the same unless a step
//                 (UNORM16 of the height range; compared as codes with the ground's level, so never computed from h)
//              z: reach in metres, float32 bits: |b| = 1 of the profile's codes
//              w: bit i set when facet i (between points i and i + 1) is internal
// Profile: points packed four to a texel, one word each: 0-15 b as SNORM16 of reach, 16-31 h as SNORM16 of depth.
#define BURIN_STYLE_POINTS_BITS 6
#define BURIN_STYLE_MATERIAL_BITS 9
#define BURIN_POINTS_PER_TEXEL 4
// Lists: 16-bit references, eight to a texel, low half first. A reference is the element's texel, counted from the
// start of the element section.
// A pattern with more than MAX_NARROW_ELEMENT_TEXELS is WIDE: references of 32 bits, four to a texel, every list from a texel on.
#define BURIN_REFS_PER_TEXEL 8
#define BURIN_WIDE_REFS_PER_TEXEL 4
// Function, head texel: x: 0-1 kind, 2-5 octaves (noise; else 0)    y: amplitude of width 0-15, of height 16-31, SNORM16
//                       z: seed (noise; else 0)                      w: period (noise; 0: none, else 0)
// Only a polynomial has two more texels, c0 to c3 of width and of height as float32 bits; its y is 0.
#define BURIN_FUNCTION_SINE 0u
#define BURIN_FUNCTION_POLYNOMIAL 1u
#define BURIN_FUNCTION_NOISE 2u
// Noise: octave k has lattice points at every 2^-k of the argument, moved by -0.375 k 2^-k. Point i has the bits
//   h = i + seed * MIX_SEED + k * MIX_OCTAVE;  h = (h ^ h >> 16) * MIX_A;  h = (h ^ h >> 15) * MIX_B;  h = h ^ h >> 16
// whose low half is the value for width and whose high half that for height: half / 32767.5 - 1.
#define BURIN_NOISE_MIX_SEED 0x9e3779b9u
#define BURIN_NOISE_MIX_OCTAVE 0x85ebca6bu
#define BURIN_NOISE_MIX_A 0x7feb352du
#define BURIN_NOISE_MIX_B 0x846ca68bu
#define BURIN_NOISE_SHIFT 0.375
// Material texel: x: base colour RGBA8 (linear, R lowest), y: 0-7 metallic, 8-15 roughness, 16 overrides the glTF
// material. Material 0 always exists; without the override bit the glTF material holds.

// Unorm/snorm decode: UNORM16 code/65535, UNORM8 code/255, SNORM16 clamp(code/32767, -1, 1) (two's complement).
// Height range: height(1.0) = base_offset (object surface), height(0.0) = base_offset - depth.

#endif
