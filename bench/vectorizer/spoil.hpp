// What happens to height maps: grain, clouds, few levels.
#pragma once

#include <random>

#include <burin/image.hpp>

namespace burin::bench {

// Equal numbers on every machine.
class Uniform {
  public:
    explicit Uniform(unsigned seed) : random_(seed) {}
    double operator()(double low, double high) { return low + (high - low) * (random_() / 4294967296.0); }

  private:
    std::mt19937 random_;
};

// Smooth noise between 0 and 1: random values every `period` texels, joined by cubics.
Image clouds(int width, int height, double period, Uniform& random);

// Adds clouds between -amplitude and amplitude; what leaves [0, 1] is cut off.
void add_clouds(Image& map, double amplitude, double period, Uniform& random);

// Adds normal noise of this standard deviation to every texel, cut off likewise.
void add_grain(Image& map, double deviation, Uniform& random);

// 36 levels: 219 to 255 of 255.
void keep_few_levels(Image& map);

}  // namespace burin::bench
