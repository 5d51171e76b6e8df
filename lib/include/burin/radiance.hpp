// Pictures of light: what falls in from every direction around an object, for image-based lighting.
//
//     sky.hdr, sky.exr --[read_radiance]--> RadianceMap --[render_asset]--> pictures lit by it
//
// The picture is equirectangular: columns go once around, rows from straight up to straight down. The middle column
// looks along +x, and to the right of it lies +z, in glTF's axes; so Blender and three.js have it.
#pragma once

#include <string>
#include <vector>

#include <burin/result.hpp>

namespace burin {

// Linear red, green and blue, row-major from the top, any unit, no value below 0 and every one finite.
struct RadianceMap {
    int width = 0;
    int height = 0;
    std::vector<float> texels;  // width * height * 3 entries
};

inline constexpr int kMaxRadianceSide = 16384;  // texels, of either side
inline constexpr int kMinRadianceSide = 2;

// Reads Radiance HDR (RGBE, run-length encoded or flat, rows from the top) and OpenEXR (as in heightmap.hpp; channels R, G, B, or one
// that stands for all). The first bytes decide, never the name. Input is not trusted. EXR values below 0, which
// filters leave at sharp edges, count as 0. Fails with io_failed, unsupported (another format, XYZE, another order of rows), invalid_input (damaged;
// a value that is not finite: where), limit_exceeded (a side below 2 or above 16384). Cost: one decode, twelve bytes per texel.
Result<RadianceMap> read_radiance(const std::string& path);

}  // namespace burin
