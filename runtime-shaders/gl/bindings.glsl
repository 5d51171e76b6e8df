// What the core text needs from GLSL: parameter macros, the two textures and the map's constants. Stands between
// core/types.glsl and the rest.
uniform BurinMap burin_map;
uniform highp usampler2D burin_grid;  // RG32UI
uniform highp usampler2D burin_data;  // RGBA32UI
uniform int burin_data_width;
#if BURIN_CHARTS != 0
uniform BurinCharts burin_charts;
uniform highp usampler2D burin_chart_table;  // RGBA32UI

uvec4 fetch_chart(int index) {
    int width = textureSize(burin_chart_table, 0).x;
    return texelFetch(burin_chart_table, ivec2(index % width, index / width), 0);
}
#endif

#ifdef BURIN_COUNTED
vec4 burin_fetched = vec4(0.0);  // texels so far: cells, elements, lists, others of the data texture
#endif

uvec2 fetch_cell(ivec2 index) {
#ifdef BURIN_COUNTED
    burin_fetched.x += 1.0;
#endif
    return texelFetch(burin_grid, index, 0).xy;
}

uvec4 fetch_data(int index) {
#ifdef BURIN_COUNTED
    burin_fetched += index < burin_map.first_style ? vec4(0, 1, 0, 0) : index < burin_map.first_list ? vec4(0, 0, 0, 1) : vec4(0, 0, 1, 0);
#endif
    return texelFetch(burin_data, ivec2(index % burin_data_width, index / burin_data_width), 0);
}
