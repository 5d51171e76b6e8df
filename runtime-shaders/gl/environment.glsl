// Light from all around, cpp/environment.hpp.
uniform sampler2D environment_radiance;     // levels by roughness
uniform sampler2D environment_reflectance;  // by cosine of view and roughness
uniform float environment_levels;           // the last one, of roughness 1
uniform vec3 environment_terms[9];
uniform float environment_strength;
uniform vec2 environment_turn;  // cosine and sine of how far it is turned about y

// World directions as the picture has them.
vec3 turn_to_environment(vec3 d) {
    return vec3(environment_turn.x * d.x - environment_turn.y * d.z, d.y, environment_turn.y * d.x + environment_turn.x * d.z);
}

// Between two levels such that the mean of both spreads a point of light as far as the roughness does: by its fourth power.
float level_of(float rough) {
    float lower = min(floor(rough * environment_levels), environment_levels - 1.0);
    vec2 ends = pow(vec2(lower, lower + 1.0) / environment_levels, vec2(4.0));
    return lower + clamp((pow(rough, 4.0) - ends.x) / (ends.y - ends.x), 0.0, 1.0);
}

vec3 mirrored_radiance(vec3 world, float rough) {
    vec3 d = turn_to_environment(world);
    float around = abs(d.x) + abs(d.z) > 0.0 ? atan(d.z, d.x) : 0.0;
    vec2 uv = vec2(0.5 + around * 0.15915494, acos(clamp(d.y, -1.0, 1.0)) * 0.31830989);
    return textureLod(environment_radiance, uv, level_of(rough)).rgb * environment_strength;
}

// What a matt white surface shows.
vec3 gathered_radiance(vec3 world) {
    vec3 n = turn_to_environment(world);
    vec3 sum = environment_terms[0] + environment_terms[1] * n.y + environment_terms[2] * n.z + environment_terms[3] * n.x;
    sum += environment_terms[4] * (n.x * n.y) + environment_terms[5] * (n.y * n.z) + environment_terms[6] * (3.0 * n.z * n.z - 1.0);
    sum += environment_terms[7] * (n.x * n.z) + environment_terms[8] * (n.x * n.x - n.y * n.y);
    return max(sum, vec3(0.0)) * environment_strength;
}

// Share of even light that is mirrored once: (a, b) for f0 a + b.
vec2 mirrored_share(float nv, float rough) {
    vec2 side = vec2(textureSize(environment_reflectance, 0));
    vec2 at = (vec2(nv, rough) * (side - 1.0) + 0.5) / side;
    return textureLod(environment_reflectance, at, 0.0).rg;
}
