// Curved strokes, strokes that taper, and letters of one stroke.
#include <cmath>
#include <string_view>

#include "drawing.hpp"
#include "glyphs.hpp"
#include "patterns.hpp"

namespace burin::bench {
namespace {

constexpr double kGround = 0.75, kDepth = 0.5;

// A spiral whose radius grows by `pitch` a turn, as quadratics that share their tangents.
Stroke spiral(Vec2 centre, double radius, double pitch, double from, double to) {
    const double rate = pitch / (4.0 * kQuarter);
    const auto place = [&](double a) { return centre + Vec2{std::cos(a), std::sin(a)} * (radius + rate * (a - from)); };
    const auto tangent = [&](double a) {
        const double r = radius + rate * (a - from);
        return unit(Vec2{rate * std::cos(a) - r * std::sin(a), rate * std::sin(a) + r * std::cos(a)});
    };
    const int pieces = static_cast<int>(std::ceil((to - from) / 0.3));
    Stroke stroke(place(from));
    for (int i = 0; i < pieces; ++i) {
        const double a = from + (to - from) * i / pieces, b = from + (to - from) * (i + 1) / pieces;
        const Vec2 p = place(a), q = place(b), t = tangent(a), u = tangent(b);
        stroke.quadratic(p + t * (cross(q - p, u) / cross(t, u)), q);
    }
    return stroke;
}

// Quarter and longer arcs of given radii, each tangent to the one before; a negative radius bends to the left.
Stroke scroll(Vec2 start, double heading, const std::vector<std::pair<double, double>>& radius_and_turn) {
    Stroke stroke(start);
    Vec2 at = start;
    for (const auto& [radius, turn] : radius_and_turn) {
        const double side = radius > 0.0 ? 1.0 : -1.0, r = std::abs(radius);
        const Vec2 centre = at + Vec2{-std::sin(heading), std::cos(heading)} * radius;
        const double from = heading - side * kQuarter;
        stroke.arc(centre, r, from, from + side * turn);
        heading += side * turn;
        at = centre + Vec2{std::cos(from + side * turn), std::sin(from + side * turn)} * r;
    }
    return stroke;
}

}  // namespace

Pattern draw_arcs(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    const double radii[] = {8.0, 12.0, 18.0, 25.0, 33.0, 42.0, 50.0, 56.0};
    for (int i = 0; i < 16; ++i) {
        const Vec2 c{64.0 + 128.0 * (i % 4) + 0.37 * i, 64.0 + 128.0 * (i / 4) - 0.21 * i};
        const double from = 0.7 * i, width = 3.0 + i % 5;
        d.draw(d.groove(width, kDepth), arc(c, radii[i % 8], from, from + 1.5 + 0.25 * i));
    }
    // Flat arcs between the fields.
    for (int i = 0; i < 3; ++i)
        d.draw(d.groove(4.0, kDepth), arc({128.0 + 128.0 * i, 1500.0}, 1246.0 - 9.0 * i, -kQuarter - 0.04, -kQuarter + 0.04));
    return d.take();
}

Pattern draw_concentric(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    for (int i = 0; i < 9; ++i) d.draw(d.groove(5.0, kDepth), circle({140.3, 139.8}, 14.0 + 14.0 * i));
    for (int i = 0; i < 7; ++i)
        d.draw(d.groove(4.0, kDepth), arc({395.6, 141.2}, 20.0 + 13.0 * i, 0.4 * i, 0.4 * i + 2.2 + 0.3 * i));
    for (int i = 0; i < 12; ++i)
        d.draw(d.groove(3.0 + 0.4 * i, kDepth), arc({20.0, 500.0}, 30.0 + 16.0 * i, -kQuarter + 0.06, -0.06));
    for (int i = 0; i < 5; ++i) d.draw(d.groove(3.0, kDepth), circle({400.0, 390.0}, 12.0 + 16.0 * i));
    for (int i = 0; i < 8; ++i) {
        const Vec2 along{std::cos(0.2 + 0.5 * kQuarter * i), std::sin(0.2 + 0.5 * kQuarter * i)};
        d.draw(d.groove(3.0, kDepth), polyline({Vec2{400.0, 390.0} + along * 76.0, Vec2{400.0, 390.0} + along * 98.0}));
    }
    return d.take();
}

Pattern draw_spirals(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    d.draw(d.groove(6.0, kDepth), spiral({146.2, 142.7}, 12.0, 22.0, 0.3, 34.0));
    d.draw(d.groove(4.0, kDepth), spiral({402.6, 118.4}, 6.0, 11.0, 1.0, 49.0));
    d.draw(d.groove(9.0, kDepth), spiral({132.0, 402.8}, 20.0, 32.0, 2.0, 17.0));
    // Two arms of one spiral.
    d.draw(d.groove(5.0, kDepth), spiral({374.3, 372.9}, 10.0, 40.0, 0.0, 17.0));
    d.draw(d.groove(5.0, kDepth), spiral({374.3, 372.9}, 10.0, 40.0, 2.0 * kQuarter, 17.0 + 2.0 * kQuarter));
    return d.take();
}

// S-curves, volutes, and tendrils that leave a stem.
Pattern draw_scrolls(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    const Pen stem = d.groove(7.0, kDepth), tendril = d.groove(4.0, kDepth);
    for (int i = 0; i < 3; ++i)
        d.draw(stem, scroll({40.0 + 150.0 * i, 40.0 + 6.0 * i}, 0.2, {{45.0, 2.6}, {-30.0 - 5.0 * i, 3.0 - 0.2 * i}}));
    for (int i = 0; i < 2; ++i) {
        const double flip = i == 0 ? 1.0 : -1.0;
        d.draw(stem, scroll({256.0 - flip * 226.0, 330.0}, i == 0 ? 0.0 : 2.0 * kQuarter,
                            {{-flip * 120.0, 0.8}, {flip * 62.0, 2.0}, {flip * 44.0, 1.6}, {flip * 31.0, 1.6},
                             {flip * 22.0, 1.6}, {flip * 15.0, 1.6}}));
    }
    // A wavy stem with tendrils that leave it at 30 degrees, to either side in turn.
    std::vector<std::pair<double, double>> waves;
    for (int i = 0; i < 6; ++i) waves.push_back({i % 2 ? 58.0 : -58.0, 1.5});
    const Stroke wavy = scroll({22.0, 440.0}, 0.75, waves);
    d.draw(stem, wavy);
    for (std::size_t i = 0; i < 5; ++i) {
        const Element& e = wavy.elements()[4 * i + 3];
        const Vec2 along = e.p2 - e.p1;
        const double side = i % 2 ? 1.0 : -1.0, heading = std::atan2(along.y, along.x) + side * 0.5;
        d.draw(tendril, scroll(e.p2, heading, {{side * 26.0, 1.3}, {side * 11.0, 2.4}}));
    }
    return d.take();
}

// Widths and heights that change along the stroke, down to nothing.
Pattern draw_tapers(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    const Pen broad = d.groove(10.0, kDepth), usual = d.groove(6.0, kDepth);
    for (int i = 0; i < 5; ++i) {
        const double y = 30.2 + 24.0 * i;
        d.draw(broad, polyline({{20.0, y}, {240.0, y + 13.7}}).taper({1.0, 0.8 - 0.2 * i}));
        d.draw(usual, polyline({{270.0, y + 9.1}, {490.0, y - 4.4}}).taper({1.0}, {1.0, 0.85 - 0.05 * i}));
    }
    // Spindles: to nothing at both ends.
    for (int i = 0; i < 3; ++i) {
        const double x = 30.0 + 160.0 * i, sag = 11.0 * i;
        d.draw(broad, Stroke({x, 190.0}).quadratic({x + 32.0, 190.0 + sag}, {x + 65.0, 200.0 + sag})
                          .quadratic({x + 98.0, 210.0 + sag}, {x + 130.0, 188.0 + sag}).taper({0.0, 1.0, 0.0}));
    }
    for (int i = 0; i < 4; ++i) {
        d.draw(broad, arc({75.0 + 120.0 * i, 320.0}, 30.0 + 6.0 * i, 0.5 * i, 0.5 * i + 4.0).taper({0.3, 1.0}));
        d.draw(broad, scroll({40.0 + 115.0 * i, 425.0}, 0.1 * i, {{40.0, 1.6}, {-30.0, 1.6}}).taper({1.0, 0.0}));
    }
    return d.take();
}

// Engraved capitals of three sizes.
Pattern draw_stroke_text(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    const auto write = [&](std::string_view word, Vec2 at, double height, double width, double angle) {
        for (const Stroke& stroke : written(word, height, at, angle)) d.draw(d.groove(width, kDepth), stroke);
    };
    write("HARKEN", {24.3, 24.7}, 72.0, 8.0, 0.0);
    write("MUSTY OX", {22.6, 126.2}, 56.0, 6.0, 0.04);
    write("ZINK RADIUM", {25.4, 238.9}, 44.0, 4.0, -0.02);
    write("THE HARE PAST A YAK", {20.5, 312.0}, 24.0, 3.0, 0.01);
    write("SOUND AND SMOKE", {24.8, 366.3}, 32.0, 4.0, 0.0);
    write("KNOX", {30.0, 440.0}, 52.0, 10.0, -0.03);
    write("1774", {310.0, 425.0}, 56.0, 5.0, 0.05);
    return d.take();
}

}  // namespace burin::bench
