// Texels to structs. Needs fetch_cell(ivec2) -> uvec2, fetch_data(int) -> uvec4 and burin_map, which bindings.glsl
// defines for GLSL and decode.hpp for C++. Bit positions: format/layout.h.

uint burin_word(uvec4 v, int i) {
    return i == 0 ? v.x : (i == 1 ? v.y : (i == 2 ? v.z : v.w));
}

float burin_snorm16(uint code) {
    int value = int(code);
    value = value > 32767 ? value - 65536 : value;
    return max(float(value) / 32767.0f, -1.0f);
}

// Drop of a UNORM level, 1 being the object surface.
float burin_drop(float unorm) {
    return burin_map.depth * (1.0f - unorm);
}

// Cell sides from a cell's centre to its start, along one axis.
float burin_start(int spread) {
    int at = (spread + BURIN_START_HALF) % BURIN_START_STEPS - BURIN_START_HALF;
    return float(at) * (1.0f / float(BURIN_START_SPREAD));
}

// Whether references take 32 bits and lists begin on texels (layout.h, lists). Styles begin where elements end.
bool burin_wide() {
    return burin_map.first_style > BURIN_MAX_NARROW_ELEMENT_TEXELS;
}

BurinCell burin_cell(ivec2 index) {
    uvec2 word = fetch_cell(index);
    BurinCell cell;
    cell.first = int(word.x & 0xfffffu) * (burin_wide() ? BURIN_WIDE_REFS_PER_TEXEL : 1);
    cell.count = int((word.x >> 20) & 63u);
    cell.skip = int((word.x >> 26) & 15u);
    cell.flags = word.x >> 30;
    cell.stepped = BURIN_STEPS != 0 && (cell.flags & BURIN_CELL_FLAG_STEP) != 0u;
    cell.start = vec2(0.0f, 0.0f);
    if (cell.stepped) {
        cell.start = vec2(burin_start(cell.skip * BURIN_START_FACTOR_U), burin_start(cell.skip * BURIN_START_FACTOR_V));
        cell.skip = 0;
    }
    cell.level = burin_drop(float(word.y & 0xffffu) / 65535.0f);
    cell.highest = burin_drop(float((word.y >> 16) & 255u) / 255.0f);
    cell.lowest = burin_drop(float(word.y >> 24) / 255.0f);
    return cell;
}

// Reference i of a cell's list. `texel` is the caller's from one i to the next, so that each is fetched once.
uint burin_listed(BurinCell cell, int i, BURIN_INOUT(uvec4) texel) {
    bool wide = burin_wide();
    int index = cell.first + i;
    int slot = wide ? index % BURIN_WIDE_REFS_PER_TEXEL : index % BURIN_REFS_PER_TEXEL;
    if (i == 0 || slot == 0) texel = fetch_data(burin_map.first_list + (wide ? index / BURIN_WIDE_REFS_PER_TEXEL : index / BURIN_REFS_PER_TEXEL));
    uint word = burin_word(texel, wide ? slot : slot / 2);
    if (wide) return word;
    return slot % 2 == 0 ? word & 0xffffu : word >> 16;
}

// Exact in float: 20 bits of code, a power of two, and whole tiles.
vec2 burin_vertex_uv(uint x, uint y) {
    return vec2(float(x & 0xfffffu), float(y & 0xfffffu)) * (1.0f / float(BURIN_COORDINATE_STEPS)) - vec2(0.5f, 0.5f);
}

vec2 burin_direction(vec2 v, vec2 otherwise) {
    float l = length(v);
    return l > 0.0f ? v * (1.0f / l) : otherwise;
}

float burin_scale(uint code) {
    return float(code & 0xffffu) * (1.0f / float(BURIN_SCALE_STEPS));
}

vec4 burin_floats(uvec4 bits) {
    return vec4(uintBitsToFloat(bits.x), uintBitsToFloat(bits.y), uintBitsToFloat(bits.z), uintBitsToFloat(bits.w));
}

// Whole tiles by which an element is moved: to the image whose chord is nearest to the cell's centre.
vec2 burin_image(vec2 p0, vec2 p2, vec2 centre) {
    return burin_map.repeats != 0 ? floor(centre - (p0 + p2) * 0.5f + vec2(0.5f, 0.5f)) : vec2(0.0f, 0.0f);
}

// The element as seen from `origin`, in that image.
BurinElement burin_element(uint reference, vec2 origin, vec2 centre) {
    uvec4 a = fetch_data(int(reference));
    BurinElement e;
    e.curved = BURIN_CURVES != 0 && (a.z & 0x10000000u) != 0u;
    vec2 p0 = burin_vertex_uv(a.x, a.y);
    vec2 p2 = burin_vertex_uv(a.z, a.w);
    vec2 p1 = (p0 + p2) * 0.5f;
    e.scales = vec4(1.0f, 1.0f, 1.0f, 1.0f);
    e.scaled = false;
    e.waved = false;
    e.function = uvec4(0u, 0u, 0u, 0u);
    e.width_terms = vec4(1.0f, 0.0f, 0.0f, 0.0f);
    e.height_terms = e.width_terms;
    e.turns = 0;
    e.argument = vec2(0.0f, 0.0f);
    int next = int(reference) + 1;
    if ((a.z & 0x20000000u) != 0u) {
        uvec4 b = fetch_data(next);
        ++next;
        if (e.curved) p1 = burin_vertex_uv(b.x, b.y);
        e.scales = vec4(burin_scale(b.z), burin_scale(b.z >> 16), burin_scale(b.w), burin_scale(b.w >> 16));
        e.scaled = b.z >> 16 != (b.z & 0xffffu) || b.w >> 16 != (b.w & 0xffffu);
    }
#if BURIN_FUNCTION_KINDS != 0
    if ((a.z & 0x40000000u) != 0u) {
        uvec4 c = fetch_data(next);
        int function = burin_map.first_function + int(c.z & 0xffffu);
        e.waved = true;
        e.scaled = true;
        e.function = fetch_data(function);
        e.turns = int(c.x >> BURIN_ARGUMENT_BITS);
        e.argument = vec2(float(c.x & 0xffffu), float(int(c.y - c.x))) * (1.0f / float(BURIN_ARGUMENT_STEPS));
#if (BURIN_FUNCTION_KINDS & 2) != 0
        if ((e.function.x & 3u) == BURIN_FUNCTION_POLYNOMIAL) {
            e.width_terms = burin_floats(fetch_data(function + 1));
            e.height_terms = burin_floats(fetch_data(function + 2));
        }
#endif
    }
#endif
    e.image = burin_image(p0, p2, centre);
    e.p0 = (p0 + e.image) * burin_map.size - origin;
    e.p1 = (p1 + e.image) * burin_map.size - origin;
    e.p2 = (p2 + e.image) * burin_map.size - origin;
    vec2 chord = burin_direction(e.p2 - e.p0, vec2(1.0f, 0.0f));
    e.extent = length(e.p2 - e.p0);
    e.t0 = e.curved ? burin_direction(e.p1 - e.p0, chord) : chord;
    e.t2 = e.curved ? burin_direction(e.p2 - e.p1, chord) : chord;
    e.kind0 = (a.z >> 20) & 15u;
    e.kind2 = (a.z >> 24) & 15u;
    e.clip0 = float(a.x >> 20) * (3.14159265f / float(BURIN_CLIP_ANGLE_STEPS));
    e.clip2 = float(a.y >> 20) * (3.14159265f / float(BURIN_CLIP_ANGLE_STEPS));
    e.style = a.w >> 20;
    e.slack = 0.0f;
    return e;
}

BurinStyle burin_style(uint index) {
    uvec4 texel = fetch_data(burin_map.first_style + int(index));
    BurinStyle style;
    style.first = burin_map.first_profile + int(texel.x & 0xffffu);
    style.count = int((texel.x >> 16) & 63u);
    style.stepped = BURIN_STEPS != 0 && ((texel.x >> 22) & 1u) != 0u;
    style.material = texel.x >> 23;
    style.level = burin_drop(float(texel.y & 0xffffu) / 65535.0f);
    style.right_level = burin_drop(float(texel.y >> 16) / 65535.0f);
    style.reach = uintBitsToFloat(texel.z);
    style.internal = texel.w;
    return style;
}

vec2 burin_point(uvec4 texel, int i) {
    uint word = burin_word(texel, i % BURIN_POINTS_PER_TEXEL);
    return vec2(burin_snorm16(word & 0xffffu), burin_snorm16(word >> 16));
}

uvec4 burin_point_texel(BurinStyle style, int i) {
    return fetch_data(style.first + i / BURIN_POINTS_PER_TEXEL);
}

vec2 burin_profile_point(BurinStyle style, int i) {
    return burin_point(burin_point_texel(style, i), i);
}

struct BurinMaterial {
    bool overrides;    // false: the glTF material holds
    vec4 base_color;  // linear
    float metallic;
    float roughness;
};

BurinMaterial burin_material(uint index) {
    uvec4 texel = fetch_data(burin_map.first_material + int(index));
    BurinMaterial material;
    material.overrides = ((texel.y >> 16) & 1u) != 0u;
    material.base_color = vec4(float(texel.x & 255u), float((texel.x >> 8) & 255u), float((texel.x >> 16) & 255u),
                               float(texel.x >> 24)) * (1.0f / 255.0f);
    material.metallic = float(texel.y & 255u) / 255.0f;
    material.roughness = float((texel.y >> 8) & 255u) / 255.0f;
    return material;
}
