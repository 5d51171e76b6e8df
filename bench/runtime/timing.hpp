// Time and work of a picture.
#pragma once

#include <cpp/decode.hpp>

#include "subject.hpp"

namespace burin::bench {

// Seconds of processor time that one ray for every pixel, with its shadow, takes, the least of `repeats`: what four samples take beyond
// one, so that loading and building the program do not count. Below 0 where nothing could be drawn.
double seconds_per_pass(const Asset& asset, RenderOptions options, int repeats);

// Mean work of a pixel whose middle sees the plane, view ray and shadow ray together, by the decoder in C++.
struct PixelWork {
    double cells = 0.0, elements = 0.0, styles = 0.0, profiles = 0.0, lists = 0.0;
    double fetches() const { return cells + elements + styles + profiles + lists; }
};
PixelWork work_of(const Subject& subject, const PlaneView& view);

}  // namespace burin::bench
