// Time and work of a picture.
#pragma once

#include <cpp/decode.hpp>

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

// Mean work of a pixel whose middle sees the plane, view ray and shadow ray together, by the decoder in C++.
struct PixelWork {
    double cells = 0.0, elements = 0.0, styles = 0.0, profiles = 0.0, lists = 0.0;
    double fetches() const { return cells + elements + styles + profiles + lists; }
};
PixelWork work_of(const Subject& subject, const PlaneView& view);

}  // namespace burin::bench
