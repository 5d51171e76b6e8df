// The frame of pattern space on the mesh.
in vec3 world_position;
in vec3 world_normal;
in vec2 pattern_uv;
in vec3 world_along_u;
in vec3 world_along_v;
flat in float chart_number;
uniform int mirrored;  // 1: the triangles are wound against their order in the file

// World directions of one unit of u and of v, from the derivatives of the triangle: exact on flat faces, and it jumps
// from face to face on round ones, where the mesh's own directions are better.
void derived_directions(BURIN_OUT(vec3) along_u, BURIN_OUT(vec3) along_v) {
    vec3 px = dFdx(world_position);
    vec3 py = dFdy(world_position);
    vec2 ux = dFdx(pattern_uv);
    vec2 uy = dFdy(pattern_uv);
    float area = ux.x * uy.y - ux.y * uy.x;
    area = abs(area) > 1.0e-30 ? area : 1.0e-30;
    along_u = (px * uy.y - py * ux.y) / area;
    along_v = (py * ux.x - px * uy.x) / area;
}

// Columns: world directions of one metre along x, y and z of pattern space. `own`: as the mesh brings them.
mat3 pattern_frame(vec3 n, BURIN_OUT(bool) own) {
    vec3 along_u;
    vec3 along_v;
    derived_directions(along_u, along_v);
    // Where mirrored faces meet, what the mesh brings cancels out.
    own = dot(world_along_u, along_u) > 0.5 * dot(along_u, along_u) &&
          dot(world_along_v, along_v) > 0.5 * dot(along_v, along_v);
    if (has_frames()) own = frames_hold(n, world_along_u, world_along_v, along_u, along_v);
    vec3 along_x = (own ? world_along_u : along_u) / burin_map.size.x;
    vec3 along_y = (own ? world_along_v : along_v) / burin_map.size.y;
    return mat3(along_x - n * dot(along_x, n), along_y - n * dot(along_y, n), n);
}

// The triangle's chart, and how it is wound in uv: screen and pattern agree when its front is seen and both run alike.
int chart_key() {
    vec2 ux = dFdx(pattern_uv);
    vec2 uy = dFdy(pattern_uv);
    bool clockwise = (ux.x * uy.y - ux.y * uy.x < 0.0) == gl_FrontFacing;
    return 2 * int(chart_number + 0.5) + (clockwise != (mirrored != 0) ? 1 : 0);
}
