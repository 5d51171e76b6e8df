// The material's own textures, looked up where the ray meets the relief. BURIN_TEXTURES says which of them there are, as a sum: 1 base
// colour, 2 metallic and roughness, 4 occlusion, 8 emissive; drivers pay for what they could have to do.
uniform vec4 base_color;    // linear; factors, as the next four
uniform float metallic;
uniform float roughness;
uniform vec3 emissive;
uniform float occlusion_strength;
uniform sampler2D base_color_texture;  // sRGB, as the emissive one
uniform sampler2D metallic_roughness_texture;
uniform sampler2D occlusion_texture;
uniform sampler2D emissive_texture;
uniform ivec4 texture_sets;  // of these four: 0 and 1 the mesh's uv sets, 2 the pattern's, -1 there is no texture
uniform vec3 texture_rows[8];  // two of each: (u, v, 1) times them is where it is looked up
in vec4 texture_uvs;           // sets 0 and 1

// The pixel's own: set by main before anything is shaded.
mat2 sets_by_pattern[2];  // how sets 0 and 1 change with the pattern's uv
// And set for each ray: where it is over the plane, metres, by the drop; and the sides of what it stands for, at the object surface.
vec2 look_origin;
vec2 look_slope;
vec2 look_start;  // of the pixel, metres
vec2 look_x;
vec2 look_y;

// Place and size of a texture's lookup, metres of the pattern.
struct Look {
    vec2 place;
    vec2 along_x;
    vec2 along_y;
};

// What one set's uv and the pattern's change by with each other on the triangle.
mat2 set_by_pattern(vec2 uv) {
    mat2 by_pixel = mat2(dFdx(pattern_uv), dFdy(pattern_uv));
    mat2 set = mat2(dFdx(uv), dFdy(uv));
    return abs(determinant(by_pixel)) > 1.0e-30 ? set * inverse(by_pixel) : mat2(0.0);
}

// Side of the pixel as it lies on a facet: the ray through it meets the facet earlier or later.
vec2 carry_side(vec2 side, vec3 normal) {
    return side + look_slope * (dot(normal.xy, side) / max(normal.z - dot(normal.xy, look_slope), 0.05));
}

Look look_at(vec3 normal, float drop) {
    Look look;
    look.place = look_origin + look_slope * drop;
    look.along_x = carry_side(look_x, normal);
    look.along_y = carry_side(look_y, normal);
    return look;
}

// Mean over a footprint, by lookups along its longer side, each as wide as the shorter one. The driver's own such filter takes a
// hundred times as long on a CPU.
vec4 fetch_along(sampler2D picture, vec2 at, vec2 along_x, vec2 along_y) {
    vec2 texels = vec2(textureSize(picture, 0));
    vec2 x = along_x * texels;
    vec2 y = along_y * texels;
    vec2 longer = dot(x, x) > dot(y, y) ? x : y;
    float most = max(length(longer), 1.0e-6);
    float least = abs(x.x * y.y - x.y * y.x) / most;
    // Below a texel nothing is finer.
    int count = clamp(int(ceil(most / max(least, 1.0) - 0.1)), 1, 8);
    vec2 along = longer / (float(count) * texels);
    vec2 aside = vec2(-longer.y, longer.x) * (least / most) / texels;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 8; ++k) {
        if (k >= count) break;
        sum += textureGrad(picture, at + along * (float(k) + 0.5 - 0.5 * float(count)), along, aside);
    }
    return sum / float(count);
}

vec4 fetch_texture(sampler2D picture, int which, Look look) {
    int set = texture_sets[which];
    mat2 change = set == 2 ? mat2(1.0) : sets_by_pattern[set];
    vec2 start = set == 2 ? look.place / burin_map.size
                          : (set == 0 ? texture_uvs.xy : texture_uvs.zw) + change * ((look.place - look_start) / burin_map.size);
    mat3x2 rows = transpose(mat2x3(texture_rows[2 * which], texture_rows[2 * which + 1]));
    mat2 turned = mat2(rows[0], rows[1]) * change;
    return fetch_along(picture, rows * vec3(start, 1.0), turned * (look.along_x / burin_map.size), turned * (look.along_y / burin_map.size));
}

// Of a facet. A material of a path's own stands in the glTF material's place, textures and glow included; its occlusion is the mesh's affair.
Paint paint_of(uint material, Look look) {
    Paint paint;
    paint.open = 1.0;
#if BURIN_TEXTURES % 8 >= 4
    if (texture_sets.z >= 0) paint.open += occlusion_strength * (fetch_texture(occlusion_texture, 2, look).r - 1.0);
#endif
    BurinMaterial own = burin_material(material);
    if (own.overrides) {
        paint.albedo = own.base_color.rgb;
        paint.metal = own.metallic;
        paint.rough = own.roughness;
        paint.glow = vec3(0.0);
        return paint;
    }
    paint.albedo = base_color.rgb;
#if BURIN_TEXTURES % 2 >= 1
    if (texture_sets.x >= 0) paint.albedo *= fetch_texture(base_color_texture, 0, look).rgb;
#endif
    vec2 made = vec2(roughness, metallic);
#if BURIN_TEXTURES % 4 >= 2
    if (texture_sets.y >= 0) made *= fetch_texture(metallic_roughness_texture, 1, look).gb;
#endif
    paint.rough = made.x;
    paint.metal = made.y;
    paint.glow = emissive;
#if BURIN_TEXTURES % 16 >= 8
    if (texture_sets.w >= 0) paint.glow *= fetch_texture(emissive_texture, 3, look).rgb;
#endif
    return paint;
}
