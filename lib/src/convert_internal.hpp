// Stage by stage inside of a conversion:
//   convert_pack.cpp  resolved, packed and measured: a candidate     convert_fit.cpp  traced, and fitted within a budget
//   convert.cpp       refined, kept within bounds, written
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <burin/convert.hpp>
#include <burin/reconstruct.hpp>

namespace burin::converting {

// Tells the user which stage runs and sums up the time of each.
class StageClock {
  public:
    using Seconds = std::vector<std::pair<std::string, double>>;
    StageClock(const Progress& progress, Seconds& seconds) : progress_(progress), seconds_(seconds) {}

    // False when the user wants to stop.
    bool begin(const char* stage) {
        end();
        stage_ = stage;
        begun_ = std::chrono::steady_clock::now();
        return !progress_ || progress_(stage, 0.0);
    }
    void end() {
        if (!stage_) return;
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun_;
        // A stage that runs again, for a smaller budget or after the refinement, adds to its time.
        const auto known = std::find_if(seconds_.begin(), seconds_.end(), [&](const auto& s) { return s.first == stage_; });
        if (known == seconds_.end())
            seconds_.emplace_back(stage_, spent.count());
        else
            known->second += spent.count();
        if (progress_) progress_(stage_, 1.0);
        stage_ = nullptr;
    }

  private:
    const Progress& progress_;
    Seconds& seconds_;
    const char* stage_ = nullptr;
    std::chrono::steady_clock::time_point begun_;
};

Error stopped();

// Maps of lines and plateaus come above 0.5, rock and terrain stay below 0.2.
constexpr double kPathLikeShare = 0.35;
// A map whose paths explain less than this has more of them than the budget takes, or other things.
constexpr double kClearShare = 0.6;

struct Packed {
    PackedTextures textures;
    PathDetail detail;
    std::vector<std::uint32_t> paths;  // of the pattern, that are stored
};

// A pattern, its textures, and what they were measured to explain.
struct Candidate {
    Vectorized traced;
    Packed packed;
    ConvertStats stats;  // counts and figures of this candidate
    int most_elements = 0;  // that it took to keep within the budget; 0: all there were
    Image heights;          // what was measured: the stored paths, drawn; empty where the room was needed
    std::size_t bytes() const { return stats.grid_bytes + stats.data_bytes; }
};

// A map, and what of it was traced: the map itself, or the map without its soft ground.
struct Source {
    const HeightMap& map;
    std::shared_ptr<const HeightMap> separated;  // null: the map itself
    TracedMap traced;
    bool shading = true;  // see VectorizeOptions
    const HeightMap& detail() const { return separated ? *separated : map; }
};

struct Start {
    Source source;
    Candidate candidate;
    std::size_t budget = 0;  // bytes that it was fitted to: of the default one as many times as pays
};

// The heights of the textures as they are stored, in the map's size.
Result<Image> reconstruct(const Image& map, const PackedTextures& textures, const PathDetail& detail,
                          const ReconstructOptions& options);
// Of a map that shows as much in fewer texels, a texel tells as much from fewer samples.
int samples_for(const ConvertStats& stats, int usual);
// Quadratics that the budget leaves room for, with their place in the lists.
int room_for_elements(const PackedTextures& textures, std::size_t budget);

Result<Candidate> pack_candidate(Vectorized traced, const HeightMap& map, const ConvertOptions& options,
                                 std::size_t budget, StageClock& clock);
Result<Candidate> measure_candidate(Candidate candidate, const HeightMap& map, const ConvertOptions& options, StageClock& clock);
Result<Candidate> pack_and_measure(Vectorized traced, const HeightMap& map, const ConvertOptions& options,
                                   std::size_t budget, StageClock& clock);
std::size_t bytes_of(const PackedTextures& textures);
// Of elements and their styles, without cells and lists.
std::size_t element_bytes(const PackedTextures& textures);

// Bytes of both textures, where none were asked for.
std::size_t default_budget(std::size_t texels);
// Fits with ever fewer elements until the textures keep to the budget; a budget that was asked for goes before looks.
// `most_elements`: as many as kept to it when the same map was traced in another way, or 0.
Result<Candidate> fit_within(const Source& source, const ConvertOptions& options, std::size_t budget,
                             const Progress& progress, StageClock& clock, int most_elements = 0);
// The map as it is, or without its soft ground where that explains more: whether a ramp is ground or the side of a wide
// bevel shows when its paths are drawn.
Result<Start> trace_best(const HeightMap& map, const ConvertOptions& options, std::size_t budget,
                         const Progress& progress, StageClock& clock);

}  // namespace burin::converting
