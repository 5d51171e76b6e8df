// The prefilter's texture: four classes to a layer.
uniform highp sampler2DArray burin_prefilter;
uniform int burin_class_count;
uniform vec4 burin_classes[BURIN_MAX_CLASSES];  // style, tangent, height scale

// Colour less that of lit ground, of a pixel that spans many cells around a place, metres.
vec3 far_color(vec2 place, vec2 slope, vec2 light_slope, bool shadows, vec3 ground, vec2 along_x, vec2 along_y) {
    BurinFar sum = BurinFar(vec3(0.0), 0.0, 0.0, 0.0);
    vec4 weights = vec4(0.0);
    vec2 uv = place / burin_map.size;
    for (int k = 0; k < burin_class_count; ++k) {
        if (k % 4 == 0) weights = textureGrad(burin_prefilter, vec3(uv, float(k / 4)), along_x, along_y);
        float weight = k % 4 == 0 ? weights.x : (k % 4 == 1 ? weights.y : (k % 4 == 2 ? weights.z : weights.w));
        if (weight < 1.0e-4) continue;
        BurinClass kind;
        kind.style = uint(burin_classes[k].x + 0.5);
        kind.tangent = burin_classes[k].yz;
        kind.height = burin_classes[k].w;
        BurinFar stripe = burin_far_stripe(kind, slope, light_slope, shadows, ground);
        sum.color += stripe.color * weight;
        sum.shown += stripe.shown * weight;
        sum.own += stripe.own * weight;
        sum.shadow += stripe.shadow * weight;
    }
    return burin_far_sum(sum, ground);
}
