// The pixel as a box filter: [2010] 5.7. All rays of a pixel run parallel, so the picture inside it is a flat drawing on
// the object surface: every point of the relief is carried there along the ray. In PIXEL COORDINATES the pixel is the
// unit square, whatever the angle of view, and the share of a polygon is its area inside the square.

struct BurinFootprint {
    vec2 along_x;  // metres over the object surface from a pixel to its neighbours
    vec2 along_y;
    vec2 to_x;  // rows of the inverse: metres from the pixel's centre to pixel coordinates, less a half
    vec2 to_y;
    float radius;  // metres, of the circle around the pixel
};

BurinFootprint burin_footprint(vec2 along_x, vec2 along_y) {
    BurinFootprint f;
    f.along_x = along_x;
    f.along_y = along_y;
    float area = along_x.x * along_y.y - along_x.y * along_y.x;
    float least = 1.0e-6f * dot(along_x, along_x) + 1.0e-6f * dot(along_y, along_y) + 1.0e-30f;
    area = abs(area) > least ? area : (area < 0.0f ? -least : least);
    f.to_x = vec2(along_y.y, -along_y.x) * (1.0f / area);
    f.to_y = vec2(-along_x.y, along_x.x) * (1.0f / area);
    f.radius = 0.5f * sqrt(max(dot(along_x + along_y, along_x + along_y), dot(along_x - along_y, along_x - along_y)));
    return f;
}

vec2 burin_pixel_direction(BurinFootprint f, vec2 metres) {
    return vec2(dot(f.to_x, metres), dot(f.to_y, metres));
}

// Pixel coordinates of a place, metres from the pixel's centre.
vec2 burin_to_pixel(BurinFootprint f, vec2 metres) {
    return burin_pixel_direction(f, metres) + vec2(0.5f, 0.5f);
}

// Integral of clamp(y, 0, 1).
float burin_ramp(float y) {
    float inside = clamp(y, 0.0f, 1.0f);
    return 0.5f * inside * inside + max(y - 1.0f, 0.0f);
}

// Area between the edge a-b and the side y = 0, as far as both lie inside the unit square; negative where the edge runs
// to the left. The edges of a closed polygon add up to its area inside the square.
float burin_edge_area(vec2 a, vec2 b) {
    float x0 = clamp(a.x, 0.0f, 1.0f);
    float x1 = clamp(b.x, 0.0f, 1.0f);
    if (x0 == x1) return 0.0f;
    float slope = (b.y - a.y) / (b.x - a.x);
    float y0 = a.y + (x0 - a.x) * slope;
    float y1 = a.y + (x1 - a.x) * slope;
    float rise = y1 - y0;
    float mean = abs(rise) < 1.0e-3f ? clamp(0.5f * (y0 + y1), 0.0f, 1.0f) : (burin_ramp(y1) - burin_ramp(y0)) / rise;
    return mean * (x1 - x0);
}

// The same for a quadrilateral, whichever way it runs.
float burin_quad_area(vec2 a, vec2 b, vec2 c, vec2 d) {
    return abs(burin_edge_area(a, b) + burin_edge_area(b, c) + burin_edge_area(c, d) + burin_edge_area(d, a));
}

// A pixel is looked at in 4 x 4 places, one bit each, row by row, lowest first. Rows are taken at once: loops cost some
// drivers more than what is in them.
vec4 burin_turns(vec2 a, vec2 b, float y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (vec4(0.125f, 0.375f, 0.625f, 0.875f) - a.x);
}

uint burin_row_mask(vec2 a, vec2 b, vec2 c, vec2 d, float y) {
    vec4 ab = burin_turns(a, b, y);
    vec4 bc = burin_turns(b, c, y);
    vec4 cd = burin_turns(c, d, y);
    vec4 da = burin_turns(d, a, y);
    vec4 least = min(min(ab, bc), min(cd, da));
    vec4 most = max(max(ab, bc), max(cd, da));
    return (least.x >= 0.0f || most.x <= 0.0f ? 1u : 0u) | (least.y >= 0.0f || most.y <= 0.0f ? 2u : 0u) |
           (least.z >= 0.0f || most.z <= 0.0f ? 4u : 0u) | (least.w >= 0.0f || most.w <= 0.0f ? 8u : 0u);
}

// Places inside a convex quadrilateral.
uint burin_quad_mask(vec2 a, vec2 b, vec2 c, vec2 d) {
    vec2 low = min(min(a, b), min(c, d));
    vec2 high = max(max(a, b), max(c, d));
    if (low.x > 1.0f || low.y > 1.0f || high.x < 0.0f || high.y < 0.0f) return 0u;
    return burin_row_mask(a, b, c, d, 0.125f) | (burin_row_mask(a, b, c, d, 0.375f) << 4) |
           (burin_row_mask(a, b, c, d, 0.625f) << 8) | (burin_row_mask(a, b, c, d, 0.875f) << 12);
}
