// Words <-> codes <-> values. The one place where the bit layout of layout.h is turned into shifts.
#include <burin/format/texels.hpp>

#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

namespace burin {
namespace {

constexpr std::uint32_t mask(unsigned bits) { return bits >= 32 ? 0xFFFFFFFFu : (1u << bits) - 1u; }

constexpr std::uint32_t field(std::uint32_t word, unsigned first, unsigned bits) {
    return (word >> first) & mask(bits);
}

// Places `value` at bit `first`; a value that would spill into the next field is a mistake of the caller.
std::uint32_t place(std::uint32_t value, unsigned first, unsigned bits) {
    assert(value <= mask(bits));
    return (value & mask(bits)) << first;
}

constexpr unsigned kCoordinate = BURIN_COORDINATE_BITS;
constexpr unsigned kFirst = BURIN_CELL_FIRST_BITS;
constexpr unsigned kCount = BURIN_CELL_COUNT_BITS;
constexpr unsigned kSkip = BURIN_CELL_SKIP_BITS;
constexpr unsigned kAngle = BURIN_CLIP_ANGLE_BITS;
constexpr unsigned kPoints = BURIN_STYLE_POINTS_BITS;
constexpr unsigned kMaterial = BURIN_STYLE_MATERIAL_BITS;
static_assert(kFirst + kCount + kSkip + 2 == 32);
static_assert(kCoordinate + kAngle == 32);
static_assert(16 + kPoints + 1 + kMaterial == 32);
static_assert(mask(kCount) == BURIN_MAX_REFS_PER_CELL);
static_assert(mask(kFirst) + 1 == BURIN_MAX_NARROW_LIST_TEXELS * BURIN_REFS_PER_TEXEL);
static_assert(mask(kFirst) + 1 == BURIN_MAX_LIST_TEXELS);
static_assert(mask(16) + 1 == BURIN_MAX_NARROW_ELEMENT_TEXELS && 32 * BURIN_WIDE_REFS_PER_TEXEL == 16 * BURIN_REFS_PER_TEXEL);
// All sections at their longest fit one texture, and indices of references fit 32 bits with a count beside them.
static_assert(BURIN_MAX_ELEMENT_TEXELS + BURIN_MAX_STYLES + BURIN_MAX_PROFILE_TEXELS + BURIN_MAX_MATERIALS + BURIN_MAX_LIST_TEXELS +
                  BURIN_MAX_FUNCTION_TEXELS <= BURIN_MAX_TEXTURE_SIDE * BURIN_MAX_TEXTURE_SIDE);
static_assert(std::uint64_t{BURIN_MAX_LIST_TEXELS} * BURIN_WIDE_REFS_PER_TEXEL << kCount <= std::uint64_t{1} << 32);
static_assert(mask(kMaterial) + 1 == BURIN_MAX_MATERIALS && mask(12) + 1 == BURIN_MAX_STYLES);

std::uint32_t end_kind(const EndCode& end) { return place(end.priority, 0, 2) | place(end.shape, 2, 2); }

EndCode end_from(std::uint32_t kind, std::uint32_t clip_angle) {
    return {field(kind, 0, 2), field(kind, 2, 2), clip_angle};
}

// Rounds to whole steps in two stages, first to 2^-21 of a step. The first stage takes away the noise that an
// earlier division or addition of a whole tile left, so that the second one cuts equal values equally even at
// an exact half.
bool round_steps(double steps, std::int64_t& rounded) {
    constexpr double kFine = 2097152.0;
    if (!(std::abs(steps) < 4294967296.0)) return false;
    const auto fine = static_cast<std::int64_t>(std::floor(steps * kFine + 0.5));
    rounded = (fine + (std::int64_t{1} << 20)) >> 21;
    return true;
}

bool encode_range(double steps, std::int64_t low, std::int64_t high, std::int64_t& code) {
    std::int64_t rounded = 0;
    if (!round_steps(steps, rounded) || rounded < low || rounded > high) return false;
    code = rounded;
    return true;
}

bool encode_unsigned(double steps, std::uint32_t high, std::uint32_t& code) {
    std::int64_t rounded = 0;
    if (!encode_range(steps, 0, high, rounded)) return false;
    code = static_cast<std::uint32_t>(rounded);
    return true;
}

}  // namespace

CellTexel pack_cell(const CellCode& c) {
    return {place(c.first_reference, 0, kFirst) | place(c.count, kFirst, kCount) |
                place(c.skip, kFirst + kCount, kSkip) | place(c.flags, 30, 2),
            place(c.level, 0, 16) | place(c.highest, 16, 8) | place(c.lowest, 24, 8)};
}

CellCode unpack_cell(const CellTexel& t) {
    CellCode c;
    c.first_reference = field(t[0], 0, kFirst);
    c.count = field(t[0], kFirst, kCount);
    c.skip = field(t[0], kFirst + kCount, kSkip);
    c.flags = field(t[0], 30, 2);
    c.level = field(t[1], 0, 16);
    c.highest = field(t[1], 16, 8);
    c.lowest = field(t[1], 24, 8);
    return c;
}

std::array<Texel, 3> pack_element(const ElementCode& e) {
    assert(e.has_texel_b || !e.quadratic);
    const Texel a = {place(e.p0.u, 0, kCoordinate) | place(e.start.clip_angle, kCoordinate, kAngle),
                     place(e.p0.v, 0, kCoordinate) | place(e.end.clip_angle, kCoordinate, kAngle),
                     place(e.p2.u, 0, kCoordinate) | place(end_kind(e.start), 20, 4) |
                         place(end_kind(e.end), 24, 4) | (e.quadratic ? 1u << 28 : 0u) |
                         (e.has_texel_b ? 1u << 29 : 0u) | (e.has_texel_c ? 1u << 30 : 0u) |
                         place(e.unused & 1u, 31, 1),
                     place(e.p2.v, 0, kCoordinate) | place(e.style, 20, 12)};
    const Texel c = e.has_texel_c ? Texel{e.argument0, e.argument1,
                                          place(e.function, 0, 16) | (e.unused_c ? 1u << 31 : 0u), 0}
                                  : Texel{};
    if (!e.has_texel_b) return {a, Texel{}, c};
    const Texel b = {place(e.p1.u, 0, kCoordinate) | place(field(e.unused, 1, 12), 20, 12),
                     place(e.p1.v, 0, kCoordinate) | place(field(e.unused, 13, 12), 20, 12),
                     place(e.width0, 0, 16) | place(e.width1, 16, 16),
                     place(e.height0, 0, 16) | place(e.height1, 16, 16)};
    return {a, b, c};
}

ElementCode unpack_element(const Texel& a, const Texel& b, const Texel& c) {
    ElementCode e;
    e.p0 = {field(a[0], 0, kCoordinate), field(a[1], 0, kCoordinate)};
    e.p2 = {field(a[2], 0, kCoordinate), field(a[3], 0, kCoordinate)};
    e.start = end_from(field(a[2], 20, 4), field(a[0], kCoordinate, kAngle));
    e.end = end_from(field(a[2], 24, 4), field(a[1], kCoordinate, kAngle));
    e.quadratic = field(a[2], 28, 1) != 0;
    e.has_texel_b = field(a[2], 29, 1) != 0;
    e.has_texel_c = field(a[2], 30, 1) != 0;
    e.unused = field(a[2], 31, 1);
    e.style = field(a[3], 20, 12);
    if (e.has_texel_c) {
        e.argument0 = c[0];
        e.argument1 = c[1];
        e.function = field(c[2], 0, 16);
        e.unused_c = field(c[2], 16, 16) != 0 || c[3] != 0;
    }
    if (!e.has_texel_b) return e;
    e.p1 = {field(b[0], 0, kCoordinate), field(b[1], 0, kCoordinate)};
    e.unused |= field(b[0], 20, 12) << 1 | field(b[1], 20, 12) << 13;
    e.width0 = field(b[2], 0, 16);
    e.width1 = field(b[2], 16, 16);
    e.height0 = field(b[3], 0, 16);
    e.height1 = field(b[3], 16, 16);
    return e;
}

bool element_has_texel_b(const Texel& a) { return field(a[2], 29, 1) != 0; }
bool element_has_texel_c(const Texel& a) { return field(a[2], 30, 1) != 0; }
std::uint32_t element_texel_count(const Texel& a) { return 1u + field(a[2], 29, 1) + field(a[2], 30, 1); }

std::array<Texel, 3> pack_function(const FunctionCode& f) {
    std::array<Texel, 3> texels{};
    texels[0] = {place(f.kind, 0, 2) | place(f.octaves, 2, 4) | place(field(f.unused, 0, 26), 6, 26),
                 pack_profile_point({f.width, f.height}), f.seed, f.period};
    for (unsigned i = 0; i < 8 && f.kind == BURIN_FUNCTION_POLYNOMIAL; ++i)
        texels[1 + i / 4][i % 4] = std::bit_cast<std::uint32_t>(f.coefficients[i]);
    return texels;
}

FunctionCode unpack_function(const std::array<Texel, 3>& texels) {
    const Texel& head = texels[0];
    FunctionCode f;
    f.kind = field(head[0], 0, 2);
    f.octaves = field(head[0], 2, 4);
    f.unused = field(head[0], 6, 26);
    const ProfilePointCode amplitudes = unpack_profile_point(head[1]);
    f.width = amplitudes.b;
    f.height = amplitudes.h;
    f.seed = head[2];
    f.period = head[3];
    for (unsigned i = 0; i < 8 && f.kind == BURIN_FUNCTION_POLYNOMIAL; ++i)
        f.coefficients[i] = std::bit_cast<float>(texels[1 + i / 4][i % 4]);
    return f;
}

std::uint32_t function_texel_count(const Texel& head) {
    return field(head[0], 0, 2) == BURIN_FUNCTION_POLYNOMIAL ? 3u : 1u;
}

Texel pack_style(const StyleCode& s) {
    return {place(s.profile_texel, 0, 16) | place(s.point_count, 16, kPoints) |
                (s.step ? 1u << (16 + kPoints) : 0u) | place(s.material, 17 + kPoints, kMaterial),
            place(s.level_left, 0, 16) | place(s.level_right, 16, 16), std::bit_cast<std::uint32_t>(s.reach),
            s.internal_mask};
}

StyleCode unpack_style(const Texel& t) {
    StyleCode s;
    s.profile_texel = field(t[0], 0, 16);
    s.point_count = field(t[0], 16, kPoints);
    s.step = field(t[0], 16 + kPoints, 1) != 0;
    s.material = field(t[0], 17 + kPoints, kMaterial);
    s.level_left = field(t[1], 0, 16);
    s.level_right = field(t[1], 16, 16);
    s.reach = std::bit_cast<float>(t[2]);
    s.internal_mask = t[3];
    return s;
}

std::uint32_t pack_profile_point(const ProfilePointCode& p) {
    assert(p.b >= -32768 && p.b <= 32767 && p.h >= -32768 && p.h <= 32767);
    return static_cast<std::uint16_t>(p.b) | static_cast<std::uint32_t>(static_cast<std::uint16_t>(p.h))
                                                 << 16;
}

ProfilePointCode unpack_profile_point(std::uint32_t word) {
    return {static_cast<std::int16_t>(field(word, 0, 16)), static_cast<std::int16_t>(field(word, 16, 16))};
}

Texel pack_material(const MaterialCode& m) {
    std::uint32_t color = 0;
    for (unsigned i = 0; i < 4; ++i) color |= place(m.base_color[i], 8 * i, 8);
    return {color,
            place(m.metallic, 0, 8) | place(m.roughness, 8, 8) | (m.overrides ? 1u << 16 : 0u) |
                place(field(m.unused, 0, 15), 17, 15),
            0, 0};
}

MaterialCode unpack_material(const Texel& t) {
    MaterialCode m;
    for (unsigned i = 0; i < 4; ++i) m.base_color[i] = field(t[0], 8 * i, 8);
    m.metallic = field(t[1], 0, 8);
    m.roughness = field(t[1], 8, 8);
    m.overrides = field(t[1], 16, 1) != 0;
    m.unused = field(t[1], 17, 15) | ((t[2] | t[3]) != 0 ? 1u << 15 : 0u);
    return m;
}

CellTexel cell_texel(const PackedTextures& textures, std::uint32_t index) {
    const std::size_t at = std::size_t{2} * index;
    assert(at + 2 <= textures.grid.size());
    return {textures.grid[at], textures.grid[at + 1]};
}

Texel data_texel(const PackedTextures& textures, std::uint32_t index) {
    const std::size_t at = std::size_t{4} * index;
    assert(at + 4 <= textures.data.size());
    return {textures.data[at], textures.data[at + 1], textures.data[at + 2], textures.data[at + 3]};
}

std::uint32_t list_begin(const Sections& sections, const CellCode& cell) {
    return cell.first_reference * (sections.wide() ? BURIN_WIDE_REFS_PER_TEXEL : 1u);
}

std::uint32_t first_reference_code(const Sections& sections, std::uint32_t index) {
    return index / (sections.wide() ? BURIN_WIDE_REFS_PER_TEXEL : 1u);
}

std::uint32_t list_reference(const PackedTextures& textures, std::uint32_t index) {
    if (textures.sections.wide()) {
        const std::size_t at = std::size_t{4} * textures.sections.lists_begin() + index;
        assert(at < textures.data.size());
        return textures.data[at];
    }
    const std::size_t word = std::size_t{4} * textures.sections.lists_begin() + index / 2;
    assert(word < textures.data.size());
    return field(textures.data[word], 16 * (index & 1u), 16);
}

ElementCode element_at(const PackedTextures& textures, std::uint32_t texel) {
    const Texel a = data_texel(textures, texel);
    const std::uint32_t count = element_texel_count(a);
    return unpack_element(a, count > 1 ? data_texel(textures, texel + 1) : Texel{},
                          count > 1 ? data_texel(textures, texel + count - 1) : Texel{});
}

FunctionCode function_at(const PackedTextures& textures, std::uint32_t texel) {
    const std::uint32_t at = textures.sections.functions_begin() + texel;
    std::array<Texel, 3> texels{};
    texels[0] = data_texel(textures, at);
    for (std::uint32_t i = 1; i < function_texel_count(texels[0]); ++i) texels[i] = data_texel(textures, at + i);
    return unpack_function(texels);
}

bool encode_coordinate(double uv, std::uint32_t& code) {
    constexpr std::int64_t kTile = static_cast<std::int64_t>(BURIN_COORDINATE_STEPS);
    if (!(std::abs(uv) < 4.0)) return false;
    std::int64_t steps = 0;
    if (!round_steps(uv * BURIN_COORDINATE_STEPS, steps)) return false;
    const std::int64_t shifted = steps + kTile / 2;
    if (shifted < 0 || shifted > static_cast<std::int64_t>(mask(kCoordinate))) return false;
    code = static_cast<std::uint32_t>(shifted);
    return true;
}

double decode_coordinate(std::uint32_t code) { return code / BURIN_COORDINATE_STEPS - 0.5; }

bool encode_clip_angle(double radians, std::uint32_t& code) {
    if (!(std::abs(radians) < 1e6)) return false;
    std::int64_t steps = 0;
    const double turns = radians / std::numbers::pi;
    if (!round_steps((turns - std::floor(turns)) * BURIN_CLIP_ANGLE_STEPS, steps)) return false;
    code = static_cast<std::uint32_t>(steps) & mask(kAngle);
    return true;
}

double decode_clip_angle(std::uint32_t code) { return code * (std::numbers::pi / BURIN_CLIP_ANGLE_STEPS); }

bool encode_scale(double scale, std::uint32_t& code) {
    return encode_unsigned(scale * BURIN_SCALE_STEPS, 65535, code);
}

double decode_scale(std::uint32_t code) { return code / BURIN_SCALE_STEPS; }

bool encode_argument(double argument, std::uint32_t& code) {
    return encode_unsigned(argument * BURIN_ARGUMENT_STEPS, 0xFFFFFFFFu, code);
}

double decode_argument(std::uint32_t code) { return code / BURIN_ARGUMENT_STEPS; }

bool encode_unorm16(double value, std::uint32_t& code) {
    return encode_unsigned(value * 65535.0, 65535, code);
}
double decode_unorm16(std::uint32_t code) { return code / 65535.0; }
bool encode_unorm8(double value, std::uint32_t& code) { return encode_unsigned(value * 255.0, 255, code); }
double decode_unorm8(std::uint32_t code) { return code / 255.0; }

bool encode_unorm8_floor(double value, std::uint32_t& code) {
    const double steps = std::floor(value * 255.0 + 255e-9);
    return steps >= 0.0 && steps <= 255.0 && encode_unsigned(steps, 255, code);
}

bool encode_unorm8_ceil(double value, std::uint32_t& code) {
    const double steps = std::ceil(value * 255.0 - 255e-9);
    return steps >= 0.0 && steps <= 255.0 && encode_unsigned(steps, 255, code);
}

bool encode_snorm16(double value, std::int32_t& code) {
    std::int64_t rounded = 0;
    if (!encode_range(value * 32767.0, -32767, 32767, rounded)) return false;
    code = static_cast<std::int32_t>(rounded);
    return true;
}

double decode_snorm16(std::int32_t code) { return code <= -32767 ? -1.0 : code / 32767.0; }

}  // namespace burin
