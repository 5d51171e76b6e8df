// Time of a picture.
#pragma once

#include <functional>
#include <vector>

#include "subject.hpp"

namespace burin::bench {

// Processor time of one pass over a picture: of a ray for every pixel, or of a sample's areas, shadows included. It is what four samples
// take beyond one, so that loading and building the program do not count.
class PassTimer {
  public:
    using Draw = std::function<Result<RgbaImage>(int samples)>;

    // Both must outlive it.
    PassTimer(const Asset& asset, const RenderOptions& options);
    void try_once();
    // Of the least of all tries, and the median of them. Below 0 where nothing could be drawn.
    double seconds() const;
    double median_seconds() const;

  private:
    Draw draw_;
    std::vector<double> one_, four_;  // of each try
};

}  // namespace burin::bench
