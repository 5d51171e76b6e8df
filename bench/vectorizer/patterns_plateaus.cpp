// Plateaus, and patterns that mix plateaus, grooves and ridges.
#include <cmath>

#include "drawing.hpp"
#include "patterns.hpp"

namespace burin::bench {
namespace {

// A letter cut out of a plate: its outline clockwise, and its holes.
struct Letter {
    double width;
    Stroke outline;
    std::vector<Stroke> holes;
};

Letter letter_a() {
    return {0.9, polyline({{0.35, 0}, {0.55, 0}, {0.9, 1}, {0.7, 1}, {0.62, 0.77}, {0.28, 0.77}, {0.2, 1}, {0, 1}}, true),
            {polyline({{0.45, 0.28}, {0.56, 0.6}, {0.34, 0.6}}, true)}};
}

Letter letter_d() {
    return {0.8, Stroke({0, 0}).line({0.3, 0}).arc({0.3, 0.5}, 0.5, -kQuarter, kQuarter).line({0, 1}).close(),
            {Stroke({0.2, 0.19}).line({0.3, 0.19}).arc({0.3, 0.5}, 0.31, -kQuarter, kQuarter).line({0.2, 0.81}).close()}};
}

Letter letter_e() {
    return {0.6, polyline({{0, 0}, {0.6, 0}, {0.6, 0.18}, {0.2, 0.18}, {0.2, 0.41}, {0.52, 0.41}, {0.52, 0.59}, {0.2, 0.59},
                           {0.2, 0.82}, {0.6, 0.82}, {0.6, 1}, {0, 1}}, true), {}};
}

Letter letter_h() {
    return {0.7, polyline({{0, 0}, {0.2, 0}, {0.2, 0.4}, {0.5, 0.4}, {0.5, 0}, {0.7, 0}, {0.7, 1}, {0.5, 1}, {0.5, 0.6},
                           {0.2, 0.6}, {0.2, 1}, {0, 1}}, true), {}};
}

Letter letter_o() {
    return {0.84, slab({0.42, 0.5}, {0.42, 0.5}, 0.42, 0.0), {slab({0.42, 0.5}, {0.23, 0.31}, 0.23, 0.0)}};
}

Letter letter_r() {
    return {0.75, Stroke({0, 0}).line({0.36, 0}).arc({0.36, 0.3}, 0.3, -kQuarter, 1.0).line({0.75, 1}).line({0.53, 1})
                      .line({0.33, 0.6}).line({0.2, 0.6}).line({0.2, 1}).line({0, 1}).close(),
            {Stroke({0.2, 0.18}).line({0.36, 0.18}).arc({0.36, 0.3}, 0.12, -kQuarter, kQuarter).line({0.2, 0.42}).close()}};
}

Letter letter_s() {
    const Vec2 upper{0.32, 0.27}, lower{0.32, 0.73};
    const double tip = -0.4, tail = 2.0 * kQuarter - 0.4;
    const Vec2 start = upper + Vec2{std::cos(tip), std::sin(tip)} * 0.14;
    const Vec2 turn = lower + Vec2{std::cos(tail), std::sin(tail)} * 0.14;
    return {0.64, Stroke(start).arc(upper, 0.14, tip, -3.0 * kQuarter).arc(lower, 0.32, -kQuarter, tail).line(turn)
                      .arc(lower, 0.14, tail, -kQuarter).arc(upper, 0.32, -3.0 * kQuarter, tip).close(), {}};
}

}  // namespace

// Raised letters with holes, three sizes.
Pattern draw_outline_text(double wall) {
    constexpr double kRelief = 0.6;
    Drawing d(kPatternTexels, wall, 0.2);
    const Pen rise = d.step(kRelief), fall = d.on(d.step(-kRelief), kRelief);
    const auto write = [&](const std::vector<Letter>& word, Vec2 at, double height, double angle) {
        for (const Letter& letter : word) {
            d.draw(rise, letter.outline.placed(height, angle, at));
            for (const Stroke& hole : letter.holes) d.draw(fall, hole.placed(height, angle, at));
            at = at + Vec2{std::cos(angle), std::sin(angle)} * (height * (letter.width + 0.2));
        }
    };
    write({letter_s(), letter_h(), letter_o(), letter_r(), letter_e()}, {18.3, 20.7}, 108.0, 0.0);
    write({letter_r(), letter_o(), letter_a(), letter_d(), letter_s()}, {26.7, 150.2}, 96.0, 0.03);
    write({letter_h(), letter_e(), letter_a(), letter_r(), letter_d(), letter_h(), letter_o(), letter_r(), letter_s(), letter_e()},
          {20.9, 292.8}, 48.0, -0.02);
    const std::vector<Letter> small{letter_s(), letter_e(), letter_a(), letter_s(), letter_h(), letter_o(), letter_r(), letter_e()};
    write(small, {22.1, 368.4}, 32.0, 0.05);
    write(small, {290.3, 382.7}, 24.0, 0.0);
    write(small, {26.6, 440.5}, 40.0, -0.03);
    return d.take();
}

// Discs, dots, pits and rings of all sizes, and bolts on a plate.
Pattern draw_discs(double wall) {
    Drawing d(kPatternTexels, wall, 0.5);
    const Pen rise = d.step(0.4), pit = d.step(-0.4);
    const double radii[] = {2.5, 4.0, 6.0, 9.0, 14.0, 20.0, 28.0};
    double x = 18.0;
    for (const double radius : radii) {
        x += radius;
        d.draw(rise, circle({x, 45.3}, radius));
        d.draw(pit, circle({x + 7.7, 115.8}, radius));
        d.draw(d.groove(3.0 + 0.1 * radius, 0.3), circle({x + 3.1, 190.4}, radius + 3.0));
        x += radius + 36.0;
    }
    for (int i = 0; i < 40; ++i)
        d.draw(i % 2 ? rise : pit, circle(Vec2{26.0 + 24.3 * (i % 20), 245.2 + 27.4 * (i / 20)}, 1.5 + 0.3 * (i % 13)));
    d.draw(d.step(0.25), slab({256.0, 400.0}, {230.0, 88.0}, 20.0, 0.0));
    const Pen bolt = d.on(d.step(0.2), 0.25);
    for (int i = 0; i < 12; ++i) {
        d.draw(bolt, circle({50.3 + 37.4 * i, 332.7}, 5.0));
        d.draw(bolt, circle({50.3 + 37.4 * i, 467.1}, 3.0 + 0.5 * i));
    }
    for (int i = 0; i < 5; ++i) {
        d.draw(bolt, circle({90.0 + 82.0 * i, 400.2}, 26.0));
        d.draw(d.on(d.groove(4.0, 0.3), 0.45), polyline({Vec2{90.0 + 82.0 * i, 400.2} - Vec2{13.0, 5.0 * i - 9.0},
                                                         Vec2{90.0 + 82.0 * i, 400.2} + Vec2{13.0, 5.0 * i - 9.0}}));
    }
    return d.take();
}

// Plateaus on plateaus, pits in them, and two of different heights side by side.
Pattern draw_plateaus(double wall) {
    constexpr double kStep = 0.25;
    Drawing d(kPatternTexels, wall, 0.15);
    const auto rise = [&](int from) { return d.on(d.step(kStep), from * kStep); };
    d.draw(rise(0), slab({140.0, 130.0}, {118.0, 108.0}, 14.0, 0.0));
    d.draw(rise(1), slab({132.0, 124.0}, {78.0, 70.0}, 22.0, 0.4));
    d.draw(rise(2), circle({120.4, 118.9}, 40.3));
    d.draw(d.on(d.step(-0.35), 2 * kStep), slab({170.0, 150.0}, {14.0, 9.0}, 5.0, 0.9));
    d.draw(rise(0), polyline({{300.2, 24.6}, {486.3, 61.8}, {440.1, 232.4}, {318.7, 190.2}}, true));
    d.draw(rise(1), polyline({{338.8, 62.9}, {432.4, 88.1}, {402.6, 178.9}}, true));
    d.draw(d.on(d.step(-kStep), kStep), circle({444.0, 130.0}, 14.0));
    for (int i = 0; i < 5; ++i)
        d.draw(d.step(0.3 + 0.08 * i), slab({58.0 + 98.0 * i, 300.0}, {40.0, 30.0}, 3.0 + 3.0 * i, 0.12 * i));
    // A terrace whose terraces keep close to each other, and narrow walls between pits.
    for (int i = 0; i < 3; ++i) d.draw(rise(i), circle({110.0 + 4.0 * i, 424.0}, 72.0 - 12.0 * i));
    for (int i = 0; i < 4; ++i) {
        const double left = 208.0 + 34.0 * i, right = left + 22.0 + 2.0 * i;
        d.draw(d.step(-0.1), polyline({{left, 352.4}, {right, 352.4}, {right, 402.7}, {left, 402.7}}, true));
    }
    // Two bricks of different heights that share a wall.
    const Vec2 top{400.3, 370.2}, foot{388.8, 480.6};
    d.draw(d.step(0.3), polyline({foot, {250.4, 478.3}, {252.8, 420.4}, {356.0, 418.7}, {358.2, 371.9}, top}));
    d.draw(d.step(0.6), polyline({top, {492.1, 368.4}, {490.3, 482.2}, foot}));
    d.draw(d.on(d.step(-0.3), 0.6), polyline({top, foot}));
    return d.take();
}

// Grooves on plateaus, and across their edges.
Pattern draw_engraved(double wall) {
    Drawing d(kPatternTexels, wall, 0.4);
    const Pen rise = d.step(0.4), groove = d.groove(6.0, 0.3), thin = d.groove(4.0, 0.3);
    d.draw(rise, slab({256.0, 120.0}, {220.0, 84.0}, 18.0, 0.0));
    const Pen high = d.on(groove, 0.4), high_thin = d.on(thin, 0.4);
    d.draw(high, polyline({{60.3, 60.2}, {200.7, 180.4}}));
    d.draw(high, polyline({{64.2, 178.1}, {205.5, 71.7}}));
    d.draw(high_thin, circle({290.4, 121.3}, 55.0));
    d.draw(high_thin, circle({290.4, 121.3}, 30.0));
    d.draw(high, arc({410.0, 122.0}, 44.0, 0.4, 4.6));
    // Over the edge.
    d.draw(rise, circle({130.0, 350.0}, 90.0));
    d.draw(groove, polyline({{16.0, 310.4}, {250.0, 371.3}}));
    d.draw(groove, polyline({{128.8, 232.0}, {131.6, 470.0}}));
    d.draw(high_thin, polyline({{90.2, 300.3}, {160.1, 330.9}}));
    d.draw(rise, polyline({{290.3, 260.2}, {480.4, 262.8}, {486.1, 360.4}, {300.7, 372.9}}, true));
    d.draw(groove, polyline({{260.0, 330.0}, {400.0, 318.5}, {440.0, 420.0}}));
    d.draw(thin, polyline({{330.0, 240.0}, {345.0, 330.0}}));
    d.draw(rise, slab({380.0, 450.0}, {100.0, 34.0}, 12.0, -0.1));
    for (int i = 0; i < 5; ++i) d.draw(high_thin, polyline({{306.0 + 30.0 * i, 475.0 - 3.0 * i}, {316.0 + 30.0 * i, 440.0 - 3.0 * i}}));
    d.draw(groove, polyline({{24.0, 488.0}, {258.0, 484.3}}));
    return d.take();
}

// Ridges, and grooves that cut them.
Pattern draw_ridges(double wall) {
    Drawing d(kPatternTexels, wall, 0.4);
    const Pen low = d.ridge(7.0, 0.3), high = d.ridge(5.0, 0.5), groove = d.groove(6.0, 0.3);
    for (int i = 0; i < 4; ++i) {
        d.draw(low, polyline({{30.0 + 60.3 * i, 24.0}, {50.0 + 62.1 * i, 240.0}}));
        d.draw(groove, polyline({{20.0, 50.0 + 54.2 * i}, {246.0, 44.0 + 54.2 * i}}));
    }
    for (int i = 0; i < 4; ++i) {
        d.draw(i % 2 ? low : high, polyline({{280.0, 40.0 + 50.0 * i}, {490.0, 60.0 + 44.0 * i}}));
        d.draw(i % 2 ? high : low, arc({385.0, 120.0}, 30.0 + 24.0 * i, 0.3 * i, 0.3 * i + 4.2));
    }
    for (int i = 0; i < 6; ++i) d.draw(d.ridge(3.0 + i, 0.3), circle({130.0, 380.0}, 14.0 + 19.0 * i));
    d.draw(groove, polyline({{40.0, 300.0}, {240.0, 470.0}}));
    d.draw(low, polyline({{280.3, 300.4}, {380.0, 290.0}, {400.7, 380.2}, {480.9, 360.0}}));
    d.draw(high, polyline({{290.0, 480.0}, {480.0, 430.0}}));
    d.draw(high, polyline({{lerp({290.0, 480.0}, {480.0, 430.0}, 0.5)}, {350.0, 370.0}}));
    return d.take();
}

// What runs over the border and on at the other side.
Pattern draw_tile(double wall) {
    Drawing d(kPatternTexels, wall, 0.6, Wrap::repeat);
    const Pen groove = d.groove(6.0, 0.4), thin = d.groove(4.0, 0.4), rise = d.step(0.3);
    for (int row = 0; row < 3; ++row) {
        // Two waves a tile; the joints lie on the middle line, where the tangents of neighbours agree.
        const double y = 50.6 + 40.0 * row;
        Stroke wave({0.0, y});
        for (int i = 0; i < 4; ++i) wave.quadratic({64.0 + 128.0 * i, y + (i % 2 ? -22.0 : 22.0)}, {128.0 * (i + 1), y});
        d.draw(row == 1 ? thin : groove, wave.close_across());
    }
    d.draw(thin, polyline({{20.3, 170.0}, {20.3 + 512.0, 170.0 + 512.0}}).close_across());
    d.draw(groove, polyline({{430.2, 0.0}, {430.2, 512.0}}).close_across());
    d.draw(groove, circle({500.0, 300.0}, 44.0));
    d.draw(rise, slab({250.0, 503.0}, {60.0, 30.0}, 8.0, 0.0));
    d.draw(rise, slab({3.0, 200.0}, {40.0, 26.0}, 8.0, 0.2));
    d.draw(rise, circle({120.0, 400.0}, 40.0));
    d.draw(rise, circle({330.0, 240.0}, 52.0));
    d.draw(thin, arc({250.0, 320.0}, 40.0, 0.4, 4.0));
    return d.take();
}

}  // namespace burin::bench
