// Cross-sections of fitted chains: measured over every texel that belongs to a chain, shared between chains of equal
// section. Part of stage vectorize; texels and map values.
#pragma once

#include "vectorize_internal.hpp"

namespace burin::vectorizing {

// A chain after fitting. A section is sampled at offsets k * kSectionStep, k = -count..count.
struct FittedChain {
    Chain chain;
    std::vector<Element> elements;
    std::uint32_t profile = 0;   // index into ProfileSet::profiles
    double gain = 0.0;           // squared height error that the chain takes away
    double length = 0.0;
    bool round_start = false, round_end = false;  // see choose_caps
};

// The same curve from its other end.
void reverse_chain(FittedChain& fitted);

inline constexpr double kSectionStep = 0.5;

struct ProfileSet {
    std::vector<Profile> profiles;  // offsets in texels, heights relative to the left level, as map values
};

struct ProfileOptions {
    double reach = 32.0;     // texels to each side over which sections are looked at
    double noise = 0.0;
    std::size_t most_profiles = 256;
    double least_gain = 0.0;  // squared height error that an element with scales has to take away
};

// Settles the level of every region from its texels far from any chain, measures all sections, shares them between
// chains of equal section (reversing lines whose section is mirrored), and fits polylines to them.
ProfileSet measure_profiles(std::vector<FittedChain>& chains, const Image& map, const Lattice& lattice,
                            Regions& regions, const ProfileOptions& options);

// Height at an offset; beyond the profile's ends that of the end.
double height_at(const Profile& profile, double b);

// Round ends: of round spots, and of lines whose open ends the map shows to be so.
void choose_caps(std::vector<FittedChain>& chains, const ProfileSet& set, const Image& map, const Lattice& lattice,
                 const Regions& regions);

// Lines that end on others (EndTie::chain) end on what was fitted to those; all were fitted within `tolerance`.
void land_tees(std::vector<FittedChain>& chains, const Lattice& lattice, double tolerance);

// Per chain: 1 when it is a step whose elements cross those of a step, itself included.
std::vector<std::uint8_t> find_tangled_steps(const std::vector<FittedChain>& chains, const Lattice& lattice);

// Fewest points whose polyline follows the section within the grain; both ends on the ground. Steep facets no wider
// than a texel's own blur are made steeper by it.
Profile fit_profile(const std::vector<double>& height, const std::vector<double>& weight, double right_level,
                    double noise);

}  // namespace burin::vectorizing
