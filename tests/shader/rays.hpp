// Rays at a pattern, and how two answers about them are compared.
//
//     half aimed at features, a quarter at junctions, a quarter anywhere (DESIGN 7); kinds reported apart
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <burin/evaluate.hpp>
#include <burin/grid.hpp>
#include <burin/pack.hpp>
#include <burin/resolve.hpp>

#include <gl/render.hpp>

namespace burin::testing {

enum class RayKind { feature, junction, anywhere };
inline constexpr int kRayKinds = 3;
inline constexpr const char* kRayKindNames[kRayKinds] = {"features", "junctions", "anywhere"};

struct AimedRay {
    PatternRay ray;
    RayKind kind;
};

// A pattern through all stages: what the textures hold, and the truth about just that.
struct PreparedPattern {
    ResolvedPattern resolved;  // as authored: knows the junctions
    PackedTextures textures;
    PathDetail detail;
    ResolvedPattern stored;                     // read back from the textures
    std::vector<std::uint32_t> element_texels;  // texel of each stored element
};

// Fails the running test when a stage fails.
PreparedPattern prepare(const Pattern& pattern, const GridOptions& options = {});

// Slopes reach about 3 (70 degrees from upright). Equal for equal seeds.
std::vector<AimedRay> aim_rays(const PreparedPattern& pattern, int count, std::uint64_t seed);

struct Agreement {
    std::array<int, kRayKinds> rays{}, facet_differs{}, height_differs{}, borders{}, sheets{};
    int not_met = 0;
    double worst_height = 0.0;  // of range, over rays that agree on the facet
    std::string worst;          // the first rays that differ, for the log

    double facet_share(RayKind kind) const;
    std::string report(const std::string& name) const;
};

// Holds answers against the truth. A ray whose neighbours, a thousandth of the reach away, meet different
// facets passes beside a border and is counted under `borders`, whatever it met. Where a groove goes over a
// step, rounding of stored angles can leave a sheet of solid thinner than the format resolves; the truth of
// the stored numbers meets it, the decoder goes through on purpose: counted under `sheets` when both agree on
// what is behind.
Agreement judge(const PreparedPattern& pattern, const std::vector<AimedRay>& rays,
                const std::vector<ShadedHit>& hits);

// The decoder on the CPU, in the form of the shader's answer.
std::vector<ShadedHit> decode_rays(const PreparedPattern& pattern, const std::vector<AimedRay>& rays);

}  // namespace burin::testing
