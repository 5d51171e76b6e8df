// Chance that is the same on every machine: integers and the four operations alone, no distribution of the standard library.
#pragma once

#include <cstdint>

#include "steady_math.hpp"

namespace burin {

// A stream of numbers by splitmix64. Streams of one seed are as good as independent, so that pieces of work that are done by several
// threads each have their own.
class Chance {
  public:
    explicit Chance(std::uint64_t seed, std::uint64_t stream = 0) : state_(mixed(seed + kStep) ^ mixed(mixed(stream + 2 * kStep))) {}

    double uniform() { return double(next() >> 11) * 0x1p-53; }  // [0, 1)
    double between(double low, double high) { return low + (high - low) * uniform(); }
    int below(int n) { return int(uniform() * n); }

    // Normal of mean 0 and deviation 1, within [-6, 6]: a sum of twelve.
    double normal() {
        double sum = -6.0;
        for (int i = 0; i < 12; ++i) sum += uniform();
        return sum;
    }

    // Median 1; `spread` is the deviation of its logarithm.
    double around_one(double spread) { return spread > 0.0 ? steady::exponential(spread * normal()) : 1.0; }

  private:
    static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15ull;

    static std::uint64_t mixed(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }
    std::uint64_t next() { return mixed(state_ += kStep); }

    std::uint64_t state_;
};

}  // namespace burin
