// Straight strokes and how they meet.
#include <algorithm>
#include <cmath>

#include "drawing.hpp"
#include "patterns.hpp"

namespace burin::bench {
namespace {

constexpr double kGround = 0.75, kDepth = 0.5;

Vec2 toward(double degrees, double radius = 1.0) {
    const double angle = degrees * kQuarter / 90.0;
    return Vec2{std::cos(angle), std::sin(angle)} * radius;
}

// The middles of `columns` x `rows` equal fields.
Vec2 field(int index, int columns, int rows) {
    return {kSheet * (index % columns + 0.5) / columns, kSheet * (index / columns + 0.5) / rows};
}

// The part of a segment that lies on the sheet, its ends exactly on the border; false: none.
bool clip_to_sheet(Vec2& a, Vec2& b) {
    double low = 0.0, high = 1.0;
    const Vec2 d = b - a;
    const auto side = [&](double from, double along) {
        if (along == 0.0) return from >= 0.0 && from <= kSheet;
        const double s = -from / along, t = (kSheet - from) / along;
        low = std::max(low, std::min(s, t)), high = std::min(high, std::max(s, t));
        return low < high;
    };
    if (!side(a.x, d.x) || !side(a.y, d.y)) return false;
    const auto on_sheet = [](Vec2 p) { return Vec2{std::clamp(p.x, 0.0, kSheet), std::clamp(p.y, 0.0, kSheet)}; };
    const Vec2 from = a;
    a = on_sheet(from + d * low), b = on_sheet(from + d * high);
    return true;
}

}  // namespace

// Border to border, of several widths and two depths: at a crossing the deeper wins.
Pattern draw_grid(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    const double places[] = {41.3, 118.725, 199.15, 287.6, 371.45, 462.2};
    const double widths[] = {3.0, 5.0, 8.0, 12.0, 4.0, 6.0};
    for (int i = 0; i < 6; ++i) {
        d.draw(d.groove(widths[i], kDepth), polyline({{places[i], 0.0}, {places[i], kSheet}}));
        d.draw(d.groove(widths[5 - i], 0.35), polyline({{0.0, places[i] - 7.35}, {kSheet, places[i] - 7.35}}));
    }
    return d.take();
}

Pattern draw_crossings(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    const double angles[] = {10.0, 20.0, 30.0, 45.0, 60.0, 90.0};
    for (int i = 0; i < 6; ++i) {
        const Vec2 centre = field(i, 3, 2) + Vec2{1.3, i < 3 ? -28.7 : 28.4};
        const double base = 11.0 + 29.0 * i;
        for (const double turn : {0.0, angles[i]})
            d.draw(d.groove(6.0, kDepth), polyline({centre - toward(base + turn, 74.0), centre + toward(base + turn, 74.0)}));
        // The same at a finer scale, with two widths.
        const Vec2 small = field(i, 6, 1) + Vec2{0.7 * i, -1.9};
        d.draw(d.groove(3.0, kDepth), polyline({small - toward(base, 36.0), small + toward(base, 36.0)}));
        d.draw(d.groove(4.5, kDepth), polyline({small - toward(base + angles[i], 36.0), small + toward(base + angles[i], 36.0)}));
    }
    return d.take();
}

// Stems on straight and bent strokes, and places where three to five strokes end together.
Pattern draw_junctions(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    const Pen usual = d.groove(6.0, kDepth), thin = d.groove(3.0, kDepth), broad = d.groove(10.0, kDepth);
    const double stems[] = {90.0, 60.0, 45.0, 30.0};
    for (int i = 0; i < 4; ++i) {
        const Vec2 c = field(i, 4, 4);
        const double base = 7.0 + 40.0 * i;
        d.draw(usual, polyline({c - toward(base, 52.0), c + toward(base, 52.0)}));
        d.draw(usual, polyline({c, c + toward(base + stems[i], 50.0)}));
        const Vec2 under = field(4 + i, 4, 4);
        d.draw(i % 2 ? thin : broad, polyline({under - toward(base, 50.0), under + toward(base, 50.0)}));
        d.draw(i % 2 ? broad : thin, polyline({under, under + toward(base - stems[i], 48.0)}));
    }
    const std::vector<std::vector<double>> stars{{0, 120, 240}, {10, 100, 235}, {20, 65, 200, 290}, {0, 72, 144, 216, 288}};
    for (int i = 0; i < 4; ++i) {
        const Vec2 c = field(8 + i, 4, 4);
        for (const double angle : stars[i]) d.draw(i == 1 ? thin : usual, polyline({c, c + toward(angle + 13.0, 52.0)}));
    }
    // Stems on an arc, from within and from without; two stems hardly apart; a stem between two strokes.
    const Vec2 bow = field(12, 4, 4);
    d.draw(usual, arc(bow, 38.0, 0.3, 4.9));
    d.draw(usual, polyline({bow + toward(100, 38.0), bow + toward(110, 4.0)}));
    d.draw(thin, polyline({bow + toward(200, 38.0), bow + toward(205, 58.0)}));
    const Vec2 pair = field(13, 4, 4);
    d.draw(usual, polyline({pair - toward(0, 50.0), pair + toward(0, 50.0)}));
    d.draw(usual, polyline({pair - Vec2{5, 0}, pair + Vec2{-5, 45}}));
    d.draw(usual, polyline({pair + Vec2{6, 0}, pair + Vec2{6, -45}}));
    const Vec2 rung = field(14, 4, 4) + Vec2{8, 0};
    d.draw(broad, polyline({rung + Vec2{-30, -50}, rung + Vec2{-30, 50}}));
    d.draw(usual, polyline({rung + Vec2{30, -50}, rung + Vec2{30, 50}}));
    d.draw(usual, polyline({rung + Vec2{-30, -7.3}, rung + Vec2{30, 12.1}}));
    d.draw(thin, polyline({field(15, 4, 4) - Vec2{20, 45}, field(15, 4, 4) + Vec2{-20, 45}}));
    d.draw(thin, polyline({field(15, 4, 4) - Vec2{20, 0.3}, field(15, 4, 4) + Vec2{40, -0.3}}));
    return d.take();
}

// Inner angles of 30 to 150 degrees, and two closed shapes.
Pattern draw_corners(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    for (int i = 0; i < 9; ++i) {
        const Vec2 c = field(i, 3, 4);
        const double inner = 30.0 + 15.0 * i, base = 23.0 + 51.0 * i;
        const Vec2 tip = c - toward(base + 0.5 * inner, 22.0);
        d.draw(d.groove(4.0 + i % 3 * 2.0, kDepth),
               polyline({tip + toward(base, 58.0), tip, tip + toward(base + inner, 58.0)}));
    }
    const Vec2 c = field(9, 3, 4), s = field(10, 3, 4), z = field(11, 3, 4);
    d.draw(d.groove(5.0, kDepth), polyline({c + toward(12, 50), c + toward(140, 50), c + toward(250, 50)}, true));
    d.draw(d.groove(6.0, kDepth), polyline({s + toward(40, 52), s + toward(130, 52), s + toward(220, 52), s + toward(310, 52)}, true));
    std::vector<Vec2> zigzag;
    for (int i = 0; i < 7; ++i) zigzag.push_back(z + Vec2{-66.0 + 22.0 * i, i % 2 ? 20.3 : -19.2});
    d.draw(d.groove(4.0, kDepth), polyline(zigzag));
    return d.take();
}

// A honeycomb that runs off the sheet: every joint has three arms.
Pattern draw_hexagons(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    const Pen pen = d.groove(6.0, kDepth);
    constexpr double kEdge = 41.0;
    const double across = kEdge * std::sqrt(3.0);
    const auto centre = [&](int column, int row) {
        return Vec2{13.3 + across * (column + 0.5 * (row & 1)), 9.7 + 1.5 * kEdge * row};
    };
    for (int row = -1; row < 10; ++row) {
        for (int column = -1; column < 9; ++column) {
            const Vec2 c = centre(column, row);
            // Three edges of each: the others belong to its neighbours.
            for (const double angle : {-30.0, 30.0, 90.0}) {
                Vec2 a = c + toward(angle, kEdge), b = c + toward(angle + 60.0, kEdge);
                if (clip_to_sheet(a, b)) d.draw(pen, polyline({a, b}));
            }
        }
    }
    return d.take();
}

Pattern draw_bricks(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    const Pen bed = d.groove(6.0, kDepth), joint = d.groove(5.0, kDepth);
    constexpr double kRow = 64.0, kBrick = 128.0;
    for (int row = 0; row < 9; ++row) {
        const double y = 20.45 + kRow * row, above = std::max(0.0, y - kRow), below = std::min(y, kSheet);
        if (y < kSheet) d.draw(bed, polyline({{0.0, y}, {kSheet, y}}));
        for (int i = 0; i < 4; ++i) {
            const double x = 37.8 + kBrick * (i + 0.5 * (row & 1));
            if (x < kSheet) d.draw(joint, polyline({{x, above}, {x, below}}));
        }
    }
    return d.take();
}

// Side by side from thinner than a texel to wider than most tools look, and pairs that nearly touch.
Pattern draw_widths(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    double x = 30.0;
    for (const double width : {0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0}) {
        x += 0.5 * width;
        d.draw(d.groove(width, kDepth), polyline({{x, 24.4}, {x + 31.3, 250.2}}));
        x += 0.5 * width + 26.0;
    }
    const double gaps[] = {2.0, 3.0, 5.0, 8.0};
    for (int i = 0; i < 4; ++i) {
        const double y = 282.0 + 38.0 * i, apart = 5.0 + gaps[i];
        d.draw(d.groove(5.0, kDepth), polyline({{18.2, y}, {250.7, y + 9.3}}));
        d.draw(d.groove(5.0, kDepth), polyline({{22.9, y + apart}, {246.1, y + 9.3 + apart}}));
    }
    // Two that draw near each other and do not meet, and a fan that does.
    d.draw(d.groove(5.0, kDepth), polyline({{280.4, 280.0}, {490.0, 296.0}}));
    d.draw(d.groove(5.0, kDepth), polyline({{281.7, 312.0}, {490.0, 304.0}}));
    for (const double angle : {-12.0, 0.0, 12.0})
        d.draw(d.groove(4.0, kDepth), polyline({{285.0, 345.5}, Vec2{285.0, 345.5} + toward(angle, 200.0)}));
    d.draw(d.groove(40.0, kDepth), polyline({{60.0, 464.0}, {440.0, 452.0}}));
    return d.take();
}

// Dashes, dots and slots: strokes little longer than wide.
Pattern draw_slots(double wall) {
    Drawing d(kPatternTexels, wall, kGround);
    for (int row = 0; row < 5; ++row) {
        const double dash = 6.0 + 5.0 * row, gap = 9.0 + row;
        const Vec2 along = toward(row * 3.0);
        for (Vec2 p{20.2, 22.0 + 26.0 * row}; p.x + dash < 495.0; p = p + along * (dash + gap))
            d.draw(d.groove(3.0 + row, kDepth), polyline({p, p + along * dash}));
    }
    const Pen pit = d.step(-kDepth);
    for (int i = 0; i < 14; ++i) {
        const double radius = 3.0 + 0.7 * i, length = 4.0 + i;
        d.draw(pit, slab(Vec2{45.0 + i % 7 * 68.0, 240.0 + i / 7 * 70.0}, {length + radius, radius}, radius, 0.45 * i));
    }
    for (int i = 0; i < 22; ++i)
        d.draw(pit, circle(Vec2{24.3 + 21.7 * i, 380.6 + 3.0 * (i % 3)}, 2.0 + 0.25 * i));
    for (int i = 0; i < 12; ++i)
        d.draw(pit, slab(Vec2{35.7 + 40.3 * i, 455.4}, {12.0, 30.0 - 2.0 * i}, 2.0 + 0.8 * (i % 4), 0.06 * i));
    return d.take();
}

}  // namespace burin::bench
