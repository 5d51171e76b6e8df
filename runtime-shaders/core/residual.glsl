// The residual: slopes that the paths leave out, added to the normal of what was met (SPECIFICATION.md, section 13).

// Slopes along x and y of pattern space, metres per metre, of a filtered texel whose channels run from -1 to 1.
vec2 burin_residual_slopes(vec3 texel, float scale) {
    return vec2(-texel.x, texel.y) * (scale / max(texel.z, 1.0f / 255.0f));
}

// Unit normal, z up. Facets that face up lean further; upright and undercut ones, which the residual was not measured
// on, keep their normals.
vec3 burin_add_slopes(vec3 normal, vec2 slopes) {
    vec2 lean = slopes * max(normal.z, 0.0f);
    return normalize(vec3(normal.x - lean.x, normal.y - lean.y, normal.z));
}
