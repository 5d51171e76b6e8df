// What a lit place looks like: metallic-roughness under one directional light and a soft surround.
uniform vec3 light;         // towards the light, unit length
uniform float light_strength;
uniform float ambient;

vec3 to_eye;  // of the pixel, unit length: set by main before anything is shaded

// What a place is made of.
struct Paint {
    vec3 albedo;  // linear
    float metal;
    float rough;
    vec3 glow;
    float open;  // occlusion of the material's own
};

// Lambert and GGX with Smith's shadowing, for one light; colours linear.
vec3 shade_lamp(vec3 n, Paint paint) {
    vec3 halfway = normalize(to_eye + light);
    float nl = max(dot(n, light), 0.0);
    float nv = max(dot(n, to_eye), 1.0e-3);
    float nh = max(dot(n, halfway), 0.0);
    float a = max(paint.rough * paint.rough, 2.0e-3);
    float a2 = a * a;
    float d = a2 / (3.14159265 * pow(nh * nh * (a2 - 1.0) + 1.0, 2.0));
    float visible = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2) + 1.0e-6);
    vec3 f0 = mix(vec3(0.04), paint.albedo, paint.metal);
    vec3 fresnel = f0 + (vec3(1.0) - f0) * pow(1.0 - max(dot(to_eye, halfway), 0.0), 5.0);
    vec3 diffuse = paint.albedo * (1.0 - paint.metal) / 3.14159265;
    return (diffuse * (vec3(1.0) - fresnel) + fresnel * (d * visible)) * (nl * light_strength);
}

// The sky is brighter than the ground; a metal mirrors what a matt surface gathers.
vec3 shade_surround(vec3 n, Paint paint) {
    vec3 f0 = mix(vec3(0.04), paint.albedo, paint.metal);
    vec3 fresnel = f0 + (vec3(1.0) - f0) * pow(1.0 - max(dot(to_eye, normalize(to_eye + light)), 0.0), 5.0);
    float sky = 0.5 + 0.5 * n.y;
    vec3 around = mix(paint.albedo * (1.0 - paint.metal), fresnel * mix(1.0, 0.75, paint.rough), mix(0.1, 1.0, paint.metal));
    return around * ambient * paint.open * mix(0.35, 1.0, sky);
}
