// Numbers that seem random and are the same for equal seeds.
#pragma once

#include <cmath>
#include <cstdint>

namespace burin::reference {

// Numbers in [0, 1): a place of the plane's unit square for each of `count`, well spread, turned by the seed.
struct Spread {
    double turn_x, turn_y;
    explicit Spread(std::uint64_t seed) {
        std::uint64_t z = seed * 0x9e3779b97f4a7c15ull + 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        z ^= z >> 31;
        turn_x = double(z >> 32) * 0x1p-32;
        turn_y = double(z & 0xffffffffu) * 0x1p-32;
    }
    // Of two: the plastic number's rank-one lattice.
    double x(int i) const { return fraction(turn_x + 0.7548776662466927 * i); }
    double y(int i) const { return fraction(turn_y + 0.5698402909980532 * i); }
    static double fraction(double v) { return v - std::floor(v); }
};

}  // namespace burin::reference
