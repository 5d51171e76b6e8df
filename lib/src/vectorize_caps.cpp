// Ends of lines: a section goes round them as an arc, as a milled slot has it, or square, as the hip does.
#include "vectorize_profiles.hpp"

#include <algorithm>
#include <cmath>

#include <burin/fit.hpp>

#include "parallel.hpp"

namespace burin::vectorizing {
namespace {

// An open end as a frame: `outward` leads out of the line.
struct End {
    Vec2 tip, outward;
    double width = 1.0, height = 1.0;  // scales
};

End end_of(const FittedChain& fitted, bool at_start) {
    const Element& e = at_start ? fitted.elements.front() : fitted.elements.back();
    const Vec2 tangent = unit(derivative_at(e, at_start ? 0.0 : 1.0));
    return at_start ? End{e.p0, -tangent, e.width0, e.height0} : End{e.p2, tangent, e.width1, e.height1};
}

// What the map has around an end, relative to the ground: texels' places in its frame, and heights.
struct Look {
    std::vector<Vec2> places;  // x out of the line, y across it
    std::vector<double> heights;
};

Look look_around(const End& end, double reach, const Image& map, const Lattice& lattice, const Regions& regions) {
    constexpr double kInwards = 1.0;
    Look look;
    const int span = static_cast<int>(std::ceil(1.5 * reach));
    for (int dy = -span; dy <= span; ++dy)
        for (int dx = -span; dx <= span; ++dx) {
            const int x = static_cast<int>(std::floor(end.tip.x)) + dx, y = static_cast<int>(std::floor(end.tip.y)) + dy;
            const int texel = lattice.index(x, y);
            const Vec2 d = Vec2{x + 0.5, y + 0.5} - end.tip;
            const Vec2 place{dot(d, end.outward), cross(end.outward, d)};
            if (texel < 0 || place.x < -kInwards || place.x > reach || std::fabs(place.y) > reach) continue;
            look.places.push_back(place);
            look.heights.push_back(map.texels[texel] - regions.level[regions.at(static_cast<std::size_t>(texel))]);
        }
    return look;
}

// Squares that an end leaves, at the best of the places near it: where a line ends is known by a texel or so.
double left_by(bool round, const Look& look, const End& end, const Profile& profile) {
    double least = 1e300;
    for (double shift = -1.5; shift <= 1.5; shift += 0.25) {
        double left = 0.0;
        for (std::size_t i = 0; i < look.places.size() && left < least; ++i) {
            const double past = std::max(0.0, look.places[i].x - shift), across = std::fabs(look.places[i].y);
            const double offset = round ? std::hypot(past, across) : std::max(past, across);
            const double height = end.height * height_at(profile, std::copysign(offset, look.places[i].y) / end.width);
            left += (look.heights[i] - height) * (look.heights[i] - height);
        }
        least = std::min(least, left);
    }
    return least;
}

bool is_round(const FittedChain& fitted, bool at_start, const Profile& profile, const Image& map, const Lattice& lattice,
              const Regions& regions) {
    constexpr double kNarrowest = 1.5;  // half width, texels: the map does not tell how less ends
    const double half_width = fitted.chain.half_width, contrast = fitted.chain.contrast;
    const End end = end_of(fitted, at_start);
    if (half_width < kNarrowest || end.width <= 0.0) return false;
    const Look look = look_around(end, half_width + 3.0, map, lattice, regions);
    const double round = left_by(true, look, end, profile), square = left_by(false, look, end, profile);
    return round < 0.5 * square && square - round > 0.04 * contrast * contrast * half_width * half_width;
}

}  // namespace

void choose_caps(std::vector<FittedChain>& chains, const ProfileSet& set, const Image& map, const Lattice& lattice,
                 const Regions& regions) {
    for_each_piece(chains.size(), lattice.threads, [&](std::size_t c) {
        FittedChain& fitted = chains[c];
        const Chain& chain = fitted.chain;
        if (chain.spot != Spot::no) {
            fitted.round_start = fitted.round_end = chain.spot == Spot::round;
            return;
        }
        if (chain.kind == ChainKind::step || chain.closed) return;
        const Profile& profile = set.profiles[fitted.profile];
        fitted.round_start = chain.start_tie == EndTie::free && is_round(fitted, true, profile, map, lattice, regions);
        fitted.round_end = chain.end_tie == EndTie::free && is_round(fitted, false, profile, map, lattice, regions);
    });
}

}  // namespace burin::vectorizing
