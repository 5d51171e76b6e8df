// Metallic-roughness shading of what a ray has met: one directional light and a soft surround.
uniform vec3 light;         // towards the light, unit length
uniform float light_strength;
uniform float ambient;
uniform vec4 base_color;    // linear
uniform float metallic;
uniform float roughness;

// The pixel's own: set by main before anything is shaded.
vec3 to_eye;
mat3 to_pattern;     // world directions to pattern space
vec2 rest_slopes;    // of the residual

// Lambert and GGX with Smith's shadowing, for one light; colours linear.
vec3 shade(vec3 n, vec3 albedo, float metal, float rough, float lit) {
    vec3 halfway = normalize(to_eye + light);
    float nl = max(dot(n, light), 0.0);
    float nv = max(dot(n, to_eye), 1.0e-3);
    float nh = max(dot(n, halfway), 0.0);
    float a = max(rough * rough, 2.0e-3);
    float a2 = a * a;
    float d = a2 / (3.14159265 * pow(nh * nh * (a2 - 1.0) + 1.0, 2.0));
    float visible = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2) + 1.0e-6);
    vec3 f0 = mix(vec3(0.04), albedo, metal);
    vec3 fresnel = f0 + (vec3(1.0) - f0) * pow(1.0 - max(dot(to_eye, halfway), 0.0), 5.0);
    vec3 diffuse = albedo * (1.0 - metal) / 3.14159265;
    vec3 direct = (diffuse * (vec3(1.0) - fresnel) + fresnel * (d * visible)) * (nl * lit * light_strength);
    // The sky is brighter than the ground; a metal mirrors what a matt surface gathers.
    float sky = 0.5 + 0.5 * n.y;
    vec3 around = mix(albedo * (1.0 - metal), fresnel * mix(1.0, 0.75, rough), mix(0.1, 1.0, metal));
    return direct + around * ambient * mix(0.35, 1.0, sky);
}

// Of a facet, `normal` in pattern space.
vec3 burin_facet_color(vec3 normal, uint material, float lit) {
    vec3 albedo = base_color.rgb;
    float metal = metallic;
    float rough = roughness;
    BurinMaterial own = burin_material(material);
    if (own.overrides) {
        albedo = own.base_color.rgb;
        metal = own.metallic;
        rough = own.roughness;
    }
    vec3 n = normalize(transpose(to_pattern) * burin_bend_normal(bend, bend_moved, bend_drop, burin_add_slopes(normal, rest_slopes)));
    return clamp(shade(n, albedo, metal, rough, lit), 0.0, 1.0);
}
