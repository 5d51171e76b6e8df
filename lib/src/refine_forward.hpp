// The map that a resolved pattern predicts, texel by texel, and the equations that its difference to a given map poses.
// Lengths in texels of the map's width, heights in map scale.
//
// Texels that one element plainly rules are integrated in one step. Texels near ends, crossings, corners and steps
// are divided into cells; in each cell every feature is averaged on its own and the averages are combined.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <burin/image.hpp>
#include <burin/resolve.hpp>

#include "refine_element.hpp"
#include "refine_profile.hpp"
#include "refine_sampling.hpp"

namespace burin::refinement {

// How the quantities that shape an element depend on the unknowns. Local quantities: kPoints.. as below, then the
// profile's offsets, then its heights.
constexpr int kPoints = 0;   // p0.x p0.y p1.x p1.y p2.x p2.y
constexpr int kWidths = 6;   // width0 width1
constexpr int kHeights = 8;  // height0 height1
constexpr int kLevel = 10;
constexpr int kProfile = 11;
constexpr int kMaxLocal = kProfile + 2 * kMaxPoints;

struct LocalTerm {
    int local = 0;
    int slot = 0;  // index into ElementUnknowns::unknowns
    double factor = 0.0;
};

struct ElementUnknowns {
    int path = -1, element = -1;  // of the pattern, where it came from; -1: a piece of resolve's own
    std::vector<int> unknowns;    // ascending
    std::vector<LocalTerm> terms;
};

// Sum over texels of weight * (J^T J) and weight * (J^T r), by pairs of elements.
struct Equations {
    struct Pair {
        std::uint32_t first = 0, second = 0;  // first <= second
        // Into values: rows of first's unknowns, columns of second's; nothing below the diagonal where they are the same.
        std::size_t offset = 0;
    };
    std::vector<Pair> pairs;
    std::vector<double> values;
    std::vector<std::vector<double>> gradients;  // by element
};

struct Residual {
    float value = 0.0f;              // model minus map
    float weight = 1.0f;             // texels that it stands for
    std::uint32_t texel = 0;         // its index in the map
    float slope = 0.0f;              // change of the model's value per texel that the element below moves sideways
    std::int32_t element = -1;       // the resolved element whose place matters most; -1: flat
    bool steep() const { return element >= 0; }
};

struct Prediction {
    std::vector<Equations> parts;     // in a fixed order that does not depend on threads
    std::vector<Residual> residuals;  // of the texels near features, in a fixed order
    std::vector<Residual> far;        // of all others
};

// Cells that one texel may be divided into, per side.
constexpr int kFineDivisions = 8;
constexpr int kWhole = 1;  // never divided: where features meet, the means of each over the texel are combined

struct ForwardOptions {
    int divisions = kFineDivisions;
    bool equations = true;     // else residuals alone
    double robust = 1e30;      // Huber's threshold
    // Parts of a texel where the surface cannot vary by more than this, times their share, are not divided further.
    double precision = 0.0;
    int threads = 0;
};

class Forward {
  public:
    // map and pattern outlive it. `side`: a texel's sides, side.x is 1. `sampling` outlives it, too.
    Forward(const ResolvedPattern& pattern, const Image& map, Vec2 side, const Sampling& sampling, int threads = 0);
    ~Forward();
    Forward(const Forward&) = delete;
    Forward& operator=(const Forward&) = delete;

    // `unknowns`: one per resolved element.
    Prediction predict(const std::vector<ElementUnknowns>& unknowns, const ForwardOptions& options) const;

    // The model's map, for tests: every texel; those far from features have their region's level.
    Image image(const ForwardOptions& options) const;

  private:
    struct Scene;
    std::unique_ptr<Scene> scene_;
};

// Huber's.
double robust_cost(const Residual& residual, double threshold);
double robust_cost(const std::vector<Residual>& residuals, double threshold);
double root_mean_square(const std::vector<Residual>& residuals);

}  // namespace burin::refinement
