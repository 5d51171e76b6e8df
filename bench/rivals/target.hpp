// What a rival's picture is drawn into.
#pragma once

#include <memory>
#include <vector>

#include <gl/program.hpp>

namespace burin::rivals {

class CoverageTarget;

// Plain floats with depth; outlines smoothed if asked, by four samples of coverage per pixel that become one when they are read.
class Target {
  public:
    // Fails with unavailable where the driver has no such target.
    static Result<std::unique_ptr<Target>> create(const gl::Functions& gl, int width, int height, bool outlines);
    ~Target();
    void bind() const;
    // Four floats per pixel, lower row first.
    std::vector<float> read() const;

  private:
    Target() = default;
    std::unique_ptr<gl::FloatTarget> plain_;
    std::unique_ptr<CoverageTarget> coverage_;
};

}  // namespace burin::rivals
