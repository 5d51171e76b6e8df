// The unknowns of a refinement: which numbers of a pattern move freely, and how the rest follows from them.
//
// The pattern is in texels with heights in map scale (see `refine.cpp`).
#pragma once

#include <cstdint>
#include <vector>

#include <burin/pattern.hpp>
#include <burin/refine.hpp>
#include <burin/resolve.hpp>

#include "refine_forward.hpp"
#include "refine_nodes.hpp"

namespace burin::refinement {

struct Term {
    int unknown = 0;
    double factor = 0.0;
};

// How a profile's numbers depend on the unknowns; all are linear.
struct ProfileTerms {
    std::vector<std::vector<Term>> b, h;
};

struct ScaleUnknowns {
    int width[2] = {-1, -1};   // -1: fixed
    int height[2] = {-1, -1};
};

struct PathLevels {
    int left = -1, right = -1;                    // into Parameters' levels
    double left_value = 0.0, right_value = 0.0;   // right equals left but for a step
    bool step = false;
};

class Parameters {
  public:
    // Requires: a pattern that resolves. Changes it by rounding only, except that joints that are smooth within
    // ResolveOptions::smooth_angle become exactly so and ends near another path come to lie on it.
    Parameters(Pattern& pattern, const RefineOptions& options);

    int count() const { return count_; }

    // How far each unknown has moved, and 1 / deviation^2 of what it was expected to move: the map alone does not hold
    // a point's place along a straight line, or the depth of a groove narrower than a texel.
    const std::vector<double>& moved() const { return moved_; }
    const std::vector<double>& stiffness() const { return stiffness_; }
    double largest_shift() const { return nodes_.largest_shift(); }

    // The points of an element, and what they hang on, stay from now on. `held`: 1 for the unknowns that do.
    void hold(int path, int element);
    void hold(const std::vector<int>& unknowns);
    const std::vector<std::uint8_t>& held() const { return held_; }

    // Moves the pattern by `step`, keeping its structure.
    void apply(const std::vector<double>& step, double most_shift, Pattern& pattern);

    std::vector<ElementUnknowns> of_elements(const Pattern& pattern, const ResolvedPattern& resolved) const;

  private:
    int level_class(double level);
    int nearest_level(double level) const;
    void number_levels(const Pattern& pattern, bool free);
    void number_profiles(const Pattern& pattern, const RefineOptions& options);
    void number_offsets(const Profile& profile, bool narrow, ProfileTerms& terms);
    void number_heights(const Profile& profile, bool free, const PathLevels* step, ProfileTerms& terms);
    void number_scales(const Pattern& pattern);
    void apply_profiles(const std::vector<double>& step, Pattern& pattern) const;
    void apply_levels(const std::vector<double>& step, Pattern& pattern);
    void follow_levels(Pattern& pattern) const;
    void apply_scales(const std::vector<double>& step, Pattern& pattern) const;

    Nodes nodes_;
    std::vector<ProfileTerms> profiles_;
    std::vector<std::vector<ScaleUnknowns>> scales_;  // by path, by element
    std::vector<double> levels_;                      // one value for each distinct level
    std::vector<int> level_unknown_;                  // -1: fixed
    std::vector<PathLevels> path_levels_;
    int outer_level_ = 0;
    int count_ = 0;
    std::vector<double> moved_, stiffness_;
    std::vector<std::uint8_t> held_;
};

}  // namespace burin::refinement
