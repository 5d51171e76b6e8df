// What the core text needs from GLSL: parameter macros, the two textures and the map's constants. Stands between
// core/types.glsl and the rest.
uniform BurinMap burin_map;
uniform highp usampler2D burin_grid;  // RG32UI
uniform highp usampler2D burin_data;  // RGBA32UI
uniform int burin_data_width;

uvec2 fetch_cell(ivec2 index) {
    return texelFetch(burin_grid, index, 0).xy;
}

uvec4 fetch_data(int index) {
    return texelFetch(burin_data, ivec2(index % burin_data_width, index / burin_data_width), 0);
}
