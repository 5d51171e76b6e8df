// The residual's texture. Stands behind core/residual.glsl.
uniform highp sampler2D burin_residual;
uniform float burin_residual_scale;  // 0: the material has none

// Slopes at a place in pattern space, metres. `along_x` and `along_y` are how uv changes from pixel to pixel on the mesh:
// where the ray meets the surface it may jump.
vec2 fetch_residual(vec2 place, vec2 along_x, vec2 along_y) {
    if (burin_residual_scale == 0.0) return vec2(0.0);
    vec2 uv = place / burin_map.size;
    bool outside = any(lessThan(uv, vec2(0.0))) || any(greaterThan(uv, vec2(1.0)));
    if (burin_map.repeats == 0 && outside) return vec2(0.0);
    vec3 texel = textureGrad(burin_residual, uv, along_x, along_y).xyz * 2.0 - 1.0;
    return burin_residual_slopes(texel, burin_residual_scale);
}
