// The surface's derivatives as the fragment shader gets them from the vertices: how it bends under the pattern.
in vec3 world_duu;  // metres of the world per uv squared; zero: unknown, or flat
in vec3 world_duv;
in vec3 world_dvv;

#ifdef BURIN_CORRECT_DEPTH
uniform mat4 world_to_clip;

// Depth of a world point as the rasterizer would have it, of perspective and parallel views.
float depth_of(vec3 world) {
    vec4 clip = world_to_clip * vec4(world, 1.0);
    return clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 1.0);
}
#endif

// The pixel's own: set by main before anything is traced or shaded.
BurinRound bend;
vec2 bend_start;   // pattern metres where the pixel's ray passes the mesh
vec2 bend_moved;   // place of what is shaded, metres from there, and its drop
float bend_drop;

// The vertices bring derivatives, which part at mirrored faces and hold where a triangle is seen from its edge.
bool has_frames() {
    return dot(world_duu, world_duu) + dot(world_duv, world_duv) + dot(world_dvv, world_dvv) > 0.0;
}

// They go with the triangle: the same side up, and not next to nothing, as they become at a pole.
bool frames_hold(vec3 n, vec3 du, vec3 dv, vec3 along_u, vec3 along_v) {
    float area = dot(n, cross(along_u, along_v));
    return dot(n, cross(du, dv)) * area > 0.05 * area * area;
}

// `own`: the frame comes from the vertices' own directions, with which these go.
BurinRound pattern_bend(mat3 frame, mat3 to_local, bool own) {
    float known = own ? 1.0 : 0.0;
    return burin_bend_at(frame, to_local, known * world_duu, known * world_duv, known * world_dvv);
}
