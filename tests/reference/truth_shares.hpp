// Shares of a footprint by rays of the truth, to hold against those of the renderer; and patterns of the kinds that [2008]
// figure 5 tells apart.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include <burin/evaluate.hpp>
#include <reference/areas.hpp>

namespace burin::testing {

// Requires: a pattern that a grid can hold.
reference::GroovedSurface grooved(const ResolvedPattern& pattern);

// A footprint, seen and lit from 5 to 90 degrees.
struct Situation {
    reference::Footprint footprint;
    reference::Slopes slopes;
};

// By path and facet: what is seen, and what of it is lit. Elements that go on in each other share their facets.
struct FacetShare {
    double seen = 0.0, lit = 0.0;
};
using Shares = std::map<std::pair<std::uint32_t, std::uint32_t>, FacetShare>;

// `side` x `side` rays, one in each cell of a grid over the footprint's box that its polygon holds.
Shares shares_by_truth(const reference::GroovedSurface& surface, const Situation& situation, int side, std::uint64_t seed);
Shares gather_shares(const ResolvedPattern& pattern, const std::vector<reference::Share>& shares);

// Part of the footprint that the two give to different facets, seen and lit.
struct ShareError {
    double seen = 0.0, lit = 0.0;
};
ShareError compare_shares(const Shares& a, const Shares& b);

enum class GrooveCase { isolated, parallel, crossing, intersected_end, isolated_end, corner, protruding, two_at_once };
inline constexpr int kGrooveCases = 8;
const char* name_of(GrooveCase which);
std::string identifier_of(GrooveCase which);  // the same without spaces

// A pattern of some ten centimetres with the case near its middle, (0.05, 0.05); features about 4 mm wide, 1 to 3 mm deep.
ResolvedPattern make_case(GrooveCase which, std::uint64_t seed);

// Near the middle, from a tenth of a groove to several grooves large.
Situation make_situation(std::uint64_t seed);
// The same at a random element of a pattern.
Situation make_situation_on(const ResolvedPattern& pattern, std::uint64_t seed);

// A beam of a share with corners, in a random direction away from its facet.
reference::Beam beam_from(const reference::Share& share, const std::vector<reference::Vec3>& corners, std::uint64_t seed);

// Rays of the truth from places inside of the beam: how many meet another facet than the hits say, away from borders of the hits.
struct BeamCheck {
    int rays = 0, wrong = 0;
};
BeamCheck check_beam(const reference::GroovedSurface& surface, const reference::Beam& beam, const std::vector<reference::Share>& hits,
                     const std::vector<reference::Vec3>& corners);

}  // namespace burin::testing
