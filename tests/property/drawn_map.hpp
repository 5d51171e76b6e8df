// Maps drawn for a test, and what the vectorizer makes of them.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "../../bench/resolution/authored.hpp"
#include "../../bench/resolution/contour.hpp"
#include "../../bench/resolution/drawing.hpp"
#include "../../bench/resolution/level_lines.hpp"
#include "../../bench/resolution/start.hpp"
#include "../../bench/vectorizer/spoil.hpp"
#include "../../bench/vectorizer/structure.hpp"

namespace burin::testing {

inline constexpr int kTexels = 256;

// A sheet whose units are texels: four fields of 128 x 128, one trial each.
class DrawnMap {
  public:
    explicit DrawnMap(double wall, double ground = 0.75) : drawing_(kTexels, wall, ground) {}

    bench::Drawing& pens() { return drawing_; }
    void draw(bench::Pen pen, const bench::Stroke& stroke) {
        drawing_.draw(pen, stroke.placed(bench::kSheet / kTexels, 0.0, {}));
    }
    static Vec2 field(int index) { return {64.0 + 128.0 * (index % 2), 64.0 + 128.0 * (index / 2)}; }
    Pattern take() { return drawing_.take(); }

  private:
    bench::Drawing drawing_;
};

struct Recovered {
    Pattern pattern;
    bench::StructureScore structure;
    bench::LineDistance contour;  // half-height contours, texels
};

// What is found in `map`, which was made of `drawing` and perhaps spoilt since.
inline Recovered recovered_from(const Image& map, const Pattern& drawing) {
    constexpr int kZoom = 4 * kTexels;
    Recovered r;
    r.pattern = bench::vectorized(map, drawing, true);
    r.structure = bench::compare_structure(drawing, r.pattern, kTexels);
    const std::vector<double> heights = bench::half_heights(drawing);
    r.contour = bench::distance_between(bench::lines_of(drawing, heights, kZoom, kTexels),
                                        bench::lines_of(r.pattern, heights, kZoom, kTexels));
    return r;
}

inline Recovered recovered_from(const Pattern& drawing, int bits = 16) {
    return recovered_from(bench::map_of(drawing, kTexels, bits), drawing);
}

// Printed with every test; BURIN_SEED=N tries another.
inline unsigned seed_of_run() {
    const char* given = std::getenv("BURIN_SEED");
    const unsigned seed = given ? static_cast<unsigned>(std::strtoul(given, nullptr, 10)) : 1u;
    std::printf("  seed %u (BURIN_SEED)\n", seed);
    return seed;
}

using bench::Uniform;

inline Vec2 toward(double angle, double radius) { return Vec2{std::cos(angle), std::sin(angle)} * radius; }
inline double degrees(double d) { return d * bench::kQuarter / 90.0; }

}  // namespace burin::testing
