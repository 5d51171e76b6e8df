#include "timing.hpp"

#include <algorithm>
#include <ctime>

namespace burin::bench {
namespace {

double seconds_of(const Asset& asset, const RenderOptions& options) {
    const std::clock_t before = std::clock();
    const auto picture = render_asset(asset, options);
    return picture ? double(std::clock() - before) / CLOCKS_PER_SEC : 1e9;
}

}  // namespace

void PassTimer::try_once() {
    options_.samples = 1;
    one_ = std::min(one_, seconds_of(asset_, options_));
    options_.samples = 4;
    four_ = std::min(four_, seconds_of(asset_, options_));
}

}  // namespace burin::bench
