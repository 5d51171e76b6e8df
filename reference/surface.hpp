// A resolved pattern made ready for the renderer: elements as the truth prepares them, profiles cut at b = 0 and into
// slabs, and the grid by which elements near a footprint are found.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <burin/evaluate.hpp>
#include <burin/grid.hpp>

namespace burin::reference {

// A profile's facet, or a part of it on one side of b = 0, from line to line. A line is a value of b at which a point stands.
struct ProfileFacet {
    std::uint32_t from = 0, to = 0;  // lines; equal for a vertical one
    double h0 = 0.0, h1 = 0.0;       // heights there
    std::uint32_t facet = 0;         // of the profile
    bool internal = false;
    bool rightward = true;  // from the smaller b to the larger; the solid lies below, else above
};

// What is solid or cut between two neighbouring lines, bounded by facets below and above; heights on both lines.
struct Slab {
    std::uint32_t line = 0;  // to line + 1
    bool cut = false;
    bool has_bottom = false, has_top = false;
    double bottom[2] = {0, 0}, top[2] = {0, 0};
    std::uint32_t bottom_facet = 0, top_facet = 0;  // of the profile, where there is one
};

struct SlabbedProfile {
    std::vector<double> lines;  // ascending; 0 among them when the profile lies on both sides
    std::vector<ProfileFacet> facets;
    std::vector<Slab> slabs;
    double first_height = 0.0, last_height = 0.0;  // h of the two ends
    bool height_field = true;
    double reach = 0.0;  // greatest |b|
};

// Never changes once made; safe to ask from several threads.
class GroovedSurface {
  public:
    // Requires: as Truth does; `grid` of the same pattern. Both are copied. Cost: linear in the elements.
    GroovedSurface(const ResolvedPattern& pattern, const CellGrid& grid);
    ~GroovedSurface();
    GroovedSurface(GroovedSurface&&) noexcept;

    const ResolvedPattern& pattern() const { return pattern_; }
    const CellGrid& grid() const { return grid_; }
    const Truth& truth() const { return truth_; }
    const std::vector<SlabbedProfile>& profiles() const { return profiles_; }
    // Tells surfaces apart that have been made since the program began.
    std::uint64_t id() const { return id_; }
    // Side of a square that one element acts in, in the mean over the cells where any does, metres.
    double spacing() const { return spacing_; }
    double lowest() const { return lowest_; }
    double top() const { return pattern_.base_offset; }  // of the object surface, where footprints lie
    // Bytes of all that a picture needs of the pattern: elements, profiles, grid.
    std::size_t bytes() const;

  private:
    ResolvedPattern pattern_;
    CellGrid grid_;
    Truth truth_;
    std::vector<SlabbedProfile> profiles_;
    double lowest_ = 0.0;
    double spacing_ = 0.0;
    std::uint64_t id_ = 0;
};

SlabbedProfile slab_profile(const ResolvedProfile& profile);

}  // namespace burin::reference
