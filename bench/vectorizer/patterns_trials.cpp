// What breaks tracers and is no fair measure of contours: maps with grain, shading, few levels, clouds; ragged edges; broad
// strokes; strokes that vary. `--trials yes` measures them instead of the twenty.
#include <cmath>

#include "drawing.hpp"
#include "patterns.hpp"
#include "spoil.hpp"

namespace burin::bench {
namespace {

constexpr double kDepth = 0.4;

// Strokes of all kinds and a plateau, none near another; nothing touches the object surface, so that grain stays in range.
Pattern draw_plain(double wall) {
    Drawing d(kPatternTexels, wall, 0.6);
    Uniform random(5);
    for (int i = 0; i < 16; ++i) {
        const Vec2 c{64.0 + 128.0 * (i % 4), 64.0 + 128.0 * (i / 4)};
        const double along = random(0, 6.28), across = along + random(0.8, 2.3), width = 3.0 + i % 6;
        const auto at = [&](double angle, double radius) { return c + Vec2{std::cos(angle), std::sin(angle)} * radius; };
        const Pen pen = d.groove(width, kDepth);
        switch (i % 4) {
            case 0: d.draw(pen, polyline({at(along, 50), at(along, -50)})); break;
            case 1: d.draw(pen, arc(c, 42.0, along, along + 3.4)); break;
            case 2: d.draw(pen, polyline({at(along, 48), at(along, -48)})), d.draw(pen, polyline({at(across, 46), at(across, -46)})); break;
            default: d.draw(d.step(0.3), slab(c, {34.0, 24.0}, 6.0, along)); break;
        }
    }
    return d.take();
}

Pattern draw_broad(double wall) {
    Drawing d(kPatternTexels, wall, 0.75);
    for (int i = 0; i < 9; ++i) {
        const Vec2 c{85.0 + 170.0 * (i % 3), 85.0 + 170.0 * (i / 3)}, along{std::cos(0.3 + 0.7 * i), std::sin(0.3 + 0.7 * i)};
        d.draw(d.groove(12.0 + 4.0 * i, 0.5), polyline({c - along * 55.0, c + along * 55.0}));
    }
    return d.take();
}

Pattern draw_ragged(double wall) {
    Drawing d(kPatternTexels, wall, 0.4);
    Uniform random(9);
    for (int i = 0; i < 4; ++i) {
        std::vector<Vec2> outline;
        for (int k = 0; k < 240; ++k) {
            const double angle = k * 4.0 * kQuarter / 240.0, radius = 90.0 + random(-0.5, 0.5) * i;
            outline.push_back(Vec2{128.0 + 256.0 * (i % 2), 128.0 + 256.0 * (i / 2)} + Vec2{std::cos(angle), std::sin(angle)} * radius);
        }
        d.draw(d.step(0.4), polyline(outline, true));
    }
    return d.take();
}

Pattern draw_scratches(double) {
    Drawing d(kPatternTexels, 0.3, 0.75);
    Uniform random(3);
    for (int i = 0; i < 12; ++i) {
        const double along = random(-0.4, 0.4), y = 30.0 + 38.0 * i;
        const Vec2 c{256.0, y}, half{190.0 * std::cos(along), 60.0 * std::sin(along)};
        d.draw(d.groove(1.6, 0.1), polyline({c - half, c + half}));
    }
    return d.take();
}

void grain(Image& map) {
    Uniform random(1);
    add_grain(map, 0.008, random);
}

void shading(Image& map) {
    Uniform random(2);
    add_clouds(map, 0.1, 110.0, random);
}

void cloudy(Image& map) {
    Uniform random(4);
    add_clouds(map, 0.25, 40.0, random);
}

}  // namespace

const std::vector<Subject>& trials() {
    static const std::vector<Subject> all{
        {"plain", draw_plain},          {"grain", draw_plain, grain},       {"shading", draw_plain, shading},
        {"broad", draw_broad},          {"ragged", draw_ragged},            {"scratches", draw_scratches, cloudy},
    };
    return all;
}

}  // namespace burin::bench
