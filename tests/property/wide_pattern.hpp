// A pattern with more texels of elements than references of 16 bits can name.
#pragma once

#include <cmath>

#include <burin/pattern.hpp>

#include "../elements.hpp"
#include "random_pattern.hpp"

namespace burin::testing {

// 53000 scratches of random direction over a tile of 1 m, every third one bent, which takes two texels: some 70600 in all. Each is about
// as long as the squares of the lattice that they begin in, so that many cross.
inline Pattern wide_pattern(std::uint64_t seed) {
    constexpr int kSide = 230, kCount = 53000;
    constexpr double kSquare = 1.0 / kSide;
    Pattern pattern;
    pattern.depth = 0.001;
    pattern.profiles.push_back({{{-0.06 * kSquare, 0}, {0, -0.0005}, {0.06 * kSquare, 0}}, {}});
    Random random(seed);
    for (int i = 0; i < kCount; ++i) {
        const Vec2 from = Vec2{i % kSide + random.uniform(), i / kSide + random.uniform()} * kSquare;
        const Vec2 to = from + random.direction() * (random.between(0.5, 1.2) * kSquare);
        const Vec2 beside = lerp(from, to, 0.5) + Vec2{from.y - to.y, to.x - from.x} * 0.2;
        Path path;
        path.elements.push_back(i % 3 == 0 ? make_arc(from, beside, to) : make_line(from, to));
        pattern.paths.push_back(std::move(path));
    }
    return pattern;
}

}  // namespace burin::testing
