// Places along an element between which its profile is swept straight.
#pragma once

#include "gather.hpp"

namespace burin {
struct PreparedElement;  // lib/src/evaluate_prepare.hpp
}

namespace burin::reference {

// Where the profile's lines lie: the point of a line at offset b.
struct Station {
    enum class Kind : std::uint8_t {
        across,  // origin + n b
        clip,    // on a clip line: origin + clip (b / (n . clip)) on the sides it holds for, else across
        hip,     // origin + n b + outward |b|
        apex,    // origin + outward |b|
        turned,  // origin + |b| (direction of the side)
        bevel,   // origin + clip (b (n . clip))
    };
    Kind kind = Kind::across;
    Vec2 origin, n, outward, clip;
    Vec2 turned[2];                    // of the left and the right side
    bool holds[2] = {true, true};      // of the left and the right: else as across
    double width = 1.0, height = 1.0;  // scales
    double u = 0.0;                    // parameter, for bent elements
    Vec2 at(double b) const;           // b in metres
};

// Where an element stops acting with an open section, which needs a wall: by the side, left and right.
struct OpenEnd {
    bool open[2] = {false, false};
    std::size_t station = 0;
};

struct Stations {
    std::vector<Station> list;
    OpenEnd ends[2];
    bool capped[2] = {false, false};  // a hip or a round cap: its halves may differ at b = 0
    std::vector<Station> made[2];     // of the ends, while they are put together
};

struct StationOptions {
    const Region* near = nullptr;  // elsewhere an element is not divided
    double tolerance = 0.0;  // metres
    double deep = 0.0;       // greatest height or depth of the profile, metres
};

// Of one element, in place, from its start to its end.
void place_stations(const PreparedElement& element, const ResolvedElement& resolved, Vec2 shift, const StationOptions& options, Stations& out);

}  // namespace burin::reference
