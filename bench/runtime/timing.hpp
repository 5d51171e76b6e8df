// Time of a picture.
#pragma once

#include "subject.hpp"

namespace burin::bench {

// Processor time of one pass over a picture: of a ray for every pixel, or of a sample's areas, shadows included. It is what four samples
// take beyond one, so that loading and building the program do not count, each the least of all tries.
class PassTimer {
  public:
    PassTimer(const Asset& asset, const RenderOptions& options) : asset_(asset), options_(options) {}
    void try_once();
    // Below 0 where nothing could be drawn.
    double seconds() const { return (four_ - one_) / 3.0; }

  private:
    const Asset& asset_;
    RenderOptions options_;
    double one_ = 1e9, four_ = 1e9;
};

}  // namespace burin::bench
