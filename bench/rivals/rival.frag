// A displacement map drawn per pixel. TECHNIQUE: 0 normals, 1 parallax, 2 relief, 3 cones, 4 triangles. Stands behind gl/lamp.glsl.
in vec3 world_position;
in vec3 world_normal;
in vec2 pattern_uv;
in vec3 world_along_u;
in vec3 world_along_v;
#ifdef RIVAL_TRIANGLES
in float drop;
uniform vec4 window;  // uv of the object surface that is there: low, high
#endif
uniform highp sampler2D heights;  // r: 1 at the highest place of the map, 0 at the lowest; g: root of the cone's ratio over the widest one
uniform sampler2D normals;        // x and y, signed
uniform sampler2D shares;         // of materials 1 to 4
uniform vec2 metres;              // of the tile
uniform vec2 texels;              // of the maps' first level
uniform vec2 drops;               // metres below the object surface, of the highest place and of the lowest
uniform float widest;             // cone: metres over the plane per metre of height
uniform vec3 albedos[5];
uniform vec2 metal_rough[5];
uniform vec3 eye;
uniform int count;         // samples
uniform vec2 places[64];   // of them, in pixels
uniform int steps;
uniform int refinements;
uniform float sample_side; // of a sample, in pixels
uniform float bias;
uniform float anisotropy;
layout(location = 0) out vec4 color;

mat3 to_pattern;    // world directions to pattern space, metres along u, along v and outwards
vec2 light_slope;   // uv that the light moves over the plane while it falls through the map's whole range
vec2 metric_light;  // the same per metre of fall, metres
bool light_above;
float level;        // mip level of a sample's footprint
float even_level;   // the same as a whole number

// How far below the highest place the surface lies, of the map's range.
float fall_at(vec2 uv) {
    return 1.0 - textureLod(heights, uv, even_level).r;
}

// Turns of a linear search for a ray that moves so many metres per metre of fall.
int turns_for(vec2 slope) {
    return int(ceil(float(steps) * clamp(length(slope), 0.25, 6.0)));
}

// A ray that enters the map's range at `start` and leaves it at start + way.
#if TECHNIQUE == 1 || TECHNIQUE == 2
float search(vec2 start, vec2 way, int turns) {
    float below = fall_at(start);
    if (below <= 1.0 / 255.0) return below;
    float step_size = 1.0 / float(turns);
    float at = 0.0;
    float before = below;
    for (int k = 0; k < 1024; ++k) {
        if (k >= turns) break;
        at += step_size;
        below = fall_at(start + way * at);
        if (below <= at) break;
        before = below - at;
    }
    float low = at - step_size;
    float high = at;
#if TECHNIQUE == 1
    // Secants: the surface between two places is nearly straight.
    float under = at - below;
    for (int k = 0; k < 8; ++k) {
        if (k >= refinements) break;
        float middle = low + (high - low) * before / max(before + under, 1.0e-6);
        float off = fall_at(start + way * middle) - middle;
        if (off > 0.0) {
            low = middle;
            before = off;
        } else {
            high = middle;
            under = -off;
        }
    }
    return low + (high - low) * before / max(before + under, 1.0e-6);
#else
    for (int k = 0; k < 12; ++k) {
        if (k >= refinements) break;
        float middle = 0.5 * (low + high);
        if (fall_at(start + way * middle) > middle) low = middle;
        else high = middle;
    }
    return high;
#endif
}
#endif

#if TECHNIQUE == 3
// Cone steps to within the solid, then halvings between the last two places. `inside`: it was met before `range_end`.
float search_cones(vec2 start, vec2 way, float slope, float range_end, out bool inside) {
    // At rims cones are as narrow as can be: a texel is always passed.
    float least = min(exp2(even_level) / max(length(way * texels), 1.0e-3), 0.1);
    float at = 0.0;
    float last = 0.0;
    inside = false;
    for (int k = 0; k < 256; ++k) {
        if (k >= steps) break;
        vec2 found = textureLod(heights, start + way * at, even_level).rg;
        float above = 1.0 - found.r - at;
        inside = above <= 0.0;
        if (inside || at >= range_end) break;
        float ratio = found.g * found.g * widest;
        last = at;
        at = min(at + max(ratio * above / (ratio + slope), least), range_end);
    }
    if (!inside) return at;
    float low = last;
    float high = at;
    for (int k = 0; k < 12; ++k) {
        if (k >= refinements || high <= low) break;
        float middle = 0.5 * (low + high);
        if (fall_at(start + way * middle) > middle) low = middle;
        else high = middle;
    }
    return high;
}
#endif

// Where a ray from the object surface meets the map.
float meet(vec2 start, vec2 way, vec2 slope) {
#if TECHNIQUE == 1 || TECHNIQUE == 2
    return search(start, way, turns_for(slope));
#elif TECHNIQUE == 3
    bool inside;
    return search_cones(start, way, length(slope), 1.0, inside);
#else
    return 0.0;
#endif
}

uniform float shadow_slack;  // what of the map's range counts as nothing

// 1 where the light reaches a place that lies so deep.
float reached_by_light(vec2 uv, float deep) {
    if (!light_above) return 0.0;
#if TECHNIQUE == 0
    return 1.0;
#else
    if (deep <= shadow_slack) return 1.0;
#if TECHNIQUE == 3
    bool inside;
    search_cones(uv - light_slope * deep, light_slope, length(metric_light), deep - shadow_slack, inside);
    return inside ? 0.0 : 1.0;
#else
    int turns = int(ceil(float(turns_for(metric_light)) * deep));
    float step_size = (deep - shadow_slack) / float(turns);
    float lit = 1.0;
    for (int k = 0; k < 1024; ++k) {
        if (k >= turns) break;
        float at = deep - shadow_slack - step_size * (float(k) + 0.5);
        if (fall_at(uv - light_slope * (deep - at)) < at) {
            lit = 0.0;
            break;
        }
    }
    return lit;
#endif
#endif
}

Paint paint_at(vec2 uv) {
    Paint paint;
    paint.glow = vec3(0.0);
    paint.open = 1.0;
    paint.albedo = albedos[0];
    vec2 made = metal_rough[0];
#if CHANNELS > 0
    vec4 share = textureLod(shares, uv, level);
    for (int k = 0; k < CHANNELS; ++k) {
        paint.albedo += (albedos[k + 1] - albedos[0]) * share[k];
        made += (metal_rough[k + 1] - metal_rough[0]) * share[k];
    }
#endif
    paint.metal = made.x;
    paint.rough = made.y;
    return paint;
}

vec3 shaded(vec2 uv, float lit) {
    vec2 lean = textureLod(normals, uv, level).xy;
    vec3 n = normalize(transpose(to_pattern) * vec3(lean, sqrt(max(1.0 - dot(lean, lean), 0.0))));
    Paint paint = paint_at(uv);
    vec3 around = shade_surround(n, paint);
    return mix(clamp(around, 0.0, 1.0), clamp(around + shade_lamp(n, paint), 0.0, 1.0), lit);
}

// Mip level of what one sample stands for.
float level_of(vec2 along_x, vec2 along_y) {
    vec2 x = along_x * texels * sample_side;
    vec2 y = along_y * texels * sample_side;
    float longer = max(max(length(x), length(y)), 1.0e-9);
    float shorter = abs(x.x * y.y - x.y * y.x) / longer;
    return max(0.0, log2(max(shorter, longer / anisotropy)) + bias);
}

void main() {
    to_eye = normalize(eye - world_position);
    vec3 n = normalize(world_normal);
    vec3 along_x = world_along_u / metres.x;
    vec3 along_y = world_along_v / metres.y;
    to_pattern = inverse(mat3(along_x - n * dot(along_x, n), along_y - n * dot(along_y, n), n));
    vec3 toward = to_pattern * -to_eye;
    vec2 slope = toward.xy / max(-toward.z, 0.02);
    vec3 lamp = to_pattern * light;
    light_above = lamp.z > 0.0;
    metric_light = -lamp.xy / max(lamp.z, 0.02);
    float range = drops.y - drops.x;
    light_slope = metric_light * range / metres;
    vec2 side_x = dFdx(pattern_uv);
    vec2 side_y = dFdy(pattern_uv);
    level = level_of(side_x, side_y);
    even_level = floor(level + 0.5);
#ifdef RIVAL_TRIANGLES
    // Of the relief that shows which lies behind the object surface.
    vec2 entered = pattern_uv - slope * drop / metres;
    if (any(lessThan(entered, window.xy)) || any(greaterThan(entered, window.zw))) discard;
    // Vertices may stand further apart than texels: light is asked for by the texel's own height.
    color = vec4(shaded(pattern_uv, reached_by_light(pattern_uv, fall_at(pattern_uv))), 1.0);
#else
    vec2 way = slope * range / metres;
    vec2 start = pattern_uv + slope * drops.x / metres;
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 64; ++k) {
        if (k >= count) break;
        vec2 from = start + side_x * places[k].x + side_y * places[k].y;
        float deep = meet(from, way, slope);
        vec2 uv = from + way * deep;
        sum += shaded(uv, reached_by_light(uv, deep));
    }
    color = vec4(sum / float(count), 1.0);
#endif
}
