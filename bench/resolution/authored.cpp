#include "authored.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "drawing.hpp"

namespace burin::bench {
namespace {

constexpr double kRelief = 0.5;  // height of every groove and step, in map scale

// One groove and one kind of step, for drawings that ask where contours lie and not how high.
struct Sheet {
    Drawing drawing;
    Pen groove, step;

    Sheet(int texels, const Walls& walls)
        : drawing(texels, walls.wall, 1.0 - kRelief),
          groove(drawing.groove(walls.groove, kRelief)),
          step(drawing.step(kRelief)) {}

    void lines(const std::vector<Vec2>& points, bool closed = false, bool raised = false) {
        drawing.draw(raised ? step : groove, polyline(points, closed));
    }
    void curve(Vec2 centre, double radius, double from, double to) { drawing.draw(groove, arc(centre, radius, from, to)); }
    void ring(Vec2 centre, double radius, bool raised = false) { drawing.draw(raised ? step : groove, circle(centre, radius)); }
    void plateau(Vec2 centre, Vec2 half, double radius, double angle) { drawing.draw(step, slab(centre, half, radius, angle)); }
};

Vec2 bent(Vec2 p, double amplitude, const double* phase) {
    const double k = 2.0 * 3.14159265358979 * 3.0;
    return p + Vec2{std::sin(k * p.y + phase[0]) + std::sin(1.7 * k * p.x + phase[1]),
                    std::sin(k * p.x + phase[2]) + std::sin(1.3 * k * p.y + phase[3])} * (0.5 * amplitude);
}

Vec2 on_element(const Element& e, double s) {
    return e.kind == ElementKind::line ? lerp(e.p0, e.p2, s) : lerp(lerp(e.p0, e.p1, s), lerp(e.p1, e.p2, s), s);
}

// Moves an end that lay on another path's line to the same place of the moved line.
void keep_on_line(const Pattern& original, Pattern& moved, std::size_t path, bool at_start) {
    const std::vector<Element>& own = original.paths[path].elements;
    const Vec2 end = at_start ? own.front().p0 : own.back().p2;
    for (std::size_t p = 0; p < original.paths.size(); ++p) {
        if (p == path) continue;
        for (std::size_t i = 0; i < original.paths[p].elements.size(); ++i) {
            for (int k = 1; k < 4096; ++k) {
                const double s = k / 4096.0;
                const Vec2 a = on_element(original.paths[p].elements[i], s);
                const Vec2 b = on_element(original.paths[p].elements[i], s + 1.0 / 4096.0);
                const double along = dot(end - a, b - a) / dot(b - a, b - a);
                if (along < 0.0 || along > 1.0 || length(lerp(a, b, along) - end) > 5e-5) continue;
                const Vec2 place = on_element(moved.paths[p].elements[i], s + along / 4096.0);
                std::vector<Element>& elements = moved.paths[path].elements;
                (at_start ? elements.front().p0 : elements.back().p2) = place;
                return;
            }
        }
    }
}

}  // namespace

Pattern plate(int texels, const Walls& walls) {
    Sheet d(texels, walls);
    // Axis-aligned walls lie on multiples of 1/40 of a unit, where 40 samples a side integrate them exactly.
    // Long lines that cross, axis-aligned and oblique.
    d.lines({{17.3, 33.45}, {494.6, 33.45}});
    d.lines({{58.725, 12.2}, {58.725, 301.7}});
    d.lines({{21.4, 291.3}, {197.9, 47.6}});
    d.lines({{90.2, 21.8}, {236.1, 298.4}});
    d.lines({{30.6, 171.2}, {243.7, 201.9}});
    // Stems that end on an axis-aligned line, on an oblique one (below), on an arc.
    d.lines({{290.375, 33.45}, {290.375, 121.8}});
    d.lines({{345.2, 33.45}, {318.9, 118.3}});
    d.lines({{lerp({30.6, 171.2}, {243.7, 201.9}, 0.8)}, {219.3, 128.4}});
    d.curve({420.3, 120.7}, 47.3, -2.6, 2.1);
    d.lines({Vec2{420.3, 120.7} + Vec2{std::cos(0.3), std::sin(0.3)} * 47.3, {501.7, 149.2}});
    // Corners of 130, 90, 60 and 35 degrees.
    d.lines({{270.4, 215.3}, {312.8, 188.6}, {352.1, 211.9}, {352.1, 262.6}, {301.4, 262.6}});
    d.lines({{380.4, 262.1}, {401.7, 204.4}, {431.3, 258.2}, {455.6, 195.1}, {472.8, 261.4}});
    // Arcs of several sizes, two concentric circles, an S that begins and ends straight.
    d.ring({88.6, 410.2}, 62.4);
    d.ring({88.6, 410.2}, 36.7);
    d.curve({191.7, 352.3}, 30.2, 0.4, 3.9);
    // Plateaus: turned rectangle, round, rounded, one with an acute corner.
    d.lines({{238.3, 331.6}, {297.5, 313.2}, {318.6, 381.7}, {259.4, 400.1}}, true, true);
    d.ring({389.4, 345.8}, 38.6, true);
    d.plateau({277.3, 455.8}, {73.1, 27.4}, 11.7, 0.0);
    d.lines({{383.6, 487.2}, {421.9, 409.7}, {496.3, 441.8}, {448.2, 460.4}}, true, true);
    // A groove on a plateau.
    d.drawing.draw(d.drawing.on(d.groove, kRelief), polyline({{223.4, 461.3}, {326.8, 447.9}}));
    return d.drawing.take();
}

Pattern random_plate(int texels, const Walls& walls, unsigned seed) {
    std::mt19937 random(seed);
    const auto in = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
    Sheet d(texels, walls);
    // Four by four fields of 120 units, one motif each.
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            const Vec2 c{76.0 + 120.0 * column + in(-4, 4), 76.0 + 120.0 * row + in(-4, 4)};
            const double angle = in(0.0, 6.283185);
            const auto at = [&](double turn, double radius) {
                return c + Vec2{std::cos(angle + turn), std::sin(angle + turn)} * radius;
            };
            switch ((row * 4 + column + static_cast<int>(seed)) % 8) {
                case 0: d.lines({at(0, 45), at(3.14159265, 45)}), d.lines({at(in(0.35, 2.8), 42), at(in(-2.8, -0.35), 42)}); break;
                case 1: d.lines({at(0, 45), at(3.14159265, 45)}), d.lines({c, at(in(0.7, 2.4), 44)}); break;
                case 2: d.lines({at(0, 44), at(in(1.7, 2.0), in(4, 12)), at(in(3.2, 4.2), 44)}); break;
                case 3: d.curve(c, in(22, 44), angle, angle + in(2, 5)); break;
                case 4: d.ring(c, in(20, 42), true); break;
                case 5: d.plateau(c, {in(25, 40), in(18, 25)}, in(6, 14), in(-0.7, 0.7)); break;
                case 6: d.lines({at(0, 44), at(1.2, 40), at(2.9, 42), at(4.4, 38)}, true, true); break;
                default: d.curve(c, in(28, 44), angle, angle + 4.5), d.curve(c, in(14, 18), angle, angle + 3.0); break;
            }
        }
    }
    return d.drawing.take();
}

Pattern disturbed(const Pattern& pattern, int texels, double texels_off, double share, unsigned seed) {
    std::mt19937 random(seed);
    const auto unit_random = [&] { return random() / 4294967296.0; };
    double phase[4];
    for (double& p : phase) p = 6.283185 * unit_random();
    Pattern out = pattern;
    for (Profile& profile : out.profiles) {
        const double wider = 1.0 + share * (2.0 * unit_random() - 1.0);
        const double deeper = 1.0 - 0.5 * share * unit_random();
        const bool step = std::abs(profile.points.back().h - profile.points.front().h) > 0.0;
        for (ProfilePoint& point : profile.points) {
            point.b *= wider;
            if (!step) point.h *= deeper;
        }
    }
    for (Path& path : out.paths) {
        for (Element& e : path.elements) {
            e.p0 = bent(e.p0, texels_off / texels, phase);
            e.p1 = bent(e.p1, texels_off / texels, phase);
            e.p2 = bent(e.p2, texels_off / texels, phase);
        }
    }
    for (std::size_t p = 0; p < out.paths.size(); ++p) {
        if (out.paths[p].closed) continue;
        keep_on_line(pattern, out, p, true);
        keep_on_line(pattern, out, p, false);
    }
    return out;
}

std::vector<double> half_heights(const Pattern& pattern) {
    std::vector<double> halves;
    for (const Path& path : pattern.paths) {
        double extreme = 0.0;
        for (const ProfilePoint& point : pattern.profiles[path.profile].points)
            if (std::abs(point.h) > std::abs(extreme)) extreme = point.h;
        const double half = 1.0 + (path.level + 0.5 * extreme - pattern.base_offset) / pattern.depth;
        const auto near = [&](double other) { return std::abs(other - half) < 1e-6; };
        if (std::none_of(halves.begin(), halves.end(), near)) halves.push_back(half);
    }
    std::sort(halves.begin(), halves.end());
    return halves;
}

}  // namespace burin::bench
