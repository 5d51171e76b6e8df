// The decoder on the CPU: the text of core/*.glsl compiled as C++ over the two textures.
//
//     PackedTextures + PathDetail --[Decoder]--> first point of a ray, height at a point
//
// Single precision, as on a GPU. What it answers is what the fragment shader draws, up to rounding; tests
// hold it against the truth (burin/evaluate.hpp), with which it shares no code.
//
// Units: pattern space, metres; z as in pattern.hpp (object surface at base_offset).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <burin/format/extension.hpp>
#include <burin/format/texels.hpp>
#include <burin/geometry.hpp>
#include <burin/image.hpp>

namespace burin {

inline constexpr std::uint32_t kDecodedGround = 0xffffffffu;  // as element
inline constexpr int kDecodedGroundFacet = -1;                // as facet: the ground
inline constexpr int kDecodedWall = -2;  // as facet: where an element or the ground stops

struct DecodedHit {
    bool met =
        false;  // false: the ray passed the lowest level without meeting anything, which no valid file does
    double drop = 0.0;  // metres below the object surface
    Vec2 position;      // in the tile that was met: [0, size] when the pattern repeats
    double normal[3] = {0, 0, 1};
    std::uint32_t element =
        kDecodedGround;  // texel of the element, counted from the start of the data texture
    int facet = kDecodedGroundFacet;
    std::uint32_t material = 0;
};

// Where a ray passes the object surface, as a fragment shader gets it from the vertices: derivatives of the position by u
// and v in space (burin/frames.hpp). Second derivatives of 0: flat.
struct SurfacePlace {
    Vec2 uv;
    std::array<double, 3> normal{0, 0, 1};  // unit length
    std::array<double, 3> du{}, dv{}, duu{}, duv{}, dvv{};
    // 2 * number of its chart, + 1 where the triangle is wound clockwise in uv (burin/charts.hpp).
    std::uint32_t chart = 0;
};

// Of a ray in space. met is false where the ray comes out through the object surface without meeting anything, as it
// does beside the outline of a convex surface: nothing is to be drawn there.
struct SurfaceHit : DecodedHit {
    double way = 0.0;  // metres along the ray
};

// Reads the textures where they are: both arguments must outlive it.
// Requires: textures that passed validate_textures; any others give some answer, and no access out of bounds.
// Every member is const and safe to call from several threads.
class Decoder {
  public:
    // `charts`: the table of detail.charts, of a mesh in metres, over whose borders trace_surface goes on; null: there is none.
    Decoder(const PackedTextures& textures, const PathDetail& detail, const std::vector<std::uint32_t>* charts = nullptr);

    // The ray that passes the object surface at `origin` and goes `slope` metres over the plane per metre of
    // drop. Cost: cells passed times elements listed, some microseconds.
    DecodedHit trace(Vec2 origin, Vec2 slope) const;

    // The ray that passes the object surface at `place` with a direction of unit length that leads into it, followed over
    // the bent and stretched surface. Cost: as `trace`, once per chord of the curve that the ray is in pattern space.
    SurfaceHit trace_surface(const SurfacePlace& place, const std::array<double, 3>& direction) const;

    // Metres above ground level 0, seen from straight above.
    double height_at(Vec2 p) const;

  private:
    const PackedTextures& textures_;
    const PathDetail& detail_;
    const std::vector<std::uint32_t>* charts_;
    std::array<float, 2> drop_range_;  // drop_range.hpp: a question to every cell
};

// The whole tile from straight above in the map's scale (1 = object surface, 0 = depth below it), each texel
// the mean of samples x samples points. Requires: width, height, samples >= 1. `threads` 0: as many as the
// machine has; equal results for any number.
Image decode_top(const PackedTextures& textures, const PathDetail& detail, int width, int height,
                 int samples = 1, int threads = 0);

}  // namespace burin
