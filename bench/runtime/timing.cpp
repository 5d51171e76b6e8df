#include "timing.hpp"

#include <algorithm>
#include <ctime>

namespace burin::bench {
namespace {

double seconds_of(const PassTimer::Draw& draw, int samples) {
    const std::clock_t before = std::clock();
    const auto picture = draw(samples);
    return picture ? double(std::clock() - before) / CLOCKS_PER_SEC : 1e9;
}

}  // namespace

PassTimer::PassTimer(const Asset& asset, const RenderOptions& options)
    : draw_([&asset, own = options](int samples) mutable {
          own.samples = samples;
          return render_asset(asset, own);
      }) {}

void PassTimer::try_once() {
    one_.push_back(seconds_of(draw_, 1));
    four_.push_back(seconds_of(draw_, 4));
}

double PassTimer::seconds() const {
    const auto least = [](const std::vector<double>& tries) { return *std::min_element(tries.begin(), tries.end()); };
    return (least(four_) - least(one_)) / 3.0;
}

double PassTimer::median_seconds() const {
    std::vector<double> passes;
    for (std::size_t i = 0; i < one_.size(); ++i) passes.push_back((four_[i] - one_[i]) / 3.0);
    std::nth_element(passes.begin(), passes.begin() + std::ptrdiff_t(passes.size() / 2), passes.end());
    return passes[passes.size() / 2];
}

}  // namespace burin::bench
