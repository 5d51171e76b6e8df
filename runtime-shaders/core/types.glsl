// Words and structs of the decoder. This folder is one text, read as GLSL (330 core, ES 300) and as C++ through GLM.
//
// THE DROP. A ray goes down from the object surface. Its parameter t is the drop: metres below the object surface,
// 0 at the surface, `depth` at the lowest point. The place over the plane is p(t) = origin + slope * t. Every height
// of the textures is turned into a drop when it is decoded, so that "the ray meets ground level g" reads t = g.
//
// THE SECTION. Where an element acts, the ray is a curve q(t) = (b' / reach, height / depth) in the plane of the
// profile, both divided by the scales at the foot. Profile points live in the same plane, in [-1, 1].

// Which functions along paths the program can follow, as a sum: 1 sine, 2 polynomial, 4 noise. Drivers that run both sides
// of a branch pay for each of them on every ray, so that a host should define what its textures hold (README.md).
#ifndef BURIN_FUNCTION_KINDS
#define BURIN_FUNCTION_KINDS 7
#endif
// The same of quadratics, of anything beside which a straight ray has a bent section (those, tapers, functions, round joins
// and caps), and of steps: 0 where the textures hold none.
#ifndef BURIN_CURVES
#define BURIN_CURVES 1
#endif
#ifndef BURIN_BENDS
#define BURIN_BENDS 1
#endif
#ifndef BURIN_STEPS
#define BURIN_STEPS 1
#endif
// Whether any profile is no height field.
#ifndef BURIN_FOLDS
#define BURIN_FOLDS 1
#endif
// Whether any mesh is round: 0 where all second derivatives are zero.
#ifndef BURIN_ROUND
#define BURIN_ROUND 1
#endif

struct BurinMap {
    vec2 size;          // metres per uv unit
    float depth;        // metres
    float outer_level;  // drop of the ground outside a map that does not repeat
    vec2 drop_range;    // drops of the highest and of the lowest surface
    int repeats;        // 1: the pattern tiles
    ivec2 cells;        // columns and rows of the grid
    int first_style;    // texels of the data texture where its sections start; elements start at 0
    int first_profile;
    int first_material;
    int first_list;
    int first_function;
};

// Whether the program knows charts, for meshes whose texture coordinates are cut.
#ifndef BURIN_CHARTS
#define BURIN_CHARTS 1
#endif

// The table of borders between charts; texels where its parts start.
struct BurinCharts {
    vec2 origin;  // of its grid, metres
    vec2 cell;
    ivec2 cells;  // (0, 0): no borders
    float scale;  // metres of the world per metre of the mesh
    int first_cell;
    int first_reference;
};

struct BurinRay {
    vec2 origin;  // metres, where the ray passes the object surface
    vec2 slope;   // metres travelled over the plane per metre of drop
};

struct BurinCell {
    int first;  // of its references
    int count;
    int skip;  // cells around it, in every direction, that are as empty as it is
    vec2 start;  // where the walk to a point of the cell begins, in cell sides from the centre
    uint flags;
    bool stepped;
    float level;    // drop of the ground at the start
    float highest;  // drop that no surface of the cell lies above
    float lowest;   // drop that no surface of the cell lies below
};

struct BurinElement {
    vec2 p0;  // metres from the ray's origin
    vec2 p1;
    vec2 p2;
    vec2 image;  // whole tiles by which it is moved
    vec2 t0;  // unit tangents at the ends
    vec2 t2;
    float extent;  // length of the chord
    bool curved;
    bool scaled;        // the scales change along the element
    bool waved;         // a function multiplies them
    uvec4 function;     // its head texel
    vec4 width_terms;   // and, of a polynomial, its coefficients
    vec4 height_terms;
    int turns;          // whole part of its argument at the start
    vec2 argument;      // the rest of it, and how much it grows to the end
    uint kind0;         // end-kinds, layout.h
    uint kind2;
    float clip0;  // clip angles, radians
    float clip2;
    vec4 scales;  // width at start and end, height at start and end
    uint style;
    float slack;  // metres by which a clip line may stand off where it should, see burin_clip_slack
};

struct BurinStyle {
    int first;  // texel of the first profile points
    int count;
    bool stepped;
    uint material;
    uint internal;  // bit i: facet i cuts
    float level;    // drop that h = 0 means, and of the ground on the left
    float right_level;
    float reach;    // metres that b = 1 means
};

// One stretch of the ray over which one formula gives b'.
struct BurinPiece {
    float lo;  // empty when hi < lo
    float hi;
    vec2 lo_wall;  // normal of the border that ends it; (0, 0) where only the cell ends
    vec2 hi_wall;
    int kind;       // BURIN_PIECE_*
    float side;     // -1, +1, or 0 for both
    vec2 anchor;    // point that the offset is measured from
    vec2 gradient;  // of b', for BURIN_PIECE_LINEAR
    float width;    // scales of a piece beyond an end
    float height;
    bool fixed_scale;
};

#define BURIN_PIECE_LINEAR 0
#define BURIN_PIECE_RADIAL 1
#define BURIN_PIECE_CURVE 2

// Names what the ray met: reference of the element, part and side of its domain, and facet.
struct BurinMark {
    uint element;
    int part;
    float side;
    int facet;
    vec2 wall;  // normal of a border wall, when facet is BURIN_FACET_WALL
};

#define BURIN_NO_ELEMENT 0xffffffffu
#define BURIN_FACET_GROUND -1
#define BURIN_FACET_WALL -2
#define BURIN_FACET_STEP -3  // somewhere on the path line of a step; burin_surface finds the facet
#define BURIN_FACET_TOP -5   // what lies flush with the object surface, where the ray begins; burin_surface finds the facet
#define BURIN_FACET_KEEP -4  // what was known before still holds

struct BurinHit {
    bool met;  // false: the ray ended above the surface
    float t;
    BurinRay ray;  // moved into the tile that was met
    vec2 centre;   // centre of the cell that was met, uv
    BurinMark mark;
};

// Work bounds. A ray that exceeds one ends on the ground it is above, so that no pixel stays empty.
#define BURIN_MAX_CELLS_PER_RAY 1024
#define BURIN_MAX_GROUND_CHANGES 64
#define BURIN_MAX_PASSES 32
#define BURIN_MAX_SEGMENTS 6
#if BURIN_FUNCTION_KINDS != 0
#define BURIN_MAX_WAVE_SEGMENTS 64  // where a function changes the scales
#else
#define BURIN_MAX_WAVE_SEGMENTS BURIN_MAX_SEGMENTS
#endif
// Parabolas that stand for a bent section, on each reach of a ray's way past a bend with a radius of one reach: off by 0.002 reaches.
#define BURIN_TRACK_PARTS 2.3f
// Steps to a crossing along a parabola, and from there along the section that it stands for.
#define BURIN_MAX_FALSI 12
#define BURIN_CROSSING_STEPS 2
// Part of the depth under which two drops count as one: above float noise, below the texels' own steps.
#define BURIN_SAME_DROP 1.0e-6f
// Part of the depth under which two levels are one code: less than one step of UNORM16.
#define BURIN_SAME_LEVEL 7.0e-6f
// Part of the depth that a profile may stand above the ground by rounding where it means to lie on it.
#define BURIN_FILM 2.0e-5f
// Part of the distances that their border is calculated from by which neighbouring domains overlap: some steps of a float,
// so that no ray falls between.
#define BURIN_OVERLAP 1.0e-6f
// Half a step of a clip angle, radians.
#define BURIN_CLIP_ROUNDING 4.0e-4f
