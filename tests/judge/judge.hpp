// Rays at a pattern, and how two answers about them are compared.
//
//     half aimed at features, a quarter at junctions, a quarter anywhere (DESIGN 7); kinds reported apart
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
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

// Fails as the first stage that does.
Result<PreparedPattern> prepare_pattern(const Pattern& pattern, const GridOptions& options = {});

// Draws the material with the pattern.
void put_pattern(const PreparedPattern& pattern, MaterialInfo& material);

// Slopes reach about 3 (70 degrees from upright). Equal for equal seeds.
std::vector<AimedRay> aim_rays(const PreparedPattern& pattern, int count, std::uint64_t seed);

// What the truth says about one answer. All marks off: the same facet at the same place.
struct Verdict {
    RayHit truth;                 // t counts metres of fall
    bool facet_differs = false;
    bool height_differs = false;  // by more than a thousandth of the range
    bool border = false;          // asked only when one of the two differs
    bool sheet = false;           // met a sheet too thin to be stored; then neither of the two is said to differ
    double height = 0.0;          // difference of the fall as a share of the range
};

// Holds one answer against the truth of the stored pattern. `border` in metres: the ray passes beside a border
// when a neighbour so far away meets another facet.
Verdict compare_hit(const Truth& truth, const PreparedPattern& pattern, const PatternRay& ray, const ShadedHit& hit,
                    double border);

// Levels of stored patterns are codes: the truth that judges them.
Truth truth_of_stored(const PreparedPattern& pattern);

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

// Work on [0, count) by every core.
template <typename Work>
void in_parallel(std::size_t count, Work work) {
    const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
    std::atomic<std::size_t> next{0};
    std::vector<std::thread> pool;
    for (std::size_t k = 0; k < threads; ++k)
        pool.emplace_back([&] {
            for (std::size_t i; (i = next.fetch_add(1)) < count;) work(i);
        });
    for (std::thread& thread : pool) thread.join();
}

}  // namespace burin::testing
